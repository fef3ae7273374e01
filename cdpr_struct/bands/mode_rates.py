"""How the frequencies of a robot at rest change with its numbers, modes that lie close together included."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import connected_components

from cdpr_struct.bands.locked_response import LockedResponse
from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.errors import ModesApartError
from cdpr_struct.observation.expanded_modes import ExpandedModes
from cdpr_struct.robot.tolerances import Spread

_BEYOND = 1.15  # times the last frequency asked for: up to there modes may come down and change places with it
_ALIKE = 0.2  # relative distance of a frequency from the exact model's beyond which it is another mode
_NEAR = 4.0  # sigmas of the change of their distance within which two modes may meet


@dataclass(frozen=True, slots=True, eq=False)
class ModeRates:
    """Changes of ln f of k modes per change of each number, `VARIED` says which.

    hertz : (k,) [Hz], ascending; more than were asked for, since these may change places with them
    own : (p, k) of each mode as if it were alone
    groups : (k,) number of the group of modes that are linked by modes that may meet
    pairs : (q, 2) all of one group: two that do not meet by themselves still push each other while others pass
    mixing : (p, q) by which a change turns the modes of a pair into each other, in ln f
    """

    hertz: np.ndarray
    own: np.ndarray
    pairs: np.ndarray
    mixing: np.ndarray
    groups: np.ndarray


def mode_rates(
    point: OperatingPoint,
    hertz: np.ndarray,
    response: LockedResponse,
    spread: Spread,
    assembly: Assembly = "consistent",
    model: CableModel = "exact",
) -> ModeRates:
    """Rates of the frequencies hertz (k,) [Hz] of one robot at rest, all above zero, ascending, and some beyond.

    spread : which robots are probable, about this one: how far modes may move, and so which may meet
    model : whose relative rates are taken, exact or static; frequencies of dsm and fem have those of exact

    Raises
    ------
    ModesApartError : the model's frequencies are not these, mode by mode.
    """
    found = _expanded(point, float(hertz[-1]), assembly, model)
    shapes = found.shapes
    hertz = _with_those_beyond(shapes.omega[0] / (2.0 * np.pi), hertz)
    squared = shapes.omega[0] ** 2
    own = response.dependence @ found.gradient(shapes)[0] / (2.0 * squared)
    groups = _groups(len(hertz), _near(np.log(hertz), own, spread))
    pairs = np.argwhere(np.triu(groups[:, None] == groups, 1))
    mixing = np.zeros((len(own), 0))
    if len(pairs):
        first, second = pairs.T
        summed, differing = (found.gradient(found.mixed(first, second, sign))[0] for sign in (1.0, -1.0))
        mixing = response.dependence @ (summed - differing) / (4.0 * np.sqrt(squared[first] * squared[second]))
    return ModeRates(hertz, own, pairs, mixing, groups)


def _expanded(point: OperatingPoint, last: float, assembly: Assembly, model: CableModel) -> ExpandedModes:
    batch = OperatingPoint(point.arrays, point.position[None], point.rotation[None], point.cables.at(None))
    return ExpandedModes.at(batch, 2.0 * np.pi * _BEYOND * last, assembly, model, fine=True)


def _with_those_beyond(own: np.ndarray, hertz: np.ndarray) -> np.ndarray:
    """Frequencies (k,), and behind them those of the model (n,) that are more, in the same proportion as the last."""
    count = len(hertz)
    if len(own) < count or (np.abs(own[:count] / hertz - 1.0) > _ALIKE).any():
        raise ModesApartError(
            "the model's frequencies lie too far from those of the exact model for its rates to be taken; "
            "ask for bands of the model exact"
        )
    return np.concatenate([hertz, own[count:] * (hertz[-1] / own[count - 1])])


def _near(logarithm: np.ndarray, own: np.ndarray, spread: Spread) -> np.ndarray:
    """(q, 2) pairs whose distance may change by as much as it is."""
    sigmas = own.T @ spread.root
    apart = np.linalg.norm(sigmas[:, None] - sigmas[None], axis=-1)
    gap = np.abs(logarithm[:, None] - logarithm)
    return np.argwhere(np.triu(gap <= _NEAR * apart + 1e-9, 1))


def _groups(count: int, pairs: np.ndarray) -> np.ndarray:
    linked = np.zeros((count, count), dtype=bool)
    linked[pairs[:, 0], pairs[:, 1]] = True
    return np.asarray(connected_components(linked, directed=False)[1])
