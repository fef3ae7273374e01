"""Inverse kinematics: balance, least norm, bounds, symmetry, and clear words for a pose that cannot be held."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from cdpr_struct.errors import ConvergenceError, UnholdablePoseError
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import builtin_names, load_robot
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, weight_wrench
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import InverseStatus, inverse
from cdpr_struct.statics.minimum_norm import QuadraticPrograms, solve_programs

ROBOT = load_robot("thesis-3-1")
FIXED = load_robot("thesis-5")
PLACES = st.tuples(st.floats(-3, 3), st.floats(-2.5, 2.5), st.floats(0.2, 1.5))


def some_cables(robot: Robot, pick: list[int]) -> Robot:
    return replace(
        robot,
        cables=tuple(robot.cables[i] for i in pick),
        platform_anchors=robot.platform_anchors[pick],
        frame_anchors=robot.frame_anchors[pick],
        pulleys=(),
    )


def with_pulleys(robot: Robot, radius: float) -> Robot:
    return replace(robot, pulleys=(Pulley(radius, np.array([0.1, 0.0, 1.0])),) * len(robot.cables))


@settings(max_examples=20, deadline=None)
@given(place=PLACES, model=st.sampled_from(["sagging", "spring", "ideal"]), radius=st.sampled_from([0.0, 0.1]))
def test_tensions_balance_the_weight(place, model, radius):
    robot = with_pulleys(ROBOT, radius) if radius else ROBOT
    solution = inverse(robot, place, np.eye(3), model=model)
    arrays = RobotArrays.of(robot)
    arms = PlatformArms.at(arrays, np.array(place), np.eye(3))
    wrench = cable_wrench(solution.cables, arms) + weight_wrench(arrays, arms)
    assert np.abs(wrench).max() < 1e-8 * 588.6
    heavier = weight_wrench(RobotArrays.of(robot, mass=1.02 * 60.0), arms) + cable_wrench(solution.cables, arms)
    assert np.abs(heavier).max() > 10.0  # twin: 2 % more mass is seen


@settings(max_examples=8, deadline=None)
@given(place=PLACES, radius=st.sampled_from([0.0, 0.1]))
def test_no_tensions_of_smaller_norm_hold_the_pose(place, radius):
    """Optimality without the solver's own equations: along the null space of the wrench the norm has no slope."""
    assert _slopes(place, radius)[0] < 1e-5


def test_tensions_of_straight_cables_are_another_optimum():
    """Twin, at one pose off the symmetry planes (on them the two optima come together): their norm has a slope."""
    optimal, straight = _slopes((1.0, -0.7, 0.8), 0.0)
    assert optimal < 1e-5
    assert straight > 1e-4


def _slopes(place, radius) -> tuple[float, float]:
    """Slope of the norm along the null space at the minimum-norm tensions of sagging and of straight cables [-]."""
    robot = with_pulleys(ROBOT, radius) if radius else ROBOT
    solution = inverse(robot, place, np.eye(3))
    arrays, model = RobotArrays.of(robot), cable_model("sagging")
    arms = PlatformArms.at(arrays, np.array(place), np.eye(3))

    def at(length: np.ndarray) -> np.ndarray:
        """Wrench and cost, (7,)."""
        states = model.states(arrays, arms.points, length)
        return np.append(cable_wrench(states, arms), 0.5 * (states.tension_at_platform**2).sum())

    def slope_in_null_space(length: np.ndarray) -> float:
        rates = np.array([at(length + d) - at(length - d) for d in 1e-6 * np.eye(8)])
        null = np.linalg.svd(rates[:, :6].T)[2][6:]
        return float(np.abs(null @ rates[:, 6]).max() / np.abs(rates[:, 6]).max())

    straight = inverse(robot, place, np.eye(3), model="ideal")
    other = model.hold(arrays, arms.points, straight.tensions).states.total_length
    return slope_in_null_space(solution.lengths), slope_in_null_space(other)


