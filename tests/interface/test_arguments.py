"""What arguments may be, and what is said of those that cannot be used."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import cdpr_struct as cs

ROOT = Path(__file__).parents[2]
POSE = (0.5, -1.0, 0.8, 2.0, 0.0, 5.0)
LEVEL = ROOT / "examples" / "table-4-4" / "level.toml"


@pytest.mark.parametrize(
    "pose",
    [POSE, list(POSE), np.array(POSE), "0.5,-1,0.8,2,0,5", cs.Pose.from_degrees(list(POSE))],
    ids=["tuple", "list", "array", "text", "Pose"],
)
def test_a_pose_in_any_form(pose):
    lengths = cs.inverse("thesis-3-1", pose).solution.lengths
    assert lengths[0] == pytest.approx(11.521814, abs=1e-6)


@pytest.mark.parametrize("robot", ["thesis-3-1", cs.load_robot("thesis-3-1")], ids=["name", "Robot"])
def test_a_robot_in_any_form(robot):
    assert cs.inverse(robot).robot.name == "thesis-3-1"


def test_a_robot_of_a_path_that_was_written(tmp_path):
    robot = cs.load_robot("cogiro")
    path = cs.write_robot(robot, tmp_path / "mine.toml")
    again = cs.inverse(path)
    np.testing.assert_array_equal(again.solution.lengths, cs.inverse(robot).solution.lengths)
    with pytest.raises(cs.InputError, match="overwrite=True"):
        cs.write_robot(robot, path)
    cs.write_robot(robot, path, overwrite=True)
    with pytest.raises(cs.InputError, match="can be written"):
        cs.write_robot(robot, tmp_path / "nowhere" / "mine.toml")


def test_lengths_of_one_result_are_arguments_of_another():
    held = cs.inverse("thesis-3-1", POSE)
    found = cs.forward("thesis-3-1", held.solution.lengths)
    np.testing.assert_allclose(found.rest.solution.position, POSE[:3], atol=1e-8)
    modes = cs.modes("thesis-3-1", lengths=held.solution.lengths, model="static")
    np.testing.assert_allclose(modes.modes.hertz, cs.modes("thesis-3-1", POSE, model="static").modes.hertz, rtol=1e-8)


class Counting(ThreadPoolExecutor):
    """Counts what it is given to do."""

    given = 0

    def submit(self, function, /, *arguments, **named):
        self.given += 1
        return super().submit(function, *arguments, **named)


def test_a_grid_of_arrays_and_an_executor():
    axis = np.linspace(-1.0, 1.0, 3)
    grid = cs.Grid(axis, axis, np.array([0.5]), np.zeros(3))
    steps: list[str] = []
    alone = cs.map("thesis-3-1", grid, "tension-max", chunk=4, progress=steps.append)
    with Counting(2) as pool:
        shared = cs.map("thesis-3-1", "-1:1:3,-1:1:3,0.5", "tension-max", chunk=4, executor=pool)
    assert alone.to_json() == shared.to_json()
    assert pool.given == 3
    assert steps == ["9 poses"] * 4


def test_names_of_degrees_of_freedom_in_a_row_or_as_text():
    common = {"excite": "fz", "model": "static", "damping": "hysteretic:0.02"}
    row = cs.frf("thesis-3-1", respond=["x", "z"], band=(1, 3, 0.5), **common)
    text = cs.frf("thesis-3-1", respond="x,z", band="1:3:0.5", **common)
    np.testing.assert_array_equal(row.sweep.response.response, text.sweep.response.response)
    assert row.to_json()["band_hz"] == "1.0:3.0:0.5"


def test_a_trajectory_that_was_made():
    from cdpr_struct.statics.trajectory import helix

    made = cs.distribute("thesis-5", helix(31))
    assert made.to_json() == cs.distribute("thesis-5", "helix", instants=31).to_json()
    with pytest.raises(cs.InputError, match="instants: got 5; a Trajectory has its own"):
        cs.distribute("thesis-5", helix(31), instants=5)


def test_causes_and_campaigns():
    assert "axial_stiffness" in cs.causes()
    campaign = cs.load_campaign(LEVEL)
    with pytest.raises(cs.InputError, match="give them to load_campaign"):
        cs.plan(campaign, lower_bound=10.0)


BAD = {
    "pose of two": (lambda: cs.inverse("thesis-3-1", (1, 2)), r"pose: got \(1, 2\); give 3 or 6 numbers x,y,z"),
    "pose of words": (lambda: cs.inverse("thesis-3-1", "a,b,c"), "pose: got 'a,b,c'; give 3 or 6 comma-separated"),
    "pose of nothing": (lambda: cs.inverse("thesis-3-1", 5), "pose: got 5; give 3 or 6 numbers"),
    "pose with nan": (lambda: cs.inverse("thesis-3-1", (0, 0, np.nan)), "pose: got"),
    "pose of many": (lambda: cs.modes("thesis-3-1", np.zeros((2, 3))), "pose: got"),
    "no robot": (lambda: cs.modes("thesis"), "a robot file that can be read, or one of"),
    "robot of a number": (lambda: cs.modes(3), "robot: got 3; a Robot, a built-in name"),
    "count of a fraction": (lambda: cs.modes("thesis-3-1", count=2.5), "count: got 2.5; give a number from 1 to 500"),
    "count of text": (lambda: cs.modes("thesis-3-1", count="x"), "count: got 'x'"),
    "count of a truth": (lambda: cs.modes("thesis-3-1", count=True), "count: got True"),
    "model": (lambda: cs.modes("thesis-3-1", model="beam"), "model: got 'beam'; one of: static, dsm, exact, fem"),
    "assembly": (lambda: cs.modes("thesis-3-1", assembly="x"), "assembly: got 'x'; consistent or thesis"),
    "payload": (lambda: cs.modes("thesis-3-1", payload=-1), "payload: got -1; give a mass"),
    "payload of text": (lambda: cs.modes("thesis-3-1", payload="1"), "payload: got '1'"),
    "mass": (lambda: cs.inverse("thesis-3-1", mass=0), "mass: got 0; give a mass in kg above zero"),
    "bound": (lambda: cs.inverse("thesis-3-1", lower_bound="5"), "lower_bound: got '5'; give a force in N"),
    "crossed": (lambda: cs.inverse("thesis-3-1", lower_bound=9, upper_bound=5), "upper_bound: got 5"),
    "both": (lambda: cs.modes("thesis-3-1", POSE, lengths=[1] * 8), "give either `pose` or `lengths`, not both"),
    "start alone": (lambda: cs.modes("thesis-3-1", start=POSE), "start: got .*it belongs to `lengths`"),
    "seven lengths": (lambda: cs.forward("thesis-3-1", [9] * 7), "lengths: got .*give 8 unstrained lengths in m"),
    "millimetres": (lambda: cs.forward("thesis-3-1", [9e3] * 8), "look like mm"),
    "wrench": (lambda: cs.inverse("thesis-3-1", wrench=(1, 2)), "wrench: got .*give 6 numbers in N and N m"),
    "grid": (lambda: cs.map("thesis-3-1", 5, "tension-max"), "grid: got 5; give X0:X1:NX"),
    "refine without a workspace": (
        lambda: cs.map("thesis-3-1", "-1:1:2,0,0.5", "tension-max", refine=3),
        "refine: got 3; only `quantity` workspace",
    ),
    "no grid": (lambda: cs.map("thesis-3-1"), "grid is missing"),
    "quantity": (lambda: cs.map("thesis-3-1", "0:1:2,0,0.5", "heat"), "quantity: got 'heat'; one of: pose-error"),
    "chunk": (lambda: cs.map("thesis-3-1", "0:1:2,0,0.5", "sag-max", chunk=0), "chunk: got 0"),
    "band": (lambda: cs.frf("thesis-3-1", excite="fz", respond="z", band=(3, 1, 0.1)), "band: got .*F0:F1:DF"),
    "excite": (lambda: cs.frf("thesis-3-1", excite="up", respond="z", band=(1, 3, 1)), "excite: got 'up'; one of"),
    "respond": (lambda: cs.frf("thesis-3-1", excite="fz", respond=3, band=(1, 3, 1)), "respond: got 3; one of"),
    "damping": (lambda: cs.frf("thesis-3-1", excite="fz", respond="z", band=(1, 3, 1), damping=0.01), "damping: got"),
    "no motion": (lambda: cs.transient("thesis-3-1", duration=1), "give either `initial_velocity` or `trajectory`"),
    "duration": (lambda: cs.transient("thesis-3-1", initial_velocity=(1, 0, 0), duration="x"), "duration: got 'x'"),
    "highest": (
        lambda: cs.transient("thesis-3-1", initial_velocity=(1, 0, 0), duration=1, highest="x"),
        "highest: got 'x'",
    ),
    "elements": (lambda: cs.verify("thesis-3-1", elements=(8, 9, 10)), "elements: got .*multiples of the first"),
    "tolerance": (lambda: cs.limits(tolerance=2), "tolerance: got 2; give a ratio"),
    "two places": (lambda: cs.audit("thesis-3-1", POSE, grid="0,0,1"), "grid: got '0,0,1'; give only one of `pose`"),
    "trajectory": (lambda: cs.distribute("thesis-5", 5), "trajectory: got 5; give a Trajectory, or helix"),
    "no file": (lambda: cs.distribute("thesis-5", "x.csv"), "trajectory: got 'x.csv'; no such file"),
    "bound rule": (lambda: cs.distribute("thesis-5", "helix", bound="x"), "bound: got 'x'; one of"),
    "campaign": (lambda: cs.diagnose("none.toml"), "campaign: got 'none.toml'; no such file"),
    "campaign without a record": (lambda: cs.ambient(LEVEL), "measurement: got 'no ambient record'"),
    "campaign of a number": (lambda: cs.plan(5), "campaign: got 5; a Campaign, or the path"),
    "budget": (lambda: cs.diagnose(LEVEL, budget="big"), "budget: got 'big'; small or full"),
    "item": (lambda: cs.reproduce("table-9"), "items: got 'table-9'; one of: table-2.2"),
    "cable": (lambda: cs.cable(force=(1, 1), length=0, EA=1e5, rho=0.1), "length: got 0; give a finite number"),
    "tolerance of load": (lambda: cs.pose_error("thesis-3-1", sufficient_load="x"), "sufficient_load: got 'x'"),
    "no question": (lambda: cs.pose_error("thesis-3-1"), "grid is missing; give `grid`, `sufficient_load`"),
    "spectrogram": (lambda: cs.spectrogram("none.csv", "thesis-3-1"), "none.csv"),
    "not a robot": (lambda: cs.write_robot("thesis-3-1", "x.toml"), "robot: got 'thesis-3-1'; a Robot"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_argument_is_told_in_one_sentence(name):
    call, match = BAD[name]
    with pytest.raises(cs.InputError, match=match) as told:
        call()
    assert "\n" not in str(told.value)


def test_what_the_robot_cannot_do_is_no_bad_argument():
    with pytest.raises(cs.UnholdablePoseError) as told:
        cs.inverse("thesis-3-1", (50.0, 0.0, 0.0))
    assert not isinstance(told.value, cs.InputError)
    with pytest.raises(cs.OutsideValidityError, match="cable"):
        cs.modes("thesis-3-1", (4.0, 3.0, 0.5), model="dsm", count=3)


def test_long_ropes_of_a_narrow_robot_are_not_taken_for_millimetres():
    lift = ROOT / "examples/robots/lift/robot.toml"
    assert cs.forward(lift, [99.92842] * 4).answer["pose"][2] == pytest.approx(0.0, abs=1e-4)  # given to 0.01 mm
    with pytest.raises(cs.InputError, match=r"look like mm \(the robot measures 100 m\)"):
        cs.forward(lift, [99928.42] * 4)
