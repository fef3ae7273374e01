"""A free vibration from the FEM, with noise, read as a campaign: the frequencies that join it are the FEM's."""

import json

import numpy as np
import pandas as pd
import pytest

import cdpr_struct.fem_reference as fem
from cdpr_struct.cli.main import run
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.measurement.campaign_file import load_campaign
from tests.conftest import at_rest

POSE = np.array([1.3, -0.8, 0.9])
TWIST = np.array([0.3, -0.2, 0.25, 0.1, 0.3, -0.2])
CAMPAIGN = 'robot = "thesis-3-1"\nmodel = "{model}"\n[[measurement]]\nkind = "{kind}"\nfile = "signal.csv"\n'
STEP, EVERY, DURATION = 0.0025, 4, 10.0  # s of the FEM, samples kept, s


@pytest.fixture(scope="module")
def vibration():
    """Time (n,), accelerations (n, 3), motion (n, 6) and the frequencies [Hz] and platform shares of the FEM."""
    mesh = solve_in_fem(at_rest("thesis-3-1", POSE), 20)
    history = fem.integrate(mesh, DURATION, STEP, TWIST, 0.01)
    modes = fem.robot_modes(mesh, 110)
    keep = slice(None, None, EVERY)
    return history.time[keep], history.platform_acceleration[keep, :3], history.platform[keep], modes


def written(tmp_path, kind, table, model="exact"):
    table.to_csv(tmp_path / "signal.csv", index=False)
    (tmp_path / "campaign.toml").write_text(CAMPAIGN.format(model=model, kind=kind))
    return tmp_path / "campaign.toml"


def decay_table(vibration, seed=11):
    time, acceleration, _, _ = vibration
    noise = np.random.default_rng(seed).normal(size=acceleration.shape) * 0.02 * acceleration.std()
    table = pd.DataFrame({"case": "stop", "time_s": time})
    table[["x_m", "y_m", "z_m"]] = POSE
    table[["ax", "ay", "az"]] = acceleration + noise
    return table


def motion_table(vibration, seed=12):
    time, _, motion, _ = vibration
    generator = np.random.default_rng(seed)
    table = pd.DataFrame({"case": "stop", "time_s": time})
    table[["x_m", "y_m", "z_m"]] = POSE + motion[:, :3] + 1e-4 * generator.normal(size=(len(time), 3))
    angles = np.degrees(motion[:, 3:]) + 0.005 * generator.normal(size=(len(time), 3))
    table[["rx_deg", "ry_deg", "rz_deg"]] = angles  # small: the rotation vector, to second order
    return table


@pytest.mark.parametrize(("kind", "make"), [("free_decay", decay_table), ("platform_motion", motion_table)])
def test_frequencies_are_those_of_the_fem(vibration, tmp_path, kind, make):
    """Each within 4 sigma of the FEM's as its time step bends it (tan(w' h / 2) = w h / 2); three or more join."""
    campaign = load_campaign(written(tmp_path, kind, make(vibration)))
    truth = np.arctan(np.pi * vibration[3].frequencies_hz * STEP) / (np.pi * STEP)
    rows = campaign.robot_frequencies
    assert campaign.states.names == ("stop",)
    assert np.abs(campaign.states.position[0] - POSE).max() < 0.01
    assert len(rows.hertz) >= 3
    for hertz, sigma in zip(rows.hertz, rows.sigma, strict=True):
        assert np.abs(truth - hertz).min() < 4.0 * sigma, (hertz, sigma)
        assert sigma < 0.01 * hertz


def test_diagnose_uses_the_signal_and_shows_its_peaks(vibration, tmp_path, capsys):
    """A platform 12 % too light in the robot file shows in the frequencies of a decay; with the right one, nothing."""
    path = written(tmp_path, "free_decay", decay_table(vibration))
    assert run(["diagnose", str(path), "--out", str(tmp_path / "right"), "--json"]) == 0
    right = json.loads(capsys.readouterr().out)
    assert not right["significant"]
    assert right["not_used"] == []
    assert sum(m["used"] for m in right["signals"][0]["modes"]) >= 3
    assert (tmp_path / "right" / "signal-1.svg").exists()
    assert "combination tones" in (tmp_path / "right" / "report.html").read_text()
    path.write_text(path.read_text() + "[nominal]\nplatform_mass = 45.0\n[tolerances]\nplatform_mass_kg = 0.2\n")
    assert run(["diagnose", str(path), "--json"]) == 0
    wrong = json.loads(capsys.readouterr().out)
    own = [next(r for r in result["simulation_error"] if r["kind"] == "robot_frequency") for result in (right, wrong)]
    assert own[1]["rms"] > 5.0 * own[0]["rms"]
