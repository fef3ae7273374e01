"""Sigmas that nobody gave are told, and those that cannot be right are doubted."""

import json
import re
from dataclasses import replace
from html import escape
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.diagnosis.null_model import NullModel
from cdpr_struct.diagnosis.sigma_check import sigmas_used, warnings
from cdpr_struct.measurement.campaign import Sheet, Sigmas
from cdpr_struct.reports.diagnosis_tables import default_sigmas, sigma_table
from tests.laws.crime_campaign import clean_campaign


@pytest.fixture(scope="module")
def clean():
    return clean_campaign()


def found(campaign, spread=1.0):
    """60 residuals of static states that scatter by `spread` of their sigma."""
    noise = np.random.default_rng(3).standard_normal(60) * spread
    labels = SimpleNamespace(
        block=np.array(["EQ"] * 60, dtype=object), kind=np.array(["static_state"] * 60, dtype=object),
        state=np.zeros(60, dtype=int),
    )  # fmt: skip
    null = NullModel(noise, np.eye(60), np.eye(60))
    return SimpleNamespace(campaign=campaign, entered=null, entered_setting=SimpleNamespace(labels=labels))


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
    assert ["static_state", "a.csv", "tension_N", "3 N", "stated"] in sigma_table(shown).rows


def vars_of(used):
    return {name: getattr(used, name) for name in ("kind", "file", "sigma", "value", "words", "source")}


def test_a_sigma_column_is_told(clean):
    campaign = replace(clean, sheets=(sheet((), ("cable", "tension_N", "sigma")),))
    assert sigmas_used(campaign)[0].source == "column sigma, else default"


@pytest.mark.parametrize(("name", "value", "word"), [("position_m", 0.5, "large"), ("tension_N", 5e-6, "small")])
def test_an_absurd_sigma_is_doubted(clean, name, value, word):
    (text,) = warnings(found(replace(clean, sheets=(sheet({name}, **{name: value}),))))
    assert f"sigma.{name} of a.csv" in text
    assert word in text


@pytest.mark.parametrize(
    ("name", "value", "words"), [("anchor_m", 0.5, "is it in m?"), ("axial_stiffness", 2.0, "is it a share of it?")]
)
def test_an_absurd_tolerance_is_doubted(clean, name, value, words):
    text, *_ = warnings(found(replace(clean, tolerances=replace(clean.tolerances, **{name: value}))))
    assert f"the tolerance {name}, {value:g}, is very large" in text
    assert words in text


def test_residuals_far_below_their_sigmas_are_told(clean):
    assert warnings(found(clean)) == []
    (text,) = warnings(found(clean, 0.2))
    assert "smaller than their sigmas" in text


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
    assert [f"<p>Warning: {escape(sentence)}</p>" in page for sentence in said] == [True] * len(said)
