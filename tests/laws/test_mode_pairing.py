"""Unlabelled peaks and modes: shared tolerances sharpen the pairing, competing pairings raise the doubt."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from cdpr_struct.diagnosis.causes.registry import LIBRARY
from cdpr_struct.diagnosis.evidence import Candidate, choice
from cdpr_struct.diagnosis.mode_pairing import Modes, paired
from cdpr_struct.diagnosis.setting import make_setting, paired_with, strays_in
from cdpr_struct.diagnosis.stray_peaks import _trial, p_of_strays
from cdpr_struct.diagnosis.world import World
from cdpr_struct.errors import CdprError
from cdpr_struct.measurement.campaign import RobotFrequencies
from tests.laws.crime_campaign import clean_campaign, with_robot_frequencies

HERTZ = np.array([1.0, 1.06, 1.5, 1.9, 2.02, 3.0])


def modes(energy=None):
    count = len(HERTZ)
    share = np.ones(count) if energy is None else np.asarray(energy)
    return Modes(np.zeros(count, dtype=int), HERTZ, np.zeros((count, 6)), share)


def given(peaks, modes, covariance):
    """Pairing of peaks of one state, noise 0.3 %, shapes not measured."""
    count = len(peaks)
    unlike = np.zeros((count, len(HERTZ)))
    return paired(np.zeros(count, dtype=int), np.asarray(peaks), np.full(count, 0.003), modes, covariance, unlike)


def pairing(chosen, shift, covariance):
    peaks = HERTZ[chosen] * np.exp(shift)
    return given(peaks, modes(), covariance)


def test_a_common_shift_is_learned_from_the_clear_peaks():
    """All modes 5 % higher, tolerances shared: every peak finds its mode though neighbours are nearer."""
    chosen = [0, 2, 3, 5]
    shared = 0.03**2 + 1e-5 * np.eye(len(HERTZ))
    found = pairing(chosen, 0.05, shared)
    assert found.chosen.tolist() == chosen
    assert found.doubt.max() < 0.01


def test_without_the_shared_tolerance_the_same_peaks_go_astray():
    alone = 0.03**2 * np.eye(len(HERTZ))
    assert pairing([0, 2, 3, 5], 0.05, alone).chosen.tolist() != [0, 2, 3, 5]


def test_two_partners_alike_mean_doubt_of_half_their_distance():
    covariance = 0.04**2 * np.eye(len(HERTZ))
    peak = np.sqrt(HERTZ[0] * HERTZ[1])
    found = given([peak], modes(), covariance)
    between = abs(np.log(HERTZ[1] / HERTZ[0]))
    assert found.chosen[0] in (0, 1)
    assert 0.5 * between < found.doubt[0] < between


def test_a_mode_without_platform_motion_is_left_to_others():
    """Of two modes equally far the one in which the platform moves is taken."""
    covariance = 0.04**2 * np.eye(len(HERTZ))
    peak = np.sqrt(HERTZ[0] * HERTZ[1])
    share = [0.05, 1.0, 1.0, 1.0, 1.0, 1.0]
    found = given([peak], modes(share), covariance)
    assert found.chosen[0] == 1


def test_a_stray_peak_is_in_doubt():
    covariance = 0.001**2 * np.eye(len(HERTZ))
    found = given([2.5], modes(), covariance)
    assert found.doubt[0] > 0.2


def test_strays_are_counted():
    covariance = 0.001**2 * np.eye(len(HERTZ))
    assert given([1.0, 1.5], modes(), covariance).stray.sum() < 0.01
    assert given([1.0, 2.5], modes(), covariance).stray.sum() > 0.99


def test_one_stray_is_nothing_and_several_are_significant():
    """Of 15 peaks, each a stray with e^-6: two or more with 6.3e-4."""
    assert p_of_strays(1.0, 15) == 1.0
    chance = np.exp(-6.0)
    assert p_of_strays(2.0, 15) == pytest.approx(1.0 - (1 - chance) ** 15 - 15 * chance * (1 - chance) ** 14)
    assert p_of_strays(3.0, 15) < 1e-4


def test_strays_of_a_world_are_counted_roughly_without_following_its_modes():
    """Peaks of a robot whose platform turns 1.7 times as heavily: none astray in its own world, some in the entered."""
    campaign = clean_campaign()
    entered = World.of(campaign.robot, len(campaign.states.names))
    true = replace(entered, inertia=1.7 * entered.inertia)
    setting, _ = make_setting(with_robot_frequencies(campaign, (0, 1, 2), true))
    assert strays_in(setting, true) < 0.2
    assert paired_with(setting, entered).strays > 1.5
    assert strays_in(setting, entered) == pytest.approx(paired_with(setting, entered).strays, rel=0.3)


def test_a_large_change_that_no_pose_would_stand_is_no_explanation():
    """With its centre of mass 30 m above it the platform tips over: no modes, so no peak is explained; 1 cm is one."""
    campaign = clean_campaign()
    guess = RobotFrequencies(np.array([0, 1, 2]), np.full(3, 6.5), np.full(3, 0.02))
    setting, _ = make_setting(replace(campaign, robot_frequencies=guess))
    entered, cause = World.of(campaign.robot, len(campaign.states.names)), LIBRARY["center_of_mass"]
    pattern = cause.patterns(setting)[0]
    candidate = Candidate(cause, np.zeros((len(setting.labels), len(pattern.basis))), [pattern])
    up = np.eye(len(pattern.prior))[-1] / pattern.prior[-1]
    ground = SimpleNamespace(setting=setting)
    tried = [_trial(ground, entered, choice(candidate, pattern, 1.0), height * up) for height in (0.01, 30.0)]
    assert np.isfinite(tried[0].strays)
    assert tried[1].strays == np.inf


def test_a_state_that_cannot_hold_says_which_and_what_to_look_at():
    """The right robot has modes there; one whose centre of mass lies far above its cables falls over."""
    campaign = clean_campaign()
    campaign = with_robot_frequencies(campaign, (1,), World.of(campaign.robot, 6))
    top = replace(campaign.robot.platform, center_of_mass=np.array([0.0, 0.0, 50.0]))
    with pytest.raises(CdprError, match=r"case s1: the equilibrium is unstable.*the robot that was measured"):
        make_setting(replace(campaign, robot=replace(campaign.robot, platform=top)))
