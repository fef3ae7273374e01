"""Peaks far from all modes that a sensor on the platform can see are said to be so, and only these."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.diagnosis.peaks_apart import peaks_apart
from cdpr_struct.hypotheses.budget import BUDGETS
from cdpr_struct.hypotheses.search import Search
from cdpr_struct.measurement.campaign import Campaign, RobotFrequencies
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.reports.diagnose.result import result_json
from cdpr_struct.residuals.recorded import recorded
from tests.laws.written_campaigns import SIGMA_HERTZ, cogiro, plan_of, with_states, written

THESIS = Path(__file__).parents[2] / "examples" / "section-4-3-3" / "campaign.toml"


def shaken(factor: float, seed: int) -> Campaign:
    """Two poses of CoGiRo whose platform modes are picked at `factor` times their frequency, and nothing else."""
    campaign = written(cogiro(), plan_of(cogiro(), 2, robot_in=(0, 1), modes=40))
    blank = np.full_like(campaign.states.tension, np.nan)
    bare = with_states(campaign, tension=blank, length=blank)
    seen = peaks_apart(Search(recorded(bare), BUDGETS["small"])).lists
    rng = np.random.default_rng(seed)
    state = np.repeat([0, 1], [len(one.predicted) for one in seen])
    hertz = factor * np.concatenate([one.predicted for one in seen])
    kept = rng.random(len(hertz)) < 0.8  # of the visible modes, as in tests/blind
    hertz = (hertz * (1.0 + SIGMA_HERTZ * rng.standard_normal(len(hertz))))[kept]
    return replace(bare, robot_frequencies=RobotFrequencies(state[kept], hertz, SIGMA_HERTZ * hertz))


@pytest.mark.parametrize("factor", [0.6, 1.6])
def test_a_common_factor_is_found(factor):
    said = peaks_apart(Search(recorded(shaken(factor, 1)), BUDGETS["small"]))
    assert said.found
    assert said.factor == pytest.approx(factor, rel=0.06)  # one and a half steps of the grid
    assert said.stiffness_per_mass == pytest.approx(said.factor**2)
    assert ("joint_compliance" in said.names) == (factor < 1.0)  # added compliance only softens


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_modes_where_they_are_predicted_are_no_finding(seed):
    assert not peaks_apart(Search(recorded(shaken(1.0, seed)), BUDGETS["small"])).found


def test_the_modes_of_the_thesis_lie_apart():
    """Section 4.3.3: 4.6 to 12.3 Hz measured, 2.8 to 6.6 Hz predicted."""
    said = peaks_apart(Search(recorded(load_campaign(str(THESIS))), BUDGETS["small"]))
    assert said.found
    assert 2.0 < said.stiffness_per_mass < 4.0


@pytest.mark.slow
def test_an_error_of_a_factor_of_two_is_significant():
    """Section 4.3.3 of the thesis: 4.6 to 12.3 Hz measured, 2.8 to 6.6 Hz predicted."""
    found = diagnosed(load_campaign(str(THESIS)))
    said = result_json(found)
    assert said["significant"]
    assert said["verdict"]["class"][0][:2] == ["axial_stiffness", "platform_mass"]
    assert 2.0 < said["peaks_apart"]["stiffness_per_mass"] < 4.0
    assert "4.6 5 6.7 8 12.3 Hz are measured" in said["verdict"]["sentence"]
