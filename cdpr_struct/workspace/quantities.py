"""What can be mapped over the workspace: a registry of quantities, one function a kind.

To add one: write a function of robot, positions (n, 3) and rotation (3, 3) that returns columns of n values, `held`
among them, computed for all poses at once, and enter it in `QUANTITIES`. What needs the whole grid is a function of
robot, grid and these columns, `finish`.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.internal_mass import with_internal_mass
from cdpr_struct.dynamics.robot_dynamic_stiffness import platform_mass_matrix
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.guides import free_block
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse
from cdpr_struct.statics.neutral_freedoms import Stability
from cdpr_struct.statics.pose_error import pose_error
from cdpr_struct.statics.slack_cables import slack_count
from cdpr_struct.statics.static_stiffness import RobotStiffness, static_stiffness
from cdpr_struct.statics.strained_cables import strains
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.lowest import LOWEST, lowest
from cdpr_struct.workspace.margins import distances, margins, tilts
from cdpr_struct.workspace.mode_map import MOST_MODES, ModeMap
from cdpr_struct.workspace.rest_columns import rest_columns
from cdpr_struct.workspace.vibration import SHARE, first_frequencies, marked_frequencies, shaped_frequencies
from cdpr_struct.workspace.work_list import Columns


@dataclass(frozen=True, slots=True)
class Quantity:
    """Something that has a value at every pose.

    label, unit : what the colour bar says
    meaning     : one sentence for the caption
    column      : which of the columns is the quantity
    evaluate    : (robot, positions (n, 3) [m], rotation (3, 3)) -> columns of n values; `held` (bool) is False where
                  the pose cannot be held, and the quantity then is nan or does not count
    chunk       : poses that are best computed at once
    shared      : column of the share of what the quantity describes, "" if it is never shared
    finish      : (robot, grid, columns) -> the columns of the map, from those of all its poses
    most_poses  : (robot) -> poses of the largest grid that can be finished
    """

    label: str
    unit: str
    meaning: str
    column: str
    evaluate: Callable[..., Columns]
    chunk: int = 256
    shared: str = ""
    finish: Callable[[Robot, Grid, Columns], Columns] | None = None
    most_poses: Callable[[Robot], int] | None = None

    def finished(self, robot: Robot, grid: Grid, columns: Columns) -> Columns:
        """The columns of the map, from those that `evaluate` gave over the whole grid."""
        return columns if self.finish is None else self.finish(robot, grid, columns)


def quantity_of(name: str, free: tuple[bool, bool, bool] | None = None) -> Quantity:
    """The quantity of a name: one of `QUANTITIES`, or `mode-K`.

    free : of rx, ry, rz, what hangs freely at the poses that are inserted to follow a mode

    Raises
    ------
    KeyError : there is none; the message says which there are.
    """
    if name in QUANTITIES:
        return QUANTITIES[name]
    kind, _, number = name.partition("-")
    if kind == "mode" and number.isdecimal() and number == str(int(number)) and 1 <= int(number) <= MOST_MODES:
        return _followed(ModeMap(int(number), free))
    raise KeyError(f"one of: {', '.join(QUANTITIES)}, mode-K with K from 1 to {MOST_MODES}")


def _followed(own: ModeMap) -> Quantity:
    return Quantity(
        f"mode {own.number}",
        "Hz",
        f"frequency of mode {own.number} at the reference pose, followed by its shape from pose to pose",
        "mode_Hz",
        own.evaluate,
        chunk=1024,
        finish=own.finish,
        most_poses=own.most_poses,
    )


def evaluate(
    name: str, robot: Robot, positions: np.ndarray, rotation: np.ndarray, found: InverseSolution | None = None
) -> Columns:
    """Columns of a quantity at poses; a plain function of plain things, so that any worker can run it.

    found : the tensions that hold the poses, where they are known; pose errors take none
    """
    quantity = quantity_of(name)
    if found is None:
        return quantity.evaluate(robot, positions, rotation)
    return quantity.evaluate(robot, positions, rotation, found)


def pose_errors(robot: Robot, positions: np.ndarray, rotation: np.ndarray) -> Columns:
    """Static pose errors [mm], [deg], and what is to be known about each pose.

    held: straight, inextensible cables hold the reference pose within their force limits. stable: sagging and spring
    model both found a stable equilibrium. more_stable_pose: the spring model has another one of lower energy.
    slack_cables: how many hang slack in the sagging model.
    """
    error = pose_error(robot, positions, rotation)
    columns = {
        f"{part}_{axis}_mm": 1e3 * getattr(error, f"{part}_error")[:, i]
        for part in ("sag", "axial", "global")
        for i, axis in enumerate("xyz")
    }
    turn = np.degrees(error.global_rotation)
    columns |= {f"global_r{axis}_deg": turn[:, i] for i, axis in enumerate("xyz")}
    known = error.held & error.converged
    slack = slack_count(error.sagging.cables, known)
    strain = np.where(known, strains(error.sagging.cables).max(axis=-1), np.nan)
    return {
        **columns,
        "slack_cables": slack,
        "strain_max": strain,
        "held": error.held,
        "stable": error.converged,
        "more_stable_pose": error.more_stable_pose,
    }


def tensions(
    robot: Robot, positions: np.ndarray, rotation: np.ndarray, found: InverseSolution | None = None
) -> Columns:
    """Largest and smallest cable tension at the platform [N], largest sag [mm], number of cables that hang slack.

    Minimum-norm tensions within the robot's force limits.
    """
    solution = _held(robot, positions, rotation) if found is None else found
    return {
        "tension_max_N": _where_held(solution, solution.tensions.max(axis=-1)),
        "tension_min_N": _where_held(solution, solution.tensions.min(axis=-1)),
        "sag_max_mm": _where_held(solution, 1e3 * solution.cables.sag.max(axis=-1)),
        **rest_columns(solution),
    }


def stiffnesses(
    robot: Robot, positions: np.ndarray, rotation: np.ndarray, found: InverseSolution | None = None
) -> Columns:
    """Static stiffness of the platform origin [N/mm], free to turn, and first frequency on massless cables [Hz].

    neutral_freedoms: in so many directions nothing pushes the platform back; a frequency is the first above zero, and
    the stiffness of an origin that such a motion moves is zero.

    Lengths locked, minimum-norm tensions within the robot's force limits.
    """
    solution = _held(robot, positions, rotation) if found is None else found
    names = ("stiffness_min_N_mm", "stiffness_vertical_N_mm", "platform_frequency_Hz")
    values = {name: np.full(len(positions), np.nan) for name in names}
    neutral = np.zeros(len(positions), dtype=int)
    good = np.flatnonzero(solution.held)
    if good.size:
        states = solution.cables.at(good)
        turned = rotation if np.ndim(rotation) == 2 else rotation[good]
        stiffness = static_stiffness(robot, positions[good], turned, states)
        held = stiffness.stability
        compliance = stiffness.compliance_of(held)[:, :3, :3]
        softest = np.linalg.eigvalsh(0.5 * (compliance + np.swapaxes(compliance, -1, -2)))[:, -1]
        loose = np.abs(held.twists[:, :3]).max(axis=-1, initial=0.0) > _STILL
        with np.errstate(divide="ignore"):  # along a guide nothing gives way
            values["stiffness_min_N_mm"][good] = np.where(loose.any(axis=-1), 0.0, 1e-3 / softest)
            values["stiffness_vertical_N_mm"][good] = np.where(loose[:, 2], 0.0, 1e-3 / compliance[:, 2, 2])
        values["platform_frequency_Hz"][good] = _first_frequency(robot, turned, stiffness, held)
        neutral[good] = held.neutral
    return {
        **values,
        "neutral_freedoms": neutral,
        **rest_columns(solution),
    }


def _first_frequency(robot: Robot, rotation: np.ndarray, stiffness: RobotStiffness, held: Stability) -> np.ndarray:
    """(k,) first frequency above zero of the platform on static stiffnesses [Hz]; nan where it is not stable."""
    arrays = RobotArrays.of(robot)
    pencil = with_internal_mass(arrays, rotation, stiffness.symmetric, platform_mass_matrix(robot, rotation))
    matrix, mass = (free_block(part, arrays) for part in pencil)
    inverse_root = np.linalg.inv(np.linalg.cholesky(mass))
    squared = np.linalg.eigvalsh(inverse_root @ matrix @ np.swapaxes(inverse_root, -1, -2))
    beyond = np.minimum(held.neutral, squared.shape[1] - 1)[:, None]
    first = np.take_along_axis(np.sort(squared, axis=1), beyond, axis=1)[:, 0]
    good = ~held.unstable & (held.neutral < squared.shape[1]) & (first > 0.0)
    return np.sqrt(np.where(good, first, np.nan)) / (2.0 * np.pi)


def _held(robot: Robot, positions: np.ndarray, rotation: np.ndarray) -> InverseSolution:
    return inverse(robot, positions, rotation, allow_unheld=True)


def _where_held(solution: InverseSolution, value: np.ndarray) -> np.ndarray:
    return np.where(solution.held, value, np.nan)


_STILL = 1e-9  # by so little [m per unit of motion] a neutral freedom may move the origin and leave it held
_POSE_ERROR = "vertical miss of the platform at cable lengths that are computed without sag and stretch"
QUANTITIES: dict[str, Quantity] = {
    "pose-error": Quantity("pose error along z", "mm", _POSE_ERROR, "global_z_mm", pose_errors),
    "pose-error-sag": Quantity(
        "pose error along z from sag", "mm", f"{_POSE_ERROR}; what sag adds to it", "sag_z_mm", pose_errors
    ),
    "pose-error-axial": Quantity(
        "pose error along z from stretch", "mm", f"{_POSE_ERROR}; the part of stretch", "axial_z_mm", pose_errors
    ),
    "stiffness-min": Quantity(
        "smallest stiffness",
        "N/mm",
        "force per displacement of the platform origin in its softest direction",
        "stiffness_min_N_mm",
        stiffnesses,
    ),
    "stiffness-vertical": Quantity(
        "vertical stiffness",
        "N/mm",
        "vertical force per vertical displacement of the platform origin",
        "stiffness_vertical_N_mm",
        stiffnesses,
    ),
    "platform-frequency": Quantity(
        "first platform frequency, massless cables",
        "Hz",
        "first frequency of the platform on its static stiffness, cable mass left out",
        "platform_frequency_Hz",
        stiffnesses,
    ),
    "first-frequency": Quantity(
        "first frequency",
        "Hz",
        "first natural frequency of the robot, cables vibrating",
        "first_Hz",
        first_frequencies,
        chunk=2048,
    ),
    "first-platform-frequency": Quantity(
        "first platform frequency",
        "Hz",
        "frequency of the mode most like the platform's first on massless cables, cables vibrating",
        "platform_Hz",
        shaped_frequencies,
        chunk=2048,
        shared=SHARE,
        finish=marked_frequencies,
    ),
    "frequencies": Quantity(
        "first frequency",
        "Hz",
        f"first of the lowest {LOWEST} natural frequencies of the robot, cables vibrating",
        "f1_Hz",
        lowest,
    ),
    "tension-max": Quantity("largest tension", "N", "largest cable tension at the platform", "tension_max_N", tensions),
    "tension-min": Quantity(
        "smallest tension", "N", "smallest cable tension at the platform", "tension_min_N", tensions
    ),
    "sag-max": Quantity("largest sag", "mm", "largest distance of a cable from its chord", "sag_max_mm", tensions),
    "slack-margin": Quantity(
        "margin to slack", "N", "smallest cable force less its lower limit", "slack_margin_N", margins
    ),
    "force-margin": Quantity(
        "margin to the largest force", "N", "upper limit less the cable force, the least", "force_margin_N", margins
    ),
    "wrench-feasible": Quantity(
        "wrenches held", "-", "share of the set of wrenches that the cables hold", "wrenches_held", margins
    ),
    "cable-distance": Quantity(
        "distance of cables", "m", "smallest distance of two cables", "cable_distance_m", distances
    ),
    "body-distance": Quantity(
        "distance to bodies", "m", "smallest distance of a cable and a body", "body_distance_m", distances
    ),
    "tilt": Quantity("tilt", "deg", "angle between the platform's z axis and the vertical", "tilt_deg", tilts),
}
