"""Data that are wrong without any cause in the robot: one reading, noise with a memory, cells that are not linear."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.causes.handling import corrections
from cdpr_struct.diagnosis.diagnose import diagnose
from cdpr_struct.diagnosis.gross_reading import without_gross_tension
from cdpr_struct.diagnosis.handled_data import handled
from cdpr_struct.diagnosis.handling_screen import _worthwhile, best_correction
from cdpr_struct.diagnosis.null_model import null_model, reading_count, sensors
from cdpr_struct.diagnosis.prepared import BUDGETS, prepare
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.setting import make_setting
from cdpr_struct.diagnosis.suspect_reading import in_words, set_aside, suspect
from cdpr_struct.diagnosis.verdict import verdict
from cdpr_struct.diagnosis.wandering_noise import likeliest_memory, remembered
from cdpr_struct.diagnosis.world import World
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.crime_campaign import clean_campaign

SMALL = BUDGETS["small"]


def quiet(_):
    return None


def noisy(memory=0.0, seed=8, count=6):
    """Readings with noise of their certificates, each sensor's remembered from state to state."""
    campaign, generator = clean_campaign(count), np.random.default_rng(seed)
    states = campaign.states

    def noise(sigma):
        fresh = generator.standard_normal(sigma.shape)
        for i in range(1, len(fresh)):
            fresh[i] = memory * fresh[i - 1] + np.sqrt(1.0 - memory**2) * fresh[i]
        return sigma * fresh

    return replace(
        campaign,
        states=replace(
            states,
            position=states.position + noise(np.repeat(states.sigma_position[:, None], 3, axis=1)),
            tension=states.tension + noise(states.tension_sigma),
            length=states.length + noise(states.length_sigma),
        ),
    )


def with_tension(campaign, state, cable, more):
    tension = campaign.states.tension.copy()
    tension[state, cable] += more
    return replace(campaign, states=replace(campaign.states, tension=tension))


def test_noise_alone_has_no_suspect():
    assert suspect(prepare(noisy(), SMALL).ground) is None


@pytest.mark.parametrize("sigmas", [8.0, -12.0])
def test_one_wrong_tension_is_found_and_set_aside(sigmas):
    campaign = with_tension(noisy(), 2, 3, 2.0 * sigmas)
    found = handled(campaign, SMALL, quiet)
    (wrong,) = found.aside
    assert (wrong.kind, wrong.state, wrong.cable) == ("tension", 2, 3)
    assert 0.5 * abs(sigmas) < wrong.sigmas < 1.6 * abs(sigmas)
    assert found.prepared.p_value > 0.02
    assert found.entered is found.prepared
    assert in_words(campaign, wrong) == "the tension of cable 4 in case s2"


def test_a_wrong_reading_is_told_where_nothing_is_significant():
    campaign = with_tension(noisy(seed=1), 2, 3, 16.0)
    assert prepare(campaign, SMALL).p_value > 0.02
    (wrong,) = handled(campaign, SMALL, quiet).aside
    assert (wrong.kind, wrong.state, wrong.cable) == ("tension", 2, 3)


def test_a_wrong_length_and_a_wrong_frequency_are_found():
    campaign = noisy()
    length, hertz = campaign.states.length.copy(), campaign.cable_frequencies.hertz.copy()
    length[4, 1] += 0.02
    (wrong,) = handled(replace(campaign, states=replace(campaign.states, length=length)), SMALL, quiet).aside
    assert (wrong.kind, wrong.state, wrong.cable) == ("length", 4, 1)
    hertz[7] *= 1.05
    rows = replace(campaign.cable_frequencies, hertz=hertz)
    (wrong,) = handled(replace(campaign, cable_frequencies=rows), SMALL, quiet).aside
    assert (wrong.kind, wrong.row) == ("cable_frequency", 7)


