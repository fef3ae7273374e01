"""Parts that move inside the platform: degrees of freedom behind its mass matrix.

One on an elastic mount, along one direction at the platform origin; one that hangs from a point of the platform and
swings in both directions across gravity. With y_k a part's motion against the platform times the root of its mass m,
and c_k the root of m along the direction of that motion, with its lever arm,

    2 T = v' M v + sum 2 (c_k . v) y_k' + y_k'^2,    2 V = sum omega_k^2 y_k^2,

M the mass matrix of the whole platform, parts at rest in it. At omega a part weighs m omega_k^2 / (omega_k^2 - omega^2)
along its motion. A part on a mount does not sag in statics. One that hangs pulls at its hook with its weight, whatever
the tilt, and so counts as a point mass there: a pendulum of length l has omega^2 = g / l, its cord no moment about the
hook.
"""

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.guides import free_part

PARTS = 3
"""Freedoms: the slide of a part on its mount, then two of one that swings."""
_SIDEWAYS = 0.9  # part of gravity along x from which the first direction across it starts from y


def internal_coupling(robot: RobotArrays, rotation: np.ndarray) -> np.ndarray:
    """c (..., 6, PARTS), of the motion of the platform origin, world axes [kg^(1/2), kg^(1/2) m]; zero where no part
    moves."""
    along = np.sqrt(robot.internal_mass)[..., None] * (rotation @ robot.internal_direction[..., None])[..., 0]
    slide = np.concatenate([along, np.zeros_like(along)], axis=-1)
    swings = [np.zeros(6), np.zeros(6)]
    if robot.has_swinging_mass:
        hook, root = (rotation @ robot.swinging_place[..., None])[..., 0], np.sqrt(robot.swinging_mass)[..., None]
        pairs = (np.broadcast_arrays(axis, np.cross(hook, axis)) for axis in _across(robot.down))
        swings = [root * np.concatenate(pair, axis=-1) for pair in pairs]
    return np.stack([free_part(own, robot) for own in np.broadcast_arrays(slide, *swings)], axis=-1)


def _across(down: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two unit vectors across gravity's direction (..., 3), at right angles; x and y where that is -z."""
    start = np.where(np.abs(down[..., :1]) > _SIDEWAYS, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0])
    first = start - (start * down).sum(axis=-1, keepdims=True) * down
    first = first / np.linalg.norm(first, axis=-1, keepdims=True)
    return first, np.cross(first, down)


def part_masses(robot: RobotArrays) -> np.ndarray:
    """(..., PARTS) mass behind each freedom [kg]."""
    return np.stack(np.broadcast_arrays(robot.internal_mass, robot.swinging_mass, robot.swinging_mass), axis=-1)


def internal_omega(robot: RobotArrays) -> np.ndarray:
    """omega_k (..., PARTS) with the platform held [rad/s]."""
    own = np.broadcast_arrays(robot.internal_frequency, robot.swinging_frequency, robot.swinging_frequency)
    return np.asarray(2.0 * np.pi * np.stack(own, axis=-1))


def internal_squared(robot: RobotArrays) -> np.ndarray:
    """omega_k^2 (..., PARTS) [rad^2/s^2]."""
    return np.asarray(internal_omega(robot) ** 2)


def present(robot: RobotArrays) -> np.ndarray:
    """Which of the PARTS freedoms any robot of a batch has, by number."""
    return np.flatnonzero([robot.has_internal_mass, robot.has_swinging_mass, robot.has_swinging_mass])


def internal_reaction(robot: RobotArrays, rotation: np.ndarray, omega_squared: np.ndarray) -> np.ndarray:
    """What moving parts add to omega^2 M, (..., 6, 6): sum of omega^4 / (omega_k^2 - omega^2) c_k c_k' [N/m].

    omega_squared : (...) [rad^2/s^2]. Exactly at a part's own frequency the reaction is that just below it.
    """
    coupling, own, squared = (
        internal_coupling(robot, rotation),
        internal_squared(robot),
        np.asarray(omega_squared)[..., None],
    )
    gap = own - squared
    gain = squared**2 / np.where(gap == 0.0, np.finfo(float).eps * np.maximum(own, 1e-300), gap)
    return np.asarray((coupling * gain[..., None, :]) @ np.swapaxes(coupling, -1, -2))


def internal_count(robot: RobotArrays, omega_squared: np.ndarray) -> np.ndarray:
    """(...) frequencies of moving parts, with the platform held, below omega."""
    below = (part_masses(robot) > 0.0) & (internal_squared(robot) < np.asarray(omega_squared)[..., None])
    return np.asarray(below.sum(axis=-1), dtype=int)


def with_internal_mass(
    robot: RobotArrays, rotation: np.ndarray, stiffness: np.ndarray, mass: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and mass (..., 6, 6) of the platform, with y_k of parts that move in it as further unknowns."""
    some = present(robot)
    if not some.size:
        return stiffness, mass
    coupling, squared = internal_coupling(robot, rotation)[..., some], internal_squared(robot)[..., some]
    lead = np.broadcast_shapes(stiffness.shape[:-2], mass.shape[:-2], coupling.shape[:-2], squared.shape[:-1])
    springs, heavy = np.zeros((2, *lead, 6 + some.size, 6 + some.size))
    own = np.arange(6, 6 + some.size)
    springs[..., :6, :6], heavy[..., :6, :6] = stiffness, mass
    springs[..., own, own], heavy[..., own, own] = squared, 1.0
    heavy[..., :6, 6:], heavy[..., 6:, :6] = coupling, np.swapaxes(coupling, -1, -2)
    return springs, heavy
