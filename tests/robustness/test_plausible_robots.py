"""Numbers of a robot in a wrong unit are a warning of every answer, and no robot of an ordinary kind has one."""

import json
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.plausibility import implausible
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import builtin_names, load_robot
from tests.random_robots import random_robot
from tests.symmetric_robots import symmetric_robots

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("**/robot.toml"))


def scaled(robot: Robot, size: float) -> Robot:
    """A robot of the same shape whose anchors are `size` times as far apart."""
    frame, inner = size * robot.frame_anchors, size * robot.platform_anchors
    pulleys = tuple(None if one is None else replace(one, radius=size * one.radius) for one in robot.pulleys)
    return replace(robot, frame_anchors=frame, platform_anchors=inner, pulleys=pulleys, home=None)


def in_mm(robot: Robot, inertia: float = 1.0) -> Robot:
    """A robot whose lengths, and inertia times a factor, are entered in mm."""
    body = replace(
        robot.platform,
        center_of_mass=1e3 * robot.platform.center_of_mass,
        inertia=inertia * robot.platform.inertia,
    )
    home = None if robot.home is None else Pose(1e3 * robot.home.position, robot.home.angles)
    return replace(scaled(robot, 1e3), platform=body, home=home)


def moved(robot: Robot, name: str, cable: int) -> Robot:
    """One anchor is in mm."""
    anchors = getattr(robot, name).copy()
    anchors[cable] *= 1000.0
    return replace(robot, **{name: anchors})


def on_cables(robot: Robot, **factors: float) -> Robot:
    """Cables with some of their numbers times a factor."""
    return replace(
        robot,
        cables=tuple(replace(c, **{n: f * getattr(c, n) for n, f in factors.items()}) for c in robot.cables),
    )


def test_no_ordinary_robot_is_doubted():
    rng = np.random.default_rng(11)
    robots = [load_robot(name) for name in [*builtin_names(), *EXAMPLES]]
    robots += [*symmetric_robots(), *(random_robot(rng) for _ in range(200))]
    for robot in [*robots, *(scaled(one, size) for one in robots[:8] for size in (1e-3, 30.0))]:
        assert implausible(robot) == (), robot.name


@pytest.mark.parametrize("name", ["cogiro", "six-cable-8mm", "thesis-5"])
@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda r: moved(r, "frame_anchors", 0), ["cables[1].frame_anchor", "as far out as all others", "in mm?"]),
        (lambda r: moved(r, "platform_anchors", 2), ["cables[3].platform_anchor", "in mm?"]),
        (lambda r: replace(r, pulleys=(Pulley(50.0),) * len(r.cables)), ["pulley.radius = 50 m", "in mm?"]),
        (lambda r: on_cables(r, axial_stiffness=1e-3), ["axial_stiffness", "stretch it by", "in kN?"]),
        (lambda r: on_cables(r, linear_density=1e3), ["linear_density", "in g/m"]),
        (lambda r: on_cables(r, axial_stiffness=1e6), ["axial_stiffness", "Young's modulus"]),
    ],
    ids=["exit in mm", "anchor in mm", "radius in mm", "EA in kN", "g/m", "E for EA"],
)
def test_a_wrong_unit_is_told_with_its_key(name, wrong, words):
    (said,) = implausible(wrong(load_robot(name)))
    assert all(word in said for word in words), said


@pytest.mark.parametrize("inertia", [1.0, 1e6], ids=["kg m^2", "kg mm^2"])
@pytest.mark.parametrize("name", [*builtin_names(), *EXAMPLES], ids=lambda path: Path(path).parts[-2:][0])
def test_a_robot_wholly_in_mm_is_told(name, inertia):
    """Three light ones on thin cables from a point keep proportions of a large robot where inertia is in mm, too."""
    (said, *_) = implausible(in_mm(load_robot(name), inertia)) or ("",)
    light = {"force-controlled-winch", "load-on-one-rope", "two-rope-plotter"}
    assert ("in mm?" in said) or (inertia > 1.0 and Path(name).parent.name in light)


@pytest.mark.parametrize("name", ["cogiro", "six-cable-8mm", "thesis-5"])
def test_a_home_pose_in_mm_is_told_alone(name):
    robot = load_robot(name)
    home = Pose(np.array([1200.0, -800.0, 1500.0]), robot.home.angles)
    (said,) = implausible(replace(robot, home=home))
    assert said.startswith("home_pose = [1200, -800, 1500] m lies")


def test_a_lift_far_below_its_frame_is_no_mistake():
    """A cage at 0 on ropes 14 cm apart, 100 m up."""
    lift = load_robot(next(path for path in EXAMPLES if path.parent.name == "lift"))
    assert implausible(lift) == ()
    assert implausible(replace(lift, home=Pose(np.array([0.0, 0.0, -1e4]), np.zeros(3))))


def test_softer_ropes_than_the_program_knows_are_not_doubted():
    """Polyamide: EA over mass per metre is about 1e6 N m/kg, a fourth of that of cogiro's steel."""
    assert implausible(on_cables(load_robot("cogiro"), axial_stiffness=0.25)) == ()


@pytest.fixture
def wrong_file(tmp_path):
    """A built-in robot with a text replaced in its file."""

    def made(old: str, new: str) -> str:
        text = files("cdpr_struct.robot.builtin").joinpath("thesis-3-1.toml").read_text("utf-8")
        assert old in text
        (tmp_path / "wrong.toml").write_text(text.replace(old, new, 1))
        return str(tmp_path / "wrong.toml")

    return made


@pytest.mark.parametrize(
    "words",
    [["inverse"], ["modes", "--count=1"], ["map", "--quantity=tension-max", "--grid=0:1:2,0:1:2,0.5:0.6:2"]],
    ids=["inverse", "modes", "map"],
)
def test_every_answer_says_it_on_the_screen_and_in_json(words, wrong_file, capsys):
    stiffness = f"axial_stiffness = {load_robot('thesis-3-1').cables[0].axial_stiffness:.1f}"
    path = wrong_file(stiffness, "axial_stiffness = 250.0")
    command, *rest = words
    assert run([command, path, *rest, "--json"]) == 0
    said = json.loads(capsys.readouterr().out)["warnings"]
    assert "(is it in kN?)" in said[0]
    assert run([command, path, *rest]) == 0
    assert f"Warning: {said[0]}" in capsys.readouterr().out


def test_what_physics_refuses_for_a_wrong_anchor_names_the_anchor(wrong_file, capsys):
    x, y, z = load_robot("thesis-3-1").frame_anchors[0]
    path = wrong_file(f"frame_anchor = [{x}, {y}, {z}]", f"frame_anchor = [{1000 * x}, {1000 * y}, {1000 * z}]")
    assert run(["modes", path]) == 1
    line = capsys.readouterr().err
    assert all(word in line for word in ["cdpr-struct: ", "cables[1].frame_anchor", "is it in mm?"]), line
