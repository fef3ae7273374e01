"""Signals become robot frequencies: modes are identified, held against the model's, and join the campaign."""

from dataclasses import replace

import numpy as np

from cdpr_struct.errors import CdprError
from cdpr_struct.measurement.amplitude_windows import amplitude_windows
from cdpr_struct.measurement.campaign import Series, Sigmas
from cdpr_struct.measurement.decay_modes import decay_modes, refilled
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.modal_estimate import Modes
from cdpr_struct.measurement.mode_partners import SIZE_SPREAD, paired
from cdpr_struct.measurement.mode_size import channel_shapes, direction, log_sizes, translation_share
from cdpr_struct.measurement.peak_kinds import MODE, peak_kinds
from cdpr_struct.measurement.response_modes import response_modes
from cdpr_struct.measurement.signal_records import SignalRecord, records
from cdpr_struct.measurement.state_modes import StateModes, state_modes
from cdpr_struct.measurement.unit_scale import check_pose_scale
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.energy_descent import arm_scale

VISIBLE = 0.15  # share of the kinetic energy in the platform from which on a mode counts as the robot's
SEEN = 0.25  # the same as an FRF shows it, whatever the model says
CLEAR = 10.0  # amplitude over its sigma
_FILLINGS = 2  # of lost samples, from the modes found before
_OF_WIDTH = 0.25  # of a peak's half-width: modes nearer than their widths are fitted as one


def placed_records(series: Series, robot: Robot, poses: dict[str, np.ndarray]) -> list[SignalRecord]:
    """Records of a signal file at their poses.

    poses : case to (7,) pose (m, rad) and payload [kg], of cases that other files describe

    Raises
    ------
    InputError : rows that do not make records, or whose pose or lengths cannot be in m.
    """
    placed = [_placed(record, poses) for record in records(series, len(robot.cables))]
    for r in placed:
        check_pose_scale(r.file, r.case, robot, r.position, r.angles, r.lengths)
    return placed


def _placed(record: SignalRecord, poses: dict[str, np.ndarray]) -> SignalRecord:
    """The record with the pose of its case, where its own file has none."""
    known = poses.get(record.case)
    if known is None or np.isfinite(record.position).all():
        return record
    return replace(record, position=known[:3], angles=known[3:6], payload=float(known[6]))


def own_modes(record: SignalRecord, sigmas: Sigmas) -> Identified:
    """Modes of a record, not held against any model yet."""
    if record.kind == "frf":
        modes, windows = response_modes(record.axis, record.signal), None
        scatter, kinds = np.ones(len(modes)), [MODE] * len(modes)
    else:
        record, modes = _decay(record)
        kinds = peak_kinds(modes)
        own = [f for f, kind, s in zip(modes.hertz, kinds, modes.strength, strict=True) if kind == MODE and s > CLEAR]
        windows = amplitude_windows(record.axis, record.signal, modes, min(own, default=0.0))
        scatter = windows.scatter() if len(windows.middle) else np.ones(len(modes))
    sigma = modes.hertz_sigma * scatter
    if record.kind == "frf":
        sigma = np.hypot(sigma, _OF_WIDTH * modes.damping * modes.hertz)
    if sigmas.frequency_hz is not None:
        sigma = np.hypot(sigma, sigmas.frequency_hz)
    k = len(modes)
    return Identified(
        record, modes, windows, sigma, tuple(kinds), np.full(k, -1), np.zeros(k, dtype=bool), ("",) * k, "", None
    )


def _decay(record: SignalRecord) -> tuple[SignalRecord, Modes]:
    """A record in time with its modes; samples that were lost are filled in with what these have there."""
    modes = decay_modes(record.axis, record.signal)
    for _ in range(_FILLINGS if record.lost.any() else 0):
        record = replace(record, signal=refilled(record.axis, record.signal, record.lost, modes.poles))
        modes = decay_modes(record.axis, record.signal)
    return record, modes


def held_against(item: Identified, robot: Robot, model: str) -> Identified:
    """Identified modes held against a robot's; against another's they may join and pair differently."""
    record, modes, kinds = item.record, item.modes, item.kinds
    partner, state, note = np.full(len(modes), -1), None, ""
    seen = translation_share(modes, record, robot.platform.mass + record.payload)
    own = np.flatnonzero([kind == MODE for kind in kinds])
    if not len(own):
        note = "no mode above the noise"
    elif not np.isfinite(record.position).all():
        note = "no pose: give pose columns, or a case that another file describes"
    elif len(robot.cables) < 6 and not np.isfinite(record.lengths).all():
        note = "fewer than six cables hold a pose at locked lengths only: give length columns"
    else:
        try:
            loaded, highest = robot.with_load(record.payload), float(modes.hertz[own].max())
            state = state_modes(loaded, record.position, record.angles, record.lengths, highest, model)
            partner[own] = partners(modes.take(own), state, record)
        except CdprError as error:
            note = str(error)
    return _judged(replace(item, partner=partner, note=note, state=state), seen)


