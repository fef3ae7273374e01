"""Static cables: a load between two spans, a heated span, and the forces at the ends of three catenaries."""

from collections.abc import Callable
from functools import cache

import numpy as np
from scipy.optimize import fsolve

import cdpr_struct.fem_reference as fem
from cdpr_struct.statics.catenary import solve_end_forces
from tests.published.case import Case

EndForces = Callable[[np.ndarray, float, float, float], tuple[np.ndarray, np.ndarray]]
Value = Callable[[EndForces], float]
BARS = (100, 200, 400)


def by_the_model(end: np.ndarray, length: float, stiffness: float, weight: float) -> tuple[np.ndarray, np.ndarray]:
    """Forces (x, z) on a cable from the origin to `end` (x, z) at its start and at its end [N]."""
    forces = solve_end_forces(abs(end[0]), end[1], length, stiffness, weight)
    at_end = np.array([np.sign(end[0]) * float(forces.force_x), float(forces.force_z)])
    return np.array([0.0, weight * length]) - at_end, at_end


def by_bars(end: np.ndarray, length: float, stiffness: float, weight: float) -> tuple[np.ndarray, np.ndarray]:
    """The same of bar elements, extrapolated to infinitely many."""
    data = fem.CableData(length, stiffness, weight)
    held = [fem.solve_cable(data, np.zeros(3), [end[0], 0.0, end[1]], n, (0.0, 0.0, -1.0)) for n in BARS]
    forces = np.array([np.concatenate([each.start_force, each.end_force]) for each in held])
    limit = np.asarray(fem.extrapolate(BARS, forces).limit)
    return limit[[0, 2]], limit[[3, 5]]


# A cable over 1000 ft with a load of 8 kip at 400 ft: Jayaraman and Knudson's isolated cable. Its two lengths are those
# with which it hangs through the printed place of the node under its own weight.
SPAN, LOAD, CABLE_EA, CABLE_WEIGHT = 304.8, 35.586e3, 131.0e9 * 548.4e-6, 46.12
NODE = np.array([121.92, -29.276])


def pull_at_node(end_forces: EndForces, node: np.ndarray, lengths: np.ndarray) -> np.ndarray:
    """Force (x, z) [N] that holds two cables at the node where they meet; supports at (0, 0) and (SPAN, 0)."""
    left = end_forces(node, lengths[0], CABLE_EA, CABLE_WEIGHT)[1]
    return np.asarray(left + end_forces(node - [SPAN, 0.0], lengths[1], CABLE_EA, CABLE_WEIGHT)[1])


def solved(residual: Callable[[np.ndarray], np.ndarray], start: np.ndarray) -> np.ndarray:
    """Root of a few equations."""
    root, _, flag, message = fsolve(residual, start, xtol=1e-12, full_output=True)
    assert flag == 1, message
    return np.asarray(root)


@cache
def node_displacement(end_forces: EndForces) -> np.ndarray:
    """Displacement (x, z) [m] of the node that the load of 35.586 kN causes."""
    chords = np.hypot([NODE[0], SPAN - NODE[0]], NODE[1])
    lengths = solved(lambda lengths: pull_at_node(end_forces, NODE, lengths) / LOAD, 1.004 * chords)
    load = np.array([0.0, -LOAD])
    return (
        solved(lambda node: (pull_at_node(end_forces, node, lengths) - load) / LOAD, NODE - np.array([0.9, 5.6])) - NODE
    )


# SSNL114 of Code_Aster: as long as its span when cold and weightless.
SSNL_LENGTH, SSNL_EA, SSNL_WEIGHT = 325.0, 5.7e10 * 2.2783e-4, 2844.23 * 2.2783e-4 * 9.81
EXPANSION, HEATED = 2.3e-5, 39.26


def sag_at_middle(end_forces: EndForces, temperature: float) -> float:
    """Height [m] of the middle of the cable: where one half of it meets the other, level."""
    half = 0.5 * SSNL_LENGTH * (1.0 + EXPANSION * temperature)

    def vertical_force(drop: np.ndarray) -> np.ndarray:
        return end_forces(np.array([0.5 * SSNL_LENGTH, -drop[0]]), half, SSNL_EA, SSNL_WEIGHT)[1][1:]

    return -float(solved(vertical_force, np.array([7.0]))[0])


# Rows of MoorPy's table of catenaries that do not touch the sea bed; the last one is buoyant: mirrored here.
MOORPY_ROWS = {
    "inextensible": ((400.0, 200.0, 500.0, 7.51e12, 200.0), (43694.580989249596, 77634.40064978378)),
    "short": ((89.9, 59.2, 130.0, 7.51e8, 881.05), (31373.229006023103, 87886.15872988368)),
    "slack": (
        (37.96888656874307, -20.49078283711694, 100.0, 7.51e8, 881.0549577007893),
        (6428.437434537766, 34926.76640219652),
    ),
}


def _case(title: str, source: str, quantity: str, told: float, accepted: float, because: str, value: Value) -> Case:
    unit = "N" if quantity.startswith("force") else "m"
    return Case(
        title, source, quantity, unit, told, accepted, because, lambda: value(by_the_model), lambda: value(by_bars)
    )


LOADED = ("cable with a load at two fifths of its span", "Jayaraman and Knudson 1981")
HEAVY = ("heavy cable as long as its span", "Code_Aster SSNL114")
CASES = (
    _case(*LOADED, "displacement z", -5.626, 1e-4, "four digits printed", lambda by: float(node_displacement(by)[1])),
    _case(*LOADED, "displacement x", -0.859, 6e-4, "three digits printed", lambda by: float(node_displacement(by)[0])),
    _case(*HEAVY, "height of the middle", -6.352, 1e-4, "four digits printed", lambda by: sag_at_middle(by, 0.0)),
    _case(
        *HEAVY,
        "the same, heated by 39.26 K",
        -8.19545175,
        1e-9,
        "nine digits printed",
        lambda by: sag_at_middle(by, HEATED),
    ),
    *(
        _case(
            f"mooring line off the sea bed, {name}",
            "MoorPy, table of its tests",
            f"force {axis}",
            told[k],
            1e-6,
            "solved there to 1e-6",
            lambda by, given=given, k=k: float(by(np.array(given[:2]), *given[2:])[1][k]),
        )
        for name, (given, told) in MOORPY_ROWS.items()
        for k, axis in enumerate("xz")
    ),
)
