"""Every result says whether it can be trusted: the numbers in `trust`, what follows as warnings, one line on screen."""

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np

import cdpr_struct as cs
from cdpr_struct.cli.main import run
from cdpr_struct.interface.campaigns import with_dropped
from cdpr_struct.measurement.campaign import RobotFrequencies
from cdpr_struct.reports.trust import Check, Trust
from cdpr_struct.reports.trust_at_rest import trust_at_rest
from cdpr_struct.reports.trust_of_modes import mode_checks
from cdpr_struct.reports.trust_over_poses import trust_over_poses
from cdpr_struct.reports.trust_without_robot import cable_trust, limits_trust, reproduction_trust, robots_trust
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.thesis.reproduction import Cell, Reproduction
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.quantities import evaluate

EXAMPLES = Path(__file__).parents[2] / "examples" / "robots"
NAME = "thesis-3-1"
GRID = Grid(np.array([0.0, 0.5]), np.array([0.0]), np.array([0.5]), np.zeros(3))


def failing(result: cs.Result) -> dict[str, dict[str, object]]:
    return {check["what"]: check for check in result.to_json()["trust"]["checks"] if not check["holds"]}


def test_what_holds_says_its_number_and_what_fails_its_limit_too():
    fine, torn = Check.of("sag", 0.01, 0.1, None), Check.of("strain", 3.0, 2.0, "It breaks.", "%")
    known = Check.of("near", 2, 0.0, "They mix.", note=True)
    assert Trust((fine, known)).holds
    assert Trust((fine, known)).sentences == ["Trust: the check holds (sag 0.01).", "They mix."]
    assert Trust((fine, torn, known)).warnings == ["It breaks."]
    assert Trust((fine, torn)).sentences == [
        "Trust: 1 of 2 checks hold; not: strain 3 % (at most 2 %). See the warnings."
    ]
    assert Trust().sentences == []
    tiny = Trust((Check.of("unbalanced wrench", 8e-17, 1e-7, None),))
    assert tiny.sentences == ["Trust: the check holds (unbalanced wrench below 1e-09)."]


def test_a_sound_robot_is_trusted_on_the_screen_in_json_and_on_the_page(tmp_path, capsys):
    assert run(["inverse", NAME, "--out", str(tmp_path)]) == 0
    told = json.loads((tmp_path / "result.json").read_text())["trust"]
    assert told["holds"]
    assert all(check["value"] <= check["limit"] or check["side"] == "at least" for check in told["checks"])
    (line,) = told["sentences"]
    assert line in capsys.readouterr().out
    assert "Trust: all 8 checks hold (" in line
    assert "Trust: all 8 checks hold (" in (tmp_path / "report.html").read_text("utf-8")


def test_what_is_left_unbalanced_is_told():
    """One cable pulls by a thousandth more: searches end with less than 1e-8 of the load."""
    found = cs.inverse(NAME)
    assert trust_at_rest(found.point).holds
    pull = found.point.cables.force_x.copy()
    pull[0] *= 1.001
    moved = replace(found.point, cables=replace(found.point.cables, force_x=pull))
    assert "unbalanced" in trust_at_rest(moved).warnings[0]


def test_a_pendulum_on_a_rope_nearly_rigid_is_ill_conditioned():
    """m g over the length of the rope, 49 N/m, beside EA over it, 3e10 N/m; below 1e-9 a freedom counts as neutral."""
    rope = load_robot(str(EXAMPLES / "load-on-one-rope" / "robot.toml"))
    stiff = replace(rope, cables=tuple(replace(c, axial_stiffness=3e5 * c.axial_stiffness) for c in rope.cables))
    assert trust_at_rest(cs.inverse(rope).point).holds
    assert "condition" in failing(cs.inverse(stiff))


def test_a_balance_that_does_not_hold_is_told_by_inverse():
    robot = load_robot(NAME)
    weight = replace(robot.platform, center_of_mass=np.array([0.0, 0.0, 300.0]))
    found = cs.inverse(replace(robot, platform=weight))
    assert not found.answer["stable"]
    assert failing(found)["least stiffness"]["value"] < 0.0
    assert any("unstable equilibrium" in sentence for sentence in found.warnings)


def test_slack_and_strain_are_told_at_locked_lengths_as_at_a_pose():
    robot = load_robot("six-cable-4mm")
    soft = replace(robot, cables=tuple(replace(c, axial_stiffness=3e3) for c in robot.cables))
    held = cs.inverse(soft)
    locked = cs.forward(soft, held.solution.lengths, start=held.pose)
    for found in (held, locked):
        assert failing(found)["strain"]["value"] > 2.0
        assert sum("would break" in sentence for sentence in found.warnings) == 1
    light = cs.inverse(NAME, (3.0, 3.0, 0.0), mass=1.0)
    assert failing(light)["slack cables"]["value"] > 0
    at_pose, at_lengths = (trust_at_rest(light.point, how).warnings[0] for how in (None, locked.rest))
    assert at_pose.startswith(at_lengths.rstrip("."))
    assert "lower bound" in at_pose


