"""All residuals of a campaign, conditioned on what was measured, for a batch of worlds and readings.

| block | rows of a state                       | unit | zero means |
| ----- | ------------------------------------- | ---- | ---------------------------------------------------- |
| EQ    | 6, moments over the platform's radius | N    | the measured tensions balance the weight |
| CO    | m                                     | mm   | the encoder's lengths fit measured pose and tensions |
| NS    | m - 6, states without encoder         | mm   | tensions sit where the commanded lengths put them |
| LP    | 6, turns times the platform's radius  | mm   | the pose at locked lengths is the measured one |
| CF    | one a cable frequency                 | %    | ln of measured over computed frequency at that state |
| RF    | one a robot frequency                 | %    | same |
| FA    | one a mode and channel of an FRF      | %    | ln of measured over computed modal constant |
"""

from dataclasses import dataclass, field, replace

import numpy as np

from cdpr_struct.diagnosis import robot_pitch
from cdpr_struct.diagnosis.cable_pitch import cable_log_frequencies
from cdpr_struct.diagnosis.commanded import Commanded
from cdpr_struct.diagnosis.conditioned_state import Circumstances, Conditioned, condition, incompatible, unbalanced
from cdpr_struct.diagnosis.locked_pose import Reference, equilibria, missed_pose
from cdpr_struct.diagnosis.modal_constants import Constants, log_gain, modelled_constants
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.vibrating_state import raised, vibrating
from cdpr_struct.diagnosis.world import World
from cdpr_struct.measurement.campaign import CableFrequencies, Campaign
from cdpr_struct.statics.cable_state import CableStates

BLOCKS = ("EQ", "CO", "NS", "LP", "CF", "RF", "FA")
UNITS = {"EQ": "N", "CO": "mm", "NS": "mm", "LP": "mm", "CF": "%", "RF": "%", "FA": "%"}
KIND_OF_BLOCK = {
    "EQ": "static_state", "CO": "static_state", "NS": "static_state", "LP": "loaded_pose", "CF": "cable_frequency",
    "RF": "robot_frequency", "FA": "frf",
}  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Labels:
    """Of each of n residuals: block name, state, and cable (-1: none)."""

    block: np.ndarray
    state: np.ndarray
    cable: np.ndarray

    def __len__(self) -> int:
        return len(self.block)

    @property
    def kind(self) -> np.ndarray:
        """(n,) kind of data that the residual belongs to."""
        return np.array([KIND_OF_BLOCK[b] for b in self.block], dtype=object)


@dataclass(frozen=True, slots=True, eq=False)
class Setting:
    """The fixed part of the residuals.

    held : states whose tensions were read;  locked : states known by their lengths only (indices)
    with_length : among `held`, whether lengths were read too
    sent : what the simulation commands at `held` states without lengths
    radius : of the platform [m]
    cable_rows, robot_rows : measured frequencies, and the gaps ln(exact / closed form) at the world as entered
    entered, entered_rate, entered_rise : D and its rate at the rows in their world, what `raised` says there
    nearness (r, m) : of the rows to the cables' own frequencies, as in `robot_pitch`
    robot_doubt : extra noise of each robot frequency [%]
    constants, constant_gap, constant_doubt : modal constants of FRFs, ln(exact / closed form), extra noise [%]
    locked_at, sent_at : equilibria in the world that this setting is about, of the `locked` states and, at the lengths
        sent, of the `held` states without lengths; None where there are none, or no first-order change starts there
    stray : probability of each robot frequency to belong to no mode of that world
    """

    campaign: Campaign
    known: Circumstances
    held: np.ndarray
    locked: np.ndarray
    with_length: np.ndarray
    sent: Commanded
    radius: float
    labels: Labels
    cable_rows: CableFrequencies
    cable_gap: np.ndarray
    robot_rows: robot_pitch.Rows
    robot_gap: np.ndarray
    robot_log: np.ndarray
    robot_doubt: np.ndarray
    entered: np.ndarray
    entered_rate: np.ndarray
    entered_rise: np.ndarray
    nearness: np.ndarray
    constants: Constants
    constant_gap: np.ndarray
    constant_doubt: np.ndarray
    massless: bool = False
    geometric: bool = True
    locked_at: Reference | None = None
    sent_at: Reference | None = None
    stray: np.ndarray = field(default_factory=lambda: np.zeros(0))

    @property
    def strays(self) -> float:
        """Expected number of robot frequencies that belong to no mode."""
        return float(self.stray.sum())


