"""Natural frequencies of single cables with both ends held, at the measured state, in any world."""

from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline

from cdpr_struct.diagnosis.world import World
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.clamped_cable import symmetric_roots
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.stiff_cable import bending_factor, load_factor, slenderness
from cdpr_struct.generated import cable_dsm
from cdpr_struct.measurement.campaign import CableFrequencies
from cdpr_struct.statics.cable_state import CableStates

_BAND = 2.0  # times the highest frequency by the closed form: up to there the exact modes are computed
_LAMBDA2 = (1e-8, 1e8)
_NODES = 8000  # keeps the spline's error below 1e-9 of a root


def cable_log_frequencies(world: World, cables: CableStates, rows: CableFrequencies) -> np.ndarray:
    """ln f (..., r) of the measured modes by the small-sag theory, bending and an added mass at mid-cable included.

    world : per state;  cables : (..., S, m)
    """
    state, cable = rows.state, rows.cable

    def pick(value: np.ndarray) -> np.ndarray:
        return np.broadcast_to(value, shape)[..., state, cable]

    own = (world.linear_density, world.bending_stiffness, world.added_mass)
    shape = np.broadcast_shapes(cables.chord.shape, *(value.shape for value in own))
    chord, tension = pick(cables.chord), pick(cables.tension)
    density, stiff = pick(world.linear_density), pick(cables.axial_stiffness)
    across = pick(cables.weight) * np.cos(pick(cables.inclination))
    epsilon = cable_dsm.epsilon(chord, tension, across)
    effective = cable_dsm.effective_length_integral(chord, epsilon)
    lambda2 = cable_dsm.lambda_squared(chord, tension, stiff, effective, across)
    number = half_waves(lambda2, rows)
    log = np.log(number * np.sqrt(tension / density) / chord / (2.0 * np.pi))
    stiffer = bending_factor(slenderness(pick(world.bending_stiffness), tension, chord), rows.mode)
    load = load_factor(pick(world.added_mass), density * chord, rows.mode)
    return log + np.log(stiffer) - 0.5 * np.log(load)


def half_waves(lambda2: np.ndarray, rows: CableFrequencies) -> np.ndarray:
    """Omega (..., r) of each row's mode: n pi out of plane, the n-th of both in-plane families else."""
    if not rows.mode.size:
        return np.zeros(lambda2.shape)
    count = int(rows.mode.max())
    symmetric = _symmetric_roots((count + 1) // 2 + 1)(np.log(np.clip(lambda2, *_LAMBDA2)))
    antisymmetric = 2.0 * np.pi * np.arange(1, (count + 1) // 2 + 2)
    both = np.sort(np.concatenate([symmetric, np.broadcast_to(antisymmetric, symmetric.shape)], axis=-1), axis=-1)
    rank = np.broadcast_to(rows.mode - 1, lambda2.shape)[..., None]
    in_plane = np.take_along_axis(both, rank, axis=-1)[..., 0]
    return np.where(rows.in_plane, in_plane, np.pi * rows.mode)


@cache
def _symmetric_roots(count: int) -> CubicSpline:
    """The first symmetric roots (count) as functions of ln lambda^2: the same curves for every cable."""
    nodes = np.linspace(np.log(_LAMBDA2[0]), np.log(_LAMBDA2[1]), _NODES)
    return CubicSpline(nodes, symmetric_roots(np.exp(nodes), count))


def exact_log_frequencies(points: dict[int, OperatingPoint], rows: CableFrequencies, closed: np.ndarray) -> np.ndarray:
    """ln f (r,) of the exact catenary at each state's operating point; nan where a state has none.

    closed : (r,) ln f by the closed form, which says how many modes are needed; what was measured may be in any unit
    """
    log = np.full(rows.mode.shape, np.nan)
    for state in np.unique(rows.state):
        if int(state) not in points:
            continue
        highest = 2.0 * np.pi * _BAND * float(np.exp(closed[rows.state == state].max()))
        full = cable_dynamics(points[int(state)], "exact", highest, rough=True).expansion(highest)
        across = np.abs(full.coupling[..., 1]) > 0.5 * np.linalg.norm(full.coupling, axis=-1)
        for i in np.flatnonzero(rows.state == state):
            cable = rows.cable[i]
            own = across[cable] != rows.in_plane[i]
            omega = np.sqrt(full.omega_squared[cable][own])
            log[i] = np.log(omega[rows.mode[i] - 1] / (2.0 * np.pi))
    return log
