"""Noise that goes on from one reading to the next is neither a cause nor taken for independent.

The same model writes and judges (crime=True); what the diagnosis is worth is measured in `tests/blind`.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.hypotheses.correlated import CORRELATION, Correlated, may_be_correlated, slow_waves
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.frames import Frames
from cdpr_struct.reports.diagnose.sentences import sentence
from cdpr_struct.residuals.recorded import recorded
from tests.laws.written_campaigns import cogiro, lighter, plan_of, with_states, written

STATES = 18


def wandering(rng: np.random.Generator, shape: tuple[int, ...], correlation: float) -> np.ndarray:
    """Noise of unit variance, each row correlated with the one before."""
    rows = rng.normal(size=shape)
    for k in range(1, len(rows)):
        rows[k] = correlation * rows[k - 1] + np.sqrt(1.0 - correlation**2) * rows[k]
    return rows


@cache
def clean(mass: float = 0.0) -> Campaign:
    plan = plan_of(cogiro(), STATES, cables_in=(0, 1, 2))
    return written(lighter(mass), plan, cogiro())


def read(correlation: float, mass: float = 0.0, seed: int = 1) -> Campaign:
    """Readings with noise of that correlation in the order of the file; of cable frequencies by mode."""
    rng, campaign = np.random.default_rng(seed), clean(mass)
    states, cables = campaign.states, campaign.cable_frequencies
    off = wandering(rng, (STATES, 6 + 2 * states.tension.shape[1]), correlation)
    hertz = cables.hertz.copy()
    for mode in np.unique(cables.mode):
        rows = cables.mode == mode
        hertz[rows] *= 1.0 + cables.sigma[rows] / hertz[rows] * wandering(rng, (rows.sum(),), correlation)
    pose, tension, length = np.split(off, [6, 6 + states.tension.shape[1]], axis=1)
    moved = with_states(
        campaign,
        position=states.position + pose[:, :3] * states.sigma_position[:, None],
        angles=states.angles + pose[:, 3:] * states.sigma_rotation[:, None],
        tension=states.tension + tension * states.tension_sigma,
        length=states.length + length * states.length_sigma,
    )
    return replace(moved, cable_frequencies=replace(cables, hertz=hertz))


def test_slow_functions_and_independent_noise_make_the_covariance():
    order = np.arange(STATES)
    wanted = CORRELATION ** np.abs(order[:, None] - order)
    waves = slow_waves(STATES, CORRELATION)
    assert 4 <= waves.shape[1] <= 6
    rest = wanted - waves @ waves.T
    assert np.linalg.eigvalsh(rest).max() < 1.0
    assert np.abs(np.diag(waves @ waves.T, 1)).min() > 0.5


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.slow), pytest.param(3, marks=pytest.mark.slow)])
def test_correlated_noise_is_no_cause_and_is_said(seed):
    said = diagnosed(read(CORRELATION, seed=seed))
    assert said.decision.status == "adequate"
    assert said.noise_correlation == CORRELATION
    assert said.drift is None
    assert all(0.75 < one.factor < 1.3 for one in said.noise)  # of the whole noise, its slow part included
    assert not said.doubts


def test_independent_noise_is_not_called_correlated():
    said = diagnosed(read(0.0))
    assert said.decision.status == "adequate"
    assert said.noise_correlation == 0.0


def test_a_wrong_mass_is_found_beside_correlated_noise():
    said = diagnosed(read(CORRELATION, mass=6.0))
    assert said.noise_correlation == CORRELATION
    assert any("platform_mass" in names for names in said.decision.classes)
    assert "correlated from one reading to the next (by 0.7)" in sentence(said)


def test_frames_of_a_motion_and_few_states_are_not_asked():
    few = written(cogiro(), plan_of(cogiro(), 5), cogiro())
    assert may_be_correlated(recorded(few)) == []
    assert may_be_correlated(recorded(clean())) == [Correlated()]
    zero = np.zeros((STATES, 8, 2))
    still = Frames(zero, zero, np.zeros((STATES, 6)), np.zeros(STATES), np.ones(STATES, dtype=int), float(STATES))
    assert may_be_correlated(recorded(replace(clean(), frames=still))) == []


def test_what_is_left_beside_slow_functions_has_the_sigma_of_the_fast_ones():
    order = np.arange(400)
    variance = np.linalg.eigvalsh(CORRELATION ** np.abs(order[:, None] - order))
    assert Correlated().independent == pytest.approx(np.sqrt(variance[variance <= 1.0].mean()), rel=0.01)
