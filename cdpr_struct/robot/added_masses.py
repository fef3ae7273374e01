"""Where on a cable a mass may sit for which one asks what it would do."""

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays

PLACES = np.array([0.1, 0.22, 0.35, 0.5])
"""Shares of the unstrained length from the platform end; a mass in the other half does nearly the same."""


def nearest_place(arrays: RobotArrays) -> np.ndarray:
    """(..., m, p) bool: which of `PLACES`, or of their mirror images, is nearest to each cable's added mass."""
    place = arrays.added_mass_place
    nearest = np.abs(np.minimum(place, 1.0 - place)[..., None] - PLACES).argmin(axis=-1)
    return np.asarray(nearest[..., None] == np.arange(len(PLACES)))


def asked_places(arrays: RobotArrays) -> np.ndarray:
    """(..., m, p) shares where a cable carries its mass, or might carry one: `PLACES` but for the one it has."""
    there = nearest_place(arrays) & (arrays.added_mass > 0.0)[..., None]
    return np.where(there, arrays.added_mass_place[..., None], PLACES)
