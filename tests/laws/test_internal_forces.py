"""Internal force beside what the simulation commands: the split, and when it is said to be another one.

Readings of the entered robot itself, its lengths and tensions moved as controllers would (crime=True).
"""

import numpy as np
import pytest

from cdpr_struct.diagnosis.internal_forces import _Deviation, force_split, internal_forces
from cdpr_struct.diagnosis.sensor_sigmas import noise_of_kinds
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.residuals.commanded_lengths import aligned, commanded_at, null_space
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded
from tests.laws.written_campaigns import cogiro, noisy, plan_of, with_states, written

NEWTONS = np.array([12.0, -8.0])  # along each direction, rms over the cables
FAR = 15.0 * np.linalg.norm(NEWTONS)


def held() -> Campaign:
    """Six poses of CoGiRo with the tensions and lengths that the simulation commands."""
    return written(cogiro(), plan_of(cogiro(), 6))


def of_null_space(campaign: Campaign) -> tuple[np.ndarray, np.ndarray]:
    """(S, m) changes of tensions and lengths by `NEWTONS` of internal force in every state."""
    data = recorded(campaign)
    place, turn = data.readings.position, data.readings.rotation
    null = [null_space(campaign.robot, *pose) for pose in zip(place, turn, strict=True)]
    sent = commanded_at(campaign, place, turn, np.ones(len(null), dtype=bool))
    tension = np.array([aligned(own, null[0]) @ NEWTONS for own in null])
    return tension, sent.internal @ NEWTONS


def found_in(campaign: Campaign):
    data = recorded(campaign)
    where = layout(data)
    null = judged(data, where, Hypothesis())
    return internal_forces(data, where, null, noise_of_kinds(null))


def moved(tensions: float, lengths: float, seed: int) -> Campaign:
    campaign = held()
    force, paid = of_null_space(campaign)
    states = campaign.states
    changed = with_states(campaign, tension=states.tension + tensions * force, length=states.length + lengths * paid)
    return noisy(changed, seed)


def test_other_internal_forces_are_found_with_their_size():
    said = found_in(moved(1.0, 1.0, 1))
    assert said.found
    assert said.probability > 0.99
    assert said.size == pytest.approx(np.linalg.norm(NEWTONS), rel=0.15)  # 2 N of noise in 48 cells
    assert said.split.share.min() > 0.8


@pytest.mark.parametrize(("tensions", "lengths"), [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
def test_a_controller_that_holds_lengths_or_forces_as_simulated_is_no_finding(tensions, lengths):
    """Tolerances of lengths move the forces where lengths are held, and the lengths where forces are."""
    said = found_in(moved(tensions, lengths, 2))
    assert not said.found


def test_the_split_is_orthogonal_and_sees_internal_force_alone():
    """Of internal force all is internal; of what the platform feels nothing."""
    campaign = held()
    force, _ = of_null_space(campaign)
    inner = force_split(recorded(with_states(campaign, tension=campaign.states.tension + force)))
    assert inner.share == pytest.approx(1.0, abs=1e-6)
    assert inner.rms == pytest.approx(np.linalg.norm(NEWTONS), rel=1e-6)
    data = recorded(campaign)
    null = np.array(
        [null_space(campaign.robot, p, r) for p, r in zip(data.readings.position, data.readings.rotation, strict=True)]
    )
    across = np.ones_like(force) - (null @ (np.swapaxes(null, 1, 2) @ np.ones((*force.shape, 1))))[..., 0]
    outer = force_split(recorded(with_states(campaign, tension=campaign.states.tension + across)))
    assert outer.share == pytest.approx(0.0, abs=1e-6)
    assert (outer.rms**2).tolist() == pytest.approx((np.ones_like(outer.rms) * (across**2).mean(axis=1)).tolist())


def test_one_state_alone_is_no_finding():
    """A fifth of the states, however far off, says nothing of the others."""
    value = np.zeros((6, 2))
    covariance = np.repeat(np.eye(2)[None], 6, axis=0)
    value[3] = FAR
    assert _Deviation(value, covariance).gain < 0.0
    assert _Deviation(np.full((6, 2), 4.0), covariance).gain > 5.0


def test_no_tensions_or_no_redundancy_say_nothing():
    campaign = held()
    assert force_split(recorded(with_states(campaign, tension=np.full_like(campaign.states.tension, np.nan)))) is None
    assert found_in(with_states(campaign, length=np.full_like(campaign.states.length, np.nan))).gain is None
