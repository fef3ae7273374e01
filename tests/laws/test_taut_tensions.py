"""Tensions of least norm at many poses at once are those that the general programs find one by one."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics import inverse_kinematics
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.small_systems import backward, cholesky, forward, solve_positive
from cdpr_struct.statics.taut_tensions import suits, taut_tensions
from tests.laws.fast_mode_cases import on_pulleys

LEVEL = np.eye(3)
TILTED = np.array([1.0, 0.3, 0.8])
LEAST_FOUND = 0.9
AGREES = 1e-12  # relative, of lengths and of the largest force


def near_home(robot, count=24, seed=3):
    spread = np.array([1.5, 1.2, 0.3])
    return robot.home.position + np.random.default_rng(seed).uniform(-1.0, 1.0, (count, 3)) * spread


def with_extensions(name, **given):
    robot = load_robot(name)
    return replace(robot, extensions=Extensions.of(len(robot.cables), given))


def over_pulleys(name, axes, line=False):
    return on_pulleys(np.random.default_rng(4), load_robot(name), axes, line)


def by_programs(monkeypatch, robot, positions, **options):
    with monkeypatch.context() as patch:
        patch.setattr(inverse_kinematics, "suits", lambda problem: False)
        return inverse(robot, positions, LEVEL, allow_unheld=True, **options)


def largest_gap(ours, theirs) -> float:
    states, others = ours.cables, theirs.cables
    size = others.tension_at_platform.max(axis=-1, keepdims=True)
    gaps = [abs(getattr(states, n) - getattr(others, n)) / size for n in ("force_x", "force_z")]
    gaps += [
        abs(getattr(states, n) - getattr(others, n)) / others.length for n in ("length", "let_out", "wrapped_length")
    ]
    gaps += [abs(states.offset - others.offset).max(axis=-1) / others.length]
    return float(max(gap[theirs.held].max() for gap in gaps))


def problem_at(robot, positions) -> HoldingProblem:
    arrays = RobotArrays.of(robot)
    turns = np.broadcast_to(LEVEL, (len(positions), 3, 3))
    m, k = arrays.cable_count, len(positions)
    bounds = tuple(np.broadcast_to(b, (k, m)) for b in (arrays.force_min, arrays.force_max))
    return HoldingProblem.at(arrays, cable_model("sagging"), (positions, turns), np.zeros((k, 6)), bounds)


ROBOTS = {
    "plain": lambda: load_robot("thesis-3-1"),
    "heavy cables": lambda: load_robot("thesis-3-1-8mm"),
    "six cables": lambda: load_robot("six-cable-4mm"),
    "cogiro": lambda: load_robot("cogiro"),
    "bounds act": lambda: load_robot("thesis-5"),
    "both bounds act": lambda: load_robot("thesis-5").with_force_limits(100.0, 1100.0),
    "stiffening": lambda: with_extensions("thesis-3-1", nonlinearity=0.3, reference_tension=200.0),
    "in line": lambda: with_extensions("thesis-3-1", series_compliance=5e-5),
    "loads": lambda: with_extensions("thesis-3-1", force=[20.0, 5.0, -30.0], tilt=[0.01, -0.02], hose=300.0),
    "upright wheels": lambda: over_pulleys("thesis-3-1", "upright"),
    "upright wheels, heavy cables": lambda: over_pulleys("thesis-3-1-8mm", "upright"),
    "level wheels": lambda: over_pulleys("thesis-3-1", "level", line=True),
    "oblique wheels": lambda: over_pulleys("thesis-3-1-8mm", "oblique"),
    "oblique wheels, six cables": lambda: over_pulleys("six-cable-4mm", "oblique"),
    "wheels where bounds act": lambda: over_pulleys("thesis-5", "upright"),
    "two wheels": lambda: replace(load_robot("cogiro"), pulleys=(Pulley(0.1), Pulley(0.2, TILTED)) + (None,) * 6),
    "encoders": lambda: with_extensions("thesis-3-1", length_offset=0.01, length_scale=1.001),
}


@pytest.mark.parametrize("name", ROBOTS)
def test_many_poses_at_once_are_those_one_by_one(name, monkeypatch):
    robot = ROBOTS[name]()
    positions = near_home(robot)
    ours, theirs = inverse(robot, positions, LEVEL, allow_unheld=True), by_programs(monkeypatch, robot, positions)
    assert (ours.status == theirs.status).all()
    assert theirs.held.any()
    assert largest_gap(ours, theirs) < AGREES
    np.testing.assert_allclose(ours.lengths[theirs.held], theirs.lengths[theirs.held], rtol=AGREES)
    np.testing.assert_allclose(ours.residual_wrench[theirs.held], 0.0, atol=1e-8)


def test_cables_two_percent_heavier_are_told_apart(monkeypatch):
    """The twin of the test above."""
    robot = load_robot("thesis-3-1")
    heavier = replace(robot, cables=tuple(replace(c, linear_density=1.02 * c.linear_density) for c in robot.cables))
    positions = near_home(robot)
    assert largest_gap(inverse(heavier, positions, LEVEL), by_programs(monkeypatch, robot, positions)) > 1e3 * AGREES


@pytest.mark.parametrize(
    "name",
    ["plain", "bounds act", "both bounds act", "upright wheels", "oblique wheels", "wheels where bounds act"],
)
def test_taut_cables_are_found_without_programs(name):
    robot = ROBOTS[name]()
    problem = problem_at(robot, near_home(robot))
    assert suits(problem)
    found, held = taut_tensions(problem).found, inverse(robot, near_home(robot), LEVEL, allow_unheld=True).held
    assert not (found & ~held).any()
    assert found[held].mean() >= LEAST_FOUND
    assert held.sum() >= 10


def test_wheels_two_percent_larger_are_told_apart(monkeypatch):
    robot = over_pulleys("thesis-3-1", "upright")
    larger = replace(robot, pulleys=tuple(Pulley(1.02 * p.radius, p.axis) for p in robot.pulleys))
    positions = near_home(robot)
    assert largest_gap(inverse(larger, positions, LEVEL), by_programs(monkeypatch, robot, positions)) > 1e3 * AGREES


def test_robots_of_a_batch_have_their_own_mass_and_wrench(monkeypatch):
    robot, rng = load_robot("thesis-3-1"), np.random.default_rng(5)
    given = {"mass": rng.uniform(40.0, 90.0, 20), "external_wrench": rng.normal(0.0, 20.0, (20, 6))}
    positions = near_home(robot, 20)
    ours = inverse(robot, positions, LEVEL, **given)
    assert largest_gap(ours, by_programs(monkeypatch, robot, positions, **given)) < AGREES


def test_what_does_not_fit_is_left_to_the_programs():
    """Masts, few cables, other models: by rule, not by failing."""
    robot = load_robot("thesis-3-1")
    positions = near_home(robot)
    assert suits(problem_at(robot, positions))
    assert not suits(problem_at(with_extensions("thesis-3-1", frame_compliance=1e-5), positions))
    assert not suits(replace(problem_at(robot, positions), model=cable_model("spring")))
    few = replace(robot, cables=robot.cables[:5], platform_anchors=robot.platform_anchors[:5],
                  frame_anchors=robot.frame_anchors[:5], pulleys=(), extensions=None)  # fmt: skip
    assert not suits(problem_at(few, positions))


def test_slack_cables_are_left_to_the_programs():
    """A cable whose chord tension is below its weight, and poses that cannot be held at all."""
    bare = load_robot("thesis-5").with_force_limits(0.0)
    positions = near_home(bare)
    assert not taut_tensions(problem_at(bare, positions)).found.any()
    assert inverse(bare, positions, LEVEL).held.all()
    weak = bare.with_force_limits(400.0, 500.0)
    assert not taut_tensions(problem_at(weak, positions)).found.any()


@pytest.mark.parametrize("name", ["plain", "bounds act", "heavy cables", "upright wheels", "oblique wheels"])
def test_a_pose_does_not_depend_on_its_company(name):
    """To the last digit: a map is the same in chunks of any size."""
    robot = ROBOTS[name]()
    positions = near_home(robot, 150)
    whole = inverse(robot, positions, LEVEL)
    for part in (slice(i, i + 1) for i in range(0, 150, 3)):
        alone = inverse(robot, positions[part], LEVEL)
        assert (alone.tensions == whole.tensions[part]).all()
        assert (alone.lengths == whole.lengths[part]).all()


def test_small_systems_are_solved():
    rng = np.random.default_rng(2)
    root = rng.normal(size=(7, 5, 5))
    matrix, right = root @ np.swapaxes(root, 1, 2), rng.normal(size=(7, 5))
    lower = cholesky(np.moveaxis(matrix, 0, -1))
    ours = backward(lower, forward(lower, right.T)).T
    np.testing.assert_allclose(ours, np.linalg.solve(matrix, right[..., None])[..., 0], rtol=1e-9)
    assert np.isnan(cholesky(-np.moveaxis(matrix, 0, -1))[-1, -1]).all()


def test_positive_systems_are_solved_from_their_lower_triangle_and_others_refused():
    rng = np.random.default_rng(3)
    root = rng.normal(size=(7, 6, 6))
    matrix, right = root @ np.swapaxes(root, 1, 2), rng.normal(size=(7, 6))
    lower = np.moveaxis(np.where(np.tri(6, dtype=bool), matrix, np.nan), 0, -1)
    ours = solve_positive(lower, right.T).T
    np.testing.assert_allclose(ours, np.linalg.solve(matrix, right[..., None])[..., 0], rtol=1e-9)
    lower[5, 5, 3] -= 2.0 / np.linalg.inv(matrix[3])[5, 5]  # the last pivot becomes negative
    assert (np.isnan(solve_positive(lower, right.T)).any(axis=0) == (np.arange(7) == 3)).all()
