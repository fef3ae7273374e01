"""The pose that the platform takes at locked lengths in a given world, beside the measured one."""

import numpy as np

from cdpr_struct.diagnosis.conditioned_state import (
    Circumstances,
    Conditioned,
    load_wrench,
    moved_anchors,
    paid_out,
    series_stiffness,
    true_pose,
)  # fmt: skip
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.world import World
from cdpr_struct.statics.forward_kinematics import ForwardSolution, forward
from cdpr_struct.statics.robot_arrays import RobotArrays

_MAST_ITERATIONS = 4


def robot_arrays(world: World, stiffness: np.ndarray, anchors: np.ndarray, known: Circumstances) -> RobotArrays:
    """The world's robot for the statics room; weight of the platform is left to the load wrench."""
    sag = 1.0 if known.sagging else 0.0
    return RobotArrays(
        platform_anchors=world.platform_anchors, frame_anchors=anchors, axial_stiffness=stiffness,
        weight=world.linear_density * world.gravity[..., None] * sag, pulley_radius=world.pulley_radius,
        pulley_axis=world.pulley_axis, mass=np.asarray(world.mass), center_of_mass=world.center_of_mass,
        gravity=np.asarray(world.gravity),
    )  # fmt: skip


def locked_pose(world: World, readings: Readings, known: Circumstances) -> tuple[ForwardSolution, np.ndarray]:
    """Equilibria (..., S) at the encoder's lengths, and the arrays' effective stiffness; `world` per state."""
    position, rotation = true_pose(world, readings)
    length = paid_out(world, readings, known)
    extra = load_wrench(world, position, rotation, known) - _own_weight(world, rotation)
    tension = np.full(length.shape, known.mean_tension)
    stiff = series_stiffness(world, length, tension, known)
    anchors = world.frame_anchors
    moving = bool(np.any(world.frame_compliance))
    bending = bool(np.any(world.nonlinearity))
    shape = np.broadcast_shapes(position.shape[:-1], length.shape[:-1], stiff.shape[:-1], extra.shape[:-1])
    start = np.broadcast_to(position, (*shape, 3)), np.broadcast_to(rotation, (*shape, 3, 3))
    model = "sagging" if known.sagging else "spring"
    for i in range(_MAST_ITERATIONS if moving or bending else 1):
        found = forward(robot_arrays(world, stiff, anchors, known), length, *start, model, extra)
        if i == _MAST_ITERATIONS - 1:
            break
        if moving:
            anchors = moved_anchors(world, found.cables, known)
        stiff = series_stiffness(world, length, np.maximum(found.tensions, 1.0), known)
        start = found.position, found.rotation
    return found, stiff


def _own_weight(world: World, rotation: np.ndarray) -> np.ndarray:
    center = (rotation @ world.center_of_mass[..., None])[..., 0]
    force = np.zeros((*np.broadcast_shapes(center.shape[:-1], world.mass.shape), 3))
    force[..., 2] = -world.mass * world.gravity
    return np.concatenate(np.broadcast_arrays(force, np.cross(center, force)), axis=-1)


def missed_pose(world: World, readings: Readings, found: ForwardSolution) -> np.ndarray:
    """(..., S, 6) measured minus computed pose: shift [m] and turn as rotation vector, world axes [rad]."""
    position, rotation = true_pose(world, readings)
    turn = rotation @ np.swapaxes(found.rotation, -1, -2)
    skew = 0.5 * (turn - np.swapaxes(turn, -1, -2))
    vector = np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)
    return np.concatenate([position - found.position, vector], axis=-1)


def state_from_lock(world: World, found: ForwardSolution) -> Conditioned:
    """The equilibrium at locked lengths as a state for the dynamics."""
    arms = world.platform_anchors @ np.swapaxes(found.rotation, -1, -2)
    return Conditioned(found.position, found.rotation, arms, found.tensions, found.cables)
