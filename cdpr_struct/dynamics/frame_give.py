"""How far do the frame ends of cables give way, and in which directions?"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot_arrays import RobotArrays

_SHORT = 1e-9  # of a cable's length: what is shorter gives way no more than a fixed point


@dataclass(frozen=True, slots=True, eq=False)
class FrameGive:
    """How far frame ends give way: directions (..., m, 3, q), orthonormal, and compliance (..., m, q) [m/N] along them.

    least : (..., m, q) compliance that counts as none
    """

    directions: np.ndarray
    compliance: np.ndarray
    least: np.ndarray


def frame_give(point: OperatingPoint) -> FrameGive | None:
    """Along the cable, by what is elastic in line and the stretch of cable on a pulley, without limit where a winch
    holds the tension; across it where pulleys swivel.

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
        across, per_arm, arm = _swivel(arrays, tension, tangent)
        directions.append(across)
        gives.append(per_arm * arm)
        least.append(per_arm * short)
    stacked = (np.stack(np.broadcast_arrays(*parts), axis=-1) for parts in (directions, gives, least))
    return FrameGive(*stacked)


def _swivel(arrays: RobotArrays, tension: np.ndarray, tangent: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Direction (..., m, 3) across the wheel's plane; compliance there (..., m) [m/N] per lever arm, and that arm [m].

    A cable that leaves the wheel at the angle phi from the axis pulls it back with T sin(phi) / (R (1 - cos(phi))). In
    the wheel's plane, rolling on or off the wheel is of second order: the exit is a fixed point.
    """
    cos = np.einsum("...mi,...mi->...m", tangent, arrays.pulley_axis)
    across = np.cross(arrays.pulley_axis, tangent)
    sin = np.linalg.norm(across, axis=-1)
    return across / sin[..., None], 1.0 / (tension * sin), arrays.pulley_radius * (1.0 - cos)
