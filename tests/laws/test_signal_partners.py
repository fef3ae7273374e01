"""Signals made of the model's own modes, held against right and wrong robots: which peaks join, and what damps them."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from cdpr_struct.diagnosis.damped import damped
from cdpr_struct.diagnosis.damping_law import damping_finding
from cdpr_struct.diagnosis.damping_rows import _laws, damping_rows, left_out
from cdpr_struct.measurement.campaign import Sigmas
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.loss import Loss
from cdpr_struct.measurement.modal_estimate import Modes
from cdpr_struct.measurement.peak_kinds import MODE
from cdpr_struct.measurement.signal_records import SignalRecord
from cdpr_struct.measurement.signal_states import held_against, model_shapes, own_modes
from cdpr_struct.measurement.state_modes import state_modes
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.tolerances import Tolerances

ROBOT = load_robot("thesis-3-1")
STIFFER = replace(ROBOT, cables=tuple(replace(c, axial_stiffness=1.2 * c.axial_stiffness) for c in ROBOT.cables))
POSES = np.array([[0.0, 0.0, 0.5], [1.0, 0.5, 0.8], [-1.5, 1.0, 0.3]])
HIGHEST, TOLERANCE = 8.5, 0.3  # Hz; of the entered damping ratio, relative
CHANNELS = tuple(f"{respond}/f{excite}" for excite in "xyz" for respond in "xyz")


def modes_at(robot, pose):
    return state_modes(robot, pose, np.zeros(3), np.full(8, np.nan), HIGHEST, "exact")


def record(kind, number, axis, signal, channels):
    nan = np.full(8, np.nan)
    return SignalRecord(kind, f"s{number}", "made", axis, signal, channels, POSES[number], np.zeros(3), 0.0, nan)


def shaken(robot, number) -> Identified:
    """All modes of an FRF in which the platform moves at all, as a perfect fit would find them, without partners."""
    state = modes_at(robot, POSES[number])
    blank = record("frf", number, np.zeros(0), np.zeros((0, 9)), CHANNELS)
    keep = state.modes.platform_energy > 0.02
    hertz, ratio = state.hertz[keep], _laws(state)[0][keep]
    pole = 2.0 * np.pi * hertz * (-ratio + 1j * np.sqrt(1.0 - ratio**2))
    residue = model_shapes(state, blank)[keep] * (pole**2 / (2j * pole.imag))[:, None]
    count, small = len(hertz), 1e-3 * ratio
    found = Modes(hertz, 1e-5 * hertz, ratio, small, residue, np.full(count, 100.0), np.full(9, 1e-3))
    none = np.zeros(count, dtype=bool)
    return Identified(
        blank, found, None, found.hertz_sigma, (MODE,) * count, np.full(count, -1), none, ("",) * count, "", None
    )


def decay(robot, number, ratio_of, seed) -> Identified:
    """10 s of the platform after a push, by all modes of a robot whose damping ratios a law gives, identified."""
    state, generator = modes_at(robot, POSES[number]), np.random.default_rng(seed + number)
    ratio, time = ratio_of(state), np.arange(0.0, 10.0, 0.01)
    pole = state.modes.omega * (-ratio + 1j * np.sqrt(1.0 - ratio**2))
    push = state.modes.platform[:, :3] @ (60.0 * np.array([0.1, 0.06, 0.04]))
    signal = (np.exp(np.outer(time, pole)) * push * pole).real @ state.modes.platform[:, :3]
    signal = signal + 0.01 * generator.normal(size=signal.shape)
    measured = record("free_decay", number, time, signal, ("ax", "ay", "az"))
    return held_against(own_modes(measured, Sigmas()), robot, "exact")


@pytest.mark.parametrize("number", range(3))
def test_clear_peaks_join_though_the_entered_stiffness_is_wrong(number):
    """With EA 20 % off all modes with half of their energy in translation join, none paired with one of the cables."""
    item = held_against(shaken(STIFFER, number), ROBOT, "exact")
    truth = modes_at(STIFFER, POSES[number])
    share = 60.0 * (truth.modes.platform[:, :3] ** 2).sum(axis=1)
    for hertz in truth.hertz[share > 0.5]:
        i = int(np.abs(item.modes.hertz - hertz).argmin())
        assert item.used[i], (hertz, item.reason[i])
        assert item.state.modes.platform_energy[item.partner[i]] > 0.3
    slow = item.modes.hertz < 3.3  # clusters of the cables' first modes
    assert not item.used[slow].any()


def test_peaks_of_the_right_robot_find_their_own_modes():
    for number in range(3):
        item = held_against(shaken(ROBOT, number), ROBOT, "exact")
        own = item.state.hertz[item.partner[item.used]]
        np.testing.assert_allclose(own, item.modes.hertz[item.used], rtol=1e-9)
        assert left_out((item,)) == []


def test_several_modes_fitted_as_one_say_nothing_of_the_damping():
    """A peak twice as large as its partner, whose width would mean four times the damping."""
    whole = shaken(ROBOT, 1)
    item = held_against(whole, ROBOT, "exact")
    i = int(np.flatnonzero(item.used)[np.argmin(np.abs(item.modes.hertz[item.used] - 5.3))])
    size, ratio = whole.modes.shape.copy(), whole.modes.damping.copy()
    size[i], ratio[i] = 2.0 * size[i], 4.0 * ratio[i]
    merged = held_against(replace(whole, modes=replace(whole.modes, shape=size, damping=ratio)), ROBOT, "exact")
    [(case, hertz, reason)] = left_out((merged,))
    assert (case, hertz) == ("s1", item.modes.hertz[i])
    assert "several" in reason
    assert item.modes.hertz[i] not in damping_rows((merged,)).hertz


def entered(state):
    return _laws(state)[0]


def structural(state):
    return _laws(state)[0] + 0.03 * _laws(state)[2]


def test_entered_damping_is_not_declared_wrong_where_modes_crowd():
    """Windows of 3 s cannot tell modes 0.1 Hz apart; the sigmas of their fits do not say so."""
    rows = damping_rows(tuple(decay(ROBOT, number, entered, 1) for number in range(3)))
    assert len(rows) > 6
    assert np.abs((rows.ratio - rows.entered) / np.hypot(rows.sigma, 0.15 * rows.entered)).max() < 3.5
    assert damping_finding(rows, TOLERANCE).status == "adequate"


def test_losses_in_the_cables_are_still_found():
    rows = damping_rows(tuple(decay(ROBOT, number, structural, 2) for number in range(3)))
    found = damping_finding(rows, TOLERANCE)
    assert found.status in ("named", "class")
    assert "hysteretic_damping" in found.causes


def test_ratios_are_compared_with_those_of_the_fitted_robot():
    """Where EA is named wrong, damping ratios are expected of the robot with the right one."""
    judged = tuple(held_against(shaken(STIFFER, number), ROBOT, "exact") for number in range(3))
    campaign = SimpleNamespace(identified=judged, model="exact", tolerances=Tolerances(), loss=Loss())
    off = []
    for robot in (STIFFER, None):
        rows = damped(campaign, robot).finding.rows
        off.append(np.abs(rows.ratio / rows.entered - 1.0).max())
    assert off[0] < 1e-6
    assert off[1] > 0.2
