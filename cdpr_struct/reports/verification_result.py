"""result.json of a verification, and its eigenfrequencies as a table."""

import dataclasses
import math
from typing import Any

import numpy as np

from cdpr_struct.crosscheck.validity_limits import (
    CROSSOVER_DISTANCE,
    INCLINATION_EPSILON_PAIRS,
    LAMBDA_SQUARED_LIMIT,
    SAG_RATIO_LIMIT,
    ValidityLimits,
)
from cdpr_struct.crosscheck.verdicts import Judged
from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.reports.trust import Check
from cdpr_struct.reports.verification_verdict import what_to_do, worst


def verification_json(v: Verification, pose: list[float]) -> dict[str, Any]:
    """The result under the keys that scripts rely on; SI units and Hz, nan where a model has no such mode."""
    return {
        "robot": v.point.entered.name,
        "pose": pose,
        "platform_mass_kg": v.point.entered.platform.mass,
        "platform_inertia_kg_m2": v.point.entered.platform.inertia,
        "assembly": v.assembly,
        "lengths_m": v.point.cables.length,
        "tensions_N": v.point.cables.tension_at_platform,
        "eigenfrequencies": [_row(v, i) for i in range(len(v.dsm_hertz))],
        "count_certified": v.dsm_certified,
        "neutral_freedoms_counted": {"model": v.neutral, "fem": v.fem_neutral},
        "convergence": {
            "elements": list(v.elements),
            "max_relative_error": v.mesh_error.max(axis=1),
            "max_relative_error_consistent_mass": v.consistent_mesh_error.max(axis=1),
            "stiffness_max_error": v.stiffness.fem_error.max(axis=1),
            "stiffness_max_error_dsm": float(v.stiffness.dsm_error.max()),
            "stiffness_compared_at_hz": v.stiffness.omega_hertz,
            "max_uncertainty": v.fem_uncertainty,
            "observed_order": _median(v.observed_order),
            "observed_order_range": _range(v.observed_order),
        },
        "max_relative_error": float(np.abs(v.relative_error).max()),
        "max_relative_error_exact": float(np.abs(v.exact_error).max()),
        "geometric_term_effect": v.geometric_effect,
        "missed_by_determinant_scan": v.missed_by_scan,
        "determinant_scan": {"step_hz": v.scan.step_hertz, "missed_by_step": v.missed, "spurious_by_step": v.spurious},
        "limits": limits_json(v.limits),
        "verdict": {"holds": not v.objections(), "objections": v.objections(), "model": v.judged[0]},
        "verdicts": {model: _verdict(v, model) for model in v.judged},
        "what_to_do": what_to_do(v),
        "mac": {"exact": v.exact_mac, "dsm": v.dsm_mac},
    }


def verification_checks(v: Verification) -> list[Check]:
    """Whether the FEM has converged to a limit sharp enough to judge by; the verdicts say the rest."""
    model = min(v.judged, key=lambda one: v.agreement(one).criteria.fem_uncertainty(one))
    found = v.agreement(model)
    asked = 100.0 * found.criteria.fem_uncertainty(model)
    return [Check.of("uncertainty of the FEM", 100.0 * v.fem_uncertainty, asked, found.undecided, "%")]


def _verdict(v: Verification, model: Judged) -> dict[str, Any]:
    found = v.agreement(model)
    return {
        "holds": not found.objections,
        "status": found.status,
        "objections": found.objections,
        "max_relative_error": worst(found),
        "tolerance": v.criteria.tolerance(model),
        "causes": [{"effect": c.effect, "remaining_error": c.error} for c in v.causes.get(model, ())],
    }


def _median(values: np.ndarray) -> float:
    return float(np.nanmedian(values)) if np.isfinite(values).any() else math.nan


def _range(values: np.ndarray) -> list[float]:
    found = values[np.isfinite(values)]
    return [float(found.min()), float(found.max())] if len(found) else [math.nan, math.nan]


def limits_json(limits: ValidityLimits) -> dict[str, Any]:
    """Cable parameters beside their printed limits."""
    return {
        "cables": [
            {
                "cable": i + 1,
                "lambda2": limits.lambda_squared[i],
                "epsilon": limits.epsilon[i],
                "alpha_deg": limits.inclination_deg[i],
                "sag_ratio": limits.sag_ratio[i],
                "crossover_distance": limits.crossover_distance[i],
            }
            for i in range(len(limits.epsilon))
        ],
        "printed_limits": {
            "lambda2": LAMBDA_SQUARED_LIMIT,
            "crossover_distance": CROSSOVER_DISTANCE,
            "alpha_deg_and_epsilon": [list(pair) for pair in INCLINATION_EPSILON_PAIRS],
            "sag_ratio": SAG_RATIO_LIMIT,
        },
        "violations": [dataclasses.asdict(violation) for violation in limits.violations],
    }


def _row(v: Verification, i: int) -> dict[str, Any]:
    return {
        "mode": i + 1,
        "fem_hz": v.fem_limit_hertz[i],
        "fem_uncertainty_hz": v.fem_uncertainty_hertz[i],
        "dsm_hz": v.dsm_hertz[i],
        "exact_hz": v.exact_hertz[i],
        "static_hz": v.static_hertz[i],
        "determinant_minimum_hz": v.determinant_hertz[i],
        "relative_error": v.relative_error[i],
        "exact_relative_error": v.exact_error[i],
        "shape_share": v.assurance[i],
        "exact_shape_share": v.exact_assurance[i],
        "kind": v.kinds[i],
    }


def mac_columns(trial: Verification) -> dict[str, Any]:
    """Columns of mac.csv: each FEM mode beside each model's mode, numbered by its FEM partner."""
    number = np.arange(1, len(trial.kinds) + 1)
    return {
        "fem_mode": np.repeat(number, len(number)),
        "model_mode": np.tile(number, len(number)),
        "mac_exact": trial.exact_mac.ravel(),
        "mac_dsm": trial.dsm_mac.ravel(),
    }


def eigenfrequency_columns(trial: Verification) -> dict[str, Any]:
    """Columns of eigenfrequencies.csv, one row a mode."""
    return {
        "mode": range(1, len(trial.kinds) + 1),
        "kind": trial.kinds,
        "fem_hz": trial.fem_limit_hertz,
        "fem_uncertainty_hz": trial.fem_uncertainty_hertz,
        "dsm_hz": trial.dsm_hertz,
        "relative_error": trial.relative_error,
        "exact_hz": trial.exact_hertz,
        "static_hz": trial.static_hertz,
        "determinant_minimum_hz": trial.determinant_hertz,
        "shape_share": trial.assurance,
        "observed_order": trial.observed_order,
        "exact_relative_error": trial.exact_error,
    }