@pytest.mark.parametrize("read", [0.0, 1e-3, 0.15, 3.0, 1000.0], ids=str)
def test_a_tension_that_cannot_be_computed_with_is_replaced(read):
    """A dead cell, kN for N, a digit too many: such a cable would sag or be another robot's, and hide the slip."""
    campaign = noisy()
    right = campaign.states.tension[2, 3]
    mended, wrong = without_gross_tension(with_tension(campaign, 2, 3, (read - 1.0) * right))
    assert (wrong.kind, wrong.state, wrong.cable) == ("tension", 2, 3)
    assert wrong.sigmas == pytest.approx(abs(read - 1.0) * right / 2.0, rel=0.1)
    assert mended.states.tension[2, 3] == pytest.approx(right, rel=0.05)
    assert mended.states.tension_sigma[2, 3] > 30.0
    assert without_gross_tension(mended) is None


def test_what_several_readings_share_is_no_gross_tension():
    campaign = noisy()
    tension = campaign.states.tension
    for wrong in (tension + 60.0 * np.eye(8)[3], 1.4 * tension, tension + 100.0 * np.eye(6)[2][:, None]):
        assert without_gross_tension(replace(campaign, states=replace(campaign.states, tension=wrong))) is None
    assert without_gross_tension(campaign) is None


def test_a_dead_cell_is_told_and_nothing_else():
    campaign = noisy()
    said = verdict(diagnose(with_tension(campaign, 2, 3, 0.2 - campaign.states.tension[2, 3])))
    assert said.status == "adequate"
    assert "Contradicts all other readings: the tension of cable 4 in case s2" in said.sentence


def test_a_load_cell_that_is_off_in_all_states_is_no_wrong_reading():
    campaign = noisy()
    tension = campaign.states.tension + np.eye(8)[3] * 16.0
    found = handled(replace(campaign, states=replace(campaign.states, tension=tension)), SMALL, quiet)
    assert not found.aside
    assert found.prepared.p_value < 1e-3


def test_only_the_sigma_of_the_wrong_reading_changes():
    campaign = with_tension(noisy(), 2, 3, 16.0)
    wrong = suspect(prepare(campaign, SMALL).ground)
    wider = set_aside(campaign, wrong).states.tension_sigma / campaign.states.tension_sigma
    assert wider[2, 3] == pytest.approx(np.hypot(1.0, wrong.sigmas))
    assert (np.delete(wider.ravel(), 2 * 8 + 3) == 1.0).all()


def test_noise_with_a_memory_is_told_from_noise_without():
    for memory, low, high in ((0.0, -np.inf, 0.0), (0.7, 8.0, np.inf)):
        campaign = noisy(memory, count=18)
        setting, _ = make_setting(campaign)
        null = null_model(setting, World.of(campaign.robot, 18), Readings.of(campaign.states))
        found, gain = likeliest_memory(null.columns, null.r, sensors(setting))
        assert low < gain < high
        assert memory == 0.0 or found in (0.4, 0.7, 0.9)


def test_a_few_readings_tell_no_memory():
    """Four that are all off look alike whether the noise wanders or something is wrong."""
    campaign = noisy(0.9, seed=3, count=4)
    states = campaign.states
    off = replace(campaign, states=replace(states, length=states.length + 0.004))
    assert handled(off, SMALL, quiet).campaign.memory == 0.0
    assert handled(off, SMALL, quiet).prepared.p_value < 1e-3


def test_memory_correlates_a_sensor_with_itself_only():
    campaign = clean_campaign()
    setting, _ = make_setting(campaign)
    total = reading_count(setting) + 400
    mixed = remembered(np.eye(total), sensors(setting), 0.5)
    covariance = mixed @ mixed.T
    np.testing.assert_allclose(np.diagonal(covariance), 1.0)
    tension = 6 * 6 + 8 * np.arange(6) + 3
    np.testing.assert_allclose(covariance[tension[0], tension], 0.5 ** np.arange(6))
    assert covariance[tension[0]].sum() == pytest.approx((0.5 ** np.arange(6)).sum())


