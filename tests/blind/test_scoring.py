"""The scorer on answers written by hand, and the harness end to end with a program that always says the same."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.blind.__main__ import main
from tests.blind.answers import (
    Answer,
    right_answer,
    right_class,
    right_name,
    wrong_confident_class,
    wrong_confident_name,
)
from tests.blind.campaign_files import write_case
from tests.blind.case_drawing import CaseKind, drawn_case
from tests.blind.intervals import band, compared, expected_calibration_error, relative_error
from tests.blind.measuring_plan import PlanSize
from tests.blind.scoring import Scored, figures, smallest_by_tool

TINY = PlanSize(static_states=1, locks=1, loads_per_lock=2, frequency_states=1)
FAKE = """
import json, pathlib, sys
out = pathlib.Path(sys.argv[sys.argv.index("--out") + 1]); out.mkdir(parents=True)
answer = {"verdict": {"status": "named", "causes": ["drum_scale"], "class": [], "probability": 0.95}}
(out / "result.json").write_text(json.dumps(answer))
"""


def said(status: str, causes=(), groups=(), probability=0.95, result=None) -> Answer:
    return Answer(status, tuple(causes), tuple(map(tuple, groups)), probability, 1.0, result or {})


def truth(kind: str, *effects) -> dict:
    records = [{"cause": name, "multiple": multiple, "change": [1.0]} for name, multiple in effects]
    return {"kind": kind, "robot": "cogiro", "effects": records}


def test_names_and_classes():
    hidden = ("joint_compliance",)
    in_class = said("class", groups=[["joint_compliance", "dead_length"]])
    assert right_class(in_class, hidden)
    assert not right_name(in_class, hidden)
    assert right_name(said("named", hidden), hidden)
    assert not right_class(said("class", groups=[["joint_compliance", *"abc"]]), hidden)
    assert not right_class(said("named", ["joint_compliance", "drum_scale"]), hidden)
    assert right_class(said("named", ["b", "a"]), ("a", "b"))
    assert right_class(said("class", groups=[["a", "b"], ["a"]]), ("a", "b"))
    assert not right_class(said("class", groups=[["a"], ["a", "c"]]), ("a", "b"))


def test_a_wrong_name_counts_only_when_it_is_confident():
    assert wrong_confident_name(said("named", ["drum_scale"]), ())
    assert not wrong_confident_name(said("named", ["drum_scale"], probability=0.6), ())
    assert not wrong_confident_name(said("unknown"), ())
    assert wrong_confident_name(said("named", ["drum_scale", "temperature"]), ("temperature",))
    assert wrong_confident_class(said("class", groups=[["drum_scale", "temperature"]]), ("platform_mass",))
    assert not wrong_confident_class(said("class", groups=[["drum_scale", "temperature"]]), ("temperature",))


@pytest.mark.parametrize(
    ("kind", "status", "right"),
    [("null", "adequate", True), ("null", "unknown", False), ("outside", "unknown", True), ("outside", "named", False)],
)
def test_right_answers_without_a_name(kind, status, right):
    effects = [("wind_gradient", 4.0)] if kind == "outside" else []
    assert right_answer(said(status, ["drum_scale"]), truth(kind, *effects)) is right


@pytest.mark.parametrize(
    ("measured", "status", "resolved"),
    [("joint_compliance", "adequate", 1), ("frame_anchor_position", "adequate", 0), ("dead_length", "named", 1)],
)
def test_nothing_left_resolves_only_what_was_itself_measured(measured, status, resolved):
    """Where the rival was measured, nothing left would mean that the effect was lost."""
    sealed = truth("ambiguous", ("joint_compliance", 4.0)) | {"measured": [measured]}
    served = [Scored("c1", sealed, said(status, ["joint_compliance"] * (status == "named")))]
    assert figures(served, served)["resolved_by_more_measurements"]["successes"] == resolved


def test_figures_of_a_small_set():
    cases = [
        Scored("c1", truth("null"), said("adequate")),
        Scored("c2", truth("null"), said("named", ["drum_scale"])),
        Scored(
            "c3",
            truth("single", ("center_of_mass", 2.0)),
            said("named", ["center_of_mass"], result={"gain": {"ratio": 3}}),
        ),
        Scored("c4", truth("single", ("drum_scale", 0.5)), said("adequate")),
        Scored("c5", truth("outside", ("wind_gradient", 4.0)), said("unknown")),
        Scored("c6", truth("handling", ("unit_error", None)), said("failed", probability=float("nan"))),
    ]
    cases[2].truth["effects"][0] |= {"total": [0.001], "shape": "common"}
    found = figures(cases)
    assert found["false_alarms"]["value"] == 0.5
    assert found["detection"]["2x"]["value"] == 1.0
    assert found["detection"]["0.5x"]["value"] == 0.0
    assert found["right_name_at_2x"]["successes"] == 1
    assert found["right_name_at_2x"]["cases"] == 2
    assert found["wrong_confident_name"]["value"] == pytest.approx(1 / 6)
    assert found["unknown_caught"]["value"] == 1.0
    assert found["heldout_ratio_median"] == 3.0
    assert found["failed_runs"]["successes"] == 1


def test_rates_count_for_false_alarms_just_detectable_effects_and_pairs_only():
    own = [
        Scored("c1", truth("null"), said("adequate")),
        Scored("c2", truth("single", ("drum_scale", 1.0)), said("adequate")),
    ]
    wrong = Scored("r1", truth("null"), said("named", ["drum_scale"]))
    both = truth("pair", ("drum_scale", 2.0), ("temperature", 4.0))
    pair = Scored("r3", both, said("named", ["drum_scale", "temperature"]))
    rates = [wrong, Scored("r2", truth("single", ("drum_scale", 1.0)), said("unknown")), pair]
    found = figures(own, rates=rates)
    assert (found["false_alarms"]["successes"], found["false_alarms"]["cases"]) == (1, 2)
    assert (found["detection"]["1x"]["successes"], found["detection"]["1x"]["cases"]) == (1, 2)
    assert found["of_which_in_the_set"]["detection"]["1x"]["successes"] == 0
    assert (found["pair_both"]["successes"], found["of_which_in_the_set"]["pair_both"]["cases"]) == (1, 0)
    assert found["wrong_confident_among_rates"]["successes"] == 1
    assert found["wrong_confident_name"]["successes"] == 0
    assert found["unknown_inside_library"]["successes"] == 0


def test_binomial_band_is_the_exact_one():
    """2 of 40: 0.6 to 16.9 per cent (Clopper and Pearson)."""
    assert band(2, 40) == pytest.approx((0.0061, 0.1692), abs=2e-4)
    assert band(0, 10)[0] == 0.0
    assert band(10, 10)[1] == 1.0


def test_intervals_are_compared_as_ratios_and_offsets():
    effect = {"cause": "axial_stiffness", "shape": "common", "total": [0.0953, 0.0953]}
    stated = {"axial_stiffness": {"value": 1.09, "sigma": 0.01, "unit": "ratio"}}
    (number,) = numbers = compared(effect, stated)
    assert number.covered
    assert relative_error(numbers) == pytest.approx(0.1, abs=0.01)
    stated["axial_stiffness"]["sigma"] = 0.001
    assert not compared(effect, stated)[0].covered
    one = {"cause": "load_cell_bias", "shape": "one", "total": [0.0, 0.0, 5.0]}
    numbers = compared(one, {"load_cell_bias_3": {"value": 5.5, "sigma": 0.5, "unit": "N"}})
    assert numbers[0].covered
    assert relative_error(numbers) == pytest.approx(0.1)


def test_turned_gravity_is_compared_by_its_horizontal_share():
    """Gravity turned by a about x points towards y: (0, sin a, -cos a)."""
    effect = {"cause": "gravity_tilt", "shape": "direction", "total": [0.02, 0.0]}
    stated = {axis: {"value": value, "sigma": 1e-4, "unit": "rad"} for axis, value in (("tilt_x", 0), ("tilt_y", 0.02))}
    assert [number.covered for number in compared(effect, stated)] == [True, True]
    stated["tilt_y"]["value"] = -0.02
    assert [number.covered for number in compared(effect, stated)] == [True, False]


def test_tracker_is_compared_by_the_way_back_from_what_it_shows():
    effect = {"cause": "tracker_frame", "shape": "direction", "total": [0.01, 0.0, 0.0, 0.0, 0.0, 0.02]}
    names = ("shift_x", "shift_y", "shift_z", "turn_x", "turn_y", "turn_z")
    values = (-0.01, 0.0002, 0.0, 0.0, 0.0, -0.02)
    stated = {name: {"value": v, "sigma": 1e-5, "unit": "m"} for name, v in zip(names, values, strict=True)}
    assert all(number.covered for number in compared(effect, stated))


def test_internal_force_is_compared_by_its_length():
    """Directions of a null space are anybody's choice."""
    effect = {"cause": "internal_force", "shape": "direction", "total": [30.0, 40.0]}
    stated = {"internal_force_1": {"value": 0.0, "sigma": 9.0, "unit": "N"}}
    stated["internal_force_2"] = {"value": -52.0, "sigma": 2.0, "unit": "N"}
    (number,) = compared(effect, stated)
    assert (number.value, number.truth, number.sigma) == pytest.approx((52.0, 50.0, 2.0))
    assert number.covered


