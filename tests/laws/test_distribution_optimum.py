"""The tension distribution is the optimum of (5.1)-(5.9): by its own certificate, by general solvers, by convexity."""

import dataclasses

import numpy as np
import pytest
from scipy.optimize import minimize

from benchmarks.general_solver import PoseProblem, slsqp, trust_constr
from cdpr_struct.dynamics.trajectory_distribution import THESIS_B, distribute_along
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.tension_bound import chord_tension_at, constant
from cdpr_struct.statics.tension_cost import Centre, EuclideanNorm, Middle, PowerNorm
from cdpr_struct.statics.tension_distribution import (
    DistributionStatus,
    bounded_problem,
    distribute,
    holding_problem,
)
from cdpr_struct.statics.trajectory import helix

ROBOT = load_robot("thesis-5")
LEVEL = np.eye(3)
COST_TOLERANCE = 1e-6  # N
WEIGHTS = np.array([1.0, 2.0, 1.0, 0.5, 3.0, 1.0, 1.0, 2.0])


@pytest.fixture(scope="module")
def path():
    return helix(31)


@pytest.fixture(scope="module")
def found(path):
    return {rule: distribute_along(ROBOT, path, rule) for rule in ("fixed", "pose-dependent")}


def pose_problem(path, found, rule, i, robot=ROBOT, power=2.0) -> PoseProblem:
    load = path.inertia_wrench(robot.platform)[i]
    load[2] -= robot.platform.mass * robot.gravity
    per_length = rule == "pose-dependent"
    low = (THESIS_B / np.pi) ** 2 * ROBOT.weight_per_length if per_length else found["fixed"].distribution.lower[0]
    return PoseProblem.at(robot, path.position[i], load, low, per_length=per_length, power=power)


def general_cost(problem) -> float:
    """SLSQP's cost [N], restarted until it no longer falls: its own stopping rule may end it early."""
    x, _ = slsqp(problem)
    for _ in range(4):
        x, converged = slsqp(problem, x)
    assert converged
    return float((problem.tensions(x) ** problem.power).sum() ** (1.0 / problem.power))


@pytest.mark.parametrize("rule", ["fixed", "pose-dependent"])
def test_certificate(found, rule):
    d = found[rule].distribution
    assert (d.status == DistributionStatus.OPTIMAL).all()
    assert d.kkt_residual.max() < 1e-11
    assert np.abs(d.residual_wrench).max() < 1e-8  # N and N m, of about 700 N
    assert (d.tensions >= d.lower * (1.0 - 1e-12)).all()
    assert (d.rank == 6).all()


@pytest.mark.parametrize("rule", ["fixed", "pose-dependent"])
@pytest.mark.parametrize("i", [0, 5, 15, 30])
def test_cost_equals_that_of_slsqp(path, found, rule, i):
    ours = found[rule].distribution.cost[i]
    assert general_cost(pose_problem(path, found, rule, i)) == pytest.approx(ours, abs=COST_TOLERANCE)


def test_trust_constr_finds_nothing_lower(path, found):
    """Its barrier stops some 1e-3 N above the optimum."""
    problem = pose_problem(path, found, "fixed", 12)
    x, converged = trust_constr(problem)
    excess = np.linalg.norm(problem.tensions(x)) - found["fixed"].distribution.cost[12]
    assert converged
    assert -COST_TOLERANCE < excess < 0.02


def test_comparison_sees_a_platform_two_per_cent_heavier(path, found):
    """Twin."""
    platform = ROBOT.platform.with_mass(1.02 * ROBOT.platform.mass)
    heavier = dataclasses.replace(ROBOT, platform=platform)
    cost = general_cost(pose_problem(path, found, "fixed", 5, heavier))
    assert abs(cost - found["fixed"].distribution.cost[5]) > 1.0


@pytest.mark.slow
@pytest.mark.parametrize("rule", ["fixed", "pose-dependent"])
def test_every_pose_of_the_helix_equals_slsqp(rule):
    """3001 poses, each to 1e-6 N."""
    path = helix()
    found = {name: distribute_along(ROBOT, path, name) for name in ("fixed", rule)}
    x = None
    for i, ours in enumerate(found[rule].distribution.cost):
        problem = pose_problem(path, found, rule, i)
        x, _ = slsqp(problem, x, 1e-13)
        cost = np.linalg.norm(problem.tensions(x))
        if abs(cost - ours) > COST_TOLERANCE:  # stopped early
            cost = general_cost(problem)
        assert cost == pytest.approx(ours, abs=COST_TOLERANCE), f"pose {i}"


def test_the_optimum_is_global(path):
    """Lagrange: with the multipliers y of the optimum, every chord tension minimises its own term phi - y . wrench over
    the whole box (120 samples from floor to 100 times the floor), so no other tensions can be cheaper."""
    wrench = path.inertia_wrench(ROBOT.platform)
    holding = holding_problem(ROBOT, path.position, path.rotation, wrench)
    floor = chord_tension_at(holding, constant(237.8))
    problem = bounded_problem(holding, floor, np.inf, np.inf, EuclideanNorm())
    optimum = problem.solve()

    def terms(tau):
        states = problem.hold(tau).states
        force = states.force_on_platform
        sides = np.concatenate([force, np.cross(holding.arms.arms, force)], axis=-1) / holding.unit[:, None, :]
        return 0.5 * states.tension_at_platform**2 - np.einsum("kmn,kn->km", sides, optimum.multiplier)

    least = terms(optimum.chord_tension)
    for factor in np.geomspace(1.0, 100.0, 120):
        assert (terms(factor * floor[0]) >= least - 1e-9 * np.abs(least).max()).all()


