"""Everything about one cable under one end force (thesis sections 2.1 and 2.3)."""

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.crosscheck.clamped_frequencies import catenary_frequencies, fem_frequencies, pulled_cable
from cdpr_struct.crosscheck.validity_limits import (
    LAMBDA_SQUARED_LIMIT,
    SAG_RATIO_LIMIT,
    crossover_distance,
    epsilon_limit,
    limit_violations,
)
from cdpr_struct.dynamics.clamped_cable import symmetric_roots
from cdpr_struct.generated import cable_compliance, cable_dsm, catenary
from cdpr_struct.statics.catenary import solve_end_forces

_MODES = 6
_FINER = 1.5  # times the polynomials


@dataclasses.dataclass(frozen=True, slots=True)
class CableCertainty:
    """How well the numbers of one cable are known.

    force_missed    : of the end force, by which that of a cable solved for the end point differs [-]
    frequency_moved : largest relative change of the exact frequencies by half again as many polynomials
    fem_apart       : their largest relative difference from the FEM's, None if it was not asked
    strain          : largest T / EA [-]
    """

    force_missed: float
    frequency_moved: float
    fem_apart: float | None
    strain: float


def cable_certainty(told: Mapping[str, Any]) -> CableCertainty:
    """Of what `describe_cable` tells: its shape solved the other way round, its frequencies by more polynomials."""
    given, end = told["input"], (told["x_m"], told["z_m"])
    (force_x, force_z), length = given["force_N"], given["length_m"]
    stiff, density = given["axial_stiffness_N"], given["linear_density_kg_m"]
    weight = density * given["gravity_m_s2"]
    back = solve_end_forces(abs(end[0]), end[1], length, stiff, weight)
    tension = np.hypot(force_x, [force_z, force_z - weight * length]).max()
    missed = np.hypot(back.force_x - abs(force_x), back.force_z - force_z) / tension
    cable = pulled_cable((force_x, force_z), end, length, stiff, weight)
    finer = catenary_frequencies(cable, density, _MODES, _FINER)
    exact = told["exact_frequencies_hz"]
    moved = max(float(np.abs(np.divide(exact[plane], finer[plane]) - 1.0).max()) for plane in exact)
    by_fem, apart = told.get("fem_frequencies_hz"), None
    if by_fem is not None:  # six of either plane hold the six lowest of both
        lowest = np.sort(np.concatenate([exact[plane] for plane in exact]))[:_MODES]
        apart = float(np.abs(lowest / np.asarray(by_fem)[:_MODES] - 1.0).max())
    return CableCertainty(float(missed), moved, apart, float(tension) / stiff)


def describe_cable(
    force_x: float, force_z: float, length: float, axial_stiffness: float, density: float, gravity: float,
    with_fem: bool = False,
) -> dict[str, Any]:  # fmt: skip
    """Static and dynamic parameters of a cable held at one end and pulled by a force at the other.

    Parameters
    ----------
    force_x, force_z : pull at the free end C [N], x horizontal (not zero), z up
    length : unstrained [m];  axial_stiffness : EA [N];  density : [kg/m];  gravity : [m/s^2]
    with_fem : the FEM's frequencies, too

    Returns
    -------
    dict with SI values under the keys of the command's result.json. Eqs (2.11)-(2.29), (2.36)-(2.41); `frequencies_hz`
    by the closed form, `exact_frequencies_hz` by the catenary itself.
    """
    weight = density * gravity
    five = (force_x, force_z, length, axial_stiffness, weight)
    x, z = catenary.end_point(*five)
    chord, tau = float(np.hypot(x, z)), float(catenary.chord_tension(*five))
    perpendicular = weight * abs(x) / chord
    epsilon = float(cable_dsm.epsilon(chord, tau, perpendicular))
    effective = float(cable_dsm.effective_length_integral(chord, epsilon))
    lambda2 = float(cable_dsm.lambda_squared(chord, tau, axial_stiffness, effective, perpendicular))
    sag = float(catenary.sag(*five))
    inclination = float(np.degrees(np.arctan2(abs(z), abs(x))))
    axial, c_xx, c_xz, c_zz = (float(c) for c in cable_compliance.compliance(*five))
    cable = pulled_cable((force_x, force_z), (float(x), float(z)), length, axial_stiffness, weight)
    by_fem = {"fem_frequencies_hz": fem_frequencies(cable, density, gravity, 2 * _MODES)} if with_fem else {}
    k_xx, k_xz, k_zz = (float(k) for k in cable_compliance.stiffness(*five))
    return {
        "x_m": float(x),
        "z_m": float(z),
        "chord_m": chord,
        "inclination_deg": inclination,
        "sag_m": sag,
        "elongation_m": float(catenary.elongation(*five)),
        "tau_N": tau,
        "lambda2": lambda2,
        "epsilon": epsilon,
        "compliance_axial": [[axial, 0.0], [0.0, axial]],
        "compliance_sag": [[c_xx, c_xz], [c_xz, c_zz]],
        "stiffness": [[k_xx, k_xz], [k_xz, k_zz]],
        "frequencies_hz": _clamped_frequencies(chord, tau, density, lambda2),
        "exact_frequencies_hz": catenary_frequencies(cable, density, _MODES),
        **by_fem,
        "validity": _validity(lambda2, inclination, epsilon, sag / chord),
        "input": {
            "force_N": [force_x, force_z],
            "length_m": length,
            "axial_stiffness_N": axial_stiffness,
            "linear_density_kg_m": density,
            "gravity_m_s2": gravity,
        },
    }


def _clamped_frequencies(chord: float, tau: float, density: float, lambda2: float) -> dict[str, list[float]]:
    scale = np.sqrt(tau / density) / chord / (2.0 * np.pi)
    number = np.arange(1, _MODES + 1)
    in_plane = np.sort(np.concatenate([2.0 * np.pi * number, symmetric_roots(np.asarray(lambda2), _MODES)]))
    return {
        "out_of_plane": (scale * np.pi * number).tolist(),
        "in_plane": (scale * in_plane[:_MODES]).tolist(),
    }


def _validity(lambda2: float, inclination: float, epsilon: float, sag_ratio: float) -> dict[str, Any]:
    violations = limit_violations(1, lambda2, inclination, epsilon, sag_ratio)
    return {
        "valid": not violations,
        "lambda2_limit": LAMBDA_SQUARED_LIMIT,
        "epsilon_limit": epsilon_limit(inclination),
        "sag_ratio": sag_ratio,
        "sag_ratio_limit": SAG_RATIO_LIMIT,
        "crossover_distance": float(crossover_distance(np.asarray(lambda2))),
        "violations": [dataclasses.asdict(v) for v in violations],
    }
