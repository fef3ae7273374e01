"""The state while vibration is measured: sensors or a shaker may hang on the platform that did not when it was read."""

import numpy as np

from cdpr_struct.diagnosis.conditioned_state import LEAST_TENSION, Circumstances, Conditioned, down, held_state
from cdpr_struct.diagnosis.robot_pitch import Dynamics
from cdpr_struct.diagnosis.world import World
from cdpr_struct.statics.equilibrium import rotation_from_vector


def vibrating(world: World, state: Conditioned, known: Circumstances) -> Conditioned:
    """The states (S) with the sensors' mass on the platform origin, cable lengths locked; `world` per state.

    Pose and tensions follow the weight to first order. Without such a mass the states themselves.
    """
    if not np.any(world.sensor_mass):
        return state
    twist, rise = _given_way(world, state, known)
    position = state.position + twist[..., :3]
    rotation = rotation_from_vector(twist[..., 3:]) @ state.rotation
    tension = np.maximum(state.tension + rise, LEAST_TENSION)
    return held_state(world, position, rotation, tension, known)


def raised(rest: Conditioned, state: Conditioned) -> np.ndarray | None:
    """(..., S, m) ln of what the cables' own frequencies rise by from a state to one of `vibrating`; or None."""
    if state is rest:
        return None
    result: np.ndarray = 0.5 * np.log(state.tension / rest.tension)
    return result


def _given_way(world: World, state: Conditioned, known: Circumstances) -> tuple[np.ndarray, np.ndarray]:
    """Twist (..., S, 6) of the platform under the mass [m, rad], and rise (..., S, m) of the tensions there [N]."""
    everywhere = np.arange(state.position.shape[-2])
    stiffness, carried = Dynamics.at(world, state, known, everywhere, True, True).at_rest()
    force = (world.sensor_mass * world.gravity)[..., None] * down(world)
    wrench = np.concatenate([force, np.zeros_like(force)], axis=-1)
    twist = np.linalg.solve(stiffness, wrench[..., None])
    back = (carried @ twist)[..., 0]
    pull = state.cables.force_on_platform
    back = back.reshape((*back.shape[:-1], *pull.shape[-2:]))
    return twist[..., 0], -(back * pull).sum(axis=-1) / state.cables.tension_at_platform
