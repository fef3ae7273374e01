"""What may stand where nothing was read: tensions in balance, the lengths of cables then, and zeros of encoders."""

from dataclasses import replace

import numpy as np

from cdpr_struct.errors import CdprError, InputError
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.observation.readings import LEAST_TENSION, Readings, cell_reading
from cdpr_struct.observation.rest import at_states
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.energy_descent import arm_scale
from cdpr_struct.statics.equilibrium import PlatformArms
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.tensioned_cables import tensioned

_NEAR = 0.2  # of the platform's arm: farther away, locked lengths have led to another equilibrium


def filled(campaign: Campaign, arrays: RobotArrays, known: Circumstances, readings: Readings) -> Readings:
    """Readings with estimates where nothing was read: tensions that hold the platform, lengths of the cables then."""
    tension = readings.tension
    if np.isnan(tension).any():
        there = at_states(arrays, known)
        held = np.maximum(_tensions(campaign, there, readings, known), LEAST_TENSION)
        said = cell_reading(arrays, held, known.approach, known.wrap)
        tension = np.where(np.isfinite(tension), tension, said)
    readings = replace(readings, tension=tension)
    if np.isnan(readings.length).any():
        there = at_states(arrays, known)
        arms = PlatformArms.at(there, readings.position, readings.rotation)
        cables = tensioned(cable_model(known.model), there, arms.points, np.maximum(tension, LEAST_TENSION))
        length = arrays.reading(cables.total_length)
        readings = replace(readings, length=np.where(np.isfinite(readings.length), readings.length, length))
    return readings


def _tensions(campaign: Campaign, there: RobotArrays, readings: Readings, known: Circumstances) -> np.ndarray:
    """(S, m) tensions in balance at or near the poses: at locked lengths where all were read, else of least norm."""
    try:
        held = inverse(there, readings.position, readings.rotation, known.model, allow_unheld=True)
    except CdprError as error:
        expected = f"poses that the robot can hold, or tensions: {error}"
        raise InputError(campaign.source, "poses", "static states", expected) from error
    found = held.tensions
    locked = np.isfinite(readings.length).all(axis=1)
    if locked.any():
        index = np.flatnonzero(locked)
        place, turn = readings.position[index], readings.rotation[index]
        rest_ = forward(there.take(index), readings.length[index], place, turn, known.model)
        near = rest_.converged & (np.linalg.norm(rest_.position - place, axis=-1) < _NEAR * arm_scale(there))
        found = found.copy()
        found[index[near]] = rest_.tensions[near]
    return found


def encoder_zeros(campaign: Campaign, arrays: RobotArrays, known: Circumstances, readings: Readings) -> np.ndarray:
    """(m,) where relative encoders begin, in the median over states with a measured pose [m].

    Raises
    ------
    InputError : a cable whose length was read at no measured pose.
    """
    states = campaign.states
    posed = np.isfinite(states.position).all(axis=1) & np.isfinite(states.angles).all(axis=1)
    none = filled(campaign, arrays, known, replace(readings, length=np.full_like(states.length, np.nan)))
    gap = np.where(posed[:, None], states.length - none.length, np.nan)
    for cable in np.flatnonzero(~np.isfinite(gap).any(axis=0) & np.isfinite(states.length).any(axis=0)).tolist():
        expected = "a state with a measured pose (x_m, y_m, z_m and angles) in which its relative encoder was read"
        raise InputError(campaign.source, f"cable {cable + 1}", "no such state", expected)
    return np.array([np.median(own[np.isfinite(own)]) if np.isfinite(own).any() else 0.0 for own in gap.T])
