"""result.json and tables of a trial of the printed limits."""

from typing import Any

import numpy as np

from cdpr_struct.crosscheck.limits_causes import Candidate, MissingLimit
from cdpr_struct.crosscheck.limits_domain import MAX_STRAIN, MAX_WEIGHT
from cdpr_struct.crosscheck.limits_errors import QUANTITIES
from cdpr_struct.crosscheck.limits_groups import broken_limits
from cdpr_struct.crosscheck.limits_strictness import StrictLimit
from cdpr_struct.crosscheck.limits_trial import LimitsTrial
from cdpr_struct.reports.csv_table import csv_text

RELATIVE = tuple(q for q in QUANTITIES if q != "mode_shape")
MEANINGS = {
    "epsilon": "weight across the chord over tension, mu g l_c cos(alpha) / tau",
    "along_weight": "weight along the chord over tension, epsilon tan(alpha)",
    "weight": "weight over tension, mu g l_c / tau",
    "strain": "static strain tau / EA = epsilon^2 l_c / (lambda^2 L_e)",
    "lambda2": "Irvine's parameter lambda^2",
    "inverse_lambda2": "1 / lambda^2",
    "alpha_deg": "inclination of the chord, degrees",
    "crossover_closeness": "one over the relative distance of lambda^2 to the nearest 4 n^2 pi^2",
    "frequency": "Omega = omega l_c sqrt(mu / tau)",
    "axial_phase": "phase of the axial wave along the cable, omega l_c sqrt(mu / EA) = Omega sqrt(tau / EA)",
    "cable_to_end_mass": "mass of the cable over the mass at its end",
}


def limits_trial_json(trial: LimitsTrial) -> dict[str, Any]:
    """The result under the keys that scripts rely on."""
    by_quantity = {q: _worst_inside(trial, q) for q in QUANTITIES}
    worst = max((by_quantity[q] for q in RELATIVE), key=lambda w: w["error"])
    return {
        "tolerance": trial.tolerance,
        "holds": trial.holds,
        "groups": MEANINGS,
        "domain": {
            "cables": len(trial.groups),
            "inside_printed_limits": int(trial.inside.sum()),
            "alpha_deg": trial.extent.domain.inclination_deg,
            "epsilon": trial.extent.domain.epsilon,
            "lambda2": trial.extent.domain.lambda_squared,
            "largest_strain": MAX_STRAIN,
            "largest_weight": MAX_WEIGHT,
        },
        "inside_limits": {"max_relative_error": worst["error"], "worst": worst, "by_quantity": by_quantity},
        "missing_limits": [_missing(trial, limit) for limit in trial.missing],
        "needlessly_strict": [_strict(trial, limit) for limit in trial.strict],
        "held_out": _held_out(trial),
        "referee": [_judged(trial, i) for i in range(len(trial.judged))],
        "veering": _veering(trial),
    }


def _held_out(trial: LimitsTrial) -> list[dict[str, Any]]:
    return [
        {
            "quantity": h.quantity,
            "cables": h.cables,
            "max_error_inside_printed": h.before,
            "max_error_inside_further": h.after,
            "share_above_tolerance_before": h.bad,
            "share_above_tolerance_after": h.left,
            "share_kept": h.kept,
        }
        for h in trial.held_out
    ]


def _veering(trial: LimitsTrial) -> list[dict[str, Any]]:
    return [
        {
            "alpha_deg": c.inclination_deg,
            "epsilon": c.epsilon,
            "relative_gap_at_first_crossover": c.gap,
            "lambda2": c.gap_at,
            "largest_mode_shape_error": float(c.mode_shape_error.max()),
        }
        for c in trial.curves
    ]


def point_json(trial: LimitsTrial, cable: int) -> dict[str, float]:
    """Parameters that rebuild a cable of the trial: `CableGroups.of(alpha_deg, epsilon, lambda2)`."""
    one = trial.groups
    return {
        "alpha_deg": float(one.inclination_deg[cable]),
        "epsilon": float(one.epsilon[cable]),
        "lambda2": float(one.lambda_squared[cable]),
        "strain": float(one.strain[cable]),
        "along_weight": float(one.along[cable]),
    }


