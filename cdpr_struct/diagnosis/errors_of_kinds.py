"""What the user sees: simulated minus measured, in his units, and where it is worst."""

import numpy as np

from cdpr_struct.association.detection import SHARE_INVISIBLE
from cdpr_struct.diagnosis.diagnosis import ErrorOfKind, Location
from cdpr_struct.diagnosis.internal_forces import simulated_tensions
from cdpr_struct.diagnosis.left_out import KINDS, rows_of
from cdpr_struct.hypotheses.explain import Explained
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.observation.rest import at_states
from cdpr_struct.observation.vibrating import of_states
from cdpr_struct.residuals.linearised import Local, Point
from cdpr_struct.residuals.recorded import Recorded
from cdpr_struct.statics.forward_kinematics import forward

_OF_ROWS = {"static_state": ("EQ", "CO", "SW"), "cable_frequency": ("CF",), "robot_frequency": ("RF",)}


def errors_of_kinds(story: Explained) -> list[ErrorOfKind]:
    """Of each kind of data that was read, as entered."""
    data, null = story.search.data, _null(story)
    table = rows_of(data, story.search.where, null, NoiseState.stated(null.model.groups))
    found = []
    for kind, values in _errors(data, null).items():
        if not np.isfinite(values).any():
            continue
        finite = np.where(np.isfinite(values), np.abs(values), -1.0)
        state, cable = np.unravel_index(int(finite.argmax()), values.shape)
        rows = np.isin(table.kind.astype(str), _OF_ROWS.get(kind, ("EQ", "CO"))) & _of_states(data, kind)[table.state]
        chi2 = float(np.mean((table.before[rows] / table.sigma[rows]) ** 2)) if rows.any() else np.nan
        unit = {"static_state": "N", "loaded_pose": "mm"}.get(kind, "Hz")
        rms = float(np.sqrt(np.nanmean(values**2)))
        case = data.campaign.states.names[int(state)]
        found.append(ErrorOfKind(kind, rms, None, unit, chi2, case, int(cable) if kind in _BY_CABLE else -1))
    return found


def _of_states(data: Recorded, kind: str) -> np.ndarray:
    """(S,) bool: states of a kind of data whose rows mean something alone: a tension was read there."""
    states, m = data.campaign.states, data.cables
    return data.read[:, 6 : 6 + m].any(axis=1) & {"loaded_pose": states.loaded, "static_state": states.static}.get(
        kind, np.ones(data.states, dtype=bool)
    )


_BY_CABLE = ("static_state", "cable_frequency")


def _null(story: Explained) -> Judged:
    return next(answer.best for answer in story.answers if not answer.names)


def _errors(data: Recorded, null: Judged) -> dict[str, np.ndarray]:
    """(S, .) errors by kind, nan where nothing was read."""
    states, found = data.campaign.states, {}
    if (states.static[:, None] & np.isfinite(states.tension)).any():
        found["static_state"] = _tensions(data)
    if (states.loaded & states.has_length & np.isfinite(states.position).all(axis=1)).any():
        found["loaded_pose"] = _poses(data)
    if data.vibrations is not None and len(data.vibrations.log_hertz):
        found["cable_frequency"] = _cable_frequencies(data, null)
    if data.vibrations is not None and data.vibrations.peaks is not None:
        found["robot_frequency"] = _robot_frequencies(data, null)
    return found


def _tensions(data: Recorded) -> np.ndarray:
    """(S, m) measured tensions less those of the simulation's distribution at the measured pose [N]."""
    states = data.campaign.states
    return np.where(states.static[:, None], states.tension - simulated_tensions(data), np.nan)


def _poses(data: Recorded) -> np.ndarray:
    """(S, 1) distance between the measured position and that computed at the encoders' lengths [mm]."""
    states = data.campaign.states
    known = np.isfinite(states.length).all(axis=1) & np.isfinite(states.position).all(axis=1)
    index = np.flatnonzero(states.loaded & known)
    there = of_states(at_states(data.arrays, data.known), index, data.states)
    place, turn = data.readings.position[index], data.readings.rotation[index]
    found = forward(there, data.readings.length[index], place, turn, data.known.model)
    error = np.full((data.states, 1), np.nan)
    error[index, 0] = np.where(found.converged, 1e3 * np.linalg.norm(found.position - place, axis=-1), np.nan)
    return error


def _cable_frequencies(data: Recorded, null: Judged) -> np.ndarray:
    """(S, m) largest error of a cable's modes, measured less computed [Hz]."""
    return _hertz(data, null)[0]


def _robot_frequencies(data: Recorded, null: Judged) -> np.ndarray:
    """(S, 1) largest distance of a peak from the nearest mode that moves the platform [Hz]."""
    return _hertz(data, null)[1]


def _hertz(data: Recorded, null: Judged) -> tuple[np.ndarray, np.ndarray]:
    measured, local = data.vibrations, Local.about(data, Point.entered(data))
    cables, robot = np.full((data.states, data.cables), np.nan), np.full((data.states, 1), np.nan)
    if measured is None or local.vibrating is None:
        return cables, robot
    computed = np.exp(local.vibrating.cables.log_hertz)
    for row, (state, cable) in enumerate(zip(measured.rows.state, measured.rows.cable, strict=True)):
        error = float(np.exp(measured.log_hertz[row]) - computed[row])
        where = measured.states[state], cable
        if not abs(cables[where]) > abs(error):
            cables[where] = error
    if measured.peaks is not None and local.vibrating.robot is not None:
        for k, state in enumerate(measured.states):
            own = local.vibrating.robot
            modes = np.exp(local.vibrating.log_hertz[k][own.mask[k] & (own.share[k] > SHARE_INVISIBLE)])
            peaks = np.exp(measured.peaks.ln_frequency[k][measured.peaks.present[k]])
            if peaks.size and modes.size:
                near = peaks[:, None] - modes
                nearest = near[np.arange(len(peaks)), np.abs(near).argmin(axis=1)]
                robot[state, 0] = nearest[np.abs(nearest).argmax()]
    return cables, robot


def located(story: Explained, null: Judged, chosen: Judged) -> Location | None:
    """Where the error sits: what the chosen causes take away, or what exceeds noise."""
    data, where = story.search.data, story.search.where
    table = rows_of(data, where, null, null.fit.noise)
    if not len(table.kind):
        return None
    square = (table.before / table.sigma) ** 2
    scores = {kind: float((square[table.kind == kind] - 1.0).sum()) for kind in KINDS if (table.kind == kind).any()}
    worst = max(scores, key=lambda kind: scores[kind] / np.sqrt(2.0 * (table.kind == kind).sum()))
    rows = np.flatnonzero(table.kind == worst)
    top = rows[square[rows].argmax()]
    return Location(worst, data.campaign.states.names[int(table.state[top])], int(table.cable[top]))
