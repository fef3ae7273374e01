"""Margins of force, distances of cables, and the tilt of the platform over many poses at once."""

import numpy as np

from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.robot import Robot, anchors_in_world
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_curves import CableCurves
from cdpr_struct.statics.cable_distance import Nearest, body_distance, cable_distance
from cdpr_struct.statics.held_stability import held_stability
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse
from cdpr_struct.statics.wrench_feasibility import wrench_feasibility
from cdpr_struct.workspace.rest_columns import rest_columns
from cdpr_struct.workspace.work_list import Columns

ZONE = 0.1  # [m] of cable next to an anchor that is shared or sits on a body: not counted in distances
NO_WRENCH = ((0.0,) * 6,)  # the set of wrenches that adds nothing to the load


def margins(
    robot: Robot,
    positions: np.ndarray,
    rotation: np.ndarray,
    found: InverseSolution | None = None,
    wrenches: tuple[tuple[float, ...], ...] = NO_WRENCH,
) -> Columns:
    """Least distances of the cable forces from their limits [N], at the worst wrench of a set, and wrenches held.

    Least-norm tensions within the limits, computed anew at each of the wrenches, six numbers that act beside the load.
    """
    solution = inverse(robot, positions, rotation, allow_unheld=True) if found is None else found
    told = wrench_feasibility(robot, positions, rotation, np.array(wrenches), solution)
    return {
        "slack_margin_N": told.slack_margin,
        "force_margin_N": told.force_margin,
        "wrenches_held": told.feasible.mean(axis=1),
        **rest_columns(solution),
    }


def distances(
    robot: Robot,
    positions: np.ndarray,
    rotation: np.ndarray,
    found: InverseSolution | None = None,
    zone: float = ZONE,
) -> Columns:
    """Smallest distance of two cables, and of a cable and a body [m], under the robot's load; and which they are.

    The columns about bodies are there for robots that have bodies.

    zone : [m] of cable next to an anchor that is shared or sits on a body, left out
    """
    solution = inverse(robot, positions, rotation, allow_unheld=True) if found is None else found
    good, m = np.flatnonzero(solution.held), len(robot.cables)
    turned = np.broadcast_to(rotation, (len(positions), 3, 3))[good]
    anchors = anchors_in_world(robot, positions[good], turned)[0]
    curves = CableCurves.of(solution.cables.at(good), anchors)
    near = cable_distance(curves, m, zone)
    columns = {
        "cable_distance_m": _at(good, near.distance, len(positions)),
        **_pair(near, good, len(positions), "nearest_cable", "to_cable"),
    }
    if robot.bodies:
        body = body_distance(curves, m, robot.bodies, (positions[good], turned), zone)
        columns["body_distance_m"] = _at(good, body.distance, len(positions))
        columns |= _pair(body, good, len(positions), "cable_at_body", "body")
    return {**columns, **rest_columns(solution)}


def tilts(robot: Robot, positions: np.ndarray, rotation: np.ndarray, found: InverseSolution | None = None) -> Columns:
    """Angle between the platform's z axis and the vertical [deg]."""
    solution = inverse(robot, positions, rotation, allow_unheld=True) if found is None else found
    tilt = from_vertical(robot, np.broadcast_to(rotation, (len(positions), 3, 3)))
    return {"tilt_deg": np.where(solution.held, tilt, np.nan), **rest_columns(solution)}


def from_vertical(robot: Robot, rotation: np.ndarray) -> np.ndarray:
    """(k,) angle between the z axis of platforms turned by (k, 3, 3) and the vertical [deg]."""
    axis = rotation[..., 2]
    level = np.linalg.norm(np.cross(axis, robot.down), axis=-1)
    return np.asarray(np.degrees(np.arctan2(level, -axis @ robot.down)))


def largest_tilt(robot: Robot, degrees: np.ndarray) -> float | None:
    """Largest angle to the vertical of platforms at angles rx, ry, rz (k, 3) [deg], nan left out; None if all are."""
    known = np.radians(degrees[np.isfinite(degrees).all(axis=1)])
    return float(from_vertical(robot, rotation_from_angles(*known.T)).max()) if len(known) else None


def stable_where_held(
    robot: Robot, positions: np.ndarray, rotation: np.ndarray, solution: InverseSolution
) -> np.ndarray:
    """(n,) bool: held, and at locked lengths no motion of the platform is pushed on."""
    good = np.flatnonzero(solution.held)
    stable = np.zeros(len(positions), dtype=bool)
    if good.size:
        turned = np.broadcast_to(rotation, (len(positions), 3, 3))[good]
        found = held_stability(RobotArrays.of(robot), positions[good], turned, solution.cables.at(good))
        stable[good] = found.stable
    return stable


def _pair(near: Nearest, good: np.ndarray, count: int, first: str, second: str) -> Columns:
    """Numbers from 1; nan where there are none."""
    pair = np.where(near.first < 0, np.nan, near.first + 1.0), np.where(near.second < 0, np.nan, near.second + 1.0)
    return {name: _at(good, value, count) for name, value in zip((first, second), pair, strict=True)}


def _at(good: np.ndarray, value: np.ndarray, count: int) -> np.ndarray:
    full = np.full(count, np.nan)
    full[good] = value
    return full
