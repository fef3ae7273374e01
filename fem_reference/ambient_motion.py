"""Accelerations of the platform under random forces: modal equations, exact between samples of the force."""

from __future__ import annotations

import numpy as np
from scipy.signal import cont2discrete, decimate, lfilter, ss2tf

from cdpr_struct.fem_reference.robot_modes import RobotModes

OVERSAMPLING = 4  # steps of the force in a sample: the force is white far beyond the band of the record
SETTLING = 6.0  # time constants of the slowest decay before the record begins: exp(-12) of the power is left


def ambient_record(
    modes: RobotModes, damping: float, force: np.ndarray, sensors: np.ndarray, rate: float, count: int,
    generator: np.random.Generator,
) -> np.ndarray:  # fmt: skip
    """Accelerations (count, c) [m/s^2] at `rate` [Hz] of a platform that white random forces keep in motion.

    modes   : of unit modal mass
    damping : ratio of every mode [-]
    force   : (6,) standard deviation of force [N] and moment [N m] on the platform, constant over 1 / (4 rate)
    sensors : (c, 6) acceleration that each sensor reads per acceleration of the reference point and rotation

    Raises
    ------
    ValueError : a damping ratio that is not between 0 and 1, or a mode without stiffness.
    """
    omega = 2.0 * np.pi * modes.frequencies_hz
    if not 0.0 < damping < 1.0:
        raise ValueError(f"damping must be between 0 and 1, got {damping!r}")
    if not (omega > 0.0).all():
        raise ValueError("every mode must have a frequency above zero: white forces move the others without limit")
    step = 1.0 / (OVERSAMPLING * rate)
    before = int(np.ceil(SETTLING / (damping * omega.min()) * rate)) * OVERSAMPLING
    wrench = generator.normal(size=(before + OVERSAMPLING * count, 6)) * force
    motion = np.zeros((len(wrench), 6))
    for frequency, shape in zip(omega, modes.platform_shapes, strict=True):
        motion += _modal_acceleration(wrench @ shape, frequency, damping, step)[:, None] * shape
    seen = decimate(motion[before:] @ sensors.T, OVERSAMPLING, ftype="fir", axis=0)
    return np.asarray(seen[:count])


def _modal_acceleration(force: np.ndarray, omega: float, damping: float, step: float) -> np.ndarray:
    """Acceleration (n,) of a mode of unit mass at the beginning of each step of a force (n,) that is constant in it."""
    system = np.array([[0.0, 1.0], [-(omega**2), -2.0 * damping * omega]])
    seen = np.array([[-(omega**2), -2.0 * damping * omega]])
    discrete = cont2discrete((system, np.array([[0.0], [1.0]]), seen, np.array([[1.0]])), step)
    above, below = ss2tf(*discrete[:4])
    return np.asarray(lfilter(above[0], below, force))
