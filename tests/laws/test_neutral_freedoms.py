"""Freedoms that nothing pushes back: found, counted, named; what is unstable or held is not among them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.dynamics.certified_modes import certified_frequencies, certified_modes
from cdpr_struct.dynamics.natural_frequencies import natural_frequencies, static_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import stability_at
from cdpr_struct.errors import UnstableEquilibriumError
from cdpr_struct.observation.robot_modes import modes_at
from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.forward_kinematics import ForwardStatus, forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.static_stiffness import static_stiffness

G, MASS, INERTIA = 9.81, 20.0, np.diag([0.3, 0.4, 0.2])
CORNERS = np.array([[-15.0, -10.0, 6.0], [15.0, -10.0, 6.0], [15.0, 10.0, 6.0], [-15.0, 10.0, 6.0]])


def hung(anchors, frame, depth, axial_stiffness=3e5, density=1e-7, **more):
    """A body whose centre of mass lies `depth` below its origin; its cables weigh next to nothing."""
    cables = tuple(Cable(axial_stiffness, density) for _ in frame)
    body = Platform(MASS, np.array([0.0, 0.0, -depth]), INERTIA)
    return Robot(
        "hung",
        body,
        cables,
        np.array(anchors, float),
        np.array(frame, float),
        home=Pose(np.zeros(3), np.zeros(3)),
        **more,
    )


def one_point(depth, **more):
    """Four cables that meet in the platform's origin."""
    return hung(np.zeros((4, 3)), CORNERS, depth, **more)


def bifilar(depth, **more):
    """Two vertical cables, 5 m long and 1 m apart."""
    return hung([[-0.5, 0, 0], [0.5, 0, 0]], [[-0.5, 0, 5], [0.5, 0, 5]], depth, **more)


def at_home(robot):
    place, turn = robot.home.position, robot.home.rotation
    return OperatingPoint(robot, place, turn, inverse(robot, place, turn).cables)


def double_pendulum(length, depth, inertia):
    """Two frequencies [Hz] of a body on a rope of that length, hung `depth` above its centre of mass."""
    mass = MASS * np.array([[length**2, length * depth], [length * depth, depth**2 + inertia / MASS]])
    squared = np.linalg.eigvals(np.linalg.solve(mass, np.diag([MASS * G * length, MASS * G * depth])))
    return np.sort(np.sqrt(squared)) / (2 * np.pi)


def test_a_load_on_one_rope_turns_freely_and_swings_like_a_double_pendulum():
    robot = hung([[0, 0, 0]], [[0, 0, 10]], 0.4)
    found = cs.modes(robot, count=6)
    unstrained = found.point.cables.length[0]
    bounce = np.sqrt(3e5 / unstrained / MASS) / (2 * np.pi)
    hand = [0.0, *double_pendulum(10.0, 0.4, 0.3), *double_pendulum(10.0, 0.4, 0.4), bounce]
    assert found.modes.hertz == pytest.approx(np.sort(hand), rel=1e-6, abs=0.0)
    assert found.modes.hertz[0] == 0.0
    assert found.modes.count_certified
    (free,) = found.answer["neutral_freedoms"]
    assert free["motion"] == pytest.approx([0, 0, 0, 0, 0, 1], abs=1e-12)
    assert free["by_symmetry"]
    assert "turning about the vertical axis through (0, 0, 0) m" in str(found)


def test_cables_in_one_point_leave_a_compound_pendulum():
    """With stiff cables the point stands still: omega^2 = m g h / (I + m h^2). So stiff that swinging is 1e-10 of the
    largest stiffness, and still it is no neutral freedom."""
    point = at_home(one_point(0.2, axial_stiffness=1e13))
    hand = [np.sqrt(MASS * G * 0.2 / (inertia + MASS * 0.04)) / (2 * np.pi) for inertia in (0.4, 0.3)]
    assert static_frequencies(point)[:3] == pytest.approx([0.0, *hand], rel=1e-6, abs=0.0)
    assert stability_at(point).neutral == 1


