"""Whether a distribution exists is decided, and the error says where, which cable and by how much."""

import dataclasses

import numpy as np
import pytest
from scipy.optimize import linprog

from cdpr_struct.dynamics.trajectory_distribution import distribute_along
from cdpr_struct.errors import UnholdablePoseError
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.tension_distribution import DistributionStatus, distribute
from cdpr_struct.statics.trajectory import helix

ROBOT = load_robot("thesis-5")
LEVEL = np.eye(3)


def random_positions(count: int) -> np.ndarray:
    return np.random.default_rng(5).uniform([-7.0, -5.0, 0.5], [7.0, 5.0, 4.8], (count, 3))


def straight_tensions_exist(position, low, high) -> bool:
    """Linear program for straight weightless cables."""
    offset = ROBOT.frame_anchors - position - ROBOT.platform_anchors
    u = offset / np.linalg.norm(offset, axis=1)[:, None]
    matrix = np.concatenate([u, np.cross(ROBOT.platform_anchors, u)], axis=1).T
    load = np.array([0.0, 0.0, ROBOT.platform.mass * ROBOT.gravity, 0.0, 0.0, 0.0])
    return linprog(np.zeros(8), A_eq=matrix, b_eq=load, bounds=[(low, high)] * 8).status == 0


def test_straight_cables_agree_with_linear_programming():
    positions = random_positions(60)
    d = distribute(ROBOT, positions, LEVEL, lower_bound=150.0, upper_bound=2000.0, model="ideal", allow_unheld=True)
    expected = [straight_tensions_exist(p, 150.0, 2000.0) for p in positions]
    assert 10 < sum(expected) < 50
    assert ((d.status == DistributionStatus.OPTIMAL) == expected).all()
    assert (d.status[~np.array(expected)] == DistributionStatus.INFEASIBLE).all()


def test_sagging_cables_are_decided_everywhere():
    """Every pose is either optimal or proven infeasible; tighter limits never help."""
    positions = random_positions(24)
    wide, tight = (
        distribute(ROBOT, positions, LEVEL, lower_bound=100.0, upper_bound=high, allow_unheld=True)
        for high in (3000.0, 2000.0)
    )
    for d in (wide, tight):
        assert (d.status != DistributionStatus.NOT_FOUND).all()
        assert 0 < (d.status == DistributionStatus.INFEASIBLE).sum() < 24
    assert not ((wide.status == DistributionStatus.INFEASIBLE) & (tight.status == DistributionStatus.OPTIMAL)).any()


def test_force_limit_too_low_names_time_cable_and_amount():
    with pytest.raises(
        UnholdablePoseError, match=r"at t = [\d.]+ s no tension .* cable \d would need .* N, .* bound"
    ) as e:
        distribute_along(ROBOT, helix(61), "fixed", upper_bound=4000.0)
    assert e.value.cable is not None
    assert e.value.amount > 10.0


def test_amount_is_what_it_takes():
    """Raising the bounds that are in the way by what the message says makes the pose feasible."""
    position = [2.0, 1.0, 3.9]
    free = distribute(ROBOT, position, LEVEL, lower_bound=100.0)
    limit = 0.97 * free.tensions.max()
    try:
        distribute(ROBOT, position, LEVEL, lower_bound=100.0, upper_bound=limit)
    except UnholdablePoseError as error:
        low = np.full(8, 100.0)
        low[error.cable - 1] -= 1.3 * error.amount
        assert (
            distribute(ROBOT, position, LEVEL, lower_bound=np.maximum(low, 0.0), upper_bound=1.02 * limit).rank[0] == 6
        )
    else:
        pytest.skip("this limit is no obstacle")


def test_cable_at_its_force_limit_is_marked():
    """CoGiRo, where 475 N are cheapest for the most loaded cable and 442 N possible: a limit of 460 N binds it."""
    robot, position = load_robot("cogiro"), [3.0, 1.0, 1.5]
    free = distribute(robot, position, LEVEL, lower_bound=20.0)
    held = distribute(robot, position, LEVEL, lower_bound=20.0, upper_bound=460.0)
    assert free.tensions.max() > 475.0
    assert not free.at_upper.any()
    assert held.at_upper.sum() == 1
    assert held.tensions.max() == pytest.approx(460.0, rel=1e-9)
    assert held.cost[0] > free.cost[0]


def test_platform_above_all_anchors_cannot_be_held():
    with pytest.raises(UnholdablePoseError, match="would need -"):
        distribute(ROBOT, [0.0, 0.0, 7.0], LEVEL, lower_bound=0.0)


def test_lower_above_upper_bound():
    with pytest.raises(UnholdablePoseError, match=r"must carry at least 300 N, 100 N above its upper bound 200 N"):
        distribute(ROBOT, [0.0, 0.0, 2.0], LEVEL, lower_bound=300.0, upper_bound=200.0)


def test_singular_wrench_matrix():
    """All cables end in one point: no moment can be held; a load without moment can, and the rank is told."""
    cogiro = load_robot("cogiro")
    point = dataclasses.replace(cogiro, platform_anchors=np.zeros((8, 3)))
    held = distribute(point, cogiro.home.position, LEVEL)
    assert held.rank[0] == 3
    with pytest.raises(
        UnholdablePoseError, match=r"singular \(rank 3 of 6\) and no cable acts against 10 N m of moment z"
    ):
        distribute(point, cogiro.home.position, LEVEL, external_wrench=[0, 0, 0, 0, 0, 10.0])


def test_too_few_cables():
    cogiro = load_robot("cogiro")
    four = dataclasses.replace(
        cogiro, cables=cogiro.cables[:4], platform_anchors=cogiro.platform_anchors[:4],
        frame_anchors=cogiro.frame_anchors[:4], pulleys=(),
    )  # fmt: skip
    with pytest.raises(UnholdablePoseError, match="no cable acts against"):
        distribute(four, cogiro.home.position, LEVEL)
