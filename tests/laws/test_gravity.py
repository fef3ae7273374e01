"""Gravity as a vector, and none at all: nothing depends on the axes; straight cables are strings."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import cdpr_struct as cs
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.damping import Viscous
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.mode_shapes import _chord_axes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import CablePort, platform_port
from cdpr_struct.dynamics.robot_dynamic_stiffness import stability_at
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.pose import Pose, angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.potential_energy import potential_energy
from cdpr_struct.statics.separating_wrench import separation
from cdpr_struct.statics.static_stiffness import static_stiffness

POSE = Pose.from_degrees(np.array([0.5, 0.3, 0.8, 3.0, 6.0, -5.0]))
MIDST = Pose(np.array([0.5, 0.3, 2.5]), np.zeros(3))
TURNS = Rotation.random(2, rng=3).as_matrix()


def entered(name):
    """A built-in robot with pulleys, springs in line, a hose and a push."""
    robot = load_robot(name)
    m = len(robot.cables)
    more = {"series_compliance": 2e-5, "hose": 300.0, "hose_center": [0.1, 0.2, 2.0], "force": [20.0, -10.0, 5.0]}
    pulleys = tuple(Pulley(0.04, np.array([0.1, 0.0, 1.0])) for _ in range(m))
    return replace(robot, extensions=Extensions.of(m, more), pulleys=pulleys)


def turned(robot, turn):
    """The same robot in a world whose axes are turned."""
    more = robot.extensions
    given = {name: getattr(more, name) for name in more.active} | {
        name: turn @ getattr(more, name) for name in ("hose_center", "force") if more.hose
    }
    return replace(
        robot,
        frame_anchors=robot.frame_anchors @ turn.T,
        gravity=turn @ robot.gravity_vector,
        pulleys=tuple(p and Pulley(p.radius, turn @ p.axis) for p in robot.pulleys),
        extensions=Extensions.of(len(robot.cables), given),
    )


def turned_pose(pose, turn):
    return Pose(turn @ pose.position, angles_from_rotation(turn @ pose.rotation))


def both(turn):
    """Two rotations on the diagonal: how twists turn."""
    return np.kron(np.eye(2), turn)


@pytest.mark.parametrize("robot", [load_robot("thesis-3-1-8mm"), entered("cogiro")], ids=["heavy", "extended"])
@pytest.mark.parametrize("turn", TURNS, ids=["one", "other"])
def test_statics_turns_with_the_world(robot, turn):
    other, there = turned(robot, turn), turned_pose(POSE, turn)
    ours, theirs = (inverse(r, p.position, p.rotation) for r, p in ((robot, POSE), (other, there)))
    assert theirs.tensions == pytest.approx(ours.tensions, rel=1e-9)
    assert theirs.lengths == pytest.approx(ours.lengths, rel=1e-11)
    assert theirs.cables.force_on_platform == pytest.approx(ours.cables.force_on_platform @ turn.T, rel=1e-7, abs=1e-7)
    assert theirs.cables.sag == pytest.approx(ours.cables.sag, rel=1e-8)
    stiff = [
        static_stiffness(r, p.position, p.rotation, s.cables)
        for r, p, s in ((robot, POSE, ours), (other, there, theirs))
    ]
    wide = both(turn)
    for part in ("matrix", "axial", "sag"):
        mine, own = getattr(stiff[0], part), getattr(stiff[1], part)
        assert own == pytest.approx(wide @ mine @ wide.T, abs=1e-8 * np.abs(mine).max())
    lengths = ours.lengths + np.linspace(-0.02, 0.02, len(ours.lengths))
    rests = [forward(r, lengths, p.position, p.rotation) for r, p in ((robot, POSE), (other, there))]
    assert rests[1].position == pytest.approx(turn @ rests[0].position, abs=1e-9)
    assert rests[1].rotation == pytest.approx(turn @ rests[0].rotation, abs=1e-9)
    energies = [
        potential_energy(RobotArrays.of(r), s.position, s.rotation, s.cables, np.zeros(6))
        - potential_energy(RobotArrays.of(r), p.position, p.rotation, c.cables, np.zeros(6))
        for r, s, p, c in zip((robot, other), rests, (POSE, there), (ours, theirs), strict=True)
    ]
    assert energies[1] == pytest.approx(energies[0], abs=1e-6 * (1.0 + abs(energies[0])))


@pytest.mark.parametrize(
    ("name", "model"),
    [*(("heavy", m) for m in ("exact", "static", "dsm")), *(("extended", m) for m in ("exact", "static"))],
)
def test_modes_turn_with_the_world(name, model):
    robot = load_robot("thesis-3-1-8mm") if name == "heavy" else entered("cogiro")
    other, there = turned(robot, TURNS[0]), turned_pose(POSE, TURNS[0])
    ours, theirs = (cs.modes(r, p, model=model, count=6, force=True).modes for r, p in ((robot, POSE), (other, there)))
    assert theirs.hertz == pytest.approx(ours.hertz, rel=1e-8)
    assert theirs.count_certified
    moved = ours.platform[0] @ both(TURNS[0]).T
    assert np.abs(theirs.platform[0]) == pytest.approx(np.abs(moved), abs=1e-5 * np.abs(moved).max())


def test_a_response_along_another_axis_is_that_of_the_turned_robot():
    """x becomes y, y becomes z, z becomes x."""
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    robot = load_robot("thesis-3-1")

    def response(machine, pose, axes):
        point = cs.modes(machine, pose, count=1).point
        ports = tuple(platform_port("", axes[i], False, np.zeros(3)) for i in (0, 2))
        ports += (CablePort("", 2, 0.3, axes[2]),)
        cables = cable_dynamics(point, "exact", 60.0)
        hertz = np.array([2.0, 2.7, 3.1])
        return frequency_response(point, cables, Viscous(np.full(8, 0.01)), ports[0], ports, hertz).response

    theirs = response(turned(robot, turn), turned_pose(POSE, turn), turn.T)
    assert theirs == pytest.approx(response(robot, POSE, np.eye(3)), rel=1e-6)


def test_maps_under_tilted_gravity_give_what_modes_give():
    robot = replace(load_robot("thesis-3-1"), gravity=np.array([1.0, 0.5, -9.7]))
    own = cs.modes(robot, [0.2, 0.0, 0.6], count=2).modes.hertz
    found = cs.map(robot, "0.2:0.3:2,0,0.6", "frequencies").frame()
    assert found[["f1_Hz", "f2_Hz"]].iloc[0].to_numpy() == pytest.approx(own, rel=1e-8)
    first = cs.map(robot, "0.2:0.3:2,0,0.6", "first-frequency").frame()["first_Hz"].iloc[0]
    assert first == pytest.approx(own[0], rel=1e-8)


def test_chords_of_tilted_cables_are_chords():
    robot = replace(load_robot("thesis-3-1"), gravity=np.array([3.0, -4.0, -8.0]))
    point = cs.modes(robot, count=1).point
    flat = OperatingPoint(robot, point.position[None], point.rotation[None], point.cables.at(None))
    chords = point.cables.offset / point.cables.chord[:, None]
    assert np.abs((_chord_axes(flat)[0] * chords).sum(axis=-1)) == pytest.approx(np.ones(8), abs=1e-4)


def weightless(**more):
    """A heavy platform between eight stretched cables."""
    robot = load_robot("thesis-5")
    cables = tuple(replace(c, force_min=800.0) for c in robot.cables)
    return replace(robot, cables=cables, gravity=0.0, platform=robot.platform.with_mass(1e9), **more)


def test_without_gravity_cables_are_taut_strings():
    """n / 2 sqrt(T / (mu L l)) across, L unstrained and l stretched; n / 2 sqrt(EA / mu) / L along."""
    point = cs.modes(weightless(), count=1).point
    cables = point.cables
    assert (cables.weight == 0.0).all()
    assert np.abs(cables.sag).max() == 0.0
    density, pull = point.arrays.linear_density, cables.tension_at_platform
    hand = 0.5 * np.sqrt(pull / (density * cables.length * cables.chord))
    found = cable_dynamics(point, "exact", 2 * np.pi * 40.0)
    assert found.first_frequency / (2 * np.pi) == pytest.approx(hand, rel=1e-9)
    squared = np.sort(found.full.omega_squared, axis=-1)[:, :6]
    assert np.sqrt(squared) / (2 * np.pi) == pytest.approx(np.outer(hand, [1, 1, 2, 2, 3, 3]), rel=1e-8)


def test_without_gravity_internal_forces_are_all_there_is():
    robot = weightless()
    held = inverse(robot, MIDST.position, MIDST.rotation)
    assert np.abs(held.residual_wrench).max() < 1e-7 * held.tensions.max()
    assert held.tensions.min() == pytest.approx(800.0, rel=1e-9)
    back = forward(robot, held.lengths, MIDST.position + 0.02, MIDST.rotation)
    assert back.stable
    assert back.position == pytest.approx(MIDST.position, abs=1e-8)
    spring = inverse(robot, MIDST.position, MIDST.rotation, "spring")
    assert spring.tensions == pytest.approx(held.tensions, rel=1e-9)


def test_almost_no_gravity_is_nearly_none():
    none = replace(weightless(), platform=load_robot("thesis-5").platform)
    little = replace(none, gravity=1e-6)
    ours, theirs = (cs.modes(r, MIDST, count=10).modes.hertz for r in (none, little))
    assert theirs == pytest.approx(ours, rel=1e-6)


def test_a_slack_cable_without_gravity_is_refused_with_the_cure():
    loose = replace(weightless(), cables=tuple(replace(c, force_min=0.0) for c in weightless().cables))
    with pytest.raises(cs.CdprError, match=r"no shape to vibrate about, .* do not pull. With --lower-bound"):
        cs.modes(loose, MIDST)
    assert np.isnan(cs.map(loose, "0:0.1:2,0,2", "first-frequency").frame()["first_Hz"]).all()


def test_one_slack_cable_among_taut_ones_is_no_state_to_vibrate_about():
    robot, spare = weightless(), np.array([[9.0, 0.0, 6.0]])
    cables = (*robot.cables, replace(robot.cables[0], force_min=0.0))
    anchors = np.concatenate([robot.platform_anchors, [[0.0, 0.0, 0.0]]]), np.concatenate([robot.frame_anchors, spare])
    nine = Robot("nine", robot.platform, cables, *anchors, gravity=0.0)
    lengths = [*inverse(robot, MIDST.position, MIDST.rotation).lengths, 20.0]
    found = forward(nine, lengths, MIDST.position, MIDST.rotation)
    assert found.cables.slack.tolist() == [False] * 8 + [True]
    assert found.stable
    assert stability_at(OperatingPoint(nine, found.position, found.rotation, found.cables)).unstable


def test_a_diagnosis_refuses_such_robots(tmp_path):
    for name, changed in (("tilted", {"gravity": np.array([1.0, 0.0, -9.0])}), ("weightless", {"gravity": 0.0})):
        (tmp_path / f"{name}.toml").write_text(robot_toml(replace(load_robot("thesis-5"), **changed), name))
        (tmp_path / "states.csv").write_text("case,x_m,y_m,z_m,cable,tension_N\na,0,0,2.5,1,100\n")
        text = 'kind = "static_state"\nfile = "states.csv"\nsigma = { tension_N = 3.0, position_m = 0.001 }\n'
        (tmp_path / "campaign.toml").write_text(f'robot = "{name}.toml"\nmodel = "exact"\n[[measurement]]\n{text}')
        with pytest.raises(cs.InputError, match="gravity along -z: no other is diagnosed"):
            load_campaign(tmp_path / "campaign.toml")


@pytest.mark.parametrize("given", [0.0, 1.62, np.array([1.0, -2.0, -9.0])])
def test_a_file_holds_gravity(tmp_path, given):
    path = tmp_path / "robot.toml"
    path.write_text(robot_toml(replace(load_robot("thesis-5"), gravity=given), "robot"))
    expected = np.array([0.0, 0.0, -given]) if np.ndim(given) == 0 else given
    assert load_robot(path).gravity_vector == pytest.approx(expected, rel=1e-15, abs=0.0)


@pytest.mark.parametrize("given", ["-9.81", "[0.0, -9.81]", '"down"', "[0, 0, nan]", "true", "1e13"])
def test_what_is_no_gravity_is_refused_in_one_sentence(tmp_path, given):
    path = tmp_path / "robot.toml"
    path.write_text(robot_toml(load_robot("thesis-5"), "robot").replace("gravity = 9.81", f"gravity = {given}"))
    with pytest.raises(cs.InputError, match="gravity: got"):
        load_robot(path)


def test_a_body_given_in_python_is_checked_too():
    for wrong in (-1.0, np.array([0.0, np.nan, 1.0]), np.zeros((2, 3))):
        with pytest.raises(ValueError, match="gravity"):
            replace(load_robot("thesis-5"), gravity=wrong)


@pytest.mark.parametrize("turn", TURNS, ids=["one", "other"])
def test_what_proves_a_pose_out_of_reach_turns_with_the_world(turn):
    """Slackest cables, and the tensions that leave the least wrench where none balance."""
    robot = load_robot("thesis-3-1-8mm")
    far = Pose(np.array([6.5, 4.5, 0.8]), np.array([0.0, 0.2, 0.1]))
    found = []
    for machine, pose in ((robot, far), (turned(robot, turn), turned_pose(far, turn))):
        arrays, bounds = RobotArrays.of(machine), (np.full((1, 8), 200.0), np.full((1, 8), 900.0))
        place = pose.position[None], pose.rotation[None]
        problem = HoldingProblem.at(arrays, cable_model("sagging"), place, np.zeros((1, 6)), bounds)
        found.append((separation(problem), problem.model.least_chord_tension(arrays, problem.arms.points)))
    (ours, least), (theirs, least_there) = found
    assert ours.proven.all()
    assert theirs.proven.all()
    assert theirs.tension == pytest.approx(ours.tension, rel=1e-6)
    assert least_there == pytest.approx(least, rel=1e-9)
