"""What the controller commands: lengths by the entered model for a pose and a tension distribution.

Tensions are the smallest (in the sum of squares) that hold the weight with straight cables and stay above a
bound; the lengths are then adjusted on the referee's cables until those tensions hold at the pose.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import null_space
from scipy.optimize import nnls

from cdpr_struct.fem_reference import PulleyData, solve_robot
from cdpr_struct.fem_reference.pulley import wrapped
from tests.blind.deviations import Deviations
from tests.blind.entered_robot import FREEDOMS, EnteredRobot
from tests.blind.true_robot import Command, at_rest, true_robot

SUSPENDED_BOUND = 70.0  # N
PRELOADED_BOUND = 150.0  # N, robots with exits below the platform
BALANCE_WEIGHT = 1e4  # of the balance against the norm in the least-squares form
ELEMENTS = 20
ROUNDS = 8
EXIT_ROUNDS = 12  # each a hundredfold nearer with pulleys of centimetres on cables of metres


def lower_bound(robot: EnteredRobot) -> float:
    """Smallest tension [N] that the controller aims at; none where balance leaves no choice."""
    if robot.hangs:
        return 0.0
    return PRELOADED_BOUND if robot.frame_anchors[:, 2].min() < robot.home[2] else SUSPENDED_BOUND


def exit_points(robot: EnteredRobot, anchors: np.ndarray) -> np.ndarray:
    """Points (m, 3) [m] where straight, weightless cables to platform anchors (m, 3) leave the frame or its pulleys."""
    if robot.pulley_radius is None:
        return robot.frame_anchors
    wheels = [None if np.isnan(axis).any() else PulleyData(robot.pulley_radius, axis) for axis in robot.axes]
    exits = robot.frame_anchors
    for _ in range(EXIT_ROUNDS):
        ends = zip(wheels, robot.frame_anchors, anchors - exits, strict=True)
        exits = np.array([entry if wheel is None else _exit(wheel, entry, along) for wheel, entry, along in ends])
    return exits


def _exit(wheel: PulleyData, entry: np.ndarray, along: np.ndarray) -> np.ndarray:
    return np.asarray(wrapped(wheel, entry, along, 0.0, np.zeros(3), 1.0).exit_point)


def structure_matrix(robot: EnteredRobot, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Wrench (6, m) on the platform per unit tension of straight cables, moments about its origin."""
    arms = robot.platform_anchors @ rotation.T
    chords = exit_points(robot, position + arms) - position - arms
    along = chords / np.linalg.norm(chords, axis=1)[:, None]
    return np.vstack([along.T, np.cross(arms, along).T])


def weight_wrench(robot: EnteredRobot, position: np.ndarray, rotation: np.ndarray, payload: float) -> np.ndarray:
    """Weight (6,) [N, N m] of platform, payload and the lower half of every cable."""
    arms = np.vstack([rotation @ robot.center_of_mass, np.zeros(3), robot.platform_anchors @ rotation.T])
    lengths = np.linalg.norm(robot.frame_anchors - position - arms[2:], axis=1)
    masses = np.concatenate([[robot.mass, payload], 0.5 * robot.linear_density * lengths])
    forces = -robot.gravity * masses[:, None] * np.array([0.0, 0.0, 1.0])
    return np.concatenate([forces.sum(axis=0), np.cross(arms, forces).sum(axis=0)])


def intended_tensions(
    robot: EnteredRobot, position: np.ndarray, rotation: np.ndarray, payload: float
) -> np.ndarray | None:
    """Tensions (m,) [N] at the platform; None if no such tensions hold the pose."""
    matrix = structure_matrix(robot, position, rotation)
    wrench = weight_wrench(robot, position, rotation, payload)
    if lower_bound(robot) == SUSPENDED_BOUND:
        tensions = -np.linalg.pinv(matrix) @ wrench
        return np.asarray(tensions) if tensions.min() >= SUSPENDED_BOUND else None
    least = np.full(robot.cables, PRELOADED_BOUND)
    stacked = np.vstack([BALANCE_WEIGHT * matrix, np.eye(robot.cables)])
    above, _ = nnls(stacked, np.concatenate([-BALANCE_WEIGHT * (wrench + matrix @ least), -least]))
    tensions = least + above
    return tensions if np.abs(matrix @ tensions + wrench).max() < 1e-3 * np.abs(wrench).max() else None


def null_directions(robot: EnteredRobot, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Two directions (m, 2) of internal force, of norm sqrt(m): those at home, turned as little as the pose allows.

    Zeros for a robot whose cables balance leaves no choice.
    """
    if robot.cables <= FREEDOMS:
        return np.zeros((robot.cables, 2))
    at_home = null_space(structure_matrix(robot, robot.home, np.eye(3)))[:, :2]
    here = null_space(structure_matrix(robot, position, rotation))[:, :2]
    left, _, right = np.linalg.svd(here @ here.T @ at_home, full_matrices=False)
    return np.asarray(left @ right * np.sqrt(robot.cables))


def commanded_lengths(
    robot: EnteredRobot, position: np.ndarray, rotation: np.ndarray, payload: float, tensions: np.ndarray
) -> np.ndarray:
    """Unstrained lengths (m,) [m] with which the entered robot, held at the pose, has these end tensions."""
    exact, anchors = Deviations.none(robot.cables), position + robot.platform_anchors @ rotation.T
    lengths = 0.998 * np.linalg.norm(robot.frame_anchors - anchors, axis=1)
    still = np.zeros_like(robot.frame_anchors)
    for _ in range(ROUNDS):
        command = Command(lengths, payload, np.zeros(robot.cables), position, rotation)
        held = solve_robot(true_robot(robot, exact, command, rotation, still), position, rotation, ELEMENTS, True)
        reached = np.array([np.linalg.norm(cable.end_force) for cable in held.cables])
        weight = robot.linear_density * robot.gravity
        give = lengths / robot.axial_stiffness + weight**2 * lengths**3 / (12.0 * np.maximum(reached, 30.0) ** 3)
        lengths = lengths + (reached - tensions) * give
    return np.asarray(lengths)


def hanging(
    robot: EnteredRobot, position: np.ndarray, payload: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Lengths (m,) [m] that reach from the exits to a level platform at a position, and where the entered robot hangs.

    Its position (3,) [m], rotation (3, 3) and tensions (m,) [N] at the platform are those of the referee's cables.
    """
    anchors = position + robot.platform_anchors
    lengths = np.linalg.norm(exit_points(robot, anchors) - anchors, axis=1)
    if robot.pulley_radius is not None:
        raise NotImplementedError("lengths of a hanging robot with pulleys")
    command = Command(lengths, payload, np.zeros(robot.cables), position, np.eye(3))
    rest = at_rest(robot, Deviations.none(robot.cables), command, ELEMENTS)
    tensions = np.array([np.linalg.norm(cable.end_force) for cable in rest.cables])
    return lengths, rest.position, rest.rotation, tensions
