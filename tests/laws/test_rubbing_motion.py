"""Vibration in time with dry friction at the ends of cables."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.damping import Undamped
from cdpr_struct.dynamics.modal_basis import modal_basis
from cdpr_struct.dynamics.ports import platform_port
from cdpr_struct.dynamics.presliding_friction import end_turns, rubbing_modes
from cdpr_struct.dynamics.rubbing_motion import EndFriction, RubbingEnds, rubbed_motion, rubbing_vibration
from cdpr_struct.dynamics.transient import along_path, complex_modes
from cdpr_struct.errors import InputError
from cdpr_struct.interface.damping_law import read_end_friction
from cdpr_struct.measurement.decay_modes import refine
from tests.large_motion_robots import three_cables

FRICTION = EndFriction(frame=(3e-4, 0.01), platform=(2e-4, 0.004))
TWIST = np.array([0.05, 0.04, 0.0, 0.1, -0.05, 0.1])


@pytest.fixture(scope="module")
def parts():
    point, highest = three_cables(), 2.0 * np.pi * 2.0
    basis = modal_basis(point, cable_dynamics(point, "exact", highest), Undamped(), 3, highest)
    return point, basis, complex_modes(basis), RubbingEnds.of(point, basis, FRICTION)


def stopped(basis, modes, ends, time):
    jump = np.concatenate([np.zeros(3), basis.rigid_motion()[0] @ TWIST])
    return rubbed_motion(modes, basis.omega, ends, time, np.zeros((len(time), 3)), {0: jump})


def test_motion_is_that_of_an_independent_integration(parts):
    """Dahl's law as a differential equation, by Runge and Kutta's method to 1e-9, three modes in 5 s."""
    point, basis, modes, ends = parts
    time = np.arange(0.0, 5.0, 1.0 / 64.0)
    ours = stopped(basis, modes, ends, time)

    def rate(_t, y):
        speed, z = y[3:6], y[6:].reshape(-1, 3)
        turning = np.einsum("k,keb->eb", speed, ends.turns)
        grown = (turning - z * np.linalg.norm(turning, axis=1)[:, None]) / ends.presliding
        return np.concatenate([speed, -(basis.omega**2) * y[:3] + ends.force(z), grown.ravel()])

    start = np.concatenate([np.zeros(3), basis.rigid_motion()[0] @ TWIST, np.zeros(ends.turns[0].size)])
    theirs = solve_ivp(rate, (0.0, time[-1]), start, t_eval=time, rtol=1e-9, atol=1e-12).y[:6].T
    theirs[:, :3] *= basis.omega
    size = np.abs(theirs).max()
    assert np.abs(ours.state - theirs).max() < 3e-4 * size  # steps of 1/50 of a period, in each z along a line
    assert np.abs(stopped(basis, modes, RubbingEnds.of(point, basis, EndFriction((0.0, 1.0), (0.0, 1.0))), time).state
                  - theirs).max() > 0.05 * size  # fmt: skip


def test_energy_that_the_modes_lose_is_the_work_done_on_the_friction(parts):
    """The work is summed with the mean friction of each step: 1e-3 of it; and the modes lose a third in 5 s."""
    _, basis, modes, ends = parts
    found = stopped(basis, modes, ends, np.arange(0.0, 5.0, 1.0 / 64.0))
    energy = 0.5 * (found.state**2).sum(axis=1)
    np.testing.assert_allclose(energy + found.lost, energy[0], rtol=1e-3)
    assert energy[-1] < 0.8 * energy[0]


def test_frequency_and_damping_read_from_the_motion_are_those_of_the_equivalent_linearisation(parts):
    """Read from 6 to 16 s, when the friction has forgotten its start, at the amplitudes in the middle: measured 2 %."""
    point, basis, modes, _ = parts
    laws = (9e-5, 0.01), (6e-5, 0.004)
    ends = RubbingEnds.of(point, basis, EndFriction(*laws))
    time = np.arange(0.0, 16.0, 1.0 / 64.0)
    late = time >= 6.0
    place = stopped(basis, modes, ends, time).state[late, :3] / basis.omega
    read = refine(time[late] - 6.0, place, basis.omega * (1j - 0.005))
    own = [int(np.abs(read.shape[:, k]).argmax()) for k in range(3)]
    hertz, damping = read.hertz[own], read.damping[own]
    amplitudes = np.abs(read.shape[own, range(3)]) * np.exp(-damping * 2.0 * np.pi * hertz * 5.0)
    motion = end_turns(point, basis.modes.platform)[None], basis.omega[None], amplitudes[None]
    linear = [rubbing_modes(motion[0], angle, *motion[1:]) for _, angle in laws]
    half = len(ends.moment) // 2
    shift, loss = (
        np.concatenate([getattr(linear[0], what)[0, :, :half], getattr(linear[1], what)[0, :, half:]], axis=1)
        @ ends.moment
        for what in ("shift", "damping")
    )
    np.testing.assert_allclose(hertz * 2.0 * np.pi / basis.omega - 1.0, shift, rtol=0.05)
    np.testing.assert_allclose(damping, loss, rtol=0.05)
    assert shift.min() > 0.002


def test_friction_refuses_what_is_none():
    with pytest.raises(ValueError, match="frame must be a radius"):
        EndFriction(frame=(-1.0, 0.1), platform=(0.0, 0.1))


def test_friction_of_no_size_changes_nothing_after_a_stop_and_along_a_path(parts):
    """The stepped motion is that of the closed form: both are exact for a drive that is linear between the instants."""
    point, basis, _, _ = parts
    none = RubbingEnds.of(point, basis, EndFriction((0.0, 1.0), (0.0, 1.0)))
    time, ports = np.arange(0.0, 4.0, 1.0 / 16.0), (platform_port("x", np.array([1.0, 0.0, 0.0]), False, np.zeros(3)),)
    still = np.zeros((len(time), 6))
    path = np.outer(np.sin(3.0 * time) * (time < 2.0), TWIST)
    for nominal, stop in ((still, 0), (path, 32)):
        ours = rubbing_vibration(basis, none, nominal, (stop, TWIST), ports, time)
        theirs = along_path(basis, nominal, TWIST, stop, ports, time)
        for what in ("displacement", "velocity", "acceleration", "energy"):
            expected = getattr(theirs, what)
            np.testing.assert_allclose(getattr(ours, what), expected, atol=1e-10 * np.abs(expected).max())
        assert ours.energy_share == pytest.approx(theirs.energy_share)


@pytest.mark.parametrize("text", ["joint:0.1,0.1", "frame:0.1", "frame:-1,0.1", "both:1,0", "frame:1,1;both:1,1", ""])
def test_end_friction_that_cannot_be_read_is_refused(text):
    with pytest.raises(InputError, match="end_friction"):
        read_end_friction(text)


def test_end_friction_is_read():
    both = read_end_friction("both:0.001,0.01")
    assert both == EndFriction((0.001, 0.01), (0.001, 0.01))
    assert read_end_friction("frame:0.002,0.02; platform:0.001,0.01").frame == (0.002, 0.02)