def test_frequencies_within_a_percent_are_a_note_with_the_numbers_of_their_modes():
    (_, near) = mode_checks([0.0, 0.0, 1.0, 1.005, 2.0, 3.0, 3.01, 3.02], True)
    assert near.note
    assert near.value == 5
    assert "modes 3 and 4, 6 to 8:" in near.consequence[0]
    assert Trust((near,)).warnings == []
    assert mode_checks([1.0, 1.02], True)[1].holds
    assert not Trust(tuple(mode_checks([1.0, 2.0], False))).holds
    assert "none above 2 Hz" in Trust(tuple(mode_checks([1.0, 2.0], True, False))).warnings[0]


def test_modes_of_equal_cables_are_told_to_be_near():
    found = cs.modes(NAME, count=8)
    assert failing(found)["frequencies near another"]["value"] >= 2
    assert not found.warnings
    assert "Within 1 % of each other" in str(found)


def test_a_campaign_tells_pulleys_that_its_model_leaves_out_of_vibrations():
    campaign = cs.load_campaign(EXAMPLES.parent / "table-4-4" / "level.toml")
    robot = replace(campaign.robot, pulleys=(Pulley(0.05),) * len(campaign.robot.cables))
    peak = RobotFrequencies(np.zeros(1, dtype=int), np.ones(1), np.full(1, 0.01))
    over = replace(campaign, robot=robot, model="dsm", robot_frequencies=peak)
    (said,) = with_dropped({}, over)["trust"].warnings
    assert "has no pulleys" in said
    for silent in (campaign, replace(over, model="exact"), over.with_states_only(over.states)):
        assert with_dropped({}, silent)["trust"].holds


def test_pulleys_that_the_closed_form_leaves_out_are_counted():
    robot = load_robot(NAME)
    over = replace(robot, pulleys=(Pulley(0.05),) * len(robot.cables))
    found = cs.modes(over, model="dsm", count=3)
    assert failing(found)["pulleys that the model leaves out"]["value"] == 8
    assert "pulleys that the model leaves out" not in failing(cs.modes(over, count=3))


def test_a_map_tells_searches_that_were_cut_short_and_strain():
    robot = load_robot(NAME)
    columns = evaluate("tension-max", robot, GRID.positions, np.eye(3))
    assert trust_over_poses(robot, GRID, columns).holds
    columns["cut_short"][1] = True
    columns["strain_max"][0] = 0.05
    first, second = trust_over_poses(robot, GRID, columns).warnings
    assert "at 1 of 2 poses the search for tensions ended before" in first
    assert "At 1 of 2 poses a cable is stretched beyond 2 %, at most by 5 %" in second


def test_one_cable_says_whether_shape_and_frequencies_are_found():
    given = {"force": (500.0, 100.0), "length": 10.0, "EA": 250e3, "rho": 0.067}
    assert cs.cable(**given).to_json()["trust"]["holds"]
    assert set(failing(cs.cable(**given | {"EA": 250.0, "rho": 67.0}))) >= {
        "implausible numbers of the cable",
        "strain",
    }
    slack = cs.cable(**given | {"force": (5.0, 1.0)}, fem=True)
    assert slack.to_json()["trust"]["holds"], "what the closed form's limits say is a note"
    assert set(failing(slack)) == {"printed limits broken"}
    told = dict(slack.answer)
    told["fem_frequencies_hz"] = [1.01 * f for f in told["fem_frequencies_hz"]]
    told["exact_frequencies_hz"] = {p: [1.0001 * f for f in hertz] for p, hertz in told["exact_frequencies_hz"].items()}
    told["z_m"] += 1e-3
    doubted = {check.what for check in cable_trust(told).doubted}
    assert doubted == {
        "force that the shape misses",
        "change of frequencies by more polynomials",
        "difference from the FEM",
    }


def test_the_list_of_robots_and_the_thesis_say_whether_they_are_sound():
    assert cs.robots().to_json()["trust"]["sentences"] == [
        "Trust: the check holds (no implausible numbers of the robots)."
    ]
    robot = load_robot(NAME)
    thin = replace(robot, cables=tuple(replace(c, axial_stiffness=1e-3 * c.axial_stiffness) for c in robot.cables))
    assert NAME in robots_trust([robot, thin]).warnings[0]
    told = cs.reproduce("table-2.2").to_json()["trust"]
    assert told["holds"]
    lost = Reproduction("x", "", (Cell("a", "b", "1.0", float("nan")),), "")
    assert reproduction_trust([lost]).warnings == ["1 numbers could not be computed."]


def test_the_trial_of_the_limits_doubts_judges_that_are_not_sure():
    sure, unsure = (SimpleNamespace(uncertainty=u, catenary=1e-5, stiffness=1e-3) for u in (1e-5, 5e-3))
    assert limits_trust(SimpleNamespace(tolerance=0.01, verdicts=[sure])).holds
    (warning,) = limits_trust(SimpleNamespace(tolerance=0.01, verdicts=[sure, unsure])).warnings
    assert "uncertainty of the FEM is up to 0.005" in warning
    assert not limits_trust(SimpleNamespace(tolerance=0.01, verdicts=[])).holds