def test_the_sentence_says_which_reading_was_set_aside():
    said = verdict(diagnose(with_tension(noisy(), 2, 3, 16.0)))
    assert said.status == "adequate"
    assert "the tension of cable 4 in case s2" in said.sentence
    assert said.next_measurement == "read again the tension of cable 4 in case s2"


def test_a_cell_that_is_not_linear_is_not_told_as_gain_and_zero():
    campaign = noisy()
    tension = campaign.states.tension
    bent = replace(campaign, states=replace(campaign.states, tension=tension + 15.0 * (tension / 300.0) ** 2))
    said = verdict(diagnose(bent))
    assert said.status == "unknown"
    assert said.location
    assert f"repeat what is worst: {said.location}" in said.next_measurement
    assert "One law explains it better" in said.sentence
    assert "the load cells: a law other than gain and zero" in said.sentence
    assert "names the robot" not in said.sentence


def test_units_of_payloads_are_tried_where_only_locked_poses_have_any():
    """Static states decide which corrections are worth the whole computation; here they say nothing of payloads."""
    campaign = clean_campaign(5)
    locked = np.arange(5)[:, None] >= 2
    tension, sigma = (np.where(locked, np.nan, v) for v in (campaign.states.tension, campaign.states.tension_sigma))
    payload = np.array([0.0, 0.0, 200.0, 400.0, 600.0])
    states = replace(campaign.states, tension=tension, tension_sigma=sigma, payload=payload)
    tried = {c.sentence for c in _worthwhile(replace(campaign, states=states), angular_peaks=False)}
    assert "the payloads are in N" in tried


def test_readings_of_another_robot_are_unknown_and_the_robot_is_asked_for():
    said = verdict(diagnose(replace(noisy(), robot=load_robot("thesis-3-1"))))
    assert said.status == "unknown"
    assert "see whether the campaign names the robot that was measured" in said.sentence


def test_gain_and_zero_of_the_cells_are_told_as_such():
    campaign = noisy()
    tension = 1.03 * campaign.states.tension + 12.0
    said = verdict(diagnose(replace(campaign, states=replace(campaign.states, tension=tension))))
    assert set(said.causes) == {"load_cell_gain", "load_cell_bias"}


def test_a_single_wrong_angle_is_no_wrong_unit():
    """With one tilted state, dividing its angle by 57 hides the tilt as well as any unit would."""
    campaign = noisy()

    def angle_units(angles):
        new = replace(campaign, states=replace(campaign.states, angles=angles))
        return [c for c in corrections(new) if "angles" in c.sentence and c.cause == "unit_error"]

    angles = 1e-4 * campaign.states.angles
    angles[3, 0] = 0.35
    assert not angle_units(angles)
    angles[2, 1] = 0.1
    assert angle_units(angles)
    assert angle_units(campaign.states.angles / 57.3**2)  # rad taken for deg, however small


def test_no_correction_is_made_twice():
    campaign = noisy()
    wrong = replace(campaign, states=replace(campaign.states, tension=0.1 * campaign.states.tension))
    correction, _ = best_correction(wrong, prepare(wrong, SMALL).fine.level, [])
    again = best_correction(wrong, prepare(wrong, SMALL).fine.level, [correction])
    assert again is None or again[0].sentence != correction.sentence


def test_the_modes_of_cables_do_not_depend_on_the_unit_of_what_was_read():
    """Cable frequencies filed sixty times too high or too low: the model's own are the same, and as soon there."""
    campaign = clean_campaign()
    rows = campaign.cable_frequencies
    gaps = [
        make_setting(replace(campaign, cable_frequencies=replace(rows, hertz=factor * rows.hertz)))[0].cable_gap
        for factor in (1.0, 60.0, 1.0 / 60.0)
    ]
    assert np.ptp(gaps, axis=0).max() < 1e-9
    assert np.abs(gaps[0]).max() > 1e-6
