"""Wind on cables: drag per metre by first principles, each cable in a plane of its own, and alike in every command."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import cdpr_struct as cs
from cdpr_struct.dynamics.condensed_pose import knows
from cdpr_struct.errors import InputError
from cdpr_struct.live.controls import Controls
from cdpr_struct.live.view_state import view_state
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.robot.extensions import Extensions, drag_across
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot, robot_of_text
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, load_wrench, rotation_from_vector
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.static_stiffness import static_stiffness

WIND, WIDTH = [12.0, -7.0, 2.0], 0.012  # m/s, m
TURN = Rotation.from_rotvec([0.03, -0.02, 0.05]).as_matrix()


def blown(name: str, width: float | list[float] = WIDTH, wind: list[float] = WIND) -> Robot:
    robot = load_robot(name)
    return replace(robot, extensions=Extensions.of(len(robot.cables), {"drag_width": width, "wind": wind}))


def off_home(robot: Robot) -> np.ndarray:
    return robot.home.position + np.array([0.3, -0.2, 0.1])


def test_wind_presses_across_a_cable_only():
    """10 m/s of standard air on 12 mm: 0.735 N/m square to it, a quarter of that at 30 degrees, nothing along it."""
    wind, square = np.array([10.0, 0.0, 0.0]), 0.5 * 1.225 * 0.012 * 100.0
    chords = np.array([[0.0, 0.0, 7.0], [np.cos(np.pi / 6), np.sin(np.pi / 6), 0.0], [3.0, 0.0, 0.0]])
    pushed = drag_across(wind, chords, np.array(0.012), np.array(1.225))
    expected = [[square, 0, 0], square / 4.0 * np.array([0.5, -np.sqrt(0.75), 0.0]), [0, 0, 0]]
    np.testing.assert_allclose(pushed, expected, atol=1e-15)


def test_ends_of_a_cable_carry_its_weight_and_drag():
    """And across the wind each cable leaves the vertical plane, to the lee."""
    robot = blown("cogiro")
    place = off_home(robot)
    cables = inverse(robot, place, TURN).cables
    pushed = drag_across(np.array(WIND), cables.offset, np.array(WIDTH), np.array(1.225))
    load = robot.linear_density[:, None] * np.array([0.0, 0.0, -9.81]) + pushed
    held = cables.force_at_frame + cables.force_on_platform  # by the cable, on both its ends
    np.testing.assert_allclose(held, load * cables.length[:, None], atol=1e-9)  # N of some 10
    lean = cables.up - np.array([0.0, 0.0, 1.0])
    assert (np.einsum("mi,mi->m", lean, pushed) < 0.0).all()
    assert np.linalg.norm(lean, axis=1).max() > 0.5


def test_statics_in_wind_turns_with_the_world():
    """Wind, gravity and frame turned together: no axis of the world is special."""
    robot, turn = blown("thesis-3-1"), Rotation.from_rotvec([0.7, -1.1, 0.4]).as_matrix()
    more = robot.extensions.with_changes(wind=turn @ robot.extensions.wind)
    gravity = turn @ robot.gravity_vector
    other = replace(robot, frame_anchors=robot.frame_anchors @ turn.T, gravity=gravity, extensions=more)
    place = off_home(robot)
    ours, theirs = inverse(robot, place, TURN), inverse(other, turn @ place, turn @ TURN)
    np.testing.assert_allclose(theirs.tensions, ours.tensions, rtol=1e-9)
    np.testing.assert_allclose(theirs.lengths, ours.lengths, rtol=1e-11)
    rests = [
        forward(r, ours.lengths + 0.01, p, t) for r, p, t in ((robot, place, TURN), (other, turn @ place, turn @ TURN))
    ]
    np.testing.assert_allclose(rests[1].position, turn @ rests[0].position, atol=1e-9)


def test_poses_in_one_batch_have_their_own_drag():
    robot = blown("thesis-3-1", list(np.linspace(0.0, 0.02, 8)))
    places = off_home(robot) + np.array([[0.0, 0.0, 0.0], [0.7, -0.5, 0.3], [-0.4, 0.9, -0.2]])
    together = inverse(robot, places, TURN)
    for i, place in enumerate(places):
        np.testing.assert_allclose(together.tensions[i], inverse(robot, place, TURN).tensions, rtol=1e-9)
    there = forward(robot, together.lengths, places + 0.01, TURN)
    np.testing.assert_allclose(there.position, places, atol=1e-10)  # m


@pytest.mark.parametrize("name", ["cogiro", "six-cable-8mm"])
def test_stiffness_is_the_derivative_of_the_wrench_at_constant_drag(name, monkeypatch):
    """Drag turned with the chord changes it by less than 1e-3 of its largest entry, as docs/statics.md says."""
    robot = blown(name)
    place = off_home(robot)
    arrays, held = RobotArrays.of(robot), inverse(robot, place, np.eye(3))
    matrix = static_stiffness(robot, place, np.eye(3), held.cables).matrix

    def differences() -> np.ndarray:
        def wrench(motion: np.ndarray) -> np.ndarray:
            arms = PlatformArms.at(arrays, place + motion[:3], rotation_from_vector(motion[3:]))
            states = cable_model("sagging").states(arrays, arms.points, arrays.paid_out(held.lengths))
            return cable_wrench(states, arms) + load_wrench(arrays, arms)

        return np.array([wrench(-step) - wrench(step) for step in 1e-6 * np.eye(6)]).T / 2e-6

    size, turning = np.abs(matrix).max(), differences()
    constant = arrays.cable_load(held.cables.offset)
    monkeypatch.setattr(RobotArrays, "cable_load", lambda *_: constant)
    np.testing.assert_allclose(matrix, differences(), atol=2e-7 * size)  # measured: 8e-8
    assert 2e-5 * size < np.abs(matrix - turning).max() < 1e-3 * size  # measured: 4e-5 and 3e-4


def test_straight_cables_have_no_drag():
    answers = [cs.inverse(robot, model="spring").answer for robot in (blown("cogiro"), load_robot("cogiro"))]
    np.testing.assert_array_equal(answers[0]["tensions_N"], answers[1]["tensions_N"])
    assert answers[0]["extensions"]["idle"] == {"drag_width": "straight cables without weight have no drag, either"}


COMMANDS = {
    "inverse": {"pose": [0.5, 0.2, 0.8]},
    "modes": {"count": 3},
    "forward": {"lengths": [10.78, 10.38, 10.78, 10.38, 10.24, 10.64, 10.24, 10.64]},
    "map": {"grid": "0,0:1:2,0.5", "quantity": "frequencies"},
    "pose_error": {"grid": "0,0:1:2,0.5"},
    "frf": {"excite": "fz", "respond": "z", "band": "1:2:0.5"},
    "distribute": {"trajectory": "line:0,0,0.5:0.5,0,0.5:2", "instants": 3},
}


@pytest.mark.parametrize("name", COMMANDS)
def test_commands_that_take_it_say_so_and_answer_otherwise(name):
    command, given = getattr(cs, name), COMMANDS[name]
    told, bare = (command(robot, **given) for robot in (blown("thesis-3-1"), load_robot("thesis-3-1")))
    assert told.answer["extensions"]["acting"] == ["drag_width"]
    assert any("across its chord" in said for said in told.answer["extensions"]["sentences"])
    assert not told.frame().equals(bare.frame())


def test_tensions_in_time_balance_what_acts():
    """`distribute` at its instants is `inverse` there, with the acceleration's wrench left out by a slow line."""
    robot = blown("thesis-3-1")
    line = cs.distribute(robot, trajectory="line:0,0,0.5:0.5,0,0.5:1e4", instants=3)
    middle = line.frame().filter(regex=r"^force_\d_N").iloc[1].to_numpy(dtype=float)
    held = inverse(robot, np.array([0.25, 0.0, 0.5]), np.eye(3)).tensions
    np.testing.assert_allclose(middle, held, rtol=1e-5)


