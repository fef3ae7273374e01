"""Natural frequencies of single cables between held ends in measured states, and how they change."""

from dataclasses import dataclass, fields, replace

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import expand_catenaries_at
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.observation.cable_fields import fields_of_expansion
from cdpr_struct.observation.dependence import cable_dependence
from cdpr_struct.observation.mode_gradient import cable_gradient
from cdpr_struct.robot.parameters import CABLES, PARAMETERS
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import VECTORS

_PER_HALF_WAVE, _SPARE = 2, 14  # order of the polynomials: ten digits of a taut cable's mode
_SAG = 8.0  # further orders per unit of weight over chord tension: half waves shift, and the tension varies
_HIGHEST = 400  # order at most: beyond, a cable is so slack that its modes are nobody's measurement


@dataclass(frozen=True, slots=True, eq=False)
class CableRows:
    """Modes that were looked for, (r,) each: state and cable from 0, number from 1 of those in plane or out of it."""

    state: np.ndarray
    cable: np.ndarray
    mode: np.ndarray
    in_plane: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class CableModes:
    """Modes of clamped cables.

    log_hertz (r,) : ln f [Hz]
    dependence (r, CABLE_COLUMNS) : what they depend on;  gradient (r, CABLE_COLUMNS) : of ln f by it
    """

    rows: CableRows
    log_hertz: np.ndarray
    dependence: np.ndarray
    gradient: np.ndarray


def cable_modes_at(point: OperatingPoint, rows: CableRows) -> CableModes:
    """Modes of the exact catenary in states (F,); what gives way at the frame end does, masts and platform do not.

    Raises
    ------
    ValueError : a mode has no such number.
    """
    if not len(rows.mode):
        nothing = cable_dependence(point)[rows.state, rows.cable]
        return CableModes(rows, np.zeros(0), nothing, nothing)
    if rows.mode.min() < 1:
        raise ValueError(f"mode numbers count from 1, got {int(rows.mode.min())}")
    pairs, place = np.unique(np.stack([rows.state, rows.cable]), axis=1, return_inverse=True)
    one, place = _one_cable_each(point, *pairs), place.reshape(-1)
    slack = float((one.cables.weight * one.cables.length / one.cables.tension).max())
    order = min(_HIGHEST, _SPARE + _PER_HALF_WAVE * int(rows.mode.max()) + int(_SAG * slack))
    expansion = expand_catenaries_at(one, order)
    number = _numbers(expansion.sideways[:, 0], place, rows)
    rank = _ranks(place)
    squared = np.ones((len(one.position), rank.max() + 1))
    squared[place, rank] = expansion.omega_squared[place, 0, number]
    own = np.zeros((*squared.shape, 1, expansion.omega_squared.shape[-1]))
    own[place, rank, 0, number] = 1.0
    still = np.zeros((*squared.shape, 1, 3))
    now = cable_dependence(one)
    moved = cable_gradient(now, fields_of_expansion(one, order, expansion, still, own, still, bent=True), squared)
    mine = squared[place, rank]
    gradient = moved.columns[place, 0, rank] / (2.0 * mine[:, None])
    return CableModes(rows, np.log(np.sqrt(mine) / (2.0 * np.pi)), now[place, 0], gradient)


def cable_rates(modes: CableModes, points: OperatingPoint, steps: np.ndarray) -> np.ndarray:
    """d ln f / d(step) (B, r) towards nearby states, points (B, F) after steps (B,)."""
    there = cable_dependence(points)
    there = np.broadcast_to(there, (len(steps), *there.shape[-3:]))[:, modes.rows.state, modes.rows.cable]
    change = np.einsum("brn,rn->br", there - modes.dependence, modes.gradient)
    return np.asarray(change / np.asarray(steps, dtype=float)[:, None])


def _one_cable_each(point: OperatingPoint, state: np.ndarray, cable: np.ndarray) -> OperatingPoint:
    """(u,) operating points of one cable: `cable` (u,) in `state` (u,)."""
    shape = point.cables.length.shape

    def picked(value: np.ndarray, core: int) -> np.ndarray:
        whole = np.broadcast_to(value, shape + value.shape[value.ndim - core :])
        return whole[state, cable][:, None]

    own = {}
    for name, rule in PARAMETERS.items():
        value: np.ndarray = getattr(point.arrays, name)
        if rule.shape[:1] == (CABLES,) and name not in ("masts", "uprights"):
            own[name] = picked(value, rule.axes - 1)
        elif value.ndim > rule.axes:
            own[name] = np.broadcast_to(value, shape[:-1] + value.shape[value.ndim - rule.axes :])[state]
    arrays: RobotArrays = replace(point.arrays, **own, masts=np.eye(1), uprights=np.zeros((1, 1)))
    cables = point.cables
    states = {f.name: picked(getattr(cables, f.name), f.name in VECTORS) for f in fields(cables)}
    return OperatingPoint(arrays, point.position[state], point.rotation[state], type(cables)(**states))


def _numbers(sideways: np.ndarray, place: np.ndarray, rows: CableRows) -> np.ndarray:
    """(r,) which mode of the expansion each row's is; (u, p) whether they move out of the cable's plane."""
    mine = np.cumsum(sideways[place] != rows.in_plane[:, None], axis=-1)
    return np.asarray((mine == rows.mode[:, None]).argmax(axis=-1))


def _ranks(place: np.ndarray) -> np.ndarray:
    """(r,) how many rows before have the same place."""
    order = np.argsort(place, kind="stable")
    starts = np.flatnonzero(np.diff(place[order], prepend=-1))
    rank = np.empty(len(place), dtype=int)
    rank[order] = np.arange(len(place)) - np.repeat(starts, np.diff(starts, append=len(place)))
    return rank