def residuals(setting: Setting, world: World, readings: Readings, small: bool = False) -> np.ndarray:
    """(..., n) residuals in the units of the table above.

    world : batch axes (B,) or none;  readings : (B, S, ...) or (S, ...)
    small : locked poses and robot frequencies to first order in the change of world and readings, for Jacobians
    """
    batch = _batch(world, readings)
    wide = world.per_state()
    states = States(setting, wide, readings, small)
    blocks = _static_blocks(setting, wide, states, readings, small) if setting.held.size else []
    if setting.locked.size:
        blocks.append(1e3 * _scaled(states.missed, setting.radius))
    flat = [np.broadcast_to(b, (*batch, *b.shape[-2:])).reshape((*batch, -1)) for b in blocks]
    flat += [np.broadcast_to(r, (*batch, r.shape[-1])) for r in _of_vibration(setting, wide, states.all, small)]
    return np.concatenate(flat, axis=-1)


def _of_vibration(setting: Setting, world: World, rest: Conditioned, small: bool) -> list[np.ndarray]:
    """Cable frequencies, robot frequencies and modal constants, with what hangs on the platform for them."""
    rows, cables, robot = [], setting.cable_rows.hertz.size, setting.robot_rows.omega.size
    state = vibrating(world, rest, setting.known) if cables or robot else rest
    if cables:
        model = cable_log_frequencies(world, state.cables, setting.cable_rows) + setting.cable_gap
        rows.append(100.0 * (np.log(setting.cable_rows.hertz) - model))
    if robot:
        rows += [100.0 * block for block in _robot_blocks(setting, world, state, raised(rest, state), small)]
    return rows


def _batch(world: World, readings: Readings) -> tuple[int, ...]:
    sizes = {getattr(world, name).shape[0] for name in World.__slots__ if world.is_batched(name)}
    if readings.position.ndim > 2:
        sizes.add(readings.position.shape[0])
    if len(sizes - {1}) > 1:
        raise ValueError(f"batch sizes differ: {sorted(sizes)}")
    return (max(sizes),) if sizes else ()


class States:
    """Conditioned states of those with tensions, locked ones of the others, and both together."""

    def __init__(self, setting: Setting, world: World, readings: Readings, small: bool = False) -> None:
        parts = []
        if setting.held.size:
            self.held = condition(
                world_of_states(world, setting.held),
                readings_of_states(readings, setting.held),
                at_states(setting, setting.held),
            )
            parts.append((setting.held, self.held))
        if setting.locked.size:
            part, known = readings_of_states(readings, setting.locked), at_states(setting, setting.locked)
            own = world_of_states(world, setting.locked)
            found = equilibria(own, part, known, setting.locked_at, small)
            self.missed = missed_pose(own, part, found)
            arms = world.platform_anchors @ np.swapaxes(found.rotation, -1, -2)
            parts.append(
                (setting.locked, Conditioned(found.position, found.rotation, arms, found.tensions, found.cables))
            )
        self.all = _merged(parts)


def among(setting: Setting, some: np.ndarray) -> Setting:
    """The setting of some states only, for `States`; its rows are those of all."""
    kept = np.isin(setting.locked, some)
    about = None if setting.locked_at is None or not kept.any() else setting.locked_at.some(np.flatnonzero(kept))
    return replace(setting, held=np.intersect1d(setting.held, some), locked=setting.locked[kept], locked_at=about)


def resting_and_vibrating(
    setting: Setting, world: World, readings: Readings, some: np.ndarray
) -> tuple[Conditioned, Conditioned]:
    """Some states, in ascending order, as they were read and while vibration is measured; `world` per state."""
    rest = States(among(setting, some), world, readings).all
    return rest, vibrating(world, rest, at_states(setting, some))


def world_of_states(world: World, index: np.ndarray) -> World:
    """World per state whose pose offsets are those of the chosen states."""
    offset = world.pose_offset
    per = offset.reshape((*offset.shape[:-1], -1, 6))[..., index, :]
    return replace(world, pose_offset=per.reshape((*offset.shape[:-1], -1)))


def readings_of_states(readings: Readings, index: np.ndarray) -> Readings:
    return Readings(
        np.take(readings.position, index, axis=-2), np.take(readings.rotation, index, axis=-3),
        np.take(readings.tension, index, axis=-2), np.take(readings.length, index, axis=-2),
    )  # fmt: skip


def at_states(setting: Setting, index: np.ndarray) -> Circumstances:
    """What is known of some states."""
    return setting.known.at(index)


