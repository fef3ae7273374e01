"""Winches that wind several cables: laws of what they say, of the rest they lead to, files, and refusals."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.errors import CdprError, InputError, UnholdablePoseError
from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.cable import Cable, Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.fingerprint import fingerprint
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot, robot_of_text
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.home_lengths import with_home_lengths
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.shared_winches import wound_rest

ROBOT = "examples/robots/paired-ropes/robot.toml"
PLACE = np.array([1.0, 0.5, 1.5])
ALL, NONE = (True,) * 3, (False,) * 3


def paired(stiffness: float = 2e5, pulleys: bool = False, **extensions: float) -> Robot:
    robot = load_robot(ROBOT)
    cables = tuple(replace(cable, axial_stiffness=stiffness) for cable in robot.cables)
    more = Extensions.of(6, extensions)
    return replace(robot, cables=cables, extensions=more, pulleys=(Pulley(0.05),) * 6 if pulleys else ())


def doubled() -> Robot:
    """Eight winches of two parallel cables each in place of the eight cables of `thesis-3-1`."""
    robot = load_robot("thesis-3-1")
    away = robot.frame_anchors - robot.platform_anchors - robot.home.position
    aside = 0.05 * np.cross(away, [0.0, 0.0, 1.0])
    aside /= np.linalg.norm(aside, axis=1, keepdims=True) / 0.05
    anchors = [
        np.stack([a - aside, a + aside], axis=1).reshape(-1, 3) for a in (robot.platform_anchors, robot.frame_anchors)
    ]
    cables = tuple(replace(cable, winch=f"w{i // 2}") for i, cable in enumerate(np.repeat(robot.cables, 2)))
    return with_home_lengths(
        Robot("doubled", robot.platform, cables, *anchors, home=robot.home, extensions=Extensions.of(16))
    )


@pytest.mark.parametrize("name", ["thesis-3-1", "examples/robots/planar-four-cables/robot.toml"])
def test_a_winch_for_each_cable_leaves_the_tensions_of_least_norm(name):
    """The general search then has the unknowns of `inverse`: the same optimum by another way, beside a guide, too."""
    robot = load_robot(name).with_force_limits(50.0)
    angles = np.array([[0.02, -0.03, 0.05], [0.0, 0.0, 0.0]]) * (0.0 if robot.guided else 1.0)
    place = robot.home.position + np.array([[0.3, 0.0, 0.1], [0.4, 0.0, -0.2]])
    held = inverse(robot, place, rotation_from_angles(*angles.T))
    found = wound_rest(robot, place, angles, NONE)
    assert found.hung.found.all()
    np.testing.assert_allclose(found.hung.cables.tension_at_platform, held.tensions, atol=2e-4)  # N; measured 2e-5
    np.testing.assert_allclose(found.said, held.lengths, atol=1e-8)


@pytest.mark.parametrize("model", ["sagging", "spring"])
@pytest.mark.parametrize(
    "robot",
    [paired(), paired(pulleys=True), paired(frame_compliance=1e-5), paired(series_compliance=1e-5, length_scale=1.01)],
    ids=["plain", "pulleys", "masts", "in line"],
)
def test_forward_rests_where_the_winches_were_to_bring_the_platform(robot, model):
    robot = with_home_lengths(robot).with_load(payload=5.0)
    found = wound_rest(robot, PLACE[None], np.zeros(3), ALL, model)
    assert found.hung.found.all()
    home = np.array([cable.home_length for cable in robot.cables])
    lengths = home + np.repeat(found.said[0] - home[::2], 2)  # equal changes since home
    rest = forward(robot, lengths, robot.home.position, robot.home.rotation, model)
    np.testing.assert_allclose(rest.position, PLACE, atol=1e-9)
    np.testing.assert_allclose(rest.rotation, found.hung.rotation[0], atol=1e-9)


def test_parallel_ropes_keep_the_platform_level_but_for_their_stretch():
    """A parallelogram: with inextensible weightless ropes there is no tilt, so it falls with 1/EA."""
    tilts = []
    for stiffness in (1e6, 1e7):
        robot = with_home_lengths(paired(stiffness))
        found = wound_rest(robot, PLACE[None], np.zeros(3), ALL, "spring")
        tilts.append(np.linalg.norm(found.hung.angles))
        middles = (robot.frame_anchors - robot.platform_anchors)[::2]
        chord = np.linalg.norm(middles - PLACE, axis=1)
        assert np.abs(found.said[0] / chord - 1.0).max() < 2.0 * 130.0 / stiffness  # of the largest tension, 127 N
    assert tilts[0] > 1e-4
    # the home lengths are those of sagging cables, which adds a tilt of sag that does not fall: below 1e-5 rad
    assert tilts[0] / tilts[1] == pytest.approx(10.0, rel=0.1)


def test_the_home_lengths_hold_the_home_pose_whatever_is_loaded_later():
    empty, loaded = cs.inverse(ROBOT), cs.inverse(ROBOT, free="rx,ry,rz", payload=30.0)
    assert all(abs(winch["paid_out_since_home_m"]) < 1e-9 for winch in empty.answer["winches"])
    taken_in = [winch["paid_out_since_home_m"] for winch in loaded.answer["winches"]]
    # dL = -L dT / EA of ropes with dT = 30 g / (6 sin(inclination)), 5 % of it as sag that is pulled out
    stretch = 6.32 * 30.0 * 9.81 / (6.0 * 4.0 / 6.325) / 2e5
    np.testing.assert_allclose(taken_in, -stretch, rtol=0.08)


def test_tensions_are_of_least_norm_where_there_are_more_winches_than_coordinates():
    """No change of the winches that keeps the pose reduces |T|^2 to first order; all lengths are equal changes."""
    robot, place, angles = doubled(), np.array([[0.5, -0.8, 0.6]]), np.array([0.02, 0.01, -0.03])
    found = wound_rest(robot, place, angles, NONE)
    assert found.hung.found.all()
    turn, said = found.hung.rotation[0], found.said[0]

    def rest(change: np.ndarray):
        return forward(robot, robot.winches.lengths(said + change), place[0], turn)

    step, here = 1e-6, rest(np.zeros(8))
    sides = [(rest(step * way), rest(-step * way)) for way in np.eye(8)]
    turned = [a.rotation @ b.rotation.T for a, b in sides]
    reach = [[*(a.position - b.position), t[2, 1], t[0, 2], t[1, 0]] for (a, b), t in zip(sides, turned, strict=True)]
    pulls = np.array([(a.tensions - b.tensions) / (2.0 * step) for a, b in sides]).T
    idle = np.linalg.svd(np.array(reach).T)[2][6:].T  # of the winches, that leave the pose alone
    slope = here.tensions @ pulls @ idle
    assert np.abs(slope).max() < 1e-5 * np.abs(here.tensions @ pulls).max()  # measured 2e-7


def test_bounds_of_tension_hold_where_there_is_a_choice():
    robot = doubled().with_force_limits(93.0)
    found = wound_rest(robot, np.array([[0.5, -0.8, 0.6]]), np.zeros(3), NONE)
    pull = found.hung.cables.tension_at_platform
    assert found.hung.found.all()
    assert pull.min() == pytest.approx(93.0, abs=1e-3)  # 91.7 N without the bound, 94.0 N is the most there can be


def test_a_guide_leaves_fewer_coordinates_to_the_winches():
    """A load that does not turn, in a vertical plane on two ropes that share a winch, and a third: two winches do."""
    anchors = np.array([[-3.0, 0.1, 4.0], [-3.0, -0.1, 4.0], [3.0, 0.0, 4.0]])
    cables = (Cable(1e5, 0.02, winch="left"), Cable(1e5, 0.02, winch="left"), Cable(1e5, 0.02))
    body = Platform(20.0, np.zeros(3), np.eye(3))
    guided, home = ("y", "rx", "ry", "rz"), Pose(np.zeros(3), np.zeros(3))
    robot = Robot("plane", body, cables, np.zeros((3, 3)), anchors, home=home, guided=guided)
    told = cs.inverse(robot, [0.5, 0.0, 0.5]).answer
    assert told["tensions_N"][0] == pytest.approx(told["tensions_N"][1], rel=1e-9)
    back = cs.forward(robot, [winch["length_m"] for winch in told["winches"]]).answer
    np.testing.assert_allclose(back["pose"][:3], [0.5, 0.0, 0.5], atol=1e-9)


def test_two_cables_wound_against_each_other_keep_their_tension():
    """A slide on a rail, two ropes on one drum: d1 / L1 = d2 / L2, L1 + L2 constant, so T = EA (D / L - 1) anywhere."""
    anchors, guided = np.array([[-2.0, 0.0, 0.0], [3.0, 0.0, 0.0]]), ("y", "z", "rx", "ry", "rz")
    one = Cable(1e5, 0.02, force_min=200.0, winch="drum")
    robot = Robot(
        "slide", Platform(5.0, np.zeros(3), np.eye(3)), (one, replace(one, winch_ratio=-1.0)), np.zeros((2, 3)),
        anchors, gravity=0.0, home=Pose(np.zeros(3), np.zeros(3)), guided=guided,
    )  # fmt: skip
    for x in (0.0, 1.2, -0.7):
        told = cs.inverse(robot, [x, 0.0, 0.0]).answer
        np.testing.assert_allclose(told["tensions_N"], 200.0, rtol=1e-6)
        np.testing.assert_allclose(told["lengths_m"], np.array([2.0 + x, 3.0 - x]) / (1.0 + 200.0 / 1e5), rtol=1e-9)
    back = cs.forward(robot, [told["winches"][0]["length_m"]]).answer
    assert back["pose"][0] == pytest.approx(-0.7, abs=1e-9)
    with pytest.raises(UnholdablePoseError, match="no lengths of its winches"):
        cs.inverse(robot, [4.0, 0.0, 0.0])  # beyond the end of the rail
    with pytest.raises(InputError, match="cable 2 would have -"):
        cs.forward(robot, [5.1])


def test_a_whole_pose_is_refused_with_the_angles_at_which_the_platform_rests():
    with pytest.raises(UnholdablePoseError, match=r"3 winches do not set") as refused:
        cs.inverse(ROBOT, PLACE.tolist())
    said = str(refused.value).split("turned by (")[1].split(")")[0]
    told = cs.inverse(ROBOT, [*PLACE.tolist(), *map(float, said.split(","))]).answer
    assert told["stable"]
    free = cs.inverse(ROBOT, PLACE.tolist(), free="rx").answer
    assert free["free"]["added"] == ["ry", "rz"]
    np.testing.assert_allclose(free["free"]["orientation_deg"], told["pose"][3:], atol=1e-6)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"pose": [-2.0, 2.0, 1.5], "free": "rx,ry,rz"}, "no lengths of its winches"),
        ({"pose": PLACE.tolist(), "free": "rx,ry,rz", "lower_bound": 80.0}, "cable 4: .* below its force_min of 80 N"),
        ({"pose": PLACE.tolist(), "free": "rx,ry,rz", "upper_bound": 110.0}, "cable 5: .* above its force_max of 110"),
        ({"pose": PLACE.tolist(), "free": "rx,ry,rz", "model": "ideal"}, "inextensible"),
        ({"orient": "even"}, "cables\\[1\\].winch"),
    ],
)
def test_what_the_winches_cannot_do_is_said(options, said):
    with pytest.raises(CdprError, match=said):
        cs.inverse(ROBOT, **options)


def test_too_few_winches_cannot_place_a_platform():
    robot = load_robot(ROBOT)
    cables = tuple(replace(cable, winch="one" if i < 4 else "two") for i, cable in enumerate(robot.cables))
    with pytest.raises(CdprError, match="2 winches cannot place this platform; at least 3"):
        cs.inverse(replace(robot, cables=cables), PLACE.tolist())


def test_lengths_are_given_for_winches_or_for_cables_that_fit():
    one = cs.forward(ROBOT, [6.2, 7.2, 6.3]).answer
    all_ = cs.forward(ROBOT, [6.2, 6.2, 7.2, 7.20001, 6.3, 6.3]).answer  # rounding of written lengths
    np.testing.assert_allclose(one["pose"], all_["pose"], atol=1e-3)
    assert len(set(all_["lengths_m"])) == 3
    assert one["locked"]["other_equilibria"]
    with pytest.raises(InputError, match=r"on winch west .* those of cables 3 and 4 differ by 1 mm"):
        cs.forward(ROBOT, [6.2, 6.2, 7.2, 7.201, 6.3, 6.3])
    with pytest.raises(InputError, match=r"give 3 or 6 .* per winch or cable"):
        cs.forward(ROBOT, [6.2, 6.2])


def test_commands_at_one_pose_take_such_a_robot():
    exact = cs.modes(ROBOT, PLACE.tolist(), free="rx,ry,rz", count=3)
    locked = cs.modes(ROBOT, lengths=[w["length_m"] for w in exact.answer["winches"]], count=3)
    np.testing.assert_allclose(exact.modes.hertz, locked.modes.hertz, rtol=1e-7)
    mapped = cs.map(ROBOT, grid="1,0.5:0.6:2,1.5", quantity="first-frequency", free="rx,ry,rz").columns()
    assert min(np.abs(np.asarray(v, dtype=float) - exact.modes.hertz[0]).min() for v in mapped.values()) < 1e-6
    assert cs.audit(ROBOT, grid="1,0.5:0.6:2,1.5", free="rx,ry,rz").answer
    there = {"pose": PLACE.tolist(), "free": "rx,ry,rz"}
    for told in (
        cs.frf(ROBOT, excite="fz", respond="z", band="1:2:0.5", **there),
        cs.transient(ROBOT, initial_velocity="0.1,0,0", duration=0.2, **there),
    ):
        assert [w["length_m"] for w in told.answer["winches"]] == [w["length_m"] for w in exact.answer["winches"]]
    assert any("left free" in said for said in cs.export(ROBOT, to="moordyn", **there).warnings)


def test_a_trajectory_leaves_no_angles_free():
    with pytest.raises(InputError, match="free: got 'rx'; leave it out"):
        cs.transient("cogiro", trajectory="helix", free="rx")


@pytest.mark.parametrize(
    ("command", "options", "field"),
    [
        ("distribute", {"trajectory": "helix"}, r"cables\[1\]\.winch"),
        ("pose_error", {"grid": "0:1:2,0,0.5"}, r"cables\[1\]\.winch"),
        ("map", {"grid": "0:1:2,0,0.5", "quantity": "pose-error", "free": "rx"}, r"cables\[1\]\.winch"),
        ("map", {"grid": "0:1:2,0,0.5", "quantity": "slack-margin", "free": "rx", "wrenches": "fx=-1:1"}, "winch"),
        ("map", {"grid": "0:1:2,0,0.5", "quantity": "first-frequency"}, "free"),
        ("audit", {"grid": "0:1:2,0,0.5"}, "free"),
        ("transient", {"trajectory": "helix"}, r"cables\[1\]\.winch"),
    ],
)
def test_commands_that_know_a_winch_for_each_cable_say_so(command, options, field):
    with pytest.raises(InputError, match=field):
        getattr(cs, command)(ROBOT, **options)


def test_a_robot_file_keeps_winches_and_home_lengths():
    robot = with_home_lengths(load_robot(ROBOT))
    robot = replace(robot, cables=(replace(robot.cables[0], winch_ratio=-2.0), *robot.cables[1:]))
    again = robot_of_text(robot_toml(robot, "again"), "again.toml")
    assert again.cables == robot.cables
    assert with_home_lengths(again) is again


def test_the_fingerprint_of_results_knows_the_winches():
    robot = with_home_lengths(load_robot(ROBOT))
    own = replace(robot, cables=tuple(replace(cable, winch="", home_length=0.0) for cable in robot.cables))
    longer = replace(robot.cables[0], home_length=6.4)
    names = {fingerprint("map", r) for r in (robot, own, replace(robot, cables=(longer, *robot.cables[1:])))}
    assert len(names) == 3


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('winch = "north"', 'winch = "north"\nhome_length = 6.3', "home_length for all"),
        ('winch = "north"', 'winch = "north"\nwinch_tension = 100.0', "holds a tension winds one cable"),
        ('winch = "north"', "home_length = 6.3", "belongs to `winch`"),
        ('winch = "north"', "winch_ratio = 2.0", "belongs to `winch`"),
        ('winch = "north"', 'winch = "north"\nwinch_ratio = 0.0', "winch_ratio: got 0.0; a ratio from"),
        ('winch = "north"', "winch = 3", "winch"),
        ('winch = "north"', 'winch = "two\\nlines"', "printable"),
        ('winch = "north"', 'winch = "north"\nhome_length = -1.0', "home_length"),
    ],
)
def test_a_robot_file_that_contradicts_itself_is_refused(old, new, said):
    text = Path(ROBOT).read_text("utf-8")
    with pytest.raises(InputError, match=said):
        robot_of_text(text.replace(old, new, 1), "robot.toml")


def test_home_lengths_need_a_home_pose_that_is_held():
    robot = load_robot(ROBOT)
    with pytest.raises(CdprError, match="give home_pose, or home_length"):
        cs.inverse(replace(robot, home=None), PLACE.tolist(), free="rx,ry,rz")
    with pytest.raises(CdprError, match=r"home pose: .* give each its home_length"):
        cs.inverse(replace(robot, home=Pose(np.array([5.0, 5.0, 2.0]), np.zeros(3))), PLACE.tolist())