def test_maps_of_frequencies_are_those_of_modes():
    """The fast paths, of many poses and of one, know no cables that lean, and leave them to the exact model."""
    robot = blown("thesis-3-1")
    row = cs.map(robot, "0:0.2:6,1,0.5", quantity="frequencies").frame().iloc[0]
    found = cs.modes(robot, [0.0, 1.0, 0.5], count=12)
    np.testing.assert_allclose([row[f"f{i}_Hz"] for i in range(1, 13)], found.answer["frequencies_hz"], rtol=1e-7)
    assert not knows(found.point)


def test_the_live_view_shows_cables_in_wind():
    robot = blown("thesis-3-1")
    state = view_state(robot, Controls((), 0.0).at(Pose(off_home(robot), np.zeros(3))))
    held = inverse(robot, off_home(robot), np.eye(3))
    np.testing.assert_allclose(state.point.cables.tension_at_platform, held.tensions, rtol=1e-9)


def test_energies_of_other_equilibria_are_left_out():
    """Drag has no potential; JSON has null there."""
    robot = blown("cogiro")
    found = cs.forward(robot, inverse(robot, robot.home.position, np.eye(3)).lengths)
    others = found.to_json()["locked"]["other_equilibria"]
    assert others
    assert all(each["energy_J"] is None for each in others)
    assert "drag on cables has no potential" in str(found)


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("drag_width = 0.012", "drag_width needs wind = [x, y, z]"),
        ("drag_width = -0.1\nwind = [1.0, 0.0, 0.0]", "in m, not below 0"),
        ("drag_width = [0.01, 0.02]\nwind = [1.0, 0.0, 0.0]", "give 8 numbers in square brackets, or one for all"),
    ],
)
def test_an_unusable_drag_width_is_refused_by_its_name(table, said):
    text = robot_toml(load_robot("thesis-3-1"), "blown").replace("[extensions]\n", f"[extensions]\n{table}\n")
    with pytest.raises(InputError, match=r"extensions\.drag_width") as refused:
        robot_of_text(text, "blown.toml")
    assert said in str(refused.value)


def test_drag_without_gravity_is_refused():
    robot = blown("thesis-3-1")
    with pytest.raises(ValueError, match="drag_width needs gravity above 0"):
        replace(robot, gravity=0.0)


def test_commands_without_room_for_it_refuse_by_its_name(tmp_path):
    """A campaign is what `diagnose` and `plan` read, and what `new-campaign` begins."""
    path = tmp_path / "blown.toml"
    path.write_text(robot_toml(blown("thesis-3-1"), "blown"))
    for command in (cs.new_campaign, lambda robot: cs.export(robot, to="moordyn")):
        with pytest.raises(InputError, match=r"extensions\.drag_width") as refused:
            command(path)
        assert "leave it out: " in str(refused.value)
    (tmp_path / "states.csv").write_text("case,x_m,y_m,z_m,cable,tension_N\na,0,0,0.5,1,100\n")
    sheet = 'kind = "static_state"\nfile = "states.csv"\nsigma = { tension_N = 3.0, position_m = 0.001 }\n'
    (tmp_path / "campaign.toml").write_text(f'robot = "blown.toml"\nmodel = "exact"\n[[measurement]]\n{sheet}')
    with pytest.raises(InputError, match=r"drag_width.*wind on cables is not among what is diagnosed"):
        load_campaign(tmp_path / "campaign.toml")
