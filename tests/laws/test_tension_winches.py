"""Winches that hold the tension of their cable: closed forms, derivatives, energies, files, and refusals."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError, ConvergenceError, InputError
from cdpr_struct.robot.cable import Cable, Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot, robot_of_text
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.cable_response import end_stiffness
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.locked_balance import LockedBalance
from cdpr_struct.statics.locked_rest import locked_rest
from cdpr_struct.statics.potential_energy import potential_energy

PLACE = np.array([0.5, -1.0, 0.8])
WINCHES = {1: 247.0, 4: 195.0}  # N, cables from 0


def with_winches(robot: Robot, tensions: dict[int, float]) -> Robot:
    cables = (replace(c, winch_tension=tensions.get(i, 0.0)) for i, c in enumerate(robot.cables))
    return replace(robot, cables=tuple(cables))


def thesis(pulleys: bool = False, tensions: dict[int, float] = WINCHES, **extensions: float) -> Robot:
    robot = with_winches(load_robot("thesis-3-1"), tensions)
    robot = replace(robot, extensions=Extensions.of(8, extensions))
    return replace(robot, pulleys=(Pulley(0.1),) * 8) if pulleys else robot


def lengths() -> np.ndarray:
    return inverse(load_robot("thesis-3-1"), PLACE, np.eye(3), lower_bound=100.0).lengths


def helped_load(density: float, helper: float = 300.0) -> OperatingPoint:
    """60 kg that only moves in x, y and z, 4 m below a locked cable and 7 m below a winch that pulls with a force."""
    cables = (Cable(2.0e5, density), Cable(3.0e5, density, winch_tension=helper))
    anchors = np.array([[0.0, 0.0, 4.0], [0.0, 0.0, 7.0]])
    body, turns = Platform(60.0, np.zeros(3), np.eye(3)), ("rx", "ry", "rz")
    robot = Robot("helped", body, cables, np.zeros((2, 3)), anchors, gravity=9.81, guided=turns)
    return OperatingPoint(robot, np.zeros(3), np.eye(3), inverse(robot, np.zeros(3), np.eye(3)).cables)


def test_a_constant_force_adds_to_a_pendulum_but_not_along_the_cable():
    """With nearly massless cables: m omega^2 = (m g - F) / l + F / h sideways, EA / l along."""
    omega = 2.0 * np.pi * certified_modes(helped_load(1e-7), "static", 3).frequencies.hertz
    point = helped_load(1e-7)
    sideways = ((60.0 * 9.81 - 300.0) / 4.0 + 300.0 / 7.0) / 60.0
    along = 2.0e5 / point.cables.length[0] / 60.0
    np.testing.assert_allclose(omega**2, [sideways, sideways, along], rtol=1e-7)


def test_a_cable_that_slides_over_its_winch_moves_as_a_whole():
    """Along: m + mu l / 3 of the locked cable + mu h of the sliding one, to first order in the cables' mass."""
    density = 1e-3
    point = helped_load(density)
    omega = 2.0 * np.pi * np.array(certified_modes(point, "exact", 40).frequencies.hertz)
    expected = np.sqrt(2.0e5 / point.cables.length[0] / (60.0 + density * (4.0 / 3.0 + 7.0)))
    assert np.abs(omega / expected - 1.0).min() < 2e-7
    held = np.sqrt(2.0e5 / point.cables.length[0] / (60.0 + density * 4.0 / 3.0))
    assert abs(held / expected - 1.0) > 5e-5  # without the sliding cable's mass


@pytest.mark.parametrize("pulleys", [False, True])
@pytest.mark.parametrize("model", ["sagging", "spring"])
def test_end_stiffness_is_the_derivative_of_the_pull(model, pulleys):
    arrays, chosen, step = RobotArrays.of(thesis(pulleys)), cable_model(model), 1e-4
    points, given = PLACE + arrays.platform_anchors, lengths()
    stiffness = end_stiffness(arrays, chosen.states(arrays, points, given))
    for k, way in enumerate(step * np.eye(3)):
        ahead, back = (chosen.states(arrays, points + s * way, given).force_on_platform for s in (1.0, -1.0))
        difference = (back - ahead) / (2.0 * step)
        for cable in WINCHES:
            np.testing.assert_allclose(stiffness[cable, :, k], difference[cable], atol=2e-7)  # N/m, of 15


@pytest.mark.parametrize("model", ["sagging", "spring"])
@pytest.mark.parametrize("extensions", [{}, {"frame_compliance": 1e-5}, {"series_compliance": 1e-5}])
def test_forward_returns_to_the_pose_that_inverse_holds(model, extensions):
    robot = thesis(**extensions)
    held = inverse(robot, PLACE, np.eye(3), model)
    np.testing.assert_allclose(held.cables.tension_at_frame[list(WINCHES)], list(WINCHES.values()), rtol=1e-10)
    given = held.lengths.copy()
    given[list(WINCHES)] = 9.0  # what is said of a winch that holds its tension does not matter
    found = forward(robot, given, PLACE + 0.1, np.eye(3), model)
    assert found.stable
    np.testing.assert_allclose(found.position, PLACE, atol=1e-9)
    np.testing.assert_allclose(found.cables.total_length, held.cables.total_length, atol=1e-9)


