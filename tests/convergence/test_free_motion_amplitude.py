"""Does the example that tells large motion from friction know a pendulum, and say what it needs?"""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

import cdpr_struct.fem_reference as fem

EXAMPLE = Path(__file__).parents[2] / "examples" / "free_motion_amplitude.py"
LONG = 1.5  # m


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("free_motion_amplitude", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_parallel_cables_are_a_pendulum(example):
    """A platform on four parallel cables swings without turning: f = f0 (1 - a^2 / 16 + a^4 / 3072)."""
    corners = np.array([[x, y, 0.0] for x in (-0.2, 0.2) for y in (-0.3, 0.3)])
    cables = (fem.CableData(LONG, 1e5, 1e-5),) * 4
    body = fem.PlatformData(1.0, [0.0, 0.0, 0.0], 0.02 * np.eye(3))
    data = fem.RobotData(corners + np.array([0.0, 0.0, LONG]), corners, cables, body)
    rest = fem.solve_robot(data, np.array([0.0, 0.0, -4e-5]), np.eye(3), 2)
    for swing in (0.1, 0.3):
        speed = 2.0 * np.sin(0.5 * swing)  # of a pendulum that reaches this angle, over sqrt(g / L)
        found = example.large_motion_shifts(rest, np.array([LONG * speed]), 0.3)[0]
        assert found == pytest.approx(-(swing**2) / 16.0 + swing**4 / 3072.0, rel=0.02)


def test_a_campaign_without_recorded_motion_is_refused(example, monkeypatch, capsys):
    campaign = Path(__file__).parents[2] / "examples" / "table-4-4" / "campaign.toml"
    monkeypatch.setattr(sys, "argv", ["free_motion_amplitude.py", str(campaign)])
    with pytest.raises(SystemExit) as stopped:
        example.main()
    assert stopped.value.code == 2
    assert "no measurement of kind platform_motion" in capsys.readouterr().err
