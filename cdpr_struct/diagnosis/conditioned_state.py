"""Wrench balance and length compatibility at the measured state.

The measured pose and tensions are put into the model; what is left over is the wrench that does not balance (EQ) and
the difference between the encoder's unstrained length and that of the cable with this tension between these points
(CO). Both are nearly linear in every cause, while tensions predicted from lengths are not.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.world import World
from cdpr_struct.statics.cable_state import CableStates, heading_and_span
from cdpr_struct.statics.catenary_length import CatenaryLength, solve_length
from cdpr_struct.statics.equilibrium import rotation_from_vector
from cdpr_struct.statics.pulley import pulley_exit, straight_exit

LEAST_TENSION = 1.0  # [N] a reading below this is taken as this: a slack cable has no direction
_EXIT_ITERATIONS = 8
_SAME_DIRECTION = 1e-8  # of the exit: below it lengths change by less than a tenth of a micrometre


@dataclass(frozen=True, slots=True, eq=False)
class Circumstances:
    """What is known of each state without error.

    payload (S,), approach (S, m), hours (S,), center (3,) mean position;
    wrap (S, m) : right angles that a cable turns at its exit;  mean_tension [N]
    sagging : whether cables have weight in this simulation
    """

    payload: np.ndarray
    approach: np.ndarray
    wrap: np.ndarray
    hours: np.ndarray
    center: np.ndarray
    mean_tension: float
    sagging: bool = True

    def at(self, some: np.ndarray) -> "Circumstances":
        """Those of some states."""
        own = {name: getattr(self, name)[some] for name in ("payload", "approach", "wrap", "hours")}
        return replace(self, **own)


@dataclass(frozen=True, slots=True, eq=False)
class Conditioned:
    """The state that readings mean in a world.

    position (..., S, 3), rotation (..., S, 3, 3), arms (..., S, m, 3); tension (..., S, m) true, at the platform;
    cables : CableStates with these tensions (axial stiffness with what is in series), anchors moved with the masts
    """

    position: np.ndarray
    rotation: np.ndarray
    arms: np.ndarray
    tension: np.ndarray
    cables: CableStates


def true_pose(world: World, readings: Readings) -> tuple[np.ndarray, np.ndarray]:
    """Position and rotation that the tracker's readings mean; `world` per state."""
    states = readings.position.shape[-2]
    turn = rotation_from_vector(world.tracker[..., 3:])
    position = (turn @ readings.position[..., None])[..., 0] + world.tracker[..., :3]
    own = world.pose_offset.reshape((*world.pose_offset.shape[:-1], -1, 6)) if world.pose_offset.size else None
    rotation = turn @ readings.rotation
    if own is not None:
        own = own.reshape((*own.shape[:-3], states, 6)) if own.ndim > 2 else own
        position, rotation = position + own[..., :3], rotation_from_vector(own[..., 3:]) @ rotation
    return position, rotation


def true_tension(world: World, readings: Readings, known: Circumstances) -> np.ndarray:
    """(..., S, m) tensions at the platform that the load cells' readings mean; `world` per state."""
    read = (readings.tension - world.cell_bias) / world.cell_gain
    return np.maximum(read * np.exp(-world.friction * known.approach * known.wrap), LEAST_TENSION)


def paid_out(world: World, readings: Readings, known: Circumstances) -> np.ndarray:
    """(..., S, m) unstrained length that the encoder's reading means; `world` per state."""
    return readings.length * world.length_scale + world.length_offset + world.slip * known.hours[:, None]


def series_stiffness(world: World, chord: np.ndarray, tension: np.ndarray, known: Circumstances) -> np.ndarray:
    """EA of a cable that gives way like the real one with all that is in line with it [N]."""
    relative = np.maximum(1.0 + world.nonlinearity[..., None] * (tension / known.mean_tension - 1.0), 0.05)
    stiff = world.axial_stiffness * relative
    hours = 60.0 * known.hours[:, None]
    lag = 1.0 + world.creep[..., None] * np.log10(1.0 + np.where(np.isfinite(hours), hours, 0.0))
    return stiff / np.maximum(lag + world.series_compliance * stiff / chord, 0.05)


def condition(world: World, readings: Readings, known: Circumstances) -> Conditioned:
    """The state that the readings of pose and tension mean; `world` per state."""
    return held_state(world, *true_pose(world, readings), true_tension(world, readings, known), known)


def held_state(
    world: World, position: np.ndarray, rotation: np.ndarray, tension: np.ndarray, known: Circumstances
) -> Conditioned:
    """The state of given pose and tensions (..., S, m) at the platform [N]; `world` per state."""
    arms = world.platform_anchors @ np.swapaxes(rotation, -1, -2)
    points = position[..., None, :] + arms
    cables = hold(world, points, tension, known, world.frame_anchors)
    if np.any(world.frame_compliance):
        for _ in range(3):
            moved = moved_anchors(world, cables)
            cables = hold(world, points, tension, known, moved)
    return Conditioned(position, rotation, arms, tension, cables)


