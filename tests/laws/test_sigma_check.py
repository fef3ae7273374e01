"""Sigmas that nobody gave are told, and those that cannot be right are doubted."""

import json
import re
from dataclasses import replace
from html import escape
from pathlib import Path

import pandas as pd
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.diagnosis.sensor_sigmas import NoiseOfKind, doubts, sigmas_used
from cdpr_struct.measurement.campaign import Sheet, Sigmas
from cdpr_struct.reports.diagnose.tables import default_sigmas, sigmas
from cdpr_struct.reports.diagnose.words import doubt
from cdpr_struct.reports.typeset import typeset
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.written_campaigns import plan_of, written


@pytest.fixture(scope="module")
def clean():
    robot = load_robot("cogiro")
    return written(robot, plan_of(robot, 2))


def warnings(campaign, noise=()):
    return [doubt(one) for one in doubts(campaign, list(noise))]


def sheet(stated, columns=("cable", "tension_N"), **sigmas):
    return Sheet("static_state", "a.csv", columns, replace(Sigmas(), **sigmas), frozenset(stated))


def test_defaults_are_told_from_what_was_stated(clean):
    campaign = replace(clean, sheets=(sheet({"tension_N"}, tension_N=3.0),))
    rows = {used.sigma: used for used in sigmas_used(campaign)}
    assert set(rows) == {"tension_N", "position_m", "rotation_deg"}  # no length was read
    assert [rows[name].source for name in rows] == ["stated", "default", "default"]
    shown = [vars_of(used) for used in rows.values()]
    assert default_sigmas(shown) == (
        "Sigmas not given, defaults used: position_m 0.0005 m (a.csv), rotation_deg 0.02 deg (a.csv)."
    )
    assert ["static_state", "a.csv", "tension_N", "3 N", "stated"] in sigmas(shown).rows


def vars_of(used):
    return {name: getattr(used, name) for name in ("kind", "file", "sigma", "value", "words", "source")}


def test_a_sigma_column_is_told(clean):
    campaign = replace(clean, sheets=(sheet((), ("cable", "tension_N", "sigma")),))
    assert sigmas_used(campaign)[0].source == "column sigma, else default"


@pytest.mark.parametrize(("name", "value", "word"), [("position_m", 0.5, "large"), ("tension_N", 5e-6, "small")])
def test_an_absurd_sigma_is_doubted(clean, name, value, word):
    (text,) = warnings(replace(clean, sheets=(sheet({name}, **{name: value}),)))
    assert f"sigma.{name} of a.csv" in text
    assert word in text


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [("anchor_m", 0.5, "is it in m?"), ("axial_stiffness", 2.0, "is it relative to the value?")],
)
def test_an_absurd_tolerance_is_doubted(clean, name, value, words):
    text, *_ = warnings(replace(clean, tolerances=replace(clean.tolerances, **{name: value})))
    assert f"the tolerance {name}, {value:g}, is very large" in text
    assert words in text


def test_errors_far_below_their_sigmas_are_told(clean):
    assert warnings(clean, [NoiseOfKind("tension", 1.0, 60, 0, 0.5, 0.5)]) == []
    (text,) = warnings(clean, [NoiseOfKind("tension", 0.2, 60, 0, 1.0, 1e-9)])
    assert "errors of the tension readings are improbably small" in text


@pytest.mark.parametrize("factor", [2.0, 3.0])
def test_a_sigma_stated_too_small_is_told(clean, factor):
    """Twin: the sigma as stated, and one that is a fifth too small, are no warning."""
    (text,) = warnings(clean, [NoiseOfKind.of("tension", factor, 96, 0)])
    assert f"tension readings scatter by {factor:.2g} times their stated sigma" in text
    assert warnings(clean, [NoiseOfKind.of("tension", 1.0, 96, 0), NoiseOfKind.of("length", 1.2, 96, 0)]) == []


def test_screen_and_page_show_the_warning_as_a_sentence(tmp_path, capsys):
    """A sigma of a metre, and a table without angles."""
    root = Path(__file__).parents[2] / "examples" / "table-4-4"
    states = pd.read_csv(root / "level.csv", comment="#").drop(columns=["rx_deg", "ry_deg", "rz_deg"], errors="ignore")
    states.to_csv(tmp_path / "level.csv", index=False)
    text = re.sub("position_m = [^,} ]+", "position_m = 1.0", (root / "level.toml").read_text())
    (tmp_path / "level.toml").write_text(text)
    assert run(["diagnose", str(tmp_path / "level.toml"), "--out", str(tmp_path / "o")]) == 0
    shown = capsys.readouterr().out
    said = json.loads((tmp_path / "o" / "result.json").read_text())["warnings"]
    page = (tmp_path / "o" / "report.html").read_text()
    assert any("sigma.position_m" in sentence and sentence.endswith("?") for sentence in said)
    assert any("rx_deg" in sentence and sentence.endswith(".") for sentence in said)
    assert [f"Warning: {sentence}" in shown for sentence in said] == [True] * len(said)
    assert [f"<p>Warning: {escape(typeset(sentence))}</p>" in page for sentence in said] == [True] * len(said)