def test_intervals_of_masts_are_those_of_their_cables():
    """Cables 1 and 5 hang on the truth's second mast; the answer names masts by cables, in its own order."""
    masts = np.array([1, 0, 2, 3, 1, 0, 2, 3])
    one = {"cause": "frame_compliance", "shape": "one", "total": [0.0, 4e-6, 0.0, 1e-6]}

    def stated(**values: float) -> dict:
        return {name: {"value": v, "sigma": 1e-7, "unit": "m/N"} for name, v in values.items()}

    alone = stated(compliance_mast_of_1_5=4.1e-6)
    (number,) = numbers = compared(one, alone, masts=masts)
    assert number.covered
    assert relative_error(numbers) == pytest.approx(0.025)
    assert not compared(one, stated(compliance_mast_of_2_6=4.1e-6), masts=masts)[0].covered
    own = stated(
        compliance_mast_of_1_5=4e-6, compliance_mast_of_2_6=0, compliance_mast_of_3_7=0, compliance_mast_of_4_8=1e-6
    )
    assert [number.covered for number in compared(one, own, masts=masts)] == [True] * 4
    common = {"cause": "frame_compliance", "shape": "common", "total": [4e-6] * 4}
    assert compared(common, stated(compliance=4.1e-6), masts=masts)[0].covered
    assert compared(one, stated(compliance=4.1e-6), masts=masts) == []