@pytest.mark.parametrize(("low", "high"), [(0.0, np.inf), (120.0, np.inf), (0.0, 220.0), (100.0, 225.0)])
def test_bounded_optimum_agrees_with_a_general_optimiser(low, high):
    """Straight cables, bounds active, against scipy's SLSQP on the same problem."""
    place = np.array([1.5, 1.0, 0.5])
    solution = inverse(ROBOT, place, np.eye(3), model="ideal", lower_bound=low, upper_bound=high)
    arms = PlatformArms.at(RobotArrays.of(ROBOT), place, np.eye(3))
    u = ROBOT.frame_anchors - arms.points
    u /= np.linalg.norm(u, axis=1)[:, None]
    matrix = np.concatenate([u, np.cross(arms.arms, u)], axis=1).T
    load = np.array([0.0, 0.0, -588.6, 0.0, 0.0, 0.0])
    peer = minimize(
        lambda t: 0.5e-4 * t @ t, np.full(8, 150.0), jac=lambda t: 1e-4 * t, method="SLSQP",
        bounds=[(low, None if np.isinf(high) else high)] * 8, options={"maxiter": 500, "ftol": 1e-14},
        constraints={"type": "eq", "fun": lambda t: matrix @ t + load, "jac": lambda t: matrix},
    )  # fmt: skip
    assert solution.tensions == pytest.approx(peer.x, abs=1e-3)
    assert solution.tensions.min() >= low - 1e-9
    assert solution.tensions.max() <= high + 1e-9


def test_sagging_optimum_respects_its_bounds():
    solution = inverse(FIXED, [0.0, 0.0, 2.5], np.eye(3), lower_bound=[[0.0], [50.0], [200.0]])
    assert solution.held.all()
    assert (solution.tensions[1:].min(axis=1) >= [50.0 - 1e-6, 200.0 - 1e-6]).all()
    norms = np.linalg.norm(solution.tensions, axis=1)
    assert (np.diff(norms) > 0.0).all()
    capped = inverse(FIXED, [0.0, 0.0, 2.5], np.eye(3), lower_bound=50.0, upper_bound=840.0)
    assert capped.tensions.max() <= 840.0 + 1e-6


@pytest.mark.parametrize("name", builtin_names())
@pytest.mark.parametrize("model", ["sagging", "spring"])
def test_forward_returns_to_the_pose_that_inverse_held(name, model):
    robot = load_robot(name)
    middle = 0.5 * (robot.frame_anchors.min(axis=0) + robot.frame_anchors.max(axis=0))
    middle[2] = 0.8 if name != "thesis-5" else 2.5
    place = middle + np.random.default_rng(1).uniform(-1.0, 1.0, (40, 3)) * [0.1, 0.1, 0.3]
    held = inverse(robot, place, np.eye(3), model=model, allow_unheld=True)
    keep = held.held & (forward(robot, held.lengths, place, model=model).least_stiffness > 1.0)
    assert keep.any()
    back = forward(robot, held.lengths[keep], place[keep], model=model)
    assert np.abs(back.position - place[keep]).max() < 1e-8
    assert np.abs(back.rotation - np.eye(3)).max() < 1e-8


@settings(max_examples=20, deadline=None)
@given(place=PLACES, axis=st.sampled_from([0, 1]))
def test_mirrored_robot_has_mirrored_tensions(place, axis):
    flip = np.ones(3)
    flip[axis] = -1.0
    mirrored = replace(ROBOT, platform_anchors=ROBOT.platform_anchors * flip, frame_anchors=ROBOT.frame_anchors * flip)
    one = inverse(ROBOT, place, np.eye(3))
    other = inverse(mirrored, place * flip, np.eye(3))
    assert other.tensions == pytest.approx(one.tensions, rel=1e-9)
    assert other.lengths == pytest.approx(one.lengths, rel=1e-12)


def test_fewer_cables_than_equations_hold_only_where_they_hang():
    few = some_cables(ROBOT, [0, 2])
    hanging = forward(few, [9.5, 9.5])
    assert hanging.stable
    held = inverse(few, hanging.position, hanging.rotation)
    assert held.lengths == pytest.approx([9.5, 9.5], abs=1e-9)
    with pytest.raises(UnholdablePoseError, match=r"no cable acts against .* N of force z") as error:
        inverse(few, [0.3, 0.2, 0.5], np.eye(3))
    assert error.value.amount > 100.0
    assert error.value.cable is None


