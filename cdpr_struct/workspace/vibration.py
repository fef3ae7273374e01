"""First natural frequencies over the workspace, for all poses at once (fig 3.9)."""

import numpy as np

from cdpr_struct.dynamics.batched_modes import Batch, first_mode, fits
from cdpr_struct.dynamics.cable_dynamics import expand_catenaries_at
from cdpr_struct.dynamics.internal_mass import present, with_internal_mass
from cdpr_struct.dynamics.lowest_clamped import lowest_clamped
from cdpr_struct.dynamics.many_poses import poses_of
from cdpr_struct.dynamics.mode_shapes import ritz_shapes, shape_size
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.platform_modes import HARMONICS, platform_mode
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    platform_mass_matrix,
    platform_static_stiffness,
    stability_at,
)
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.guides import free_axes, free_block
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.mode_matching import unlike_neighbours
from cdpr_struct.workspace.mode_records import as_records, of_records, unit_shapes
from cdpr_struct.workspace.rest_columns import rest_columns
from cdpr_struct.workspace.work_list import Columns

SHARE, SHAPE = "platform_share", "platform_shape"
AMONG = 60  # first modes of the robot, of which one is the platform's
_CHUNK = 2048  # poses at once
_GENERAL_CABLES = 256  # at once, of the general solver
_ORDER = 24
_HALF_WAVES = 2.5


def first_frequencies(
    robot: Robot, positions: np.ndarray, rotation: np.ndarray, given: InverseSolution | None = None
) -> Columns:
    """First frequencies [Hz] of the robot, its platform (also on massless cables) and each cable; exact catenaries.

    The platform's is that of the mode, of the first `AMONG`, whose platform motion is most like the platform's first
    mode on massless cables. platform_share is the share of that motion which it holds: below one half, cable modes of
    nearly the same frequency hold more of it together, and the frequency may step to another mode at the next pose. A
    cable's frequency is that with both ends held. Minimum-norm tensions within the robot's force limits. nan where the
    platform is not held, or balanced but not stable. neutral_freedoms: number of directions in which nothing pushes it
    back; first_Hz is the first frequency above zero. slack_cables: number of cables that hang slack where it is held.
    """
    found = shaped_frequencies(robot, positions, rotation, given)
    return {name: values for name, values in found.items() if name != SHAPE}


def shaped_frequencies(
    robot: Robot, positions: np.ndarray, rotation: np.ndarray, given: InverseSolution | None = None
) -> Columns:
    """The same, and a column of records: the shape of the platform's mode, of length one, see `mode_records`."""
    if given is not None:
        return _of_chunk(robot, positions, rotation, given)
    starts = range(0, max(len(positions), 1), _CHUNK)
    parts = [_of_chunk(robot, positions[start : start + _CHUNK], rotation) for start in starts]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def marked_frequencies(robot: Robot, grid: Grid, columns: Columns) -> Columns:
    """The columns over a whole grid, and `veering`: the platform's mode holds less than half of its motion, or that
    of a neighbour has a shape that is not half alike. Between two poses without this mark the mode is the same."""
    shapes = of_records(columns[SHAPE])
    there = np.isfinite(columns[SHARE])
    veering = (columns[SHARE] < 0.5) | unlike_neighbours(shapes, there, grid.neighbours)
    return {**{name: values for name, values in columns.items() if name != SHAPE}, "veering": veering}


def _of_chunk(
    robot: Robot, positions: np.ndarray, rotation: np.ndarray, given: InverseSolution | None = None
) -> Columns:
    solution = inverse(robot, positions, rotation, allow_unheld=True) if given is None else given
    columns = _empty(robot, len(positions))
    neutral = np.zeros(len(positions), dtype=int)
    held = np.flatnonzero(solution.held)
    if held.size:
        point = _points(robot, positions, rotation, solution, held)
        how = stability_at(point)
        neutral[held] = how.neutral
        massless, momentum = _first_static_mode(point, how.neutral)
        stable = np.flatnonzero((massless > 0.0) & ~how.unstable)
        rest = poses_of(point, stable)
        found = _at_rest(rest, massless[stable], momentum[stable], how.neutral[stable]) if stable.size else {}
        for name, values in found.items():
            columns[name][held[stable]] = values if name in (SHARE, SHAPE) else np.sqrt(values) / (2.0 * np.pi)
    columns[SHAPE] = as_records(unit_shapes(columns[SHAPE]))
    return {
        **columns,
        "neutral_freedoms": neutral,
        **rest_columns(solution),
    }


def _names(robot: Robot) -> list[str]:
    cables = (f"cable_{i + 1}_Hz" for i in range(len(robot.cables)))
    return ["first_Hz", "platform_Hz", SHARE, "platform_massless_Hz", *cables]