def test_a_body_hung_in_its_centre_of_mass_is_neutral_about_three_axes():
    found = cs.modes(one_point(0.0), count=5)
    assert (found.modes.hertz == 0.0).tolist() == [True, True, True, False, False]
    assert [entry["motion"][3:].tolist() for entry in found.answer["neutral_freedoms"]] == [
        [0, 0, 1],
        [0, 1, 0],
        [1, 0, 0],
    ]
    assert found.modes.count_certified


@pytest.mark.parametrize("robot", [one_point, bifilar])
@pytest.mark.parametrize("depth", [1e-3, 1e-6, 1e-8])
@pytest.mark.parametrize("axial_stiffness", [3e5, 1e9])
def test_the_smallest_depth_decides(robot, depth, axial_stiffness):
    """A centre of mass 10 nm below its axis hangs, 10 nm above it falls over, on it neither; with any cables."""
    beside = 1 if robot is one_point else 0  # turning about the vertical
    below, on, above = (stability_at(at_home(robot(d, axial_stiffness=axial_stiffness))) for d in (depth, 0.0, -depth))
    assert not below.unstable
    assert below.neutral == beside
    assert not on.unstable
    assert on.neutral == beside + (2 if robot is one_point else 1)
    assert above.unstable
    with pytest.raises(UnstableEquilibriumError):
        certified_frequencies(at_home(robot(-depth, axial_stiffness=axial_stiffness)), "exact", 3)


@pytest.mark.parametrize("depth", [0.1, -0.1])
def test_ends_almost_on_one_axis_are_soft_or_unstable_not_neutral(depth):
    """Two vertical cables 1 mm apart turn back with m g b^2 / l, whatever lies where: soft, and no neutral freedom."""
    near = hung([[-5e-4, 0, 0], [5e-4, 0, 0]], [[-5e-4, 0, 5], [5e-4, 0, 5]], depth)
    held = stability_at(at_home(near))
    assert held.neutral == 0
    assert held.unstable == (depth < 0.0)
    if depth > 0.0:
        yaw = np.sqrt(MASS * G * 25e-8 / (5.0 * 0.2)) / (2 * np.pi)
        assert static_frequencies(at_home(near))[0] == pytest.approx(yaw, rel=1e-6)


def test_bifilar_pendulum():
    """Yaw of a bar on two ropes, omega^2 = m g b^2 / (I l), and its swing across them."""
    hertz = cs.modes(bifilar(0.3), count=6).modes.hertz
    for hand in (np.sqrt(MASS * G * 0.25 / (0.2 * 5.0)) / (2 * np.pi), *double_pendulum(5.0, 0.3, 0.3)):
        assert np.abs(hertz / hand - 1.0).min() < 1e-6


def test_a_freedom_by_size_alone_is_said_to_be_one():
    """Two ropes from one point: the whole turns about the vertical, cable ends too."""
    robot = hung([[-0.5, 0, 0], [0.5, 0, 0]], [[0, 0, 5], [0, 0, 5]], 0.3)
    found = cs.modes(robot, count=4)
    (free,) = found.answer["neutral_freedoms"]
    assert free["motion"] == pytest.approx([0, 0, 0, 0, 0, 1], abs=1e-9)
    assert not free["by_symmetry"]
    assert (found.modes.hertz == 0.0).tolist() == [True, False, False, False]
    assert found.modes.count_certified


def test_the_slow_bisection_finds_the_same():
    """With products of inertia, by which turning about the vertical and swinging are coupled."""
    robot = one_point(0.2, density=0.03)
    slanted = INERTIA + np.array([[0.0, 0.02, 0.08], [0.02, 0.0, -0.06], [0.08, -0.06, 0.0]])
    point = at_home(replace(robot, platform=replace(robot.platform, inertia=slanted)))
    slow, quick = natural_frequencies(point, cs_cables(point), 8), certified_frequencies(point, "exact", 8)
    assert quick.hertz == pytest.approx(slow.hertz, rel=1e-9, abs=0.0)
    shapes = certified_modes(point, "exact", 8).shapes
    assert shapes.platform_energy + shapes.cable_energy.sum(axis=-1) == pytest.approx(np.ones(8), abs=1e-9)


