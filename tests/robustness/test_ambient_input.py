"""Ambient records that cannot be used: one sentence with file, place and remedy, and exit code 2."""

import sys

import numpy as np
import pandas as pd
import pytest

from cdpr_struct.cli.main import run

pytest.importorskip("pyoma2")
RATE, COUNT = 25.0, 3000
CAMPAIGN = 'robot = "six-cable-4mm"\n[[measurement]]\nkind = "ambient"\nfile = "wind.csv"\n'


@pytest.fixture
def told(tmp_path, capsys):
    """(change of the table, further lines of the campaign) -> what stands on the screen; the exit code is 2."""

    def of(change, more=""):
        generator = np.random.default_rng(3)
        table = pd.DataFrame(generator.normal(size=(COUNT, 3)).round(4), columns=["ax", "ay", "az"])
        table.insert(0, "time_s", (np.arange(COUNT) / RATE).round(4))
        table[["x_m", "y_m", "z_m"]] = [0.4, 0.3, 0.6]
        change(table).to_csv(tmp_path / "wind.csv", index=False)
        (tmp_path / "campaign.toml").write_text(CAMPAIGN + more)
        assert run(["ambient", str(tmp_path / "campaign.toml"), "--out", str(tmp_path / "out")]) == 2
        captured = capsys.readouterr()
        assert captured.out == ""
        assert not (tmp_path / "out").exists()
        lines = captured.err.strip().splitlines()
        assert len(lines) == 1, captured.err
        return lines[0]

    return of


def with_value(column, rows, value):
    def change(table):
        table[column] = table[column].astype(object)
        table.loc[rows, column] = value
        return table

    return change


def clipped(table):
    table["ax"] = table["ax"].clip(-1.5, 1.5)
    return table


BAD = {
    "empty cell": (with_value("ay", [70], ""), "", ["wind.csv", "row 71, column ay", "is missing", "a number"]),
    "nan": (with_value("ay", [70], "nan"), "", ["row 71, column ay", "a finite number"]),
    "gap": (lambda t: t.drop(index=range(900, 950)), "", ["column time_s", "a step of 2.04 s", "even steps"]),
    "dead": (with_value("az", slice(None), 0.013), "", ["column az", "dead channel, 0.013", "leave the column out"]),
    "drop-out": (with_value("az", slice(500, 600), 0.013), "", ["column az", "101 samples from 20 s on"]),
    "clipped": (clipped, "", ["column ax", "at 1.5: clipped", "a range of the sensor"]),
    "too short": (lambda t: t[:1500], "", ["duration", "60 s", "96 s or more"]),
    "too slow": (lambda t: t, "band_hz = [1.0, 15.0]\n", ["sampling rate", "25 Hz", "37.5 Hz or more"]),
    "wanted too fast": (lambda t: t, "frequencies_hz = [3.0, 11.0]\n", ["sampling rate", "27.5 Hz or more"]),
    "too short for the mode": (lambda t: t, "band_hz = [0.2, 9.0]\n", ["duration", "120 s", "500 s or more"]),
    "band": (lambda t: t, "band_hz = [9.0, 2.0]\n", ["measurement[1].band_hz", "the lower one first"]),
    "order": (lambda t: t, "order = 7\n", ["measurement[1].order", "got 7", "even number of states"]),
    "no channel": (lambda t: t[["time_s", "x_m", "y_m", "z_m"]], "", ["ax, ay, az or a_NAME", "is missing"]),
    "misspelt channel": (lambda t: t.rename(columns={"az": "za"}), "", ["wind.csv", "za"]),
    "two poses": (
        lambda t: with_value("x_m", slice(2000, None), 0.5)(t).assign(case="a"), "", ["case a", "one pose a case"],
    ),
    "lengths": (lambda t: t.assign(length_1_m=6.0), "", ["length_1_m", "unknown for ambient"]),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_one_sentence(name, told):
    change, more, words = BAD[name]
    said = told(change, more)
    assert all(word in said for word in words), said


def test_without_the_extra_it_says_what_to_install(told, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyoma2.functions.ssi", None)
    said = told(lambda t: t)
    assert "no package `pyOMA-2`" in said
    assert "pip install 'cdpr-struct[ambient]'" in said


def test_the_keys_are_of_ambient_records_only(tmp_path, capsys):
    pd.DataFrame({"case": ["a"], "x_m": 0.4, "y_m": 0.3, "z_m": 0.6, "frequency_hz": 2.0}).to_csv(tmp_path / "f.csv")
    text = 'robot = "six-cable-4mm"\n[[measurement]]\nkind = "robot_frequency"\nfile = "f.csv"\norder = 8\n'
    (tmp_path / "campaign.toml").write_text(text)
    assert run(["diagnose", str(tmp_path / "campaign.toml")]) == 2
    assert 'measurement[1].order: got 8; this key beside kind = "ambient" only' in capsys.readouterr().err
