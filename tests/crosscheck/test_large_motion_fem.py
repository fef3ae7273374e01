"""Frequency over amplitude on trial before the FEM, which integrates the large motion in time."""

import numpy as np
import pytest

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.large_motion import LargeMotion
from cdpr_struct.dynamics.robot_dynamic_stiffness import attachment
from cdpr_struct.measurement.decay_modes import refine
from tests.large_motion_robots import three_cables

BARS, STEPS, PERIODS = 2, 80, 7
UNIT = np.array([1.0, 1.0, 1.0, 0.3, 0.3, 0.3])  # turns count as displacements at the anchors' radius


def fem_frequency(point, motion, mode, amplitude, linear):
    """Frequency [Hz] and amplitude [m] that the FEM gives a mode which passes the rest with its own velocity."""
    hertz = motion.omega[mode] / (2.0 * np.pi)
    twist = motion.shapes[:, mode] * motion.omega[mode] * amplitude / motion.reach(mode)
    step = 1.0 / (STEPS * hertz)
    found = fem.integrate(solve_in_fem(point, BARS), PERIODS / hertz, step, initial_velocity=twist, linear=linear)
    every, slow = slice(None, None, 4), motion.omega[:3]
    start = np.concatenate([slow, [2.0 * motion.omega[mode]]]) * (1j - 0.001)
    read = refine(found.time[every], found.platform[every] * UNIT, start)
    own = int(np.abs(np.log(read.hertz / hertz)).argmin())
    reached = np.linalg.norm(attachment(point) @ (read.shape[own] / UNIT), axis=-1).max()
    return read.hertz[own], reached


def shifts(mode, amplitude):
    """By which share the mode shifts: FEM; harmonic balance at the amplitude reached, with and without harmonics."""
    point = three_cables()
    motion = LargeMotion.about(point)
    small, _ = fem_frequency(point, motion, mode, amplitude, linear=True)  # the error of the step is in both
    large, reached = fem_frequency(point, motion, mode, amplitude, linear=False)
    return large / small - 1.0, motion.shifts([mode], [reached])[0], motion.shifts([mode], [reached], order=1)[0]


def test_shift_of_a_mode_is_the_fems_and_without_higher_harmonics_it_is_not():
    """1.36 Hz at 50 mm: -1.0 %. Measured: 0.8 % of the shift. With fundamental and mean alone cables stretch."""
    theirs, ours, fundamental = shifts(2, 0.05)
    assert theirs < -0.01
    assert ours == pytest.approx(theirs, rel=0.05)
    assert abs(fundamental - theirs) > abs(theirs)


@pytest.mark.slow
@pytest.mark.parametrize(("mode", "amplitude"), [(0, 0.05), (0, 0.1), (1, 0.05), (2, 0.08), (2, 0.12)])
def test_shifts_of_other_modes_and_amplitudes_are_the_fems(mode, amplitude):
    """Measured: 0.2, 1.3, 1.8, 1.8 and 3.4 %. The FEM starts on the straight line of the small motion, so that the
    other modes swing a little, too; mode 2 at 100 mm, which loses energy to them, differs by 7 %."""
    theirs, ours, _ = shifts(mode, amplitude)
    assert ours == pytest.approx(theirs, rel=0.05)