def cs_cables(point):
    from cdpr_struct.dynamics.cable_dynamics import cable_dynamics

    return cable_dynamics(point, "exact", 60.0)


def test_forward_says_neutral_and_leaves_the_free_motion_where_it_was():
    robot = one_point(0.2)
    turn = Pose(np.zeros(3), np.array([0.0, 0.0, 0.7])).rotation
    held = inverse(robot, np.zeros(3), turn)
    found = forward(robot, held.lengths, np.array([0.1, 0.05, 0.1]), turn)
    assert found.status == ForwardStatus.NEUTRAL
    assert found.stable
    assert np.abs(found.position).max() < 1e-8
    assert np.abs(found.rotation - turn).max() < 1e-8
    told = cs.forward(robot, held.lengths)
    assert told.answer["stable"]
    assert told.rest.others.count == 0  # 128 descents end turned about the vertical: one pose


def test_a_body_that_is_free_to_turn_answers_a_moment_like_a_free_body_and_keeps_turning():
    robot = one_point(0.2, density=0.03)
    response = cs.frf(robot, excite="mz", respond="rz", band="0.1:2:0.1").sweep.evenly.response[:, 0]
    assert response == pytest.approx(np.full(len(response), 1.0 / 0.2), rel=1e-9)
    record = cs.transient(robot, initial_velocity=[0, 0, 0, 0, 0, 0.3], duration=2.0).record
    turned = record.vibration.displacement[:, 5]
    assert turned == pytest.approx(0.3 * record.vibration.time, rel=1e-9, abs=1e-12)


def test_at_zero_hertz_the_response_has_no_bound():
    with pytest.raises(cs.CdprError, match="begin above"):
        cs.frf(one_point(0.2, density=0.03), excite="mz", respond="rz", band="0:2:0.1")


def test_maps_give_the_first_frequency_above_zero_and_count_the_neutral_ones():
    robot = replace(one_point(0.2, density=0.03), cables=(Cable(3e5, 0.03, force_min=100.0),) * 4)
    for quantity, column in (("first-frequency", "first_Hz"), ("platform-frequency", "platform_frequency_Hz")):
        found = cs.map(robot, "-1:1:2,0,0", quantity).frame()
        model = "exact" if quantity == "first-frequency" else "static"
        own = cs.modes(robot, [1.0, 0.0, 0.0], model=model, count=2).modes.hertz[1]
        assert found[column].iloc[1] == pytest.approx(own, rel=1e-8)
        assert (found["neutral_freedoms"] == 1).all()
    lowest = cs.map(robot, "-1:1:2,0,0", "frequencies").frame()
    assert lowest["f1_Hz"].tolist() == [0.0, 0.0]
    assert lowest["f2_Hz"].iloc[1] == pytest.approx(own_exact(robot), rel=1e-8)
    soft = cs.map(robot, "-1:1:2,0,0", "stiffness-min").frame()["stiffness_min_N_mm"]
    assert (soft > 0.1).all()


def test_an_origin_that_a_free_motion_carries_along_has_no_stiffness_there():
    """Two ropes from one point hold a platform whose origin lies beside the vertical through it."""
    robot = hung([[-0.7, 0, 0], [0.3, 0, 0]], [[-0.2, 0, 5], [-0.2, 0, 5]], 0.3)
    body = replace(robot.platform, center_of_mass=np.array([-0.2, 0.0, -0.3]))
    found = cs.map(replace(robot, platform=body), "0:0.1:2,0,0", "stiffness-min").frame()
    assert found["stiffness_min_N_mm"].iloc[0] == 0.0
    assert found["stiffness_vertical_N_mm"].iloc[0] > 1.0


def test_compliance_is_that_of_the_platform_held_where_it_is_free():
    point = at_home(one_point(0.2))
    stiffness = static_stiffness(point.robot, point.position, point.rotation, point.cables)
    assert stiffness.compliance[5] == pytest.approx(np.zeros(6), abs=1e-15)
    kept = stiffness.matrix[:5, :5]
    assert stiffness.compliance[:5, :5] == pytest.approx(np.linalg.inv(kept), rel=1e-9, abs=1e-15)


