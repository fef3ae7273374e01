"""Guides: what they hold stands still, what they leave free vibrates as a planar robot's formulas say."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.fingerprint import fingerprint
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.robot_from_arrays import robot_from_arrays
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.pose_error import pose_error, reference_lengths
from cdpr_struct.statics.tension_distribution import DistributionStatus

PLANE = ("y", "rx", "rz")
MASS, TURNING = 10.0, 0.2
ANCHORS = np.array([[0.2, 0, -0.1], [-0.2, 0, -0.1], [-0.2, 0, 0.1], [0.2, 0, 0.1], [0.0, 0, -0.1]])
FRAME = np.array([[2.0, 0, 1.5], [-2.0, 0, 1.5], [-2.0, 0, -1.5], [2.0, 0, -1.5], [0.0, 0, -1.5]])


def planar(pick=(0, 1, 2, 3), density=1e-7, guided=PLANE, center=(0.0, 0.0, 0.0), **more):
    cables = tuple(Cable(2e5, density, 0.005, force_min=200.0) for _ in pick)
    body = Platform(MASS, np.array(center), np.diag([0.1, TURNING, 0.15]))
    own = ANCHORS[list(pick)], FRAME[list(pick)]
    return Robot("planar", body, cables, *own, home=Pose(np.zeros(3), np.zeros(3)), guided=guided, **more)


def planar_frequencies(robot, pose, tension):
    """Closed form in the plane (x, z, angle): K = sum k g g^T + T H, with l = |B - p - R a| of every cable.

    g = dl/dq and H = d2l/dq2; the weight acts at the centre of mass, here the origin.
    """
    angle, place = -pose.angles[1], pose.position[[0, 2]]  # counter-clockwise in (x, z)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    stiffness = np.zeros((3, 3))
    for a, b, pull in zip(robot.platform_anchors[:, [0, 2]], robot.frame_anchors[:, [0, 2]], tension, strict=True):
        arm = turn @ a
        swept = np.array([-arm[1], arm[0]])
        line = b - place - arm
        length = np.linalg.norm(line)
        u = line / length
        across = (np.eye(2) - np.outer(u, u)) / length
        slope = -np.array([*u, u @ swept])
        bend = np.zeros((3, 3))
        bend[:2, :2], bend[:2, 2] = across, across @ swept
        bend[2, :2], bend[2, 2] = bend[:2, 2], swept @ across @ swept + u @ arm
        unstrained = length / (1.0 + pull / 2e5)
        stiffness += 2e5 / unstrained * np.outer(slope, slope) + pull * bend
    root = np.sqrt([MASS, MASS, TURNING])
    return np.sqrt(np.linalg.eigvalsh(stiffness / root / root[:, None])) / (2 * np.pi)


@pytest.mark.parametrize("pick", [(0, 1, 2, 3), (0, 1, 4)])
@pytest.mark.parametrize("pose", [(0, 0, 0, 0, 0, 0), (0.15, 0, 0.2, 0, 8, 0)])
def test_a_planar_robot_has_the_frequencies_of_its_closed_form(pick, pose):
    """Four cables, and three: two from above, one straight down."""
    robot, where = planar(pick), Pose.from_degrees(np.array(pose, dtype=float))
    if len(pick) == 3 and any(pose):  # there three cables balance one angle only
        where = Pose.from_degrees(np.array([0.0, 0.0, 0.2, 0.0, 0.0, 0.0]))
    held = inverse(robot, where.position, where.rotation)
    found = cs.modes(robot, where, model="static", count=6)
    assert len(found.modes.hertz) == 3
    assert found.modes.hertz == pytest.approx(planar_frequencies(robot, where, held.tensions), rel=1e-6)
    assert found.modes.count_certified
    assert np.abs(found.modes.platform[:, [1, 3, 5]]).max() < 1e-12


def test_cables_vibrate_with_a_guided_platform_in_all_models_alike():
    robot = planar(density=0.02)
    exact, dsm = (cs.modes(robot, model=m, count=12).modes for m in ("exact", "dsm"))
    assert exact.count_certified
    assert dsm.count_certified
    assert dsm.hertz == pytest.approx(exact.hertz, rel=5e-3)
    assert exact.platform_energy.max() > 0.5


def test_a_linear_guide_leaves_one_spring_and_one_mass():
    """omega^2 = EA / (L m) on a vertical cable, the guide holding all but z."""
    body = Platform(MASS, np.array([0.1, 0.05, 0.0]), np.eye(3))
    robot = Robot(
        "lift", body, (Cable(2e5, 1e-7),), np.zeros((1, 3)), np.array([[0.0, 0.0, 4.0]]),
        home=Pose(np.zeros(3), np.zeros(3)), guided=("x", "y", "rx", "ry", "rz"),
    )  # fmt: skip
    found = cs.modes(robot, model="static")
    assert found.modes.hertz == pytest.approx(
        [np.sqrt(2e5 / found.answer["lengths_m"][0] / MASS) / (2 * np.pi)], rel=1e-6
    )
    moment = MASS * 9.81 * np.array([0.05, -0.1])
    assert found.answer["guide"]["reaction_wrench"] == pytest.approx([0, 0, 0, *moment, 0], abs=1e-4)


def test_the_guide_takes_what_the_cables_cannot():
    """Weight off the plane: its moment about x; a wrench across it; and in the plane nothing."""
    robot = planar(center=(0.0, 0.05, 0.0))
    found = cs.inverse(robot, wrench=[0.0, 7.0, 0.0, 0.0, 0.0, 2.0])
    weight = MASS * 9.81
    assert found.answer["guide"]["reaction_wrench"] == pytest.approx([0, -7.0, 0, 0.05 * weight, 0, -2.0], abs=1e-6)
    assert np.abs(found.solution.residual_wrench).max() < 1e-6
    assert "A guide holds y, rx, rz" in str(found)


def test_forward_leads_back_and_holds_the_guided_freedoms():
    robot = planar(density=0.02, center=(0.0, 0.05, 0.02))
    where = Pose.from_degrees(np.array([0.3, 0.1, 0.2, 3.0, 8.0, 0.0]))
    robot = replace(robot, home=where)
    held = inverse(robot, where.position, where.rotation)
    start = Pose.from_degrees(np.array([0.25, 0.1, 0.22, 3.0, 8.0, 0.0]))
    found = forward(robot, held.lengths, start.position, start.rotation)
    assert found.stable
    assert found.position == pytest.approx(where.position, abs=1e-9)
    assert found.rotation == pytest.approx(where.rotation, abs=1e-9)
    told = cs.forward(robot, held.lengths * np.array([1.002, 1.0, 1.001, 1.0]))
    assert told.rest.solution.position[1] == 0.1
    for position in told.rest.others.position:
        assert position[1] == pytest.approx(0.1, rel=1e-12)


def test_pose_error_is_that_of_the_plane():
    """The platform sinks by its weight over the vertical stiffness of straight cables."""
    robot = planar()
    error = pose_error(robot, np.array([0.0, 0.0, 0.0]), np.eye(3))
    lengths = reference_lengths(robot, [0.0, 0.0, 0.0], np.eye(3))
    there = forward(robot, lengths, np.zeros(3), np.eye(3), "spring")
    assert error.spring.position == pytest.approx(there.position, abs=1e-9)
    assert error.spring.position[2] < -1e-4
    assert error.spring.position[[0, 1]] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert error.converged


def test_response_and_vibration_stay_in_the_plane():
    robot = planar(density=0.02)
    sweep = cs.frf(robot, excite="fz", respond="z,y,rx", band="0.01:0.05:0.01", quantity="displacement").sweep
    stiffness = cs.map(robot, "0:0.1:2,0,0", "stiffness-vertical").frame()["stiffness_vertical_N_mm"].iloc[0]
    assert abs(sweep.evenly.response[0, 0]) == pytest.approx(1e-3 / stiffness, rel=1e-4)  # 0.01 Hz against 19 Hz
    assert np.abs(sweep.evenly.response[:, 1:]).max() == 0.0
    across = cs.frf(robot, excite="fy", respond="y,z", band="0.01:0.05:0.01").sweep.evenly
    assert np.abs(across.response).max() == 0.0
    vibration = cs.transient(robot, initial_velocity=[0.1, 0.2, 0.1, 0.3, 0, 0.1], duration=1.0).record.vibration
    assert np.abs(vibration.displacement[:, [1, 3, 5]]).max() < 1e-15
    assert np.abs(vibration.displacement[:, 0]).max() > 1e-4
    assert vibration.energy_share > 0.999


def test_maps_give_what_modes_give():
    robot = planar(density=0.02)
    own = cs.modes(robot, [0.2, 0.0, 0.1], count=2).modes.hertz
    grid = "0.2:0.3:2,0,0.1"
    assert cs.map(robot, grid, "first-frequency").frame()["first_Hz"].iloc[0] == pytest.approx(own[0], rel=1e-8)
    assert cs.map(robot, grid, "frequencies").frame()["f2_Hz"].iloc[0] == pytest.approx(own[1], rel=1e-8)
    followed = cs.map(robot, grid, "mode-1").frame()
    assert followed["mode_Hz"].iloc[int(followed["followed_from"].argmin())] > 0.0


def test_forces_along_a_path_balance_in_the_plane():
    found = cs.distribute(planar(density=0.02), "line:0,0,0:0.4,0,0.2:2", instants=11).found[0].distribution
    assert (found.status == DistributionStatus.OPTIMAL).all()
    assert np.abs(found.residual_wrench).max() < 1e-6
    assert (found.rank == 6).all()


def test_a_file_holds_the_guide(tmp_path):
    path = tmp_path / "planar.toml"
    path.write_text(robot_toml(planar(), "planar"))
    assert load_robot(path).guided == PLANE


@pytest.mark.parametrize("given", ['["y", "q"]', '["y", "y"]', '["x", "y", "z", "rx", "ry", "rz"]', '"y"', "[1]"])
def test_what_is_no_guide_is_refused_in_one_sentence(tmp_path, given):
    path = tmp_path / "planar.toml"
    text = robot_toml(planar(guided=()), "planar").replace("[extensions]", f"guided = {given}\n[extensions]")
    path.write_text(text)
    with pytest.raises(cs.InputError, match=r"platform\.guided"):
        load_robot(path)


def test_codes_of_free_bodies_are_not_handed_a_guided_one(tmp_path):
    assert cs.export(planar(density=0.02), to="gltf").content
    for form in ("moordyn", "moorpy"):
        with pytest.raises(cs.InputError, match="a body is free"):
            cs.export(planar(density=0.02), to=form)


def test_another_guide_or_gravity_is_another_robot():
    robots = [planar(), planar(guided=()), planar(gravity=0.0), planar(gravity=np.array([0.0, 1.0, -9.0]))]
    assert len({fingerprint("robot", robot) for robot in robots}) == 4


def test_arrays_keep_the_guide():
    robot = planar(gravity=np.array([0.0, 1.0, -9.0]))
    again = robot_from_arrays(robot, RobotArrays.of(robot))
    assert again.guided == PLANE
    assert again.gravity_vector == pytest.approx(robot.gravity_vector, rel=1e-15)
