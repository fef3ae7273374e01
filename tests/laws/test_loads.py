"""A constant wrench on the platform and warm cables: by first principles, and alike in every command."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.dynamics.applied_moment import frequency_change, moment_sentence
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import platform_mass_matrix, platform_static_stiffness
from cdpr_struct.errors import InputError
from cdpr_struct.generated.platform import rotation
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, rotation_from_vector
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.static_stiffness import static_stiffness

ROBOT = load_robot("cogiro")
PLACE, TURN = ROBOT.home.position + np.array([0.6, -0.4, 0.2]), rotation(0.06, -0.04, 0.1)
GRAVITY = 9.81
TWISTING = [0.0, 0.0, 0.0, 20.0, -30.0, 60.0]  # N m


def point_under(robot: Robot) -> OperatingPoint:
    return OperatingPoint(robot, PLACE, TURN, inverse(robot, PLACE, TURN).cables)


def test_a_force_is_the_weight_of_a_payload_at_the_origin():
    """Of equal robots but for the mass, which statics sees through its weight only."""
    pulled, loaded = ROBOT.with_wrench([0, 0, -12.0 * GRAVITY, 0, 0, 0]), ROBOT.with_load(12.0)
    one, other = (inverse(robot, PLACE, TURN) for robot in (pulled, loaded))
    np.testing.assert_allclose(one.tensions, other.tensions, rtol=1e-10)
    np.testing.assert_allclose(one.lengths, other.lengths, rtol=1e-12)
    start = PLACE + 0.01
    poses = [forward(robot, other.lengths, start, TURN) for robot in (pulled, loaded)]
    np.testing.assert_allclose(poses[0].position, poses[1].position, atol=1e-10)  # m
    assert np.linalg.norm(forward(ROBOT, other.lengths, start, TURN).position - PLACE) > 1e-4  # twin: without the force


def test_a_moment_is_that_of_a_payload_beside_the_origin():
    """At a pose that is held: a mass at a point of the platform pulls at the origin and turns by arm x weight."""
    mass, beside = 6.0, np.array([0.3, -0.2, 0.25])
    weight = np.array([0.0, 0.0, -mass * GRAVITY])
    turning = np.cross(TURN @ beside, weight)
    loaded = replace(ROBOT, platform=ROBOT.platform.with_masses_at(np.array([mass]), beside[None]))
    one = inverse(ROBOT.with_wrench([*weight, *turning]), PLACE, TURN)
    np.testing.assert_allclose(one.tensions, inverse(loaded, PLACE, TURN).tensions, rtol=1e-9)
    centred = inverse(ROBOT.with_wrench([*weight, 0, 0, 0]), PLACE, TURN)
    assert np.abs(one.tensions - centred.tensions).max() > 1.0  # N, twin


def test_wind_pushes_the_platform_by_its_drag():
    """10 m/s of standard air on one square metre: 61.25 N; twice the speed, four times the force."""

    def blown(*wind: float) -> Robot:
        return replace(ROBOT, extensions=Extensions.of(8, {"drag_area": 1.0, "wind": wind}))

    np.testing.assert_allclose(blown(6.0, 0.0, -8.0).extensions.wrench, [36.75, 0, -49.0, 0, 0, 0], rtol=1e-14)
    tensions = inverse(blown(12.0, 0.0, -16.0), PLACE, TURN).tensions
    pushed = inverse(ROBOT.with_wrench([4 * 36.75, 0, 4 * -49.0, 0, 0, 0]), PLACE, TURN).tensions
    np.testing.assert_allclose(tensions, pushed, rtol=1e-12)
    assert np.abs(tensions - inverse(blown(6.0, 0.0, -8.0), PLACE, TURN).tensions).max() > 1.0  # N, twin


def test_two_wrenches_are_their_sum():
    twice = ROBOT.with_wrench([1, 2, 3, 4, 5, 6]).with_wrench([10, 0, 0, 0, 0, -6])
    np.testing.assert_array_equal([*twice.extensions.force, *twice.extensions.moment], [11, 2, 3, 4, 5, 0])


def test_vibration_takes_the_symmetric_part_of_the_stiffness_under_a_moment():
    point = point_under(ROBOT.with_wrench(TWISTING))
    whole = static_stiffness(point.robot, PLACE, TURN, point.cables)
    np.testing.assert_allclose(platform_static_stiffness(point), whole.symmetric, rtol=1e-9, atol=1e-4)
    assert np.abs(whole.matrix - whole.matrix.T).max() == pytest.approx(60.0, rel=1e-6)  # N m: twice half of it


def soft(moment: float) -> OperatingPoint:
    """Cables a hundred times softer, so that a moment of some size matters, at the home pose."""
    cables = tuple(replace(cable, axial_stiffness=0.01 * cable.axial_stiffness) for cable in ROBOT.cables)
    robot, place = replace(ROBOT, cables=cables).with_wrench([0, 0, 0, 0, 0, moment]), ROBOT.home.position
    return OperatingPoint(robot, place, np.eye(3), inverse(robot, place, np.eye(3)).cables)


def squares_by_differences(point: OperatingPoint) -> np.ndarray:
    """(2, 6) squared frequencies [rad^2/s^2] from the derivative of the wrench, whole and its symmetric part."""
    arrays, place = RobotArrays.of(point.robot), point.position

    def wrench(twist: np.ndarray) -> np.ndarray:
        arms = PlatformArms.at(arrays, place + twist[:3], rotation_from_vector(twist[3:]))
        cables = cable_wrench(cable_model("sagging").states(arrays, arms.points, point.cables.length), arms)
        weight = np.array([0.0, 0.0, -arrays.mass * GRAVITY])
        return cables + np.concatenate([weight, np.cross(arms.center, weight)])

    step, mass = 1e-5, platform_mass_matrix(point.robot, np.eye(3))
    whole = -np.stack([(wrench(step * e) - wrench(-step * e)) / (2.0 * step) for e in np.eye(6)], axis=-1)
    return np.stack([np.linalg.eigvals(np.linalg.solve(mass, k)) for k in (whole, 0.5 * (whole + whole.T))])


def test_what_vibration_leaves_out_of_a_moment_is_said_where_it_matters():
    """Against the derivative of the wrench by differences, in which the constant moment has no part."""
    point = soft(60.0)
    true, taken = np.sqrt(np.sort(squares_by_differences(point).real))
    change = np.abs(true / taken - 1.0).max()  # measured: 1.05 %
    assert frequency_change(point) == pytest.approx(change, rel=1e-4)
    assert f"a frequency of the platform would change by {100 * change:.2g} %" in moment_sentence(point)
    assert moment_sentence(point_under(ROBOT.with_wrench(TWISTING))) is None  # 2e-6
    assert moment_sentence(soft(0.0)) is None


def test_guides_leave_their_freedoms_out_of_what_is_said_of_a_moment():
    """About one axis alone nothing is coupled."""
    point = soft(60.0)
    guided = replace(point, robot=replace(point.robot, guided=("x", "y", "z", "rx", "ry")))
    assert frequency_change(guided) == pytest.approx(0.0, abs=1e-12)


def test_a_moment_that_makes_a_vibration_grow_is_found():
    point = soft(300.0)
    assert np.abs(squares_by_differences(point)[0].imag).max() > 1e-2
    assert "would grow without damping (flutter)" in moment_sentence(point)


@pytest.mark.parametrize("alpha", [1.2e-5, -1.2e-5])
def test_warm_cables_are_longer_ones(alpha):
    cables = tuple(replace(cable, thermal_expansion=alpha) for cable in ROBOT.cables)
    warm = replace(ROBOT, cables=cables).at_temperature(30.0)
    lengths = inverse(ROBOT, PLACE, TURN).lengths
    found = forward(warm, lengths, PLACE, TURN)
    longer = forward(ROBOT, lengths * (1.0 + 30.0 * alpha), PLACE, TURN)
    np.testing.assert_allclose(found.position, longer.position, atol=1e-12)
    assert np.linalg.norm(found.position - PLACE) > 1e-3  # m
    np.testing.assert_allclose(inverse(warm, PLACE, TURN).lengths * (1.0 + 30.0 * alpha), lengths, rtol=1e-12)


def test_expansion_and_loads_are_in_the_robot_file(tmp_path):
    cables = tuple(replace(cable, thermal_expansion=-1.2e-5) for cable in ROBOT.cables)
    path = tmp_path / "warm.toml"
    path.write_text(robot_toml(replace(ROBOT, cables=cables).at_temperature(7.0).with_wrench(TWISTING), "warm"))
    read = load_robot(path)
    assert read.cables[3].thermal_expansion == -1.2e-5
    assert read.extensions.temperature_change == 7.0
    assert read.extensions.moment.tolist() == TWISTING[3:]


COMMANDS = {
    "inverse": {"pose": [0.5, 0.2, 0.8]},
    "modes": {"count": 3},
    "forward": {"lengths": [10.78, 10.38, 10.78, 10.38, 10.24, 10.64, 10.24, 10.64]},
    "map": {"grid": "0,0:1:2,0.5", "quantity": "tension-max"},
    "pose_error": {"grid": "0,0:1:2,0.5"},
    "audit": {},
    "frf": {"excite": "fz", "respond": "z", "band": "1:2:0.5"},
    "transient": {"initial_velocity": "0.1,0,0", "duration": 1.0, "highest": 20.0},
    "distribute": {"trajectory": "line:0,0,0.5:0.5,0,0.5:2", "instants": 3},
}


def plain(answer: dict) -> str:
    return repr({key: value.tolist() if hasattr(value, "tolist") else value for key, value in answer.items()})


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_takes_a_wrench_and_a_temperature(name):
    """As options they do what the robot file does, and they do something."""
    wrench, command, given = [20.0, -10.0, -50.0, 3.0, -2.0, 4.0], getattr(cs, name), COMMANDS[name]
    robot = load_robot("thesis-3-1")
    asked = command(robot, **given, wrench=wrench, temperature=25.0).answer
    assert asked["wrench"] == wrench
    assert asked["extensions"]["acting"][:2] == ["force", "moment"]
    entered = command(robot.with_wrench(wrench).at_temperature(25.0), **given).answer
    assert plain(asked) == plain(entered)
    bare = command(robot, **given).answer
    assert plain({**bare, "extensions": 0}) != plain({**asked, "extensions": 0, "wrench": 0})
    assert "wrench" not in bare


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"wrench": [1.0, 2.0]}, "wrench: got [1.0, 2.0]; give 6 numbers in N and N m"),
        ({"wrench": "1,2,3,4,5,x"}, "give 6 comma-separated numbers in N and N m"),
        ({"temperature": 400.0}, "temperature: got 400.0; give a difference in K from -300 to 300"),
        ({"temperature": float("nan")}, "give a difference in K from -300 to 300"),
    ],
)
def test_an_unusable_load_is_refused_in_one_sentence(given, said):
    with pytest.raises(InputError, match=f"^{next(iter(given))}: got") as refused:
        cs.modes("thesis-3-1", **given)
    assert said in str(refused.value)