def test_a_calibrated_teller_has_no_calibration_error():
    right = np.array([1.0] * 9 + [0.0])
    assert expected_calibration_error(np.full(10, 0.9), right) == pytest.approx(0.0)
    assert expected_calibration_error(np.full(10, 0.5), right) == pytest.approx(0.4)


@pytest.fixture
def one_case_set(tmp_path) -> Path:
    out = tmp_path / "set"
    case = drawn_case(CaseKind("null", size=TINY), (7, 3))
    write_case(case, "c001", (7, 3), out / "campaigns", tmp_path / "set-sealed")
    (out / "run.json").write_text(json.dumps({"set": "dev", "budget": "small"}), "utf-8")
    (tmp_path / "fake.py").write_text(FAKE, "utf-8")
    return out


def test_harness_runs_scores_and_reports(one_case_set, tmp_path, capsys):
    command = f"{sys.executable} {tmp_path / 'fake.py'}"
    assert main(["run", "--out", str(one_case_set), "--command", command]) == 0
    assert main(["score", "--out", str(one_case_set)]) == 0
    assert json.loads(capsys.readouterr().out)["false_alarms"]["value"] == 1.0
    page = tmp_path / "page.md"
    assert main(["report", "--out", str(one_case_set), "--page", str(page)]) == 0
    text = page.read_text("utf-8")
    assert "| wrong confident name, over everything | 100.0 % | 2-100 % | 1 | <= 2 % |" in text
    assert "@" not in text
    assert (tmp_path / "page_confusion.svg").exists()


def test_a_run_is_resumed_and_not_repeated(one_case_set, tmp_path):
    command = f"{sys.executable} {tmp_path / 'fake.py'}"
    main(["run", "--out", str(one_case_set), "--command", command])
    record = one_case_set / "answers" / "c001" / "run.json"
    before = record.read_bytes()
    main(["run", "--out", str(one_case_set), "--command", f"{sys.executable} -c 'raise SystemExit(2)'"])
    assert record.read_bytes() == before


def test_a_smallest_size_in_metres_is_none_of_a_force():
    table = {"internal_force": {"value": 2e-4, "unit": "m"}, "load_cell_bias": {"value": 3.0, "unit": "N"}}
    assert smallest_by_tool(table, "internal_force", hidden_in="N") is None
    assert smallest_by_tool(table, "load_cell_bias", hidden_in="N") == 3.0
