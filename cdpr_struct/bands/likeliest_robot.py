"""The robot as a diagnosis leaves it: with its numbers at their means, at rest with the winches where they are.

An extended robot has its causes and nothing of what the readings say of its tolerances. These may move tensions by ten
of their sigmas, so that modes change places for certain. So bands to first order are taken where the robot most
probably is, with the spread about its means. The winches stay where the robot as entered needs them.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_from_arrays import robot_from_arrays
from cdpr_struct.robot.tolerances import Spread, changed
from cdpr_struct.statics.forward_kinematics import forward

_Held = TypeVar("_Held")


def likeliest_rests(
    points: Sequence[OperatingPoint], spread: Spread, model: str = "sagging", wrench: np.ndarray | None = None
) -> list[OperatingPoint | None]:
    """One robot at several points with its numbers at their means, solved together; None without a stable rest.

    points : of the robot as entered, without batch axes; they come back themselves where the means are zero
    model : of the cables, sagging or spring;  wrench : (n, 6) on the platform beside its weight [N, N m]
    """
    if not points or not spread.mean.any():
        return list(points)
    entered, arrays = points[0].entered, RobotArrays.of(points[0].entered)
    moved = robot_from_arrays(entered, changed(arrays, spread.mean, spread.varied), entered.extensions.causes)
    robot = replace(moved, posterior=None, remainder=None)
    lengths = np.array([arrays.reading(point.cables.paid_out) for point in points])
    place, turn = np.array([point.position for point in points]), np.array([point.rotation for point in points])
    if not (RobotArrays.of(robot).paid_out(lengths) > 0.0).all():
        return [None] * len(points)
    found = forward(robot, lengths, place, turn, model, wrench)
    return [
        OperatingPoint(robot, found.position[i], found.rotation[i], found.cables.at(i)) if stable else None
        for i, stable in enumerate(found.stable)
    ]


def about_the_means(spread: Spread) -> Spread:
    """Which robots are probable, about the likeliest in place of the one as entered."""
    return replace(spread, mean=np.zeros_like(spread.mean)) if spread.mean.any() else spread


def required(rests: Sequence[_Held | None]) -> list[_Held]:
    """All of them.

    Raises
    ------
    CdprError : one does not come to rest.
    """
    found = [one for one in rests if one is not None]
    if len(found) < len(rests):
        raise CdprError("there is no band: with its likeliest numbers the platform does not come to rest there")
    return found


def at_the_means(point: OperatingPoint, spread: Spread, model: str = "sagging") -> tuple[OperatingPoint, Spread]:
    """The robot of an operating point with its numbers at their means, and the spread about them.

    model : of the cables, sagging or spring

    Raises
    ------
    CdprError : it does not come to rest.
    """
    return required(likeliest_rests([point], spread, model))[0], about_the_means(spread)