def test_a_cable_that_would_have_to_push_is_named():
    """Suspended: nothing pulls down, so an upward load of more than the weight cannot be held."""
    with pytest.raises(
        UnholdablePoseError, match=r"cable \d would need -.* N, .* N below the lower bound 0 N"
    ) as error:
        inverse(ROBOT, [0.0, 0.0, 0.5], np.eye(3), model="spring", external_wrench=[0, 0, 900.0, 0, 0, 0])
    assert error.value.cable in range(1, 9)
    assert error.value.amount > 0.0


def test_one_bad_pose_in_a_batch_is_reported_without_spoiling_the_others():
    lift = np.zeros((3, 6))
    lift[1, 2] = 900.0
    solution = inverse(ROBOT, [0.0, 0.0, 0.5], np.eye(3), external_wrench=lift, allow_unheld=True)
    assert solution.status.tolist() == [InverseStatus.HELD, InverseStatus.UNHOLDABLE, InverseStatus.HELD]
    with pytest.raises(UnholdablePoseError, match="1 of 3 poses"):
        inverse(ROBOT, [0.0, 0.0, 0.5], np.eye(3), external_wrench=lift)


def test_an_iteration_cut_short_is_not_called_unholdable(monkeypatch):
    """Low bounds on the fully constrained robot take seven steps; after two nothing is known yet."""
    monkeypatch.setattr("cdpr_struct.statics.holding_tensions.MAX_ITERATIONS", 2)
    solution = inverse(FIXED, [0.0, 0.0, 2.5], np.eye(3), lower_bound=0.0, allow_unheld=True)
    assert solution.status == InverseStatus.NOT_CONVERGED
    with pytest.raises(ConvergenceError, match=r"inverse kinematics: residual .* after 2 iterations"):
        inverse(FIXED, [0.0, 0.0, 2.5], np.eye(3), lower_bound=0.0)


def test_bounds_are_checked():
    with pytest.raises(ValueError, match="lower_bound must be finite and >= 0 N"):
        inverse(ROBOT, [0, 0, 0.5], np.eye(3), lower_bound=-1.0)
    with pytest.raises(ValueError, match="upper_bound must be above lower_bound"):
        inverse(ROBOT, [0, 0, 0.5], np.eye(3), lower_bound=10.0, upper_bound=5.0)
    with pytest.raises(ValueError, match="one entry per cable"):
        inverse(ROBOT, [0, 0, 0.5], np.eye(3), lower_bound=[1.0, 2.0])


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 100_000), equations=st.integers(1, 6), extra=st.integers(0, 4))
def test_programs_meet_their_optimality_conditions(seed, equations, extra):
    """Feasible by construction; multipliers then prove the optimum: free unknowns have no slope, held ones push out."""
    rng = np.random.default_rng(seed)
    m = equations + extra
    matrix, inside = rng.normal(size=(1, equations, m)), rng.uniform(0.0, 1.0, (1, m))
    curvature, gradient = rng.uniform(0.5, 2.0, (1, m)), rng.normal(size=(1, m))
    target = np.einsum("knm,km->kn", matrix, inside)
    programs = QuadraticPrograms(curvature, gradient, matrix, target, np.zeros((1, m)), np.ones((1, m)))
    solution, dual = solve_programs(programs)
    assert np.abs(np.einsum("knm,km->kn", matrix, solution) - target).max() < 1e-9
    slope = curvature * solution + gradient - np.einsum("knm,kn->km", matrix, dual)
    assert np.abs(slope[(solution > 0.0) & (solution < 1.0)]).max(initial=0.0) < 1e-7 * (1.0 + np.abs(dual).max())
    assert (slope[solution <= 0.0] >= -1e-7).all()
    assert (slope[solution >= 1.0] <= 1e-7).all()