def test_straight_cables_are_a_quadratic_program(path):
    """The thesis's first guess, against SLSQP on J^T f + w = 0."""
    wrench = path.inertia_wrench(ROBOT.platform)
    d = distribute(ROBOT, path.position, path.rotation, wrench, lower_bound=150.0, model="ideal")
    wrench[:, 2] -= ROBOT.platform.mass * ROBOT.gravity
    for i in (0, 10, 20):
        offset = ROBOT.frame_anchors - path.position[i] - ROBOT.platform_anchors
        u = offset / np.linalg.norm(offset, axis=1)[:, None]
        matrix = np.concatenate([u, np.cross(ROBOT.platform_anchors, u)], axis=1).T
        balance = {
            "type": "eq",
            "fun": lambda f, a=matrix, w=wrench[i]: a @ f * 1e3 + w,
            "jac": lambda f, a=matrix: a * 1e3,
        }
        best = minimize(
            lambda f: 0.5 * f @ f, np.ones(8), jac=lambda f: f, method="SLSQP", bounds=[(0.15, None)] * 8,
            constraints=[balance], options={"ftol": 1e-16, "maxiter": 500},
        )  # fmt: skip
        assert 1e3 * np.linalg.norm(best.x) == pytest.approx(d.cost[i], abs=1e-5)


def test_inverse_kinematics_agrees(path):
    """The same optimum by a solver with other programs and other bounds."""
    wrench = path.inertia_wrench(ROBOT.platform)
    other = inverse(ROBOT, path.position, path.rotation, external_wrench=wrench, lower_bound=237.8)
    ours = distribute(ROBOT, path.position, path.rotation, wrench, lower_bound=237.8)
    np.testing.assert_allclose(ours.tensions, other.tensions, rtol=0.0, atol=1e-6)


def robot_of(count: int):
    """A robot with `count` of the thesis's cables; beyond eight, two more to the middles of the walls."""
    anchors = np.vstack([ROBOT.platform_anchors, [[0.0, 0.3, 0.3], [0.0, -0.3, 0.3]]])[:count]
    frame = np.vstack([ROBOT.frame_anchors, [[0.0, 6.0, 5.0], [0.0, -6.0, 5.0]]])[:count]
    cables = (ROBOT.cables[0],) * count
    return dataclasses.replace(ROBOT, cables=cables, platform_anchors=anchors, frame_anchors=frame, pulleys=())


@pytest.mark.parametrize("count", [8, 9, 10])
def test_more_redundancy_never_costs_more_without_bounds_in_the_way(path, count):
    d = distribute(robot_of(count), path.position, path.rotation, lower_bound=40.0)
    assert d.kkt_residual.max() < 1e-11
    assert (d.status == DistributionStatus.OPTIMAL).all()


def test_no_redundancy_leaves_no_choice():
    """Six cables: the one set of tensions that balances, whatever the cost."""
    six = load_robot("six-cable-4mm")
    one = distribute(six, six.home.position, LEVEL)
    other = distribute(six, six.home.position, LEVEL, cost=PowerNorm(4.0))
    np.testing.assert_allclose(one.tensions, other.tensions, rtol=1e-9)
    assert np.abs(one.residual_wrench).max() < 1e-8


@pytest.mark.parametrize("cost", [EuclideanNorm(WEIGHTS), PowerNorm(4.0), PowerNorm(1.2), Middle(), Centre()])
def test_every_cost_is_least_in_its_own_measure(path, cost):
    wrench = path.inertia_wrench(ROBOT.platform)
    poses = (ROBOT, path.position, path.rotation, wrench, 100.0, 6000.0)
    d = distribute(*poses, cost=cost)
    assert d.kkt_residual.max() < 1e-10
    for other in (EuclideanNorm(), Middle(), PowerNorm(6.0)):
        theirs = distribute(*poses, cost=other)
        assert (d.cost <= cost.total(theirs.tensions, theirs.lower, theirs.upper) * (1.0 + 1e-9)).all()


def test_p_norm_equals_slsqp(path, found):
    wrench = path.inertia_wrench(ROBOT.platform)
    low = found["fixed"].distribution.lower[0, 0]
    d = distribute(ROBOT, path.position, path.rotation, wrench, lower_bound=low, cost=PowerNorm(4.0))
    for i in (20,):
        general = general_cost(pose_problem(path, found, "fixed", i, power=4.0))
        assert general == pytest.approx(d.cost[i], abs=1e-5)


def test_special_cases_of_the_costs_coincide(path):
    plain = distribute(ROBOT, path.position, path.rotation, lower_bound=100.0)
    for cost in (PowerNorm(2.0), EuclideanNorm(np.full(8, 7.0))):
        same = distribute(ROBOT, path.position, path.rotation, lower_bound=100.0, cost=cost)
        np.testing.assert_allclose(same.tensions, plain.tensions, rtol=0.0, atol=1e-6)


def test_length_limit_is_kept(path):
    """(5.8): no cable longer than 12.6 m unstrained, where 12.63 m were needed without the limit."""
    free = distribute(ROBOT, path.position, path.rotation, lower_bound=20.0)
    assert free.lengths.max() > 12.605
    d = distribute(ROBOT, path.position, path.rotation, lower_bound=20.0, longest=12.6)
    assert d.lengths.max() <= 12.6 * (1.0 + 1e-12)
    assert (d.cost >= free.cost * (1.0 - 1e-12)).all()  # equal to rounding where the limit does not act
    assert d.cost.sum() > free.cost.sum()
