"""Laws of vibration in time: energy, decay, superposition, and agreement with the frequency response."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.damping import Hysteretic, Rayleigh, Undamped, Viscous
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.modal_basis import modal_basis
from cdpr_struct.dynamics.natural_frequencies import natural_frequencies
from cdpr_struct.dynamics.ports import CablePort, platform_port
from cdpr_struct.dynamics.transient import after_stop, along_path, complex_modes
from cdpr_struct.dynamics.vibration_record import VibratingRobot
from cdpr_struct.measurement.spectrogram import dominant_frequency
from cdpr_struct.robot.pose import Pose
from cdpr_struct.statics.trajectory import helix, straight_line
from tests.conftest import at_rest

HIGHEST = 2.0 * np.pi * 15.0
COUNT = 80
TWIST = np.array([0.3, -0.2, 0.1, 0.05, 0.1, -0.1])
TIME = np.arange(0.0, 4.0, 0.005)
PORTS = (
    *(platform_port(n, axis, False, np.zeros(3)) for n, axis in zip("xyz", np.eye(3), strict=True)),
    *(platform_port(f"r{n}", axis, True, np.zeros(3)) for n, axis in zip("xyz", np.eye(3), strict=True)),
    CablePort("cable5@0.3:z", 4, 0.3, np.array([0.0, 0.0, 1.0])),
)


@pytest.fixture(scope="module")
def point():
    return at_rest("thesis-3-1", np.array([1.3, -0.8, 0.9]))


@pytest.fixture(scope="module", params=["dsm", "exact"])
def cables(point, request):
    return cable_dynamics(point, request.param, HIGHEST)


def basis_of(point, cables, law):
    return modal_basis(point, cables, law, COUNT, HIGHEST)


def test_undamped_energy_is_conserved_and_starts_as_the_kinetic_energy(point, cables):
    basis = basis_of(point, cables, Undamped())
    found = after_stop(basis, TWIST, PORTS, TIME)
    _, mass = basis.rigid_motion()
    assert np.ptp(found.energy) < 1e-12 * found.energy[0]
    assert found.energy[0] == pytest.approx(0.5 * TWIST @ mass @ TWIST * found.energy_share, rel=1e-12)
    assert 0.999 < found.energy_share < 1.0


@pytest.mark.parametrize("law", [Viscous(np.full(8, 0.02)), Rayleigh(0.3, 1e-4), Hysteretic(0.02)], ids=str)
def test_energy_never_grows(point, cables, law):
    energy = after_stop(basis_of(point, cables, law), TWIST, PORTS, TIME).energy
    assert (np.diff(energy) <= 1e-12 * energy[0]).all()
    assert energy[-1] < 0.9 * energy[0]


def test_platform_starts_with_the_given_velocity(point, cables):
    """As far as the modes up to 15 Hz hold it; the rest is the fast motion of the cables."""
    found = after_stop(basis_of(point, cables, Undamped()), TWIST, PORTS, TIME)
    np.testing.assert_allclose(found.velocity[0, :6], TWIST, atol=0.01)
    np.testing.assert_allclose(found.displacement[0], 0.0, atol=1e-12)


def test_velocity_and_acceleration_are_derivatives(point, cables):
    fine = np.arange(0.0, 0.5, 0.0005)
    found = after_stop(basis_of(point, cables, Viscous(np.full(8, 0.02))), TWIST, PORTS, fine)
    velocity = CubicSpline(fine, found.displacement)(fine, 1)
    acceleration = CubicSpline(fine, found.velocity)(fine, 1)
    inner = slice(20, -20)
    for ours, numeric in ((found.velocity, velocity), (found.acceleration, acceleration)):
        assert np.abs(ours - numeric)[inner].max() < 1e-6 * np.abs(numeric).max()


def test_decay_rate_is_the_modal_damping(point, cables):
    """One mode alone decays with exp(-zeta omega t); with losses in proportion to stiffness, zeta = b omega / 2.

    The rotating-arm stiffness is not part of any cable and has no loss, hence the small remainder.
    """
    b = 2e-4
    basis = basis_of(point, cables, Rayleigh(0.0, b))
    modes = complex_modes(basis)
    np.testing.assert_allclose(modes.damping_ratio, 0.5 * b * basis.omega, rtol=2e-3)
    assert np.abs(modes.damped_hertz / (basis.omega / (2.0 * np.pi)) - 1.0).max() < 1e-3


def test_modes_are_the_certified_ones(point, cables):
    basis = basis_of(point, cables, Undamped())
    certified = natural_frequencies(point, cables, COUNT).hertz
    np.testing.assert_allclose(complex_modes(basis).damped_hertz, certified, rtol=3e-4)  # Ritz bounds of the dsm


def test_hysteretic_modes_have_half_the_loss_factor(point, cables):
    modes = complex_modes(basis_of(point, cables, Hysteretic(0.02)))
    np.testing.assert_allclose(modes.damping_ratio, 0.01, rtol=2e-3)


def test_a_stop_is_the_impulse_of_a_very_short_braking(point, cables):
    basis = basis_of(point, cables, Viscous(np.full(8, 0.02)))
    time = np.arange(0.0, 0.4, 2e-4)
    brake = np.zeros((len(time), 6))
    brake[1:6] = -TWIST / (5 * 2e-4)  # the velocity is taken away within a millisecond
    braked = along_path(basis, brake, np.zeros(6), len(time) - 1, PORTS, time)
    stopped = after_stop(basis, TWIST, PORTS, time)
    late = time > 0.01
    error = np.abs(np.interp(time - 6e-4, time, stopped.displacement[:, 0]) - braked.displacement[:, 0])
    assert error[late].max() < 2e-3 * np.abs(stopped.displacement[:, 0]).max()


def test_steady_drive_ends_in_the_frequency_response(point):
    """A long harmonic drive: the settled amplitude is |H| times the inertia force, at a frequency between modes."""
    cables = cable_dynamics(point, "exact", HIGHEST)
    law = Viscous(np.full(8, 0.15))
    basis = modal_basis(point, cables, law, COUNT, HIGHEST)
    time = np.arange(0.0, 40.0, 0.004)
    hertz = 3.9
    drive = np.zeros((len(time), 6))
    drive[:, 2] = np.cos(2.0 * np.pi * hertz * time)
    found = along_path(basis, drive, np.zeros(6), len(time) - 1, PORTS[:3], time)
    last = time >= 30.0
    wave = np.exp(-2j * np.pi * hertz * time[last])
    amplitude = 2.0 * np.mean(found.displacement[last, 2] * wave)
    participation, _ = basis.rigid_motion()
    omega = 2.0 * np.pi * hertz
    dynamic = np.diag(basis.omega**2 - omega**2) + 1j * omega * basis.damping
    expected = basis.shape_at(PORTS[2]) @ np.linalg.solve(dynamic, -participation[:, 2])
    assert amplitude == pytest.approx(expected, rel=2e-3)
    mass = point.robot.platform.mass
    response = frequency_response(point, cables, law, PORTS[2], PORTS[2:3], np.array([3.8, hertz]), "displacement")
    assert abs(expected) == pytest.approx(mass * abs(response.response[1, 0]), rel=0.05)  # cables' share of the drive


def test_a_smooth_slow_trajectory_hardly_vibrates_and_a_stop_on_the_way_does(point):
    robot = VibratingRobot(point, "exact", Viscous(np.full(8, 0.01)), 15.0)
    way = straight_line(
        Pose(point.position, np.zeros(3)), Pose(point.position + np.array([0.4, 0.0, 0.0]), np.zeros(3)), 8.0
    )
    smooth = robot.along(way, PORTS, 10.0).vibration
    stopped = robot.after_stop(np.array([0.4 / 8.0, 0, 0, 0, 0, 0]), PORTS, 10.0).vibration
    assert np.abs(smooth.acceleration[:, 0]).max() < 0.02 * np.abs(stopped.acceleration[:, 0]).max()


def test_the_nominal_acceleration_is_the_trajectorys(point):
    record = VibratingRobot(point, "exact", Undamped(), 15.0).along(helix(), PORTS, 40.0)
    way = helix()
    inside = record.vibration.time <= 30.0
    expected = np.interp(record.vibration.time[inside], way.time, way.acceleration[:, 1])
    np.testing.assert_allclose(record.nominal[inside, 1], expected)
    assert (record.nominal[~inside] == 0.0).all()


def test_dominant_frequency_is_a_certified_mode(point):
    record = VibratingRobot(point, "exact", Viscous(np.full(8, 0.01)), 15.0).after_stop(
        np.array([0.0, 0.0, 0.2, 0.0, 0.0, 0.0]), PORTS, 12.0
    )
    dominant = dominant_frequency(record.vibration.time, record.vibration.acceleration[:, :3])
    assert np.abs(record.modes.hertz - dominant).min() < 0.02
    assert dominant == pytest.approx(3.18, abs=0.02)  # the vertical mode