def _empty(robot: Robot, n: int) -> Columns:
    """Columns without values; the shape's is (n, d)."""
    columns = {name: np.full(n, np.nan) for name in _names(robot)}
    return {**columns, SHAPE: np.full((n, shape_size(len(robot.cables), HARMONICS)), np.nan)}


def _points(
    robot: Robot, positions: np.ndarray, rotation: np.ndarray, solution: InverseSolution, chosen: np.ndarray
) -> OperatingPoint:
    states = solution.cables if chosen.size == len(positions) else solution.cables.at(chosen)
    return OperatingPoint(robot, positions[chosen], np.broadcast_to(rotation, (len(positions), 3, 3))[chosen], states)


def _first_static_mode(point: OperatingPoint, neutral: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """omega^2 (n,) of the platform's first mode above zero on massless cables, negative where it is unstable, and its
    momentum (n, 6 + q), q of parts that move in the platform.

    neutral : (n,) number of neutral freedoms
    """
    pencil = with_internal_mass(
        point.arrays, point.rotation, platform_static_stiffness(point),
        platform_mass_matrix(point.arrays, point.rotation),
    )  # fmt: skip
    stiffness, mass = (free_block(matrix, point.arrays) for matrix in pencil)
    lower = np.linalg.cholesky(mass)
    inverse_root = np.linalg.inv(lower)
    squared, vectors = np.linalg.eigh(inverse_root @ stiffness @ np.swapaxes(inverse_root, -1, -2))
    row, neutral = np.arange(len(squared)), np.minimum(neutral, squared.shape[1] - 1)
    momentum = np.zeros((len(squared), pencil[0].shape[-1]))
    kept = np.concatenate([free_axes(point.arrays), np.arange(6, momentum.shape[1])])
    momentum[:, kept] = np.einsum("nij,nj->ni", lower, vectors[row, :, neutral])
    return squared[row, neutral], momentum


def _at_rest(point: OperatingPoint, massless: np.ndarray, momentum: np.ndarray, neutral: np.ndarray) -> Columns:
    """Squared frequencies by name, and the share, at stable poses: the fast path's, else the general solver's.

    neutral : (n,) number of neutral freedoms
    """
    names = _names(point.entered)
    found = _empty(point.entered, len(massless))
    found["platform_massless_Hz"] = massless
    fast = np.flatnonzero(fits(point) & (neutral == 0))
    if fast.size:
        for name, values in _fast(poses_of(point, fast), massless[fast], momentum[fast]).items():
            found[name][fast] = values
    left = np.flatnonzero(~np.isfinite([found[name] for name in names]).all(axis=0))
    size = max(1, _GENERAL_CABLES // point.cables.length.shape[-1])
    for start in range(0, left.size, size):
        chosen = left[start : start + size]
        for name, values in _general(poses_of(point, chosen), momentum[chosen], neutral[chosen]).items():
            known = found[name][chosen]
            found[name][chosen] = np.where(np.isfinite(known), known, values)
    return found


def _fast(point: OperatingPoint, massless: np.ndarray, momentum: np.ndarray) -> Columns:
    whole = Batch.of(point)
    found: Columns = {}
    for group in whole.groups:
        batch = whole.take(group)
        platform = platform_mode(batch, massless[group], momentum[group], AMONG)
        first = first_mode(batch, platform.first).squared
        columns = {"first_Hz": first, "platform_Hz": platform.squared, SHARE: platform.share, SHAPE: platform.shape}
        columns |= _of_cables(lowest_clamped(batch.cables, batch.order))
        for name, values in columns.items():
            found.setdefault(name, np.full((len(massless), *values.shape[1:]), np.nan))[group] = values
    return found


def _general(point: OperatingPoint, momentum: np.ndarray, neutral: np.ndarray) -> Columns:
    """Expansions of high order and as many modes as the definition asks for."""
    full = expand_catenaries_at(point, _ORDER)
    clamped = full.omega_squared[..., 0]
    highest = _HALF_WAVES * float(np.sqrt(clamped.max()))
    modes = ritz_modes(point, full.reduced(highest, factor=1.2), AMONG)
    moved = np.concatenate([modes.platform, modes.internal[..., present(point.arrays)]], axis=-1)
    alike = np.einsum("nki,ni->nk", moved, momentum) ** 2
    best = alike.argmax(axis=-1)[:, None]
    omega, share = (np.take_along_axis(values, best, axis=-1)[:, 0] for values in (modes.omega, alike))
    shape = np.take_along_axis(ritz_shapes(point, modes, HARMONICS), best[:, :, None], axis=1)[:, 0]
    first = np.take_along_axis(modes.omega, neutral[:, None], axis=1)[:, 0]
    found = {"first_Hz": first**2, "platform_Hz": omega**2, SHARE: share, SHAPE: shape}
    return found | _of_cables(clamped.T)


def _of_cables(squared: np.ndarray) -> Columns:
    return {f"cable_{i + 1}_Hz": values for i, values in enumerate(squared)}
