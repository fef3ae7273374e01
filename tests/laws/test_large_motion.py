"""Laws of free motion of any size: harmonic balance, and the platform's frequencies over their amplitude."""

import io
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.special import ellipk

import cdpr_struct as cs
from cdpr_struct.dynamics.harmonic_balance import free_motion
from cdpr_struct.dynamics.large_motion import LargeMotion
from cdpr_struct.dynamics.large_rotation import angular_motion, turning
from cdpr_struct.errors import CdprError, ConvergenceError, InputError
from cdpr_struct.statics.equilibrium import rotation_from_vector
from tests.large_motion_robots import hung_from_a_line, three_cables


class Duffing:
    """u'' + u + u^3 = 0."""

    def linearised(self, u, velocity, acceleration):
        one = np.ones((len(u), 1, 1))
        return acceleration + u + u**3, one + 3.0 * u[..., None] ** 2, 0.0 * one, one


def test_harmonic_balance_meets_the_elliptic_integral_of_a_stiffening_spring():
    """Exact for Duffing's equation: omega = pi sqrt(1 + A^2) / (2 K(m)), m = A^2 / (2 (1 + A^2)), A the peak."""
    found = free_motion(Duffing(), np.array([1.0]), [0], np.array([1.0]), 9)
    peak = found.coefficients.sum()  # all cosines are 1 at the start
    parameter = peak**2 / (2.0 * (1.0 + peak**2))
    exact = 0.5 * np.pi * np.sqrt(1.0 + peak**2) / ellipk(parameter)
    assert exact > 1.2  # far from small motion
    assert found.omega[0] == pytest.approx(exact, rel=1e-7)  # the harmonics beyond the ninth: measured 5e-9


def test_angular_motion_is_that_of_the_rotation():
    """Against differences of R: they lose 1e-8 of a turn in 1e-4 s twice."""
    rng, step = np.random.default_rng(3), 1e-4
    for size in (1.0, 1e-3):
        place, rate, second = size * rng.normal(size=3), rng.normal(size=3), rng.normal(size=3)

        def spin(t, place=place, rate=rate, second=second):
            turn = [rotation_from_vector(place + rate * s + 0.5 * second * s**2) for s in (t - step, t, t + step)]
            tensor = (turn[2] - turn[0]) / (2.0 * step) @ turn[1].T
            return np.array([tensor[2, 1], tensor[0, 2], tensor[1, 0]])

        found, angular = angular_motion(place, rate, second)
        np.testing.assert_allclose(found, spin(0.0), atol=1e-7)
        np.testing.assert_allclose(angular, (spin(step) - spin(-step)) / (2.0 * step), atol=1e-6)
        np.testing.assert_allclose(turning(place) @ rate, found, atol=1e-12)


def test_platform_hung_from_a_line_is_a_compound_pendulum():
    """All frame anchors on one line: to turn about it costs no stretch, so that mode is a pendulum at any size.

    Exact: omega = pi omega_0 / (2 K(sin^2(peak / 2))). The platform is symmetric, or it would also turn otherwise.
    """
    point, mode = hung_from_a_line()
    motion = LargeMotion.about(point)
    amplitude = 0.6 * motion.reach(mode) / np.linalg.norm(motion.shapes[3:, mode])  # [m], of some 0.6 rad
    found = motion.swing([mode], [amplitude])
    peak = np.linalg.norm(found.coefficients.sum(axis=0) @ motion.shapes[3:].T)
    exact = 0.5 * np.pi / ellipk(np.sin(0.5 * peak) ** 2)
    assert peak > 0.6
    shift = found.omega[0] / motion.omega[mode] - 1.0
    assert shift == pytest.approx(
        exact - 1.0, rel=1e-3
    )  # what the cables stretch, m g / EA: measured 6e-4; 6e-5 at 1e6 N


def test_energy_is_kept_and_the_shift_begins_with_the_square_of_the_amplitude():
    motion = LargeMotion.about(three_cables())
    for mode in (0, 2):
        found = motion.swing([mode], [0.05])
        u, velocity, _ = found.harmonics.motion(found.coefficients, found.omega)
        energy = motion.energy(u, velocity)
        whole = 0.5 * (motion.omega[mode] * 0.05 / motion.reach(mode)) ** 2
        assert np.ptp(energy) < 1e-3 * whole  # harmonics beyond the seventh: measured 2e-4
        once, twice = (motion.shifts([mode], [a])[0] for a in (0.005, 0.01))
        assert twice / once == pytest.approx(4.0, rel=0.01)


def test_modes_that_swing_together_shift_each_other():
    """Two modes, one of them nearly at rest: the other's shift is that of swinging alone."""
    motion = LargeMotion.about(three_cables())
    alone = motion.shifts([2], [0.03])[0]
    together = motion.shifts([0, 2], [1e-5, 0.03])
    assert together[1] == pytest.approx(alone, rel=1e-4)
    assert abs(together[0]) > 1e-4  # the large one shifts the small one


def test_modes_command_gives_curves_of_platform_modes_only():
    result = cs.modes("cogiro", count=6, amplitude="0.001,0.002")
    told, files = result.to_json()["large_motion"], result.files()
    assert told["modes"] == [1]  # 99 % of its energy is the platform's; of the others 56 % at most
    first, second = told["frequencies_hz"][0]
    assert second < first < 2.7823414  # softening, below the small motion's
    table = pd.read_csv(io.StringIO(files["large_motion.csv"]))
    np.testing.assert_array_equal(table["frequency_hz"], [first, second])
    assert "mode 1, 2.78 Hz" in files["large_motion.svg"]
    with pytest.raises(InputError, match="all above zero"):
        cs.modes("cogiro", count=2, amplitude=[0.01, -0.01])


def test_what_large_motion_does_not_know_is_refused_by_name():
    point = three_cables()
    guided = replace(point.entered, guided=("rx",))
    with pytest.raises(CdprError, match="a guided platform"):
        LargeMotion.about(replace(point, robot=guided))


def test_too_large_a_motion_says_so():
    with pytest.raises(ConvergenceError, match="smaller amplitude"):
        LargeMotion.about(three_cables()).swing([4], [0.3])


def test_shifts_of_modes_by_each_other_are_reciprocal():
    """The frequencies are derivatives of one energy by the actions, so that omega_i^2 times the share by which mode i
    shifts per squared modal amplitude of mode j is symmetric; measured 1e-4 of the largest."""
    motion = LargeMotion.about(three_cables())
    modal = motion.leading([0, 1, 2]) * np.array([motion.reach(j) for j in range(3)]) ** 2
    power = modal * motion.omega[:3, None] ** 2
    assert np.abs(power - power.T).max() < 1e-3 * np.abs(power).max()
    assert np.abs(power - np.diag(np.diag(power))).max() > 0.05 * np.abs(power).max()  # there is something to compare
    alone = motion.shifts([2], [0.01])[0] / 0.01**2
    assert motion.leading([2])[0, 0] == pytest.approx(alone, rel=0.01)