def test_frequencies_alone_are_zero_exactly_too():
    """At many poses, whose stiffness rounds to either side."""
    robot = replace(one_point(0.2, density=0.03), cables=(Cable(3e5, 0.03, force_min=100.0),) * 4)
    for place in np.random.default_rng(4).uniform(-3.0, 3.0, (12, 3)) * [1.0, 1.0, 0.3]:
        point = OperatingPoint(robot, place, np.eye(3), inverse(robot, place, np.eye(3)).cables)
        assert certified_frequencies(point, "exact", 3).hertz[0] == 0.0


def own_exact(robot):
    return cs.modes(robot, [1.0, 0.0, 0.0], count=2).modes.hertz[1]


@pytest.mark.parametrize("seed", range(8))
def test_symmetry_is_found_wherever_the_axis_lies(seed):
    """Ends on one vertical axis off the origin, a turned platform, stiff cables: rounding makes nothing unstable."""
    rng = np.random.default_rng(seed)
    turn = Pose(np.zeros(3), rng.uniform(-0.5, 0.5, 3)).rotation
    axis, place = np.array([*rng.uniform(-0.4, 0.4, 2), 0.0]), rng.uniform(-2.0, 2.0, 3)
    ends = axis + np.outer([0.3] * 4 + [0.0] * 4, [0.0, 0.0, 1.0])
    corners = np.array([[-5.0, -4.0, 6.0], [5.0, -4.0, 6.5], [4.0, 5.0, 6.0], [-4.0, 5.0, 5.5]])
    frame = place + np.concatenate([corners, corners * [1.0, 1.0, -1.0]])
    body = Platform(MASS, turn.T @ (axis - [0.0, 0.0, 0.3]), INERTIA)
    robot = Robot("axis", body, (Cable(1e8, 0.02, force_min=50.0),) * 8, ends @ turn, frame)
    held = inverse(robot, place, turn)
    held_point = OperatingPoint(robot, place, turn, held.cables)
    matrix = stability_at(held_point)
    straight = np.array([*-np.cross([0.0, 0.0, 1.0], axis), 0.0, 0.0, 1.0])
    assert not matrix.unstable
    assert matrix.neutral == 1
    assert matrix.proved.all()
    found = matrix.twists[:, 0]
    assert np.abs(found / found[5] - straight).max() < 1e-9


def test_observed_modes_begin_above_zero():
    """What a diagnosis compares with peaks: frequencies, without those of nothing."""
    robot = replace(one_point(0.2, density=0.03), cables=(Cable(3e5, 0.03, force_min=100.0),) * 4)
    held = inverse(robot, np.zeros((1, 3)), np.eye(3)[None])
    point = OperatingPoint(RobotArrays.of(robot), np.zeros((1, 3)), np.eye(3)[None], held.cables)
    seen = modes_at(point, np.array([20.0]))
    own = certified_frequencies(at_home(robot), "exact", 4).hertz[1:]
    assert np.exp(seen.log_hertz[0, :3]) == pytest.approx(own, rel=1e-6)
    assert np.isfinite(seen.gradient).all()


@pytest.mark.parametrize("wind", [(10.0, 0.0), (100.0, 50.0)])
def test_a_balloon_that_leans_does_not_spin_about_its_own_axis(wind):
    robot = cs.load_robot(Path(__file__).parents[2] / "examples" / "robots" / "tethered-aerostat" / "robot.toml")
    found = cs.forward(robot, [163.405] * 3, wrench=[*wind, 0.0, 0.0, 0.0, 0.0])
    turn = found.rest.solution.rotation
    # The least turn that takes the vertical to the leaning axis is about a horizontal one.
    assert turn[1, 0] - turn[0, 1] == pytest.approx(0.0, abs=1e-9)
    assert turn[2, 2] < np.cos(np.radians(1.0))  # it does lean
    assert np.abs(found.answer["residual_wrench"]).max() < 1e-7 * 900.0
