"""Forward kinematics: converges everywhere, finds stable equilibria, and is equivariant, as physics is."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cdpr_struct.errors import ConvergenceError
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import builtin_names, load_robot
from cdpr_struct.statics.equilibrium import rotation_from_vector
from cdpr_struct.statics.forward_kinematics import ForwardStatus, forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.pose_error import reference_lengths

ROBOT = load_robot("thesis-3-1")
PLACES = st.tuples(st.floats(-3, 3), st.floats(-2.5, 2.5), st.floats(0.2, 1.5))


def sub_workspace(robot: Robot, count: int) -> np.ndarray:
    """(count, count, 3) poses over three quarters of the frame; height 0.5 m, mid-height if anchors are low."""
    low, high = robot.frame_anchors.min(axis=0), robot.frame_anchors.max(axis=0)
    share = np.linspace(-0.375, 0.375, count)
    x, y = np.meshgrid(*(0.5 * (low + high)[i] + share * (high - low)[i] for i in (0, 1)), indexing="ij")
    return np.stack([x, y, np.full_like(x, 0.5 if low[2] > 2.0 else 0.5 * (low + high)[2])], axis=-1)


def few(pick: list[int]) -> Robot:
    return replace(
        ROBOT,
        cables=tuple(ROBOT.cables[i] for i in pick),
        platform_anchors=ROBOT.platform_anchors[pick],
        frame_anchors=ROBOT.frame_anchors[pick],
        pulleys=(),
    )


@pytest.mark.parametrize("count", [13, pytest.param(61, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", builtin_names())
@pytest.mark.parametrize("model", ["sagging", "spring"])
def test_every_pose_of_a_map_converges(name, model, count):
    robot = load_robot(name)
    poses = sub_workspace(robot, count)
    solution = forward(robot, reference_lengths(robot, poses, np.eye(3)), poses, model=model)
    assert solution.stable.all()
    assert np.abs(solution.residual_wrench).max() < 1e-6  # N, N m; measured 3e-8


@pytest.mark.parametrize("count", [60, pytest.param(1000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", builtin_names())
def test_converges_from_far_off(name, count):
    """0.3 m and 15 deg off. A few starts roll over into another equilibrium; it must be a stable one too."""
    robot = load_robot(name)
    rng = np.random.default_rng(3)
    map_ = sub_workspace(robot, 13).reshape(-1, 3)
    place = map_[rng.integers(0, len(map_), count)] + rng.uniform(-0.3, 0.3, (count, 3))
    lengths = reference_lengths(robot, place, np.eye(3))
    shift, turn = rng.normal(size=(2, count, 3))
    shift *= 0.3 / np.linalg.norm(shift, axis=1, keepdims=True)
    turn *= np.radians(15.0) / np.linalg.norm(turn, axis=1, keepdims=True)
    near = forward(robot, lengths, place)
    far = forward(robot, lengths, place + shift, rotation_from_vector(turn))
    assert near.stable.all()
    assert far.stable.all()
    same = np.linalg.norm(far.position - near.position, axis=-1) < 1e-6
    assert same.mean() > 0.9  # measured above 0.98


@settings(max_examples=15, deadline=None)
@given(
    place=PLACES, axis=st.sampled_from([0, 1]), tilt=st.floats(-0.1, 0.1), model=st.sampled_from(["sagging", "spring"])
)
def test_mirrored_robot_takes_the_mirrored_pose(place, axis, tilt, model):
    flip = np.ones(3)
    flip[axis] = -1.0
    mirror = np.diag(flip)
    mirrored = replace(ROBOT, platform_anchors=ROBOT.platform_anchors * flip, frame_anchors=ROBOT.frame_anchors * flip)
    turn = rotation_from_vector(np.array([tilt, 0.5 * tilt, -tilt]))
    lengths = reference_lengths(ROBOT, place, turn)
    one = forward(ROBOT, lengths, place, turn, model)
    other = forward(mirrored, lengths, place * flip, mirror @ turn @ mirror, model)
    assert np.abs(other.position - one.position * flip).max() < 1e-8
    assert np.abs(other.rotation - mirror @ one.rotation @ mirror).max() < 1e-8
    unmirrored = forward(ROBOT, lengths, place, turn, model, external_wrench=[5.0, 5.0, 0, 0, 0, 0])
    assert np.abs(other.position - unmirrored.position * flip).max() > 1e-6  # twin: a side load breaks the symmetry


@settings(max_examples=8, deadline=None)
@given(place=PLACES, angle=st.floats(-3.0, 3.0))
def test_turning_the_world_about_the_vertical_turns_the_answer(place, angle):
    turn = rotation_from_vector(np.array([0.0, 0.0, angle]))
    turned = replace(ROBOT, frame_anchors=ROBOT.frame_anchors @ turn.T)
    lengths = reference_lengths(ROBOT, place, np.eye(3))
    one = forward(ROBOT, lengths, place)
    other = forward(turned, lengths, turn @ np.array(place), turn)
    assert np.abs(other.position - turn @ one.position).max() < 1e-8
    assert np.abs(other.rotation - turn @ one.rotation).max() < 1e-8


@pytest.mark.parametrize("pick", [[0, 2], [0, 2, 1], [0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 2, 3, 4]])
@pytest.mark.parametrize("model", ["sagging", "spring", "ideal"])
def test_robots_with_few_cables_hang_stably(pick, model):
    """Started from nothing but the lengths."""
    robot = few(pick)
    solution = forward(robot, reference_lengths(robot, [0.3, 0.2, 0.5], np.eye(3)), model=model)
    assert solution.stable
    assert solution.least_stiffness > 1.0
    vertical = solution.cables.force_on_platform[:, 2].sum()
    assert vertical == pytest.approx(60.0 * 9.81, abs=1e-5 if model != "ideal" else 0.1)


def test_a_platform_on_one_cable_is_balanced_but_spins_freely():
    solution = forward(few([0]), [9.0])
    assert solution.status == ForwardStatus.NEUTRAL
    assert solution.converged
    assert abs(solution.least_stiffness) < 1e-6
    assert solution.tensions == pytest.approx([588.6], rel=1e-6)


def test_an_unstable_balance_is_left():
    """A heavy platform balanced above its two anchors turns over: centre of mass above the cables is not kept."""
    heavy = replace(few([0, 2]), platform=replace(ROBOT.platform, center_of_mass=np.array([0.0, 0.0, 0.2])))
    lengths = reference_lengths(heavy, [0.0, 0.0, 0.5], np.eye(3))
    solution = forward(heavy, lengths, [0.0, 0.0, 0.5])
    assert solution.stable
    lever = (solution.rotation @ np.array([0.0, 0.0, 1.0]))[2]
    assert lever == pytest.approx(forward(heavy, lengths).rotation[2, 2], abs=1e-6)


def test_batches_broadcast_over_poses_loads_masses_and_robot_parameters():
    place = np.array([[0.0, 0.0, 0.5], [1.0, 1.0, 0.5], [2.0, -1.0, 0.8]])
    lengths = reference_lengths(ROBOT, place, np.eye(3))
    draws = 1.0 + 0.02 * np.random.default_rng(0).normal(size=(4, 1, 8))
    arrays = replace(RobotArrays.of(ROBOT), axial_stiffness=ROBOT.axial_stiffness * draws)
    wrench = np.zeros((2, 1, 1, 6))
    wrench[1, ..., 2] = -50.0
    batch = forward(arrays, lengths, place, external_wrench=wrench, mass=np.array([[50.0], [60.0], [70.0], [80.0]]))
    assert batch.position.shape == (2, 4, 3, 3)
    single = replace(RobotArrays.of(ROBOT), axial_stiffness=ROBOT.axial_stiffness * draws[3, 0])
    one = forward(single, lengths[1], place[1], external_wrench=wrench[1, 0, 0], mass=80.0)
    assert np.abs(batch.position[1, 3, 1] - one.position).max() < 1e-9
    assert np.abs(batch.position[1, 2, 1] - one.position).max() > 1e-4
    loaded = forward(ROBOT.with_load(mass=80.0), lengths[1], place[1])
    assert forward(RobotArrays.of(ROBOT), lengths[1], place[1], mass=80.0).position == pytest.approx(loaded.position)
    assert np.abs(forward(ROBOT, lengths[1], place[1]).position - loaded.position).max() > 1e-3


@pytest.mark.parametrize("moment", [0.0, 1e-150, 1.0])
def test_a_start_with_every_cable_slack_falls_into_the_cables(moment):
    """No stiffness at all at the start: only the weight says where to go."""
    lengths = 1.02 * reference_lengths(ROBOT, [0.0, 0.0, 1.0], np.eye(3))
    solution = forward(ROBOT, lengths, [0.0, 0.0, 1.0], model="spring", external_wrench=[0, 0, 0, 0, 0, moment])
    assert solution.stable
    assert solution.position[2] < 1.0


def test_ideal_cables_keep_their_lengths():
    place = np.array([0.5, 0.3, 0.5])
    solution = forward(ROBOT, reference_lengths(ROBOT, place, np.eye(3)), place, model="ideal")
    assert np.abs(solution.position - place).max() < 1e-6


def test_lengths_are_checked():
    with pytest.raises(ValueError, match="lengths must be"):
        forward(ROBOT, [1.0, 2.0])
    with pytest.raises(ValueError, match="lengths must be"):
        forward(ROBOT, [-1.0] * 8)


def test_giving_up_is_an_error_with_numbers(monkeypatch):
    monkeypatch.setattr("cdpr_struct.statics.forward_kinematics.MAX_ITERATIONS", 1)
    solution = forward(ROBOT, reference_lengths(ROBOT, [0.0, 0.0, 0.5], np.eye(3)), [0.2, 0.0, 0.5])
    assert solution.status == ForwardStatus.NOT_CONVERGED
    with pytest.raises(ConvergenceError, match=r"forward kinematics at 1 of 1 poses: residual .* after 1 iterations"):
        solution.require_converged()


def test_a_robot_on_stiff_cables_comes_to_rest_from_far_away():
    """200 steps were too few for eleven of ten thousand random robots; here a turn by 160 degrees on stiff cables."""
    stiff = tuple(replace(cable, axial_stiffness=1e9) for cable in load_robot("six-cable-8mm").cables)
    robot = replace(load_robot("six-cable-8mm"), cables=stiff)
    length = inverse(robot, robot.home.position, robot.home.rotation).lengths
    upset = rotation_from_vector(np.array([[2.8, 0.0, 0.0], [0.0, 2.8, 0.0], [1.6, -1.6, 1.0]]))
    found = forward(robot, length, robot.home.position + np.array([0.5, 0.5, 1.0]), upset)
    assert found.converged.all()
    assert found.iterations.max() > 200
