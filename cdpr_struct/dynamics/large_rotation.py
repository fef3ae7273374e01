"""A rigid body in large motion: velocity, acceleration and inertia from a displacement and a rotation vector.

With R = exp([theta]x) R_0 the angular velocity is J(theta) theta', world axes, with

    J = I + a [theta]x + b [theta]x^2,  a = (1 - cos p) / p^2,  b = (p - sin p) / p^3,  p = |theta|

(Murray, Li and Sastry, A Mathematical Introduction to Robotic Manipulation, 1994, chapter 2).
"""

import numpy as np

from cdpr_struct.statics.equilibrium import cross_product_matrix

_SMALL = 1e-2  # rad, below which series of four terms stand for the quotients


def turning(vector: np.ndarray) -> np.ndarray:
    """J (..., 3, 3) at rotation vectors (..., 3) [rad]."""
    first, second, _, _ = _quotients(vector)
    cross = cross_product_matrix(vector)
    return np.asarray(np.eye(3) + first[..., None, None] * cross + second[..., None, None] * cross @ cross)


def angular_motion(vector: np.ndarray, rate: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angular velocity and acceleration (..., 3), world [rad/s], [rad/s^2], of rotation vectors and their rates."""
    a, b, slope_a, slope_b = (q[..., None] for q in _quotients(vector))
    growth = (vector * rate).sum(axis=-1, keepdims=True)
    once = np.cross(vector, rate)
    twice = np.cross(vector, once)
    linear = second + a * np.cross(vector, second) + b * np.cross(vector, np.cross(vector, second))
    change = slope_a * growth * once + slope_b * growth * twice + b * np.cross(rate, once)
    return rate + a * once + b * twice, linear + change


def inertia_wrench(
    mass: np.ndarray, arm: np.ndarray, inertia: np.ndarray, spin: np.ndarray, origin: np.ndarray, angular: np.ndarray
) -> np.ndarray:
    """(..., 6) rate of momentum and of angular momentum about the origin's place, world axes [N, N m].

    Parameters
    ----------
    mass : (...) [kg];  arm : (..., 3) from the origin to the centre of mass, world [m]
    inertia : (..., 3, 3) about the centre of mass, world axes [kg m^2]
    spin, angular : (..., 3) angular velocity and acceleration, world;  origin : (..., 3) acceleration of the origin
    """
    center = origin + np.cross(angular, arm) + np.cross(spin, np.cross(spin, arm))
    force = mass[..., None] * center
    momentum, change = ((inertia @ v[..., None])[..., 0] for v in (spin, angular))
    return np.concatenate([force, np.cross(arm, force) + change + np.cross(spin, momentum)], axis=-1)


def _quotients(vector: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """a, b, and their derivatives by p over p, (...)."""
    size = np.linalg.norm(vector, axis=-1)
    square, p = size**2, np.where(size < _SMALL, 1.0, size)
    sine, versine = np.sin(p), 2.0 * np.sin(0.5 * p) ** 2
    small = size < _SMALL
    return (
        np.where(small, 0.5 - square / 24.0 + square**2 / 720.0, versine / p**2),
        np.where(small, 1.0 / 6.0 - square / 120.0 + square**2 / 5040.0, (p - sine) / p**3),
        np.where(small, -1.0 / 12.0 + square / 180.0 - square**2 / 6720.0, (p * sine - 2.0 * versine) / p**4),
        np.where(small, -1.0 / 60.0 + square / 1260.0 - square**2 / 60480.0, (p * versine - 3.0 * (p - sine)) / p**5),
    )
