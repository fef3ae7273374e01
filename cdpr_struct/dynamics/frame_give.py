"""How far do the frame ends of cables give way, and in which directions?"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot_arrays import RobotArrays

_PARALLEL = 1e-12  # sine of the angle to its swivel axis below which a cable lies on it
_SHORT = 1e-9  # of a cable's length: what is shorter gives way no more than a fixed point


@dataclass(frozen=True, slots=True, eq=False)
class FrameGive:
    """How far frame ends give way: directions (..., m, 3, q) and compliance (..., m, q) [m/N] along them.

    Directions are orthonormal but for what leans them at a wheel by its cable's weight (`_leant`, `_drawn`).

    least   : (..., m, q) compliance that counts as none
    let_out : (..., m) stiffness [N/m] in the first direction beside that of what is elastic (`_weight_let_out`)
    """

    directions: np.ndarray
    compliance: np.ndarray
    least: np.ndarray
    let_out: np.ndarray

    @property
    def stiffness(self) -> np.ndarray:
        """(..., m, q) along the directions [N/m]."""
        spring = 1.0 / np.maximum(self.compliance, self.least)
        spring[..., 0] += self.let_out
        return np.asarray(spring)


def frame_give(point: OperatingPoint) -> FrameGive | None:
    """Along the cable, by what is elastic in line and the stretch of cable on a pulley, without limit where a winch
    holds the tension; across it where pulleys swivel. Both lean where cable rolls on and off a pulley.

    None where all frame ends are fixed points.
    """
    arrays, cables = point.arrays, point.cables
    if not arrays.has_yielding_frame_ends:
        return None
    tension, stiff = cables.tension_at_frame, cables.axial_stiffness
    tangent = cables.force_at_frame / tension[..., None]
    short = _SHORT * cables.length
    directions, least = [tangent], [short / stiff]
    along = cables.wrapped_length / stiff + arrays.series_compliance / (1.0 + tension / stiff)
    gives = [np.where(arrays.winch_tension > 0.0, np.inf, along)]
    if arrays.has_pulleys:
        wheel = _Wheel.of(arrays, tangent)
        across = _leant(point, wheel, wheel.across) + _drawn(point, wheel, along)[..., None] * tangent
        directions = [_leant(point, wheel, tangent), across]
        gives.append(arrays.pulley_radius * wheel.half_tangent / tension)
        least.append(short / tension)
    ways, given, none = (np.stack(np.broadcast_arrays(*parts), axis=-1) for parts in (directions, gives, least))
    return FrameGive(ways, given, none, _weight_let_out(point))


@dataclass(frozen=True, slots=True, eq=False)
class _Wheel:
    """How cables leave their wheels: tan(phi / 2) (..., m), phi the angle to the swivel axis, and unit vectors
    (..., m, 3) across the wheel's plane and, in that plane, the way in which the cable turns as it rolls on.

    A cable that leaves at phi pulls the wheel back with T sin(phi) / (R (1 - cos(phi))) = T / (R tan(phi / 2)).
    """

    half_tangent: np.ndarray
    across: np.ndarray
    turning: np.ndarray

    @classmethod
    def of(cls, arrays: RobotArrays, tangent: np.ndarray) -> "_Wheel":
        """Of cables with unit tangents (..., m, 3) at their frame ends; along the axis, a wheel has any plane."""
        axis = np.broadcast_to(arrays.pulley_axis, tangent.shape)
        cos = np.einsum("...mi,...mi->...m", tangent, axis)
        across = np.cross(axis, tangent)
        sin = np.linalg.norm(across, axis=-1)
        beside = np.cross(np.eye(3)[np.abs(tangent).argmin(axis=-1)], tangent)
        across = np.where((sin > _PARALLEL)[..., None], across, beside)
        across = across / np.linalg.norm(across, axis=-1)[..., None]
        return cls(sin / np.maximum(1.0 + cos, 1e-300), across, np.cross(across, tangent))


def _leant(point: OperatingPoint, wheel: _Wheel, direction: np.ndarray) -> np.ndarray:
    """Directions (..., m, 3) in which frame ends give way, leant by the weight of what rolls on and off the wheel.

    A cable that turns by u' in the wheel's plane rolls by R u' / (1 - k R), k its curvature there. Its exit stays where
    it is, but the tension at the new exit has turned and changed by the weight w of what has rolled on: a force of
    w . d R u' / (1 - k R) in the direction d. Without weight on the wheel nothing answers it, and the stiffness is not
    symmetric; its symmetric part, which alone shifts frequencies to first order, is that of an end that gives way along
    d + b n / 2, with n the way of turning and b = (w . d / T) R / (1 - k R).
    """
    radius = point.arrays.pulley_radius
    upwards = _held_up(point) / point.cables.tension_at_frame[..., None]
    rolled = radius / (1.0 - radius * np.einsum("...mi,...mi->...m", upwards, wheel.turning))
    lean = 0.5 * rolled * np.einsum("...mi,...mi->...m", upwards, direction)
    return np.asarray(direction + lean[..., None] * wheel.turning)


def _drawn(point: OperatingPoint, wheel: _Wheel, along: np.ndarray) -> np.ndarray:
    """(..., m) motion along the cable per motion across the wheel, for compliances (..., m) along the cable [m/N].

    What slides out as something in line gives way has weight, too, and pulls a leaning wheel round: by w . o for each
    length, o the way across. The wheel does not draw cable out; of this half counts, as for `_leant`.
    """
    sideways = -np.einsum("...mi,...mi->...m", _held_up(point), wheel.across)
    return np.asarray(0.5 * along * sideways)


def _weight_let_out(point: OperatingPoint) -> np.ndarray:
    """(..., m) stiffness [N/m] along cables at their frame ends, by the weight of what slides out or in there.

    A cable that leaves downwards pulls with more as it slides out, whether a winch holds its tension or what is elastic
    in line gives way.
    """
    tangent = point.cables.force_at_frame / point.cables.tension_at_frame[..., None]
    return np.asarray(np.einsum("...mi,...mi->...m", _held_up(point), tangent))


def _held_up(point: OperatingPoint) -> np.ndarray:
    """(..., m, 3) upwards, the weight of a length of cable as it hangs at the frame end [N/m]."""
    cables = point.cables
    strained = 1.0 + cables.tension_at_frame / cables.axial_stiffness
    return np.asarray((cables.weight / strained)[..., None] * cables.up)
