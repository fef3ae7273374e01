"""How a robot at rest answers small changes of its numbers while its winches stay as they are.

The wrench that a change leaves at the old pose moves the platform by K^-1 of it; where it then is, cables and
everything else are evaluated again. Both are central differences of fourth order of the statics themselves, so nothing
is left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.bands.stiffening_balance import in_static_motion, settled
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.observation.dependence import Dependence
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.tolerances import VARIED, Spread, Varied, change_count, changed, places
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.locked_balance import LockedBalance

_SHARE = 1e-3  # of a value, or of the tension: steps change nothing by more than this
_STATIONS = (1.0, -1.0, 2.0, -2.0)  # steps at which values are taken
_WEIGHTS = (2.0 / 3.0, -2.0 / 3.0, -1.0 / 12.0, 1.0 / 12.0)  # their parts in a derivative of fourth order
_SHORTEST = 1e-10  # of the chord: shorter steps are lost in rounding
_PART = 0.03  # of a sigma, of what a diagnosis found to be off
_NOTHING = 1e-9  # any unit, of what is known exactly
_PASSES = 2  # where cables stiffen: their tangent at constant EA is right to a part in a thousand
_NEUTRAL = 1e-13  # of the largest singular value: a smaller one is zero but for rounding


@dataclass(frozen=True, slots=True, eq=False)
class LockedResponse:
    """What changes (p,) of the robot's numbers do at locked lengths, to first order, in the units of `Varied`.

    pose       : (p, 6) motion of the platform origin and turn, world axes [m, rad]
    tension    : (p, m) at the platform [N]
    dependence : (p, n) of `Dependence.vector`, on which vibration depends
    """

    pose: np.ndarray
    tension: np.ndarray
    dependence: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class LockedStations:
    """Robots at rest beside one of them, each with one number changed by a small step, its winches as they are.

    rests : (4 p) of p numbers, the stations of a central difference of fourth order outermost
    step  : (p,) in the units of `Varied`
    """

    rests: OperatingPoint
    step: np.ndarray

    @classmethod
    def about(
        cls, point: OperatingPoint, model: str = "sagging", wrench: np.ndarray | None = None,
        spread: Spread | None = None,
    ) -> "LockedStations":  # fmt: skip
        """Of one robot at rest, no batch axes; a neutral freedom stays where it is.

        model : of the cables, sagging or spring;  wrench : (6,) on the platform beside its weight [N, N m]
        spread : which robots are probable, where a diagnosis found more to be off than tolerances are about
        """
        varied, step = VARIED if spread is None else spread.varied, step_sizes(point, spread)
        wrench = np.zeros(6) if wrench is None else wrench
        ways = np.array(_STATIONS)[:, None, None] * np.diag(step)
        balance = _balance(point, ways.reshape((-1, len(step))), varied, model, wrench)
        place = np.repeat(point.position[None], len(balance.length), axis=0)
        turn = np.repeat(point.rotation[None], len(balance.length), axis=0)
        still = _balance(point, np.zeros((1, len(step))), varied, model, wrench)
        rest = in_static_motion(still, place[:1], turn[:1])
        give = np.linalg.pinv(rest.evaluate(place[:1], turn[:1]).tangent[0], _NEUTRAL).T
        there, turned, motion = place, turn, np.zeros((len(place), 6))
        for _ in range(_PASSES if balance.arrays.stiffens else 1):
            left = _slope(settled(balance, there, turned).evaluate(there, turned).wrench, step)
            motion = motion + (ways @ left @ give).reshape((-1, 6))
            there, turned = balance.moved(place, turn, motion)
        balance = settled(balance, there, turned)
        return cls(OperatingPoint(balance.arrays, there, turned, balance.states(there, turned)), step)

    def slope(self, values: np.ndarray) -> np.ndarray:
        """(p, n) rates of numbers (4 p, n) of the robots at rest."""
        return _slope(values, self.step)


def locked_response(
    point: OperatingPoint, assembly: Assembly = "consistent", model: str = "sagging", spread: Spread | None = None
) -> LockedResponse:
    """Response of one robot at rest, no batch axes; a neutral freedom stays where it is.

    model : of the cables, sagging or spring;  spread : as in `LockedStations.about`
    """
    stations = LockedStations.about(point, model, spread=spread)
    rests = stations.rests
    depends = Dependence.of(rests, assembly).vector
    about = Rotation.from_matrix(rests.rotation @ np.swapaxes(point.rotation, -1, -2)).as_rotvec()
    pose = np.concatenate([rests.position - point.position, about], axis=-1)
    return LockedResponse(*(stations.slope(values) for values in (pose, rests.cables.tension_at_platform, depends)))


def _slope(values: np.ndarray, step: np.ndarray) -> np.ndarray:
    """(p, n) derivative of values (4 p, n) at the stations about rest, in steps (p,)."""
    stations = values.reshape((len(_STATIONS), len(step), -1))
    return np.asarray(np.tensordot(_WEIGHTS, stations, axes=1) / step[:, None])


def step_sizes(point: OperatingPoint, spread: Spread | None = None) -> np.ndarray:
    """(p,) changes small enough for everything to be linear, and large against rounding.

    Of what a diagnosis found to be off they are shares of how far it may be.
    """
    arrays, cables = point.arrays, point.cables
    chord = cables.chord
    strained = cables.tension_at_platform * cables.length / cables.axial_stiffness
    short = np.clip(_SHARE * strained, _SHORTEST * chord, _SHARE * chord)
    body = _SHARE * max(float(np.linalg.norm(arrays.platform_anchors, axis=-1).mean()), 1e-3)
    sizes = {
        "frame_anchors": np.repeat(short, 3),
        "platform_anchors": np.repeat(short, 3),
        "length_offset": short,
        "mass": np.array([_SHARE * float(arrays.mass)]),
        "center_of_mass": np.full(3, body),
        "cell_bias": np.ones(arrays.cable_count),
        "pulley_radius": short,
    }
    result = np.full(change_count(arrays.cable_count), _SHARE)
    for one, place in zip(VARIED, places(arrays.cable_count), strict=True):
        if one.field in sizes:
            result[place] = sizes[one.field]
    return result if spread is None else np.concatenate([result, _steps_of_found(arrays.cable_count, spread)])


def _steps_of_found(cables: int, spread: Spread) -> np.ndarray:
    """Of numbers beside `VARIED`; those of one kind alike."""
    own = np.linalg.norm(spread.root, axis=1)
    kinds = places(cables, spread.varied)[len(VARIED) :]
    return np.concatenate(
        [np.zeros(0), *(np.full(k.stop - k.start, _PART * (own[k].max() or _NOTHING)) for k in kinds)]
    )


def _balance(
    point: OperatingPoint, change: np.ndarray, varied: Sequence[Varied], model: str, wrench: np.ndarray
) -> LockedBalance:
    """Robots with changes (n, p), their winches as the robot at rest has them."""
    arrays, lead = RobotArrays.of(point.robot), (len(change),)
    robots = changed(arrays, change, varied)
    length = robots.paid_out(arrays.reading(point.cables.paid_out))
    length = np.broadcast_to(length, (*lead, arrays.cable_count))
    return LockedBalance(robots.flattened(lead), length, np.broadcast_to(wrench, (*lead, 6)), cable_model(model))
