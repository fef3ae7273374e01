"""Laws of dry friction that gives way before it slides."""

import numpy as np
import pytest

from cdpr_struct.dynamics.presliding_friction import (
    built_up,
    end_turns,
    in_phase_stiffness,
    loss_stiffness,
    rubbing_modes,
)
from cdpr_struct.statics.equilibrium import rotation_from_vector
from tests.large_motion_robots import three_cables

MOMENT, PRESLIDING = 0.3, 0.01  # N m, rad


def loop(amplitude, periods=8, steps=4000):
    """Turn and moment of the last of some periods: the memory of the start fades by exp(-4 a) in each."""
    turn = amplitude * np.cos(np.linspace(0.0, 2.0 * np.pi * periods, periods * steps + 1))
    state, moments = np.zeros(1), []
    for change in np.diff(turn):
        state = built_up(state, np.array([change]), PRESLIDING)
        moments.append(MOMENT * state[0])
    return np.array(moments[-steps:])


@pytest.mark.parametrize("ratio", [0.5, 2.0, 30.0])
def test_equivalent_stiffness_and_loss_are_those_of_the_loop(ratio):
    """The loop is stepped exactly; a sum over 4000 steps in which it jumps within some 200 is good to 1e-3."""
    amplitude = ratio * PRESLIDING
    moment = loop(amplitude)
    phase = 2.0 * np.pi * np.arange(1, len(moment) + 1) / len(moment)
    in_phase, quarter = (2.0 / amplitude * np.mean(moment * wave) for wave in (np.cos(phase), -np.sin(phase)))
    assert in_phase_stiffness(MOMENT, PRESLIDING, amplitude) == pytest.approx(in_phase, rel=2e-3)
    assert loss_stiffness(MOMENT, PRESLIDING, amplitude) == pytest.approx(quarter, rel=2e-3)


def test_small_turns_meet_a_spring_and_large_ones_coulomb_friction():
    tiny, huge = 1e-6 * PRESLIDING, 1e4 * PRESLIDING
    assert in_phase_stiffness(MOMENT, PRESLIDING, tiny) == pytest.approx(MOMENT / PRESLIDING, rel=1e-5)
    assert loss_stiffness(MOMENT, PRESLIDING, tiny) < 1e-6 * MOMENT / PRESLIDING
    assert loss_stiffness(MOMENT, PRESLIDING, huge) == pytest.approx(4.0 * MOMENT / (np.pi * huge), rel=1e-3)
    assert in_phase_stiffness(MOMENT, PRESLIDING, huge) < 0.05 * loss_stiffness(MOMENT, PRESLIDING, huge)


def test_moment_is_bounded_and_never_gives_energy_on_a_closed_path():
    """Random plane paths, closed: |z| <= 1, and the work done on the friction is positive."""
    rng = np.random.default_rng(2)
    for scale in (0.1, 1.0, 20.0):
        steps = scale * PRESLIDING * rng.normal(size=(400, 2)) / 10.0
        steps -= steps.mean(axis=0)
        state, work = np.zeros(2), 0.0
        for _ in range(3):
            work = 0.0
            for step in steps:
                after = built_up(state, step, PRESLIDING)
                work += float(0.5 * (state + after) @ step)
                state = after
                assert np.linalg.norm(state) <= 1.0 + 1e-12
        assert work > 0.0


def test_one_mode_alone_is_the_closed_form():
    """An average over periods of 60 steps: good to 1 %."""
    turns, omega = np.array([[[[0.2]]]]), np.array([[9.0]])
    for ratio in (0.3, 3.0):
        modal = np.array([[ratio * PRESLIDING / 0.2]])
        found = rubbing_modes(turns, PRESLIDING, omega, modal)
        spring, loss = (
            f(MOMENT, PRESLIDING, ratio * PRESLIDING) * 0.2**2 for f in (in_phase_stiffness, loss_stiffness)
        )
        assert MOMENT * found.shift[0, 0, 0] == pytest.approx(0.5 * spring / 81.0, rel=0.02)
        assert MOMENT * found.damping[0, 0, 0] == pytest.approx(0.5 * loss / 81.0, rel=0.02)


def test_end_turns_are_those_of_the_cables_directions():
    """Against the directions after a small motion, seen from the world and from the platform; the cables stretch so
    little and are so light that they are straight lines to 1e-4."""
    point, step = three_cables(), 1e-6
    twist = np.array([0.3, -0.2, 0.1, 0.5, 0.4, -0.3])
    found = end_turns(point, twist[None])[0]
    robot = point.entered
    turn = rotation_from_vector(step * twist[3:])

    def directions(position, rotation):
        chord = position + robot.platform_anchors @ rotation.T - robot.frame_anchors
        return chord / np.linalg.norm(chord, axis=1)[:, None]

    rest = directions(point.position, point.rotation)
    moved = directions(point.position + step * twist[:3], turn @ point.rotation)
    np.testing.assert_allclose(found[:3], np.cross(rest, moved - rest) / step, atol=2e-3)
    seen = moved @ turn  # back into the axes that turned with the platform
    np.testing.assert_allclose(found[3:], -np.cross(rest, seen - rest) / step, atol=2e-3)
