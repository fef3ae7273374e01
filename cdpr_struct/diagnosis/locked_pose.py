"""The pose that the platform takes at locked lengths in a given world, beside the measured one."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis.conditioned_state import (
    Circumstances,
    load_wrench,
    paid_out,
    series_stiffness,
    true_pose,
)  # fmt: skip
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.world import World
from cdpr_struct.errors import CdprError
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import (
    PlatformArms,
    cable_wrench,
    rotation_from_vector,
    tangent_stiffness,
    weight_wrench,
)
from cdpr_struct.statics.forward_kinematics import ForwardSolution, forward

_MOST_ROUNDS, _SAME = 8, 1e-6  # of a stiffness that follows the tensions; share of it that ends them
_SHORTEST = 1e-3  # m, of a cable that a law leaves no length
_STEPS, _BALANCED = 8, 1e-3  # most steps near a reference; imbalance left, in the largest load


def robot_arrays(world: World, stiffness: np.ndarray, known: Circumstances) -> RobotArrays:
    """The world's robot for the statics room; weight of the platform is left to the load wrench."""
    sag = 1.0 if known.sagging else 0.0
    return RobotArrays(
        platform_anchors=world.platform_anchors, frame_anchors=world.frame_anchors, axial_stiffness=stiffness,
        linear_density=world.linear_density * sag, pulley_radius=world.pulley_radius,
        pulley_axis=world.pulley_axis, mass=np.asarray(world.mass), center_of_mass=world.center_of_mass,
        inertia=world.inertia, gravity=np.asarray(world.gravity), frame_compliance=world.frame_compliance,
        masts=world.masts,
    )  # fmt: skip


def locked_pose(
    world: World, readings: Readings, known: Circumstances, about: "Reference | None" = None
) -> tuple[ForwardSolution, np.ndarray]:
    """Equilibria (..., S) at the encoder's lengths, and the arrays' effective stiffness; `world` per state.

    about : equilibria of a world like this one, to begin from; else the measured poses

    Where a law leaves a cable no length, the position is nan.
    """
    position, rotation = true_pose(world, readings)
    length = paid_out(world, readings, known)
    exists = np.all(length > 0.0, axis=-1, keepdims=True)
    length = np.maximum(length, _SHORTEST)
    extra = load_wrench(world, position, rotation, known) - _own_weight(world, rotation)
    start, tension = (position, rotation), np.full(length.shape, known.mean_tension)
    if about is not None:
        start, tension = (about.position, about.rotation), np.maximum(about.cables.tension_at_platform, 1.0)
    stiff = series_stiffness(world, length, tension, known)
    model = "sagging" if known.sagging else "spring"
    for _ in range(_MOST_ROUNDS):
        found = forward(robot_arrays(world, stiff, known), length, *start, model, extra)
        stiffer = series_stiffness(world, length, np.maximum(found.tensions, 1.0), known)
        if np.abs(stiffer / stiff - 1.0).max() <= _SAME:
            break
        stiff, start = stiffer, (found.position, found.rotation)
    return replace(found, position=np.where(exists, found.position, np.nan)), stiff


def _own_weight(world: World, rotation: np.ndarray) -> np.ndarray:
    center = (rotation @ world.center_of_mass[..., None])[..., 0]
    force = np.zeros((*np.broadcast_shapes(center.shape[:-1], world.mass.shape), 3))
    force[..., 2] = -world.mass * world.gravity
    return np.concatenate(np.broadcast_arrays(force, np.cross(center, force)), axis=-1)


@dataclass(frozen=True, slots=True, eq=False)
class Reference:
    """Equilibria of one world at the states (S): pose, flexibility (S, 6, 6) of the platform there, and cables."""

    position: np.ndarray
    rotation: np.ndarray
    flexibility: np.ndarray
    cables: CableStates

    def some(self, index: np.ndarray) -> "Reference":
        """Those of some of the states."""
        cables = self.cables.at(index)
        return Reference(self.position[index], self.rotation[index], self.flexibility[index], cables)