def moved_anchors(world: World, cables: CableStates) -> np.ndarray:
    """Frame anchors (..., S, m, 3) under the pull of all the cables of their masts."""
    pull = np.einsum("ij,...jk->...ik", world.masts, cables.force_at_frame)
    return world.frame_anchors + world.frame_compliance[..., None] * pull


def hold(
    world: World, points: np.ndarray, tension: np.ndarray, known: Circumstances, anchors: np.ndarray
) -> CableStates:
    """Cables with the given tension at the platform between anchors and points (..., S, m, 3)."""
    offset = points - anchors
    weight = world.linear_density * world.gravity[..., None] * (1.0 if known.sagging else 0.0)
    stiff = series_stiffness(world, np.linalg.norm(offset, axis=-1), tension, known)
    if not np.any(world.pulley_radius > 0.0):
        return _between(offset, tension, stiff, weight, np.zeros(offset.shape[:-1]))[0]
    lead = np.broadcast_shapes(offset.shape[:-1], world.pulley_radius.shape)
    offset = np.broadcast_to(offset, (*lead, 3))
    axis, radius = np.broadcast_to(world.pulley_axis, offset.shape), np.broadcast_to(world.pulley_radius, lead)
    direction, held = straight_exit(offset, axis, radius), None
    for _ in range(_EXIT_ITERATIONS):
        leaving = pulley_exit(direction, axis, radius)
        free = offset - leaving.point
        cables, held = _between(free, tension, stiff, weight, radius * leaving.wrap_angle, held)
        turned = cables.force_at_frame / cables.tension_at_frame[..., None]
        settled = np.abs(turned - direction).max() < _SAME_DIRECTION
        direction = turned
        if settled:
            break
    return cables


def _between(
    offset: np.ndarray,
    tension: np.ndarray,
    stiff: np.ndarray,
    weight: np.ndarray,
    wrap: np.ndarray,
    near: CatenaryLength | None = None,
) -> tuple[CableStates, CatenaryLength]:
    heading, span = heading_and_span(offset)
    held = solve_length(span, offset[..., 2], tension, stiff, weight, near)
    weight = np.broadcast_to(weight, held.length.shape)
    stiff = np.broadcast_to(stiff, held.length.shape)
    whole = (*held.length.shape, 3)
    cables = CableStates(
        np.broadcast_to(offset, whole),
        np.broadcast_to(heading, whole),
        held.length,
        np.zeros_like(held.length),
        held.force_x,
        held.force_z,
        stiff,
        weight,
        held.status,
        np.zeros_like(held.length),
    )
    return replace(cables, wrapped_length=wrap / (1.0 + cables.tension_at_frame / stiff)), held


def load_wrench(world: World, position: np.ndarray, rotation: np.ndarray, known: Circumstances) -> np.ndarray:
    """(..., S, 6) wrench of weight, payload, joints, hose and forces about the platform origin; `world` per state."""
    gravity = world.gravity[..., None] * down(world)
    center = (rotation @ world.center_of_mass[..., None])[..., 0]
    arms = world.platform_anchors @ np.swapaxes(rotation, -1, -2)
    force = world.mass[..., None] * gravity
    moment = np.cross(center, force)
    joint = world.joint_mass[..., None] * gravity[..., None, :]
    moment = moment + np.cross(arms, joint).sum(axis=-2)
    force = force + joint.sum(axis=-2) + known.payload[:, None] * gravity + world.force
    force = force - world.hose[..., None] * (position - known.center)
    return np.concatenate(np.broadcast_arrays(force, moment), axis=-1)


def down(world: World) -> np.ndarray:
    """(..., 3) where the platform's weight pulls, world axes, its vertical part 1."""
    flat = world.tilt
    return np.concatenate([flat, -np.ones((*flat.shape[:-1], 1))], axis=-1)


def unbalanced(world: World, state: Conditioned, known: Circumstances) -> np.ndarray:
    """EQ (..., S, 6): wrench of cables and load about the platform origin [N, N m]; zero if all were right."""
    force = state.cables.force_on_platform
    moment = np.cross(state.arms, force).sum(axis=-2)
    cables = np.concatenate([force.sum(axis=-2), moment], axis=-1)
    return cables + load_wrench(world, state.position, state.rotation, known)


def incompatible(world: World, state: Conditioned, readings: Readings, known: Circumstances) -> np.ndarray:
    """CO (..., S, m): paid-out length that the encoder means, minus that of the held cable [m]."""
    return paid_out(world, readings, known) - state.cables.total_length
