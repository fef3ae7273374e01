"""Cables whose end forces are known, as states."""

import numpy as np

from cdpr_struct.statics.cable_state import CableStates


def pulled_cables(
    force: np.ndarray, end: np.ndarray, length: np.ndarray, axial_stiffness: np.ndarray, weight: np.ndarray
) -> CableStates:
    """Cables (n,) from the origin to `end` (n, 2) (x, z) [m], held there by forces (n, 2) [N]; x turned positive.

    length : (n,) unstrained [m];  axial_stiffness : (n,) [N];  weight : (n,) [N/m]
    """
    none, count = np.zeros(len(length)), len(length)
    offset = np.stack([np.abs(end[:, 0]), none, end[:, 1]], axis=-1)
    return CableStates(
        offset, np.tile([1.0, 0.0, 0.0], (count, 1)), length, none, np.abs(force[:, 0]), force[:, 1],
        axial_stiffness, weight, np.zeros(count, dtype=int), none,
    )  # fmt: skip