def _merged(parts: list[tuple[np.ndarray, Conditioned]]) -> Conditioned:
    """One `Conditioned` over all states, in the campaign's order."""
    order = np.argsort(np.concatenate([index for index, _ in parts]))

    def join(values: list[np.ndarray], core: int) -> np.ndarray:
        lead = np.broadcast_shapes(*(v.shape[: v.ndim - core - 1] for v in values))
        wide = [np.broadcast_to(v, (*lead, *v.shape[v.ndim - core - 1 :])) for v in values]
        return np.take(np.concatenate(wide, axis=len(lead)), order, axis=len(lead))

    states = [state for _, state in parts]
    cables = CableStates(
        *(
            join([getattr(s.cables, name) for s in states], 2 if name in ("offset", "heading") else 1)
            for name in CableStates.__slots__
        )
    )
    fields = (("position", 1), ("rotation", 2), ("arms", 2), ("tension", 1))
    position, rotation, arms, tension = (join([getattr(s, name) for s in states], core) for name, core in fields)
    return Conditioned(position, rotation, arms, tension, cables)


def _scaled(twist: np.ndarray, radius: float) -> np.ndarray:
    return np.concatenate([twist[..., :3], twist[..., 3:] * radius], axis=-1)


def _static_blocks(setting: Setting, world: World, states: States, readings: Readings, small: bool) -> list[np.ndarray]:
    part, known = readings_of_states(readings, setting.held), at_states(setting, setting.held)
    wrench = unbalanced(world, states.held, known)
    blocks = [np.concatenate([wrench[..., :3], wrench[..., 3:] / setting.radius], axis=-1)]
    if setting.with_length.any():
        gap = incompatible(world, states.held, part, known)
        blocks.append(1e3 * np.take(gap, np.flatnonzero(setting.with_length), axis=-2))
    if setting.sent.null_space.any():
        blocks.append(1e3 * _internal(setting, world, states, readings, small))
    return blocks


def as_sent(setting: Setting, world: World, readings: Readings) -> tuple[World, Readings, Circumstances]:
    """The held states without lengths, at those that the simulation commands; `world` per state."""
    free = np.flatnonzero(~setting.with_length)
    where = setting.held[free]
    aimed = replace(readings_of_states(readings, where), length=setting.sent.lengths[free])
    return world_of_states(world, where), aimed, at_states(setting, where)


def _internal(setting: Setting, world: World, states: States, readings: Readings, small: bool) -> np.ndarray:
    """(..., free, q) commanded lengths less those that the tensions mean, along the null space [m].

    The pose that was commanded is not the one measured: it is as far from it as this world's robot, sent to the
    measured pose by the simulation, would miss it.
    """
    free = np.flatnonzero(~setting.with_length)
    sent, where = setting.sent, setting.held[free]
    gap = np.take(sent.lengths * world.length_scale + world.length_offset - states.held.cables.total_length, free, -2)
    seen = np.einsum("smq,...sm->...sq", sent.null_space[free], gap)
    own, aimed, known = as_sent(setting, world, readings)
    found = equilibria(own, aimed, known, setting.sent_at, small)
    seen = seen + np.einsum("sqj,...sj->...sq", sent.slope[free], missed_pose(own, aimed, found))
    q = seen.shape[-1]
    apart = world.internal.reshape((*world.internal.shape[:-1], -1, q))[..., where, :]
    apart = apart[..., 0, :, :] if apart.ndim > 2 else apart
    common = np.einsum("sij,...sj->...si", sent.rate[free], world.internal_force[..., None, :]
                       if world.internal_force.ndim == 1 else world.internal_force)  # fmt: skip
    return seen + apart + common


def _robot_blocks(
    setting: Setting, world: World, state: Conditioned, rise: np.ndarray | None, small: bool
) -> list[np.ndarray]:
    """Robot frequencies, and modal constants where any were measured; rise (..., S, m) as of `raised`."""
    rows = setting.robot_rows
    dynamics = robot_pitch.Dynamics.at(world, state, setting.known, rows.state, setting.massless, setting.geometric)
    along = _along(setting, rise)
    move = robot_pitch.first_order(dynamics, rows, setting.entered, setting.entered_rate, along)
    log = np.log(rows.omega) + move
    if not small:  # absurd worlds may send the first guess anywhere
        near = np.log(rows.omega) + np.clip(np.nan_to_num(move), -1.0, 1.0)
        log = np.log(robot_pitch.follow(dynamics, rows, np.exp(near)))
    frequencies = setting.robot_log - log - setting.robot_gap
    constants = setting.constants
    if not len(constants):
        return [frequencies]
    model = modelled_constants(constants, dynamics, rows, np.exp(log)) + log_gain(constants, world)
    return [frequencies, constants.log - model - setting.constant_gap]


def _along(setting: Setting, rise: np.ndarray | None) -> np.ndarray | None:
    """(..., r) ln of what nearest cables' own frequencies rise by from the world of the rows; None if by nothing."""
    if rise is None and not setting.entered_rise.any():
        return None
    now = 0.0 if rise is None else np.take(rise, setting.robot_rows.state, axis=-2)
    result: np.ndarray = ((now - setting.entered_rise) * setting.nearness).sum(axis=-1)
    return result
