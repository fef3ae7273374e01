"""A pose is refused only if no tensions hold it; also where symmetry takes rank from the structure matrix."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from cdpr_struct.errors import UnholdablePoseError
from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.inverse_kinematics import InverseSolution, InverseStatus, inverse
from cdpr_struct.statics.separating_wrench import separation
from cdpr_struct.statics.slack_cables import hangs_slack
from tests.random_robots import random_positions, random_robot
from tests.symmetric_robots import CORNERS, symmetric_positions, symmetric_robots

BOUNDS = np.concatenate([[0.0], np.geomspace(1e-3, 1.0, 5)])  # of the platform's weight
LARGEST_STRAIN = 0.05  # beyond it a refusal is not asked to be right


def robots_and_poses(count: int, random: int) -> list[tuple[Robot, np.ndarray]]:
    """Ten symmetric robots and some random ones, at `count` positions each."""
    rng = np.random.default_rng(7)
    symmetric = [(r, symmetric_positions(rng, r, count)) for r in symmetric_robots()]
    others = [random_robot(rng) for _ in range(random)]
    return symmetric + [(r, random_positions(rng, r, count)) for r in others]


def ladder(robot: Robot, positions: np.ndarray) -> tuple[np.ndarray, InverseSolution]:
    """Lower bounds (b,) [N] and the solutions (b, n) at them."""
    bounds = BOUNDS * robot.platform.mass * robot.gravity
    found = inverse(robot, positions, np.eye(3), "sagging", None, bounds[:, None, None], np.inf, allow_unheld=True)
    return bounds, found


def check_ladder(robot: Robot, positions: np.ndarray) -> int:
    """Poses held somewhere; held at a bound means held at every smaller one, the same if the bound is not active."""
    bounds, found = ladder(robot, positions)
    stiff = RobotArrays.of(robot).axial_stiffness
    sound = found.held & (found.tensions.max(axis=-1) <= LARGEST_STRAIN * stiff.min())
    inactive = sound & (found.tensions.min(axis=-1) > bounds[:, None] * (1.0 + 1e-6))
    assert not (found.status == InverseStatus.NOT_CONVERGED).any()
    for j in range(len(positions)):
        where = f"{robot.name} at {positions[j]}"
        top = np.flatnonzero(sound[:, j])
        assert found.held[: top.max(initial=0), j].all(), where
        free = np.flatnonzero(inactive[:, j])
        if free.size:
            check_same(found.cables.at((slice(free[-1] + 1), j)), where)
    return int(found.held.any(axis=0).sum())


def check_same(cables: CableStates, where: str) -> None:
    """States (b, m): all like the last; a smaller bound may let a cable hang slack if that takes less tension."""
    tensions = cables.tension_at_platform
    norm = np.linalg.norm(tensions, axis=1)
    same = np.abs(tensions - tensions[-1]).max(axis=1) <= 1e-7 * tensions[-1].max()
    better = hangs_slack(cables).any(axis=1) & (norm < norm[-1])
    assert (same | better).all(), where


def test_held_at_a_bound_means_held_at_smaller_ones():
    held = sum(check_ladder(robot, positions) for robot, positions in robots_and_poses(3, 2))
    assert held >= 12


@pytest.mark.slow
def test_held_at_a_bound_means_held_at_smaller_ones_everywhere():
    held = sum(check_ladder(robot, positions) for robot, positions in robots_and_poses(15, 10))
    assert held >= 100


def crossing_exists(robot: Robot, position: np.ndarray, low: np.ndarray, high: np.ndarray) -> bool:
    """Whether straight cables balance the platform within the bounds, by a linear program written down here."""
    offset = robot.frame_anchors - robot.platform_anchors - position
    pull = offset / np.linalg.norm(offset, axis=1)[:, None]
    matrix = np.concatenate([pull, np.cross(robot.platform_anchors, pull)], axis=1).T
    weight = robot.platform.mass * robot.gravity
    center = robot.platform.center_of_mass
    load = np.concatenate([[0.0, 0.0, -weight], np.cross(center, [0.0, 0.0, -weight])])
    radius = np.abs(robot.platform_anchors).max()
    scale = np.array([1.0, 1.0, 1.0, radius, radius, radius]) * weight
    prices = np.concatenate([np.zeros(len(low)), np.ones(12)])
    loose = np.concatenate([matrix / scale[:, None] * weight, np.eye(6), -np.eye(6)], axis=1)
    limits = [*zip(low / weight, high / weight, strict=True), *[(0.0, None)] * 12]
    return bool(linprog(prices, A_eq=loose, b_eq=-load / scale, bounds=limits).fun < 1e-7)


def test_straight_cables_are_held_exactly_where_a_linear_program_finds_tensions():
    seen = set()
    for robot, positions in robots_and_poses(4, 2):
        weight = robot.platform.mass * robot.gravity
        low, high = np.full(len(robot.cables), 0.02 * weight), np.full(len(robot.cables), 3.0 * weight)
        found = inverse(robot, positions, np.eye(3), "ideal", None, low, high, allow_unheld=True)
        expected = [crossing_exists(robot, position, low, high) for position in positions]
        assert found.held.tolist() == expected, robot.name
        seen |= set(expected)
    assert seen == {True, False}


def test_the_named_cable_is_in_the_way():
    """Its own limit opened by the amount that is named, the other limits closed, and the pose is held."""
    robot, named = symmetric_robots()[5], 0
    for position in symmetric_positions(np.random.default_rng(3), robot, 8):
        low, high = np.zeros(8), np.full(8, 0.55)
        try:
            inverse(robot, position, np.eye(3), "ideal", None, low, high)
            continue
        except UnholdablePoseError as error:
            cable, amount = error.cable, error.amount
        if cable is None:
            continue
        named += 1
        weight = robot.platform.mass * robot.gravity
        assert not crossing_exists(robot, position, low, high)
        opened = np.where(np.arange(8) == cable - 1, 1.001 * amount, 0.0)
        free = [crossing_exists(robot, position, low - a * opened, high + b * opened) for a, b in ((1, 0), (0, 1))]
        several = crossing_exists(robot, position, low - 8 * amount, high + 8 * amount)
        assert any(free) or (several and amount < weight), (position, cable, amount)
    assert named >= 3


def test_light_platform_on_heavy_vertical_cables_hangs():
    robot = symmetric_robots()[8]
    heavy = replace(robot, cables=(Cable(1e7, 5.0),) * 6)  # 30 kg each, the platform 200 g
    found = inverse(heavy, [0.0, 0.0, 14.0], np.eye(3), mass=0.2)
    assert found.tensions == pytest.approx(np.full(6, 0.2 * 9.81 / 6.0), rel=1e-9)


def test_a_cable_without_length_is_named():
    robot = next(r for r in symmetric_robots() if r.name == "haptic")
    corner = 0.45 * CORNERS[6]
    with pytest.raises(UnholdablePoseError, match="cable 7 has no length at this pose") as error:
        inverse(robot, corner, np.eye(3))
    assert error.value.cable == 7
    found = inverse(robot, np.stack([np.zeros(3), corner]), np.eye(3), allow_unheld=True)
    assert found.held.tolist() == [True, False]


def test_no_pose_that_is_held_is_proven_to_be_out_of_reach():
    """Heavy cables: straight ones leave a wrench unbalanced at poses that sagging ones hold."""
    robot = load_robot("six-cable-8mm")
    across = np.linspace(-0.9, 0.9, 13)
    half = robot.frame_anchors.max(axis=0)
    places = np.array([[half[0] * x, half[1] * y, 0.5] for x in across for y in across])
    held = inverse(robot, places, np.eye(3), allow_unheld=True).held
    k, arrays = len(places), RobotArrays.of(robot)
    turns, bounds = np.broadcast_to(np.eye(3), (k, 3, 3)), (np.zeros((k, 6)), np.full((k, 6), np.inf))
    problem = HoldingProblem.at(
        arrays.flattened((k,)), cable_model("sagging"), (places, turns), np.zeros((k, 6)), bounds
    )
    found = separation(problem)
    assert held.sum() >= 20
    assert not found.proven[held].any()
    assert found.proven[~held].mean() > 0.8