@dataclass(frozen=True, slots=True, eq=False)
class Nearby:
    """Poses to first order about a reference, with the cables there."""

    position: np.ndarray
    rotation: np.ndarray
    cables: CableStates

    @property
    def tensions(self) -> np.ndarray:
        """(..., m) at the platform [N]."""
        return self.cables.tension_at_platform


def reference(world: World, readings: Readings, known: Circumstances) -> Reference:
    """Equilibria of a world without batch axes.

    Raises
    ------
    CdprError : a cable has no length there.
    """
    found, stiff = locked_pose(world, readings, known)
    if np.isnan(found.position).any():
        raise CdprError("a cable would have no length")
    arrays = robot_arrays(world, stiff, known)
    arms = PlatformArms.at(arrays, found.position, found.rotation)
    tangent = tangent_stiffness(arrays, found.cables, arms)
    return Reference(found.position, found.rotation, np.linalg.inv(tangent), found.cables)


def nearby_pose(world: World, readings: Readings, known: Circumstances, about: Reference) -> Nearby | None:
    """Equilibria (..., S) of worlds near that of a reference: Newton's method from there, its stiffness kept.

    One step does, except for cables that hardly stretch: there the square of a small turn is a large force, and the
    steps may lead nowhere. None if so, or if a law leaves a cable no length.
    """
    position, rotation = true_pose(world, readings)
    length = paid_out(world, readings, known)
    if not np.all(length > 0.0):
        return None
    load = load_wrench(world, position, rotation, known) - _own_weight(world, rotation)
    tension = about.cables.tension_at_platform
    stiff = series_stiffness(world, length, np.maximum(tension, 1.0), known)
    arrays = robot_arrays(world, stiff, known)
    model = cable_model("sagging" if known.sagging else "spring")
    shape = np.broadcast_shapes(
        position.shape[:-1], length.shape[:-1], stiff.shape[:-1], load.shape[:-1], arrays.batch_shape
    )
    length = np.broadcast_to(length, (*shape, length.shape[-1]))
    flat = arrays.flattened(shape)
    place, turn = (np.broadcast_to(v, (*shape, *v.shape[1:])) for v in (about.position, about.rotation))

    def cables_at(place: np.ndarray, turn: np.ndarray) -> tuple[CableStates, PlatformArms]:
        arms = PlatformArms.at(flat, place.reshape((-1, 3)), turn.reshape((-1, 3, 3)))
        return model.states(flat, arms.points, length.reshape((-1, length.shape[-1]))), arms

    states, arms = cables_at(place, turn)
    for taken in range(_STEPS + 1):
        weight = weight_wrench(flat, arms).reshape((*shape, 6))
        wrench = cable_wrench(states, arms).reshape((*shape, 6)) + weight + load
        if taken and np.abs(wrench).max() < _BALANCED * np.abs(weight + load).max():
            break
        if taken == _STEPS or not np.isfinite(wrench).all():
            return None
        step = (about.flexibility @ wrench[..., None])[..., 0]
        place, turn = place + step[..., :3], rotation_from_vector(step[..., 3:]) @ turn
        states, arms = cables_at(place, turn)
    whole = CableStates(
        *(getattr(states, n).reshape((*shape, *getattr(states, n).shape[1:])) for n in states.__slots__)
    )
    return Nearby(place, turn, whole)


def equilibria(
    world: World, readings: Readings, known: Circumstances, about: Reference | None, small: bool
) -> ForwardSolution | Nearby:
    """Equilibria (..., S) at the encoder's lengths; small: to first order about those known, if there are any."""
    near = nearby_pose(world, readings, known, about) if small and about is not None else None
    return near if near is not None else locked_pose(world, readings, known, about)[0]


def missed_pose(world: World, readings: Readings, found: ForwardSolution | Nearby) -> np.ndarray:
    """(..., S, 6) measured minus computed pose: shift [m] and turn as rotation vector, world axes [rad]."""
    position, rotation = true_pose(world, readings)
    turn = rotation @ np.swapaxes(found.rotation, -1, -2)
    skew = 0.5 * (turn - np.swapaxes(turn, -1, -2))
    vector = np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)
    return np.concatenate([position - found.position, vector], axis=-1)
