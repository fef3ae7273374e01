"""A part of the platform on an elastic mount: one more degree of freedom behind the platform's mass matrix.

With y the part's motion against the platform times the root of its mass m, and c the root of m along its direction,

    2 T = v' M v + 2 (c . v) y' + y'^2,    2 V = omega_i^2 y^2,

M the mass matrix of the whole platform. At omega the part weighs m omega_i^2 / (omega_i^2 - omega^2) along its
direction. Its sag under gravity is left out: weight and centre of mass are the rigid platform's.
"""

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.guides import free_part


def internal_coupling(robot: RobotArrays, rotation: np.ndarray) -> np.ndarray:
    """c (..., 6), of the motion of the platform origin, world axes [kg^(1/2)]; zero without an internal mass."""
    root = np.sqrt(robot.internal_mass)
    along = root[..., None] * (rotation @ robot.internal_direction[..., None])[..., 0]
    return free_part(np.concatenate([along, np.zeros_like(along)], axis=-1), robot)


def internal_omega(robot: RobotArrays) -> np.ndarray:
    """omega_i (...) of the mount with the platform held [rad/s]."""
    return np.asarray(2.0 * np.pi * robot.internal_frequency)


def internal_squared(robot: RobotArrays) -> np.ndarray:
    """omega_i^2 (...) [rad^2/s^2]."""
    return np.asarray(internal_omega(robot) ** 2)


def internal_reaction(robot: RobotArrays, rotation: np.ndarray, omega_squared: np.ndarray) -> np.ndarray:
    """What the mount adds to omega^2 M, (..., 6, 6): omega^4 / (omega_i^2 - omega^2) c c' [N/m].

    omega_squared : (...) [rad^2/s^2]. Exactly at the mount's frequency the reaction is that just below it.
    """
    coupling, own = internal_coupling(robot, rotation), internal_squared(robot)
    gap = own - omega_squared
    gain = omega_squared**2 / np.where(gap == 0.0, np.finfo(float).eps * np.maximum(own, 1e-300), gap)
    return np.asarray(gain[..., None, None] * coupling[..., :, None] * coupling[..., None, :])


def internal_count(robot: RobotArrays, omega_squared: np.ndarray) -> np.ndarray:
    """(...) frequencies of the mount, with the platform held, below omega: one or none."""
    return np.asarray((robot.internal_mass > 0.0) & (internal_squared(robot) < omega_squared), dtype=int)


def with_internal_mass(
    robot: RobotArrays, rotation: np.ndarray, stiffness: np.ndarray, mass: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and mass (..., 6, 6) of the platform with y as a seventh unknown, if it has an internal mass."""
    if not robot.has_internal_mass:
        return stiffness, mass
    coupling, squared = internal_coupling(robot, rotation), internal_squared(robot)
    lead = np.broadcast_shapes(stiffness.shape[:-2], mass.shape[:-2], coupling.shape[:-1], squared.shape)
    wide = np.zeros((2, *lead, 7, 7))
    wide[0, ..., :6, :6], wide[1, ..., :6, :6] = stiffness, mass
    wide[0, ..., 6, 6], wide[1, ..., 6, 6] = squared, 1.0
    wide[1, ..., :6, 6] = wide[1, ..., 6, :6] = coupling
    return wide[0], wide[1]
