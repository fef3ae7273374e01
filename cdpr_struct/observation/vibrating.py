"""The robot while vibration is measured: sensors or a shaker may hang on the platform that did not when it was read."""

from dataclasses import replace

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.observation.readings import LEAST_TENSION
from cdpr_struct.observation.rest import Rest
from cdpr_struct.robot.parameters import PARAMETERS
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.cable_response import end_stiffness
from cdpr_struct.statics.equilibrium import PlatformArms, rotation_from_vector, tangent_stiffness
from cdpr_struct.statics.tensioned_cables import tensioned

_NEUTRAL = 1e-13  # of the largest singular value: a smaller one is zero but for rounding


def vibrating(state: Rest, known: Circumstances) -> OperatingPoint:
    """States (..., S) at rest, with the sensors' mass on the platform origin and the cables' lengths locked.

    Pose and tensions follow the sensors' weight to first order; without such a mass they are those at rest.
    """
    arrays = state.arrays
    if not arrays.sensor_mass.any():
        return OperatingPoint(arrays, state.position, state.rotation, state.cables)
    twist, rise = _given_way(state)
    heavier = arrays.with_point_masses(arrays.sensor_mass[..., None], np.zeros(3))
    position = state.position + twist[..., :3]
    rotation = rotation_from_vector(twist[..., 3:]) @ state.rotation
    arms = PlatformArms.at(heavier, position, rotation)
    tension = np.maximum(state.cables.tension_at_platform + rise, LEAST_TENSION)
    return OperatingPoint(
        heavier, position, rotation, tensioned(cable_model(known.model), heavier, arms.points, tension)
    )


def _given_way(state: Rest) -> tuple[np.ndarray, np.ndarray]:
    """Twist (..., S, 6) of the platform under the mass [m, rad], and rise (..., S, m) of the tensions there [N]."""
    arrays, arms = state.arrays, state.arms
    down = np.concatenate([arrays.tilt, np.full((*arrays.tilt.shape[:-1], 1), -1.0)], axis=-1)
    force = (arrays.sensor_mass * arrays.gravity)[..., None] * down
    wrench = np.concatenate([force, np.zeros_like(force)], axis=-1)
    # in freedoms that nothing holds, as a point mass turns, the platform stays
    twist = (np.linalg.pinv(tangent_stiffness(arrays, state.cables, arms), _NEUTRAL) @ wrench[..., None])[..., 0]
    moved = twist[..., None, :3] + np.cross(twist[..., None, 3:], arms.arms)
    back = (end_stiffness(arrays, state.cables) @ moved[..., None])[..., 0]
    pull = state.cables.force_on_platform
    return twist, -(back * pull).sum(axis=-1) / state.cables.tension_at_platform


def of_states(arrays: RobotArrays, index: np.ndarray, states: int) -> RobotArrays:
    """The robot in some of its states (..., S, ...); fields without an axis for states stay as they are."""
    taken = {}
    for name, rule in PARAMETERS.items():
        value, axes = getattr(arrays, name), rule.axes
        if value.ndim > axes and value.shape[value.ndim - axes - 1] == states:
            taken[name] = np.take(value, index, axis=value.ndim - axes - 1)
    return replace(arrays, **taken)