def held_at(item: Identified, other: Identified) -> Identified:
    """Identified modes held against the model at another record's pose."""
    there = other.record
    place = {name: getattr(there, name) for name in ("case", "position", "angles", "lengths", "payload")}
    record, state = replace(item.record, **place), other.state
    partner, own = np.full(len(item.modes), -1), np.flatnonzero([kind == MODE for kind in item.kinds])
    if state is not None and len(own):
        partner[own] = partners(item.modes.take(own), state, record)
    mass = 0.0 if state is None else state.point.entered.platform.mass
    moved = replace(item, record=record, partner=partner, note=other.note, state=state)
    return _judged(moved, translation_share(item.modes, record, mass))


def _judged(item: Identified, seen: np.ndarray) -> Identified:
    """With what joins the campaign; seen (k,) : share of the energy that is seen in the platform."""
    state, own_size = item.state, _own_size(item.modes, item.partner, item.state, item.record)
    reason = [
        _reason(i, item.modes, item.kinds, item.partner, state, bool(seen[i] >= SEEN), bool(own_size[i]))
        for i in range(len(item.modes))
    ]
    used = np.array([not r for r in reason], dtype=bool) & (state is not None)
    return replace(item, used=used, reason=tuple(reason))


def _own_size(modes: Modes, partner: np.ndarray, state: StateModes | None, record: SignalRecord) -> np.ndarray:
    """(k,) bool: whether each peak of an FRF is not much smaller than its partner in the model."""
    if state is None or record.kind != "frf":
        return np.ones(len(modes), dtype=bool)
    off = log_sizes(modes, model_shapes(state, record))[np.arange(len(modes)), partner]
    return off > -SIZE_SPREAD


def _reason(
    i: int,
    modes: Modes,
    kinds: tuple[str, ...],
    partner: np.ndarray,
    state: StateModes | None,
    seen: bool,
    own_size: bool,
) -> str:
    """Why a peak does not join, or nothing; one that is seen to move the platform needs no partner to do so."""
    if kinds[i] != MODE:
        return kinds[i]
    if modes.strength[i] < CLEAR:
        return "weak"
    if state is None:
        return "no model at this state"
    if seen:
        return ""
    if partner[i] < 0:
        return "no matching mode in the model"
    share = float(state.modes.platform_energy[partner[i]])
    if share < VISIBLE:
        return f"a mode of the cables ({share:.0%} of its energy in the platform)"
    return "" if own_size else "much smaller than the matching mode of the model"


def partners(modes: Modes, state: StateModes, record: SignalRecord) -> np.ndarray:
    """(k,) the model's mode for each identified one; -1 where none is near."""
    hidden = None if record.kind == "frf" else 1.0 - state.modes.platform_energy
    return paired(modes, channel_weight(state, record), state.hertz, model_shapes(state, record), hidden)


def model_shapes(state: StateModes, record: SignalRecord) -> np.ndarray:
    """(k, c) the model's mode shapes in the channels of a record; turns weighed by the platform's radius."""
    platform = state.modes.platform
    if record.kind == "free_decay":
        return platform[:, :3]
    if record.kind == "platform_motion":
        return platform * channel_weight(state, record)
    return channel_shapes(platform, record)


def platform_shape(record: SignalRecord, shape: np.ndarray) -> np.ndarray:
    """(6,) complex motion of the platform in a mode with channels' amplitudes (c,); nan where no channel looks."""
    seen = np.full(6, np.nan, dtype=complex)
    if record.kind != "frf":
        seen[: len(shape)] = shape
        return seen
    source = record.channels[0].split("/", 1)[1]
    for name, value in zip(record.channels, shape, strict=True):
        respond, excite = name.split("/", 1)
        along = direction(respond)
        if excite == source and along.any():
            axis = int(np.abs(along).argmax())
            seen[axis] = value * along[axis]
    return seen


def channel_weight(state: StateModes, record: SignalRecord) -> np.ndarray:
    """(c,) factors that make channels comparable: turns count by what they do at the radius of the anchors."""
    if record.kind != "platform_motion":
        return np.ones(len(record.channels))
    return np.array([1.0] * 3 + [arm_scale(RobotArrays.of(state.point.entered))] * 3)


def modal_amplitudes(item: Identified, i: int, partner: int) -> np.ndarray:
    """(w,) of mode i in each window of a decay, for unit modal mass [sqrt(kg) m]; nan where it is not clear."""
    assert item.windows is not None
    assert item.state is not None
    weight = channel_weight(item.state, item.record)
    model = float(np.linalg.norm(model_shapes(item.state, item.record)[partner]))
    fast = (2.0 * np.pi * item.modes.hertz[i]) ** 2 if item.record.kind == "free_decay" else 1.0
    found: np.ndarray = np.linalg.norm(item.windows.amplitude[:, i] * weight, axis=1) / model / fast
    return found
