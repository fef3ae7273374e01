"""What a diagnosis says in words: signs, sizes, which columns of which files are to be corrected (crime=True)."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.whole_sizes import WholeSize
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.correction import Correction
from cdpr_struct.hypotheses.hypothesis import Part
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.measurement.campaign import Campaign, Sheet, Sigmas
from cdpr_struct.reports.diagnose.corrected_columns import changed_columns, corrected
from cdpr_struct.reports.diagnose.words import described
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.written_campaigns import plan_of, written


@pytest.fixture(scope="module")
def clean() -> Campaign:
    robot = load_robot("cogiro")
    return written(robot, plan_of(robot, 2, cables_in=(0,)))


@pytest.fixture(scope="module")
def said(clean):
    """A cause in one of its patterns, at a size, in words."""
    seen = seen_in(recorded(clean))

    def of(name: str, label: str, values: np.ndarray) -> str:
        cause = LIBRARY[name]
        pattern = next(p for p in cause.patterns(seen) if p.label == label)
        sizes = np.asarray(values, dtype=float)
        return described(WholeSize(Part(cause, pattern, 1.0), sizes, 0.1 * np.diag(sizes**2)))

    return of


@pytest.mark.parametrize("size", [-0.0062, 0.0062])
def test_a_single_number_keeps_its_sign_and_says_what_it_means(said, size):
    text = said("unstrained_length_offset", "all alike", [size])
    assert f"by {size:+.2g} m (all alike" in text
    assert "on average" not in text
    assert "paid out = encoder length + this" in text


def test_numbers_of_each_cable_are_a_mean(said):
    text = said("load_cell_bias", "each its own", [3.0, -3.0] * 4)
    assert text == "the zeros of the load cells are off by 3 N on average (each its own)"


@pytest.mark.parametrize(
    ("name", "label", "values", "words"),
    [
        ("gravity_tilt", "", [0.003, -0.004], "out of level by 0.005 rad"),
        ("frame_anchor_position", "each its own", [0.002, 0.0, 0.0] * 8, "off by 0.002 m on average"),
        ("tracker_frame", "shifted and turned", [0.003, 0.0, 0.004, 0.0, 0.002, 0.0], "by 0.005 m and 0.002 rad"),
    ],
)
def test_vectors_are_told_by_their_length(said, name, label, values, words):
    assert words in said(name, label, values)


def test_ratios_of_each_axis_are_told_by_their_range(said):
    """An inertia 56 % too small about one axis is no 112 %."""
    text = said("platform_inertia", "each its own", np.log([0.965, 1.557, 0.93]))
    assert text.endswith("is 111.8 % of the entered value (each its own, from 93.0 % to 155.7 %)")


def test_a_ratio_near_one_keeps_its_digits(said):
    """A drum 0.04 % too large is no 100.0 %."""
    assert "100.042 %" in said("drum_scale", "all alike", [np.log(1.00042)])
    assert "120.0 %" in said("drum_scale", "all alike", [np.log(1.2)])


def test_a_unit_error_names_column_file_and_factor(clean):
    sheet = Sheet("static_state", "day1.csv", ("cable", "length_m", "tension_N"), Sigmas(), frozenset())
    entered = replace(clean, sheets=(sheet,))
    better = replace(entered, states=replace(entered.states, length=1e-3 * entered.states.length))
    wrong = Correction("unit_error", "the lengths are in mm", better, parameters={"factor": 1e-3})
    assert corrected(entered, wrong) == "the lengths are in mm (correct column length_m of day1.csv: times 0.001)"


@pytest.mark.parametrize(
    ("kind", "columns"), [("cable_frequency", {"frequency_hz"}), ("robot_frequency", set()), ("frf", set())]
)
def test_cable_frequencies_are_columns_of_their_own_files_only(clean, kind, columns):
    cables = replace(clean.cable_frequencies, hertz=2.0 * clean.cable_frequencies.hertz)
    assert changed_columns(clean, replace(clean, cable_frequencies=cables), kind) == columns