def sample_json(trial: LimitsTrial, quantity: str, cable: int, sample: int) -> dict[str, Any]:
    """Where an error was measured, enough to measure it again."""
    samples = trial.measured[quantity]
    ratio = float(samples.mass_ratio[sample])
    return {
        "quantity": quantity,
        **point_json(trial, cable),
        "sample": sample,
        "what": samples.label[sample],
        "frequency": float(samples.frequency[cable, sample]),
        "end_mass_over_cable_mass": ratio if np.isfinite(ratio) else None,
        "error": float(samples.error[cable, sample]),
    }


def cable_columns(trial: LimitsTrial) -> dict[str, Any]:
    """Columns of cables.csv: every cable of the domain with its worst errors and the limits it breaks."""
    broken, one = broken_limits(trial.groups), trial.groups
    return {
        "alpha_deg": one.inclination_deg,
        "epsilon": one.epsilon,
        "lambda2": one.lambda_squared,
        "strain": one.strain,
        "along_weight": one.along,
        **{f"{quantity}_error": trial.error(quantity) for quantity in QUANTITIES},
        "breaks": [";".join(name for name in broken if broken[name][i]) for i in range(len(one))],
    }


def veering_csv(trial: LimitsTrial) -> str:
    """In-plane frequencies over lambda^2, horizontal and inclined."""
    curves, modes = trial.curves, range(trial.curves[0].catenary.shape[1])
    columns: dict[str, Any] = {
        "alpha_deg": np.concatenate([np.full(len(c.lambda_squared), c.inclination_deg) for c in curves]),
        "epsilon": np.concatenate([np.full(len(c.lambda_squared), c.epsilon) for c in curves]),
        "lambda2": np.concatenate([c.lambda_squared for c in curves]),
    }
    for k in modes:
        columns[f"dsm_Omega_{k + 1}"] = np.concatenate([c.closed_form[:, k] for c in curves])
        columns[f"exact_Omega_{k + 1}"] = np.concatenate([c.catenary[:, k] for c in curves])
    return csv_text(columns)


def _worst_inside(trial: LimitsTrial, quantity: str) -> dict[str, Any]:
    cable, sample = trial.worst_inside(quantity)
    bad = (trial.error(quantity) > trial.tolerance) & trial.inside
    share = float(trial.volume[bad].sum() / trial.volume[trial.inside].sum())
    return {**sample_json(trial, quantity, cable, sample), "share_of_volume_above_tolerance": share}


def _candidate(candidate: Candidate | None) -> dict[str, Any] | None:
    if candidate is None:
        return None
    return {
        "parameter": candidate.parameter,
        "threshold": candidate.threshold,
        "share_of_good_volume_lost": candidate.cost,
    }


def _missing(trial: LimitsTrial, limit: MissingLimit) -> dict[str, Any]:
    return {
        "parameter": limit.limit.parameter,
        "threshold": limit.limit.threshold,
        "meaning": MEANINGS[limit.limit.parameter],
        "quantity": limit.quantity,
        "cause": limit.cause,
        "share_of_good_volume_lost": limit.limit.cost,
        "evidence": {
            **sample_json(trial, limit.quantity, limit.cable, limit.sample),
            "error_with_effect_switched_off": limit.without,
            "samples_above_tolerance": limit.samples,
            "alternatives": [_candidate(other) for other in limit.others],
        },
    }


def _strict(trial: LimitsTrial, limit: StrictLimit) -> dict[str, Any]:
    example = None
    if limit.example >= 0:
        example = {**point_json(trial, limit.example), "error": limit.error}
    return {
        "parameter": limit.parameter,
        "quantity": limit.quantity,
        "cables_refused": limit.refused,
        "share_of_refused_volume_below_tolerance": limit.good,
        "instead": _candidate(limit.instead),
        "farthest_good_cable": example,
    }


def _judged(trial: LimitsTrial, i: int) -> dict[str, Any]:
    verdict = trial.verdicts[i]
    return {
        **point_json(trial, int(trial.judged[i])),
        "dsm_frequency_error_against_fem": verdict.closed_form,
        "exact_frequency_error_against_fem": verdict.catenary,
        "fem_uncertainty": verdict.uncertainty,
        "exact_stiffness_error_against_fem": verdict.stiffness,
    }
