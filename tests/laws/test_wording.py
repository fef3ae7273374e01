"""What a diagnosis says in words: signs, what to mend, peaks that are given to no mode for certain."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from cdpr_struct.diagnosis.causes.handling import Correction
from cdpr_struct.diagnosis.causes.registry import LIBRARY
from cdpr_struct.diagnosis.diagnose import diagnose
from cdpr_struct.diagnosis.handled_data import handled
from cdpr_struct.diagnosis.prepared import BUDGETS
from cdpr_struct.diagnosis.setting import make_setting
from cdpr_struct.diagnosis.verdict import verdict
from cdpr_struct.diagnosis.wording import changed_columns, corrected, described, rest_words
from cdpr_struct.measurement.campaign import Sheet, Sigmas
from cdpr_struct.measurement.campaign_file import load_campaign
from tests.laws.crime_campaign import clean_campaign

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def clean():
    return clean_campaign()


def chosen(name, label, campaign):
    """A pattern of a cause as it is chosen, in units of its prior."""
    setting, _ = make_setting(
        replace(campaign, cable_frequencies=campaign.with_states_only(campaign.states).cable_frequencies)
    )
    cause = LIBRARY[name]
    pattern = next(p for p in cause.patterns(setting) if p.label == label)
    return SimpleNamespace(candidate=SimpleNamespace(cause=cause), pattern=pattern, prior=pattern.prior)


@pytest.mark.parametrize("size", [-0.0062, 0.0062])
def test_a_single_number_keeps_its_sign_and_says_what_it_means(clean, size):
    found = chosen("unstrained_length_offset", "all alike", clean)
    said = described(found, np.array([size]) / found.prior)
    assert f"by {size:+.2g} m (all alike" in said
    assert "in the mean" not in said
    assert "paid out = encoder length + this" in said


def test_numbers_of_each_cable_are_a_mean(clean):
    found = chosen("load_cell_bias", "each its own", clean)
    said = described(found, np.array([3.0, -3.0] * 4) / found.prior)
    assert said == "the load cells' zero is off, by 3 N in the mean (each its own)"


@pytest.mark.parametrize(
    ("name", "label", "values", "words"),
    [
        ("gravity_tilt", "", [0.003, -0.004], "out of level by 0.005 rad"),
        ("frame_anchor_position", "each its own", [0.002, 0.0, 0.0] * 8, "off, by 0.002 m in the mean"),
        ("tracker_frame", "shifted and turned", [0.003, 0.0, 0.004, 0.0, 0.002, 0.0], "by 0.005 m and 0.002 rad"),
    ],
)
def test_vectors_are_told_by_their_length(clean, name, label, values, words):
    found = chosen(name, label, clean)
    assert words in described(found, np.array(values) / found.prior)


def test_ratios_of_each_axis_are_told_by_their_range(clean):
    """An inertia 56 % too small about one axis is no 112 %."""
    found = chosen("platform_inertia", "each its own", clean)
    said = described(found, np.log([0.965, 1.557, 0.93]) / found.prior)
    assert said.endswith("is 111.8 % of what was entered (each its own, from 93.0 % to 155.7 %)")


def test_a_ratio_near_one_keeps_its_digits(clean):
    """A drum 0.04 % too large is no 100.0 %."""
    found = chosen("drum_scale", "all alike", clean)
    assert "100.042 %" in described(found, np.array([np.log(1.00042)]) / found.prior)
    assert "120.0 %" in described(found, np.array([np.log(1.2)]) / found.prior)


def found_with(campaign, correction, p_left):
    return SimpleNamespace(
        entered_setting=SimpleNamespace(campaign=campaign), corrections=[(correction, 1e3)], p_value_left=p_left
    )


def test_a_unit_error_names_column_file_factor_and_the_rest(clean):
    sheet = Sheet("static_state", "day1.csv", ("cable", "length_m", "tension_N"), Sigmas(), frozenset())
    entered = replace(clean, sheets=(sheet,))
    mended = replace(entered, states=replace(entered.states, length=1e-3 * entered.states.length))
    wrong = Correction("unit_error", "the lengths are in mm", mended, parameters={"factor": 1e-3})
    (said,) = corrected(found_with(entered, wrong, 0.4))
    assert said == "the lengths are in mm (mend column length_m of day1.csv: times 0.001)"
    assert "rest then agrees" in rest_words(found_with(entered, wrong, 0.4))
    assert "does not agree yet" in rest_words(found_with(entered, wrong, 1e-5))


def test_peaks_without_a_mode_are_not_said_to_agree():
    """Section 4.3.3: five rounded frequencies between 34 modes, two of which may be any of several or none."""
    said = verdict(diagnose(load_campaign(EXAMPLES / "section-4-3-3" / "campaign.toml")))
    assert said.status == "adequate"
    assert "2 of 5 robot frequencies (8, 12.3 Hz) cannot be given to a mode for certain" in said.sentence
    assert "simulation and measurements agree" not in said.sentence


def test_frequencies_of_both_kinds_in_radians_are_mended_one_by_one_each_in_its_file():
    """The cables' in rad/s say nothing of the robot's, and the robot's are seen beside cables that are right."""
    campaign = load_campaign(EXAMPLES / "soft-masts" / "campaign.toml")
    cables, robot = campaign.cable_frequencies, campaign.robot_frequencies
    turn = 2.0 * np.pi
    wrong = replace(
        campaign,
        cable_frequencies=replace(cables, hertz=turn * cables.hertz, sigma=turn * cables.sigma),
        robot_frequencies=replace(robot, hertz=turn * robot.hertz, sigma=turn * robot.sigma),
    )
    found = handled(wrong, BUDGETS["small"], lambda _: None)
    said = corrected(SimpleNamespace(entered_setting=found.entered.ground.setting, corrections=found.corrections))
    assert said == [
        f"the {name} frequencies are in rad/s (mend column frequency_hz of {file}: times 0.1592)"
        for name, file in (("cable", "cables.csv"), ("robot", "robot.csv"))
    ]


@pytest.mark.parametrize(
    ("kind", "columns"), [("cable_frequency", {"frequency_hz"}), ("robot_frequency", set()), ("frf", set())]
)
def test_cable_frequencies_are_columns_of_their_own_files_only(clean, kind, columns):
    cables = replace(clean.cable_frequencies, hertz=2.0 * clean.cable_frequencies.hertz)
    assert changed_columns(clean, replace(clean, cable_frequencies=cables), kind) == columns