def test_ideal_cables_pull_with_the_tension_of_their_winches():
    robot = thesis()
    given = inverse(robot, PLACE, np.eye(3), "ideal").lengths
    found = forward(robot, given, PLACE, np.eye(3), "ideal")
    np.testing.assert_allclose(found.tensions[list(WINCHES)], list(WINCHES.values()), rtol=1e-12)
    np.testing.assert_allclose(found.position, PLACE, atol=1e-6)


def test_the_wrench_is_the_slope_of_an_energy():
    arrays, chosen, step = RobotArrays.of(thesis()), cable_model("sagging"), 2e-5
    balance = LockedBalance(arrays, lengths()[None], np.zeros((1, 6)), chosen)

    def energy(place: np.ndarray) -> float:
        states = balance.states(place[None], np.eye(3)[None])
        return float(potential_energy(arrays, place[None], np.eye(3)[None], states, np.zeros(6))[0])

    wrench = balance.evaluate(PLACE[None] + 0.03, np.eye(3)[None]).wrench[0]
    ways = step * np.eye(3)
    slope = [(energy(PLACE + 0.03 - way) - energy(PLACE + 0.03 + way)) / (2.0 * step) for way in ways]
    np.testing.assert_allclose(slope, wrench[:3], atol=1e-3)  # N; a winch left out is 200 N off


def test_the_platform_is_led_from_home_and_other_equilibria_are_sought():
    found = locked_rest(thesis(), lengths())
    assert found.way == "continued"
    assert found.solution.stable


def test_the_command_says_what_a_winch_has_paid_out():
    given = lengths()
    told = cs.forward(thesis(), given.tolist(), start=PLACE.tolist(), model="spring")
    away = np.abs(np.array(told.answer["lengths_m"]) - given)
    assert set(np.flatnonzero(away > 1e-6)) == set(WINCHES)
    np.testing.assert_allclose(told.answer["lengths_m"], told.rest.solution.cables.total_length, atol=1e-12)


def test_too_many_held_tensions_leave_a_pose_that_nothing_holds():
    robot = thesis(tensions={i: 200.0 for i in range(4)})
    with pytest.raises(CdprError, match="cannot"):
        inverse(robot, PLACE, np.eye(3))


def test_a_tension_below_the_cable_s_weight_is_no_equilibrium():
    with pytest.raises(ConvergenceError, match="winch_tension"):
        forward(thesis(tensions={1: 0.5}), lengths(), PLACE, np.eye(3)).require_converged()


def test_a_robot_file_keeps_the_tension_and_names_a_bad_one():
    robot = thesis()
    again = robot_of_text(robot_toml(robot, "again"), "again.toml")
    assert [c.winch_tension for c in again.cables] == [c.winch_tension for c in robot.cables]
    with pytest.raises(InputError, match=r"winch_tension"):
        robot_of_text(robot_toml(robot, "bad").replace("winch_tension = 247.0", "winch_tension = -1.0"), "bad.toml")


@pytest.mark.parametrize(
    ("command", "options"),
    [
        ("verify", {}),
        ("distribute", {"trajectory": "helix"}),
        ("pose_error", {"grid": "0:1:2,0,0.5"}),
        ("audit", {}),
        ("map", {"grid": "0:1:2,0,0.5", "quantity": "pose-error"}),
        ("modes", {"free": "rx"}),
        ("export", {"to": "moordyn"}),
        ("transient", {"trajectory": "helix"}),
    ],
)
def test_commands_that_know_locked_lengths_only_say_so(command, options):
    with pytest.raises(InputError, match=r"cables\[2\]\.winch_tension"):
        getattr(cs, command)(thesis(), **options)


def test_the_closed_form_says_that_it_has_no_inertia_along_the_cable():
    with pytest.raises(CdprError, match="cable 2 has a winch_tension"):
        cs.modes(thesis(), model="dsm", count=3, force=True)


def test_commands_at_rest_accept_such_a_robot():
    robot, pose = thesis(), PLACE.tolist()
    exact = cs.modes(robot, pose, count=6).answer["frequencies_hz"]
    mapped = cs.map(robot, grid="0.5,-1:-0.9:2,0.8", quantity="first-frequency").columns()
    assert min(np.abs(np.asarray(v, dtype=float) - exact[0]).min() for v in mapped.values()) < 1e-6
    response = cs.frf(robot, pose=pose, excite="fz", respond="z", band="1:2:0.5")
    assert response.answer["peaks_hz"] is not None
    assert cs.transient(robot, pose=pose, initial_velocity="0.1,0,0", duration=0.5).answer
    assert cs.inverse(robot, pose).answer["stable"]
