"""A trial of the printed limits in words."""

import numpy as np

from cdpr_struct.crosscheck.limits_causes import Candidate, MissingLimit
from cdpr_struct.crosscheck.limits_domain import MAX_STRAIN
from cdpr_struct.crosscheck.limits_errors import QUANTITIES
from cdpr_struct.crosscheck.limits_strictness import StrictLimit
from cdpr_struct.crosscheck.limits_trial import LimitsTrial
from cdpr_struct.reports.text import paragraphs, plain_table

QUANTITY_NAMES = {
    "in_plane_frequency": "clamped frequencies in plane (6)",
    "across_frequency": "clamped frequencies out of plane (3)",
    "mode_shape": "mode shapes in plane, 1 - MAC",
    "end_stiffness": "end stiffness K(omega)",
    "end_mass_frequency": "frequencies with a mass at the end",
}
CAUSE_NAMES = {
    "along_weight": "weight along the chord",
    "axial_inertia": "inertia along the chord",
    "static_strain": "static strain",
    "higher_order_sag": "curvature beyond the parabola",
    "several": "several together",
}
SYMBOLS = {
    "epsilon": "ε",
    "along_weight": "ε tan α",
    "weight": "μ g l / τ",
    "strain": "τ/EA",
    "lambda2": "λ²",
    "inverse_lambda2": "1/λ²",
    "alpha_deg": "α [°]",
    "crossover_closeness": "1/(crossover distance)",
    "frequency": "Ω",
    "axial_phase": "Ω √(τ/EA)",
    "cable_to_end_mass": "cable mass / end mass",
}
PRINTED = {
    "lambda2": "λ² ≤ 24",
    "crossover_distance": "20 % from 4n²π²",
    "alpha_deg": "α ≤ 60°",
    "epsilon": "ε ≤ 0.24 (30°), 0.1 (60°)",
    "sag_ratio": "d/l ≤ 1/20",
}


def limits_trial_text(trial: LimitsTrial) -> str:
    """Tables and verdict for a terminal."""
    blocks = [
        plain_table(f"Inside the printed limits, {int(trial.inside.sum())} cables", INSIDE_COLUMNS, inside_rows(trial)),
        plain_table("Limits that are missing", MISSING_COLUMNS, missing_rows(trial)),
        plain_table("What each printed limit refuses on its own", STRICT_COLUMNS, strict_rows(trial)),
        plain_table("Random cables inside the printed limits", HELD_OUT_COLUMNS, held_out_rows(trial)),
        plain_table("Before the FEM", REFEREE_COLUMNS, referee_rows(trial)),
        "\n".join(verdict(trial)),
    ]
    return paragraphs(*blocks)


INSIDE_COLUMNS = ["quantity", "largest error [%]", "volume above tolerance [%]", "at α [°]", "ε", "λ²", "τ/EA [%]"]


def inside_rows(trial: LimitsTrial) -> list[list[str]]:
    """One row a quantity: its largest error and where."""
    rows = []
    total = trial.volume[trial.inside].sum()
    for quantity in QUANTITIES:
        cable, sample = trial.worst_inside(quantity)
        bad = (trial.error(quantity) > trial.tolerance) & trial.inside
        error = trial.measured[quantity].error[cable, sample]
        share = trial.volume[bad].sum() / total
        rows.append([QUANTITY_NAMES[quantity], _percent(error), f"{100.0 * share:.1f}", *_place(trial, cable)])
    return rows


MISSING_COLUMNS = [
    "quantity",
    "cause",
    "limit",
    "good volume lost [%]",
    "worst error [%]",
    "switched off [%]",
    "next best",
]


def missing_rows(trial: LimitsTrial) -> list[list[str]]:
    """One row a missing limit."""
    return [
        [
            QUANTITY_NAMES[m.quantity],
            CAUSE_NAMES[m.cause],
            limit_text(m.limit),
            f"{100.0 * m.limit.cost:.1f}",
            _percent(m.error),
            _percent(switched_off(m)),
            f"{limit_text(m.others[0])} ({100.0 * m.others[0].cost:.1f})" if m.others else "-",
        ]
        for m in trial.missing
    ]


def switched_off(limit: MissingLimit) -> float:
    """The worst error with its cause taken out of the reference; with all effects out if it has several."""
    return limit.without.get(limit.cause, limit.without["all"])


