"""Robots drawn from their tolerances, at rest with the winches where they are: the check of first-order bands."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.observation.expanded_modes import ExpandedModes
from cdpr_struct.observation.robot_modes import frequencies_at
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.tolerances import Spread, changed
from cdpr_struct.statics.forward_kinematics import forward

_AT_ONCE = 64  # robots whose vibration is computed together
_ROOM = 1.3  # times the last frequency: up to there the modes of drawn robots are sought
_SEED = 21


@dataclass(frozen=True, slots=True, eq=False)
class DrawnRobots:
    """n robots at rest.

    number : (n,) which of the draws, from 0; those without a stable rest are left out
    pose : (n, 6) position and angles about x, y, z [m, rad];  tension : (n, m) at the platform [N]
    hertz : (n, k) [Hz], infinite beyond what was sought; (n, 0) if nothing was
    lost : how many more robots did not come to a stable rest
    """

    number: np.ndarray
    pose: np.ndarray
    tension: np.ndarray
    hertz: np.ndarray
    lost: int

    def quantiles(self, name: str, level: float) -> np.ndarray:
        """(.., 2) ends of the central band that holds this share of the robots."""
        values = getattr(self, name)
        return np.quantile(values, [0.5 - 0.5 * level, 0.5 + 0.5 * level], axis=0).T


def drawn_robots(
    point: OperatingPoint,
    spread: Spread,
    count: int,
    hertz: np.ndarray | None = None,
    assembly: Assembly = "consistent",
    model: str = "sagging",
    vibrating: CableModel = "exact",
) -> DrawnRobots:
    """Draw robots like one at rest, and bring them to rest from there at locked lengths.

    Parameters
    ----------
    spread : which robots are probable
    hertz : (k,) frequencies of the robot as entered, if those of the drawn ones are asked for [Hz]
    model : of the cables at rest;  vibrating : of the cables in vibration, exact or static; frequencies are in
        proportion to those that it has of the robot as entered
    """
    rests, kept = drawn_rests(point, spread, count, model)
    angles = angles_from_rotation(point.rotation)
    turned = angles_from_rotation(rests.rotation) - angles
    around = np.remainder(turned + np.pi, 2.0 * np.pi) - np.pi
    pose = np.concatenate([rests.position, angles + around], axis=-1)
    modes = np.zeros((len(kept), 0)) if hertz is None else _like(point, rests, hertz, assembly, vibrating)
    modes = np.exp(spread.scattered(np.log(modes), _SEED + 1)) if spread.scatter else modes
    return DrawnRobots(kept, pose, rests.cables.tension_at_platform, modes, count - len(kept))


def drawn_rests(
    point: OperatingPoint, spread: Spread, count: int, model: str = "sagging", wrench: np.ndarray | None = None
) -> tuple[OperatingPoint, np.ndarray]:
    """The same robots as operating points (n), and which of the draws, from 0, they are (n,).

    wrench : (6,) on the platform beside its weight [N, N m]
    """
    arrays, cables = RobotArrays.of(point.robot), point.cables
    drawn = spread.drawn(np.random.default_rng(_SEED).standard_normal((count, spread.root.shape[1])))
    robots, lengths = changed(arrays, drawn, spread.varied), arrays.reading(cables.paid_out)
    found = forward(robots, lengths, point.position, point.rotation, model, wrench)
    kept = np.flatnonzero(found.stable)
    robots = robots.flattened((count,)).take(kept)
    return OperatingPoint(robots, found.position[kept], found.rotation[kept], found.cables.at(kept)), kept


def _parts(rests: OperatingPoint) -> Iterator[OperatingPoint]:
    for first in range(0, len(rests.position), _AT_ONCE):
        index = np.arange(first, min(first + _AT_ONCE, len(rests.position)))
        robots = rests.arrays.take(index)
        yield OperatingPoint(robots, rests.position[index], rests.rotation[index], rests.cables.at(index))


def _like(
    point: OperatingPoint, rests: OperatingPoint, hertz: np.ndarray, assembly: Assembly, model: CableModel
) -> np.ndarray:
    """(n, k) frequencies of robots at rest, in proportion to hertz (k,) of the one at a point [Hz]."""
    entered = OperatingPoint(point.arrays, point.position[None], point.rotation[None], point.cables.at(None))
    own = _frequencies(entered, hertz, assembly, model)
    return np.concatenate([_frequencies(part, hertz, assembly, model) for part in _parts(rests)]) * (hertz / own)


def _frequencies(rests: OperatingPoint, hertz: np.ndarray, assembly: Assembly, model: CableModel) -> np.ndarray:
    """(n, k) first frequencies [Hz]."""
    count, highest = len(hertz), 2.0 * np.pi * _ROOM * float(hertz[-1])
    if model == "static":
        omega = ExpandedModes.at(rests, highest, assembly, model).shapes.omega
        logarithm = np.log(omega / (2.0 * np.pi))
    else:
        logarithm, _ = frequencies_at(rests, highest, assembly)
    found = np.exp(logarithm)[:, :count]
    return np.pad(found, [(0, 0), (0, count - found.shape[1])], constant_values=np.inf)
