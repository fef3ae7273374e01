"""Along and about which axes does the platform move in a mode?

The platform's kinetic energy is m |v|^2 + w I w, v the motion of its centre of mass and w its rotation. Each of the six
directions has its product with the momentum: m v_i v_i along an axis, w_i (I w)_i about it.
"""

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint


def direction_shares(point: OperatingPoint, platform: np.ndarray) -> np.ndarray:
    """Shares of the six directions in the platform's own kinetic energy.

    Parameters
    ----------
    platform : (..., k, 6) motion of the platform origin and rotation, world axes, any scale

    Returns
    -------
    (..., k, 6), world axes through the centre of mass [-]; the sum is one, a share about an axis may be slightly
    negative where products of inertia couple the rotations; zero where the platform stands still.
    """
    body = point.arrays
    center = np.einsum("...ij,...j->...i", point.rotation, body.center_of_mass)[..., None, :]
    inertia = point.rotation @ body.inertia @ np.swapaxes(point.rotation, -1, -2)
    turn = platform[..., 3:]
    shift = platform[..., :3] + np.cross(turn, center)
    along = np.asarray(body.mass)[..., None, None] * shift**2
    about = turn * np.einsum("...ij,...kj->...ki", inertia, turn)
    energy = np.concatenate([along, about], axis=-1)
    total = energy.sum(axis=-1, keepdims=True)
    return np.asarray(energy / np.where(total > 0.0, total, 1.0))