STRICT_COLUMNS = ["printed limit", "quantity", "cables refused", "of these below tolerance [%]", "enough would be"]


def strict_rows(trial: LimitsTrial) -> list[list[str]]:
    """One row a printed limit and quantity."""
    return [
        [
            PRINTED[s.parameter],
            QUANTITY_NAMES[s.quantity],
            str(s.refused),
            f"{100.0 * s.good:.0f}" if np.isfinite(s.good) else "-",
            _instead(s),
        ]
        for s in trial.strict
    ]


HELD_OUT_COLUMNS = [
    "quantity",
    "largest error [%]",
    "with further limits [%]",
    "samples above: before [%]",
    "after [%]",
]


def held_out_rows(trial: LimitsTrial) -> list[list[str]]:
    """One row a quantity."""
    return [
        [QUANTITY_NAMES[h.quantity], _percent(h.before), _percent(h.after), _percent(h.bad), _percent(h.left)]
        for h in trial.held_out
    ]


REFEREE_COLUMNS = ["α [°]", "ε", "λ²", "τ/EA [%]", "DSM-FEM [%]", "exact-FEM", "FEM ±", "exact-FEM, K(ω)"]


def referee_rows(trial: LimitsTrial) -> list[list[str]]:
    """One row a judged cable: largest relative deviations."""
    return [
        [
            *_place(trial, int(cable)),
            _percent(v.closed_form),
            f"{v.catenary:.0e}",
            f"{v.uncertainty:.0e}",
            f"{v.stiffness:.0e}",
        ]
        for cable, v in zip(trial.judged, trial.verdicts, strict=True)
    ]


_WHAT_TO_DO = (
    "What to do: use the exact model, the default of all commands, which has none of these limits; `verify ROBOT` "
    "shows how far off the closed form is for a robot."
)


def verdict(trial: LimitsTrial) -> list[str]:
    """The outcome in plain sentences."""
    tolerance = f"{100.0 * trial.tolerance:g} %"
    if trial.holds:
        return [
            f"THE PRINTED LIMITS SUFFICE: inside them no error exceeds {tolerance}, strains up to {MAX_STRAIN:.0%}.",
            _WHAT_TO_DO,
        ]
    clamped = max(float(trial.error(q)[trial.inside].max()) for q in ("in_plane_frequency", "across_frequency"))
    loaded = float(trial.error("end_mass_frequency")[trial.inside].max())
    further = "; ".join(
        f"{QUANTITY_NAMES[q]}: {' and '.join(limit_text(m.limit) for m in trial.missing if m.quantity == q)}"
        for q in dict.fromkeys(m.quantity for m in trial.missing)
    )
    inclined = trial.curves[-1]
    return [
        f"THE PRINTED LIMITS DO NOT SUFFICE: inside them clamped frequencies are off by up to {100.0 * clamped:.2g} %, "
        f"frequencies of a mass on the cable by up to {100.0 * loaded:.2g} % (strain at most {MAX_STRAIN:.0%}).",
        f"What is missing to stay below {tolerance}: {further}.",
        f"At the first crossover the closed form's two frequencies cross; in a cable at {inclined.inclination_deg:g}° "
        f"with ε = {inclined.epsilon:g} they keep {100.0 * inclined.gap:.2g} % apart and exchange their shapes.",
        _WHAT_TO_DO,
    ]


def limit_text(limit: Candidate) -> str:
    """`symbol < threshold`."""
    return f"{SYMBOLS[limit.parameter]} < {limit.threshold:g}"


def _instead(strict: StrictLimit) -> str:
    if not strict.refused:
        return "-"
    if strict.instead is None:
        return "nothing"
    return f"{limit_text(strict.instead)} ({100.0 * strict.instead.cost:.0f} % of the good lost)"


def _place(trial: LimitsTrial, cable: int) -> list[str]:
    one = trial.groups
    return [
        f"{one.inclination_deg[cable]:.0f}",
        f"{one.epsilon[cable]:.3g}",
        f"{one.lambda_squared[cable]:.3g}",
        f"{100.0 * one.strain[cable]:.2g}",
    ]


def _percent(ratio: float) -> str:
    return f"{100.0 * ratio:.3g}"
