"""In which other convention may the poses be written? Orders of rotations, quaternions, transposes, axes of the frame.

A pose is a position and the rotation Rz(rz) Ry(ry) Rx(rx). Each other convention is a reading of the same numbers.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import permutations

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.hypotheses.correction import BEYOND_NOISE, Correction, several_tilted, with_states
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.pose import angles_from_rotation

CAUSE = "rotation_convention"
Turn = Callable[[np.ndarray], Rotation]

_FRAMES = {
    "y points up": np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]]),
    "z points down, and y the other way": np.diag([1.0, -1.0, -1.0]),
    "x points the other way, as in a left-handed frame": np.diag([-1.0, 1.0, 1.0]),
    "y points the other way, as in a left-handed frame": np.diag([1.0, -1.0, 1.0]),
    "z points the other way, as in a left-handed frame": np.diag([1.0, 1.0, -1.0]),
    "x and y are exchanged, as in a left-handed frame": np.array([[0, 1.0, 0], [1.0, 0, 0], [0, 0, 1.0]]),
}
"""Axes of the frame of those who wrote the poses: position = matrix @ written, rotation = matrix written matrix^T."""


def conventions(campaign: Campaign) -> Iterator[Correction]:
    """The campaign with its poses read in every other convention."""
    states = campaign.states
    whole = np.isfinite(states.angles).all(axis=1)
    if not several_tilted(states):
        return
    for wrong, turn in _turns().items() if several_tilted(states, BEYOND_NOISE) else ():
        angles = states.angles.copy()
        angles[whole] = angles_from_rotation(turn(states.angles[whole]).as_matrix())
        yield Correction(CAUSE, f"the rotations {wrong}", with_states(campaign, angles=angles))
    for wrong, axes in _FRAMES.items():
        angles = states.angles.copy()
        angles[whole] = angles_from_rotation(axes @ _written(states.angles[whole]).as_matrix() @ axes.T)
        new = with_states(campaign, position=states.position @ axes.T, angles=angles)
        new = new if new.frames is None else replace(new, frames=new.frames.in_axes(axes))
        yield Correction(CAUSE, f"the poses are written in a frame whose {wrong}", new)


def _turns() -> dict[str, Turn]:
    """What the angles, or the quaternion that they came from, may mean instead, in words."""
    found: dict[str, Turn] = {}
    for order in permutations("xyz"):
        if order != ("x", "y", "z"):
            about = ", then ".join(order)
            found[f"are about the fixed axes {about}, and not x, then y, then z"] = _about(order)
    found["have the angle about z in the column of x and the other way round"] = lambda a: _written(a[:, ::-1])
    found["are rotation vectors"] = Rotation.from_rotvec
    found["are transposed: from the frame to the platform"] = lambda a: _written(a).inv()
    found["come from quaternions x, y, z, w that were taken as w, x, y, z"] = lambda a: _moved(a, 1)
    found["come from quaternions w, x, y, z that were taken as x, y, z, w"] = lambda a: _moved(a, -1)
    return found


def _about(order: tuple[str, ...]) -> Turn:
    """Angles about fixed axes in an order of turning."""
    columns = ["xyz".index(axis) for axis in order]
    return lambda angles: Rotation.from_euler("".join(order), angles[:, columns])


def _moved(angles: np.ndarray, places: int) -> Rotation:
    """The rotation whose quaternion has its numbers by some places elsewhere."""
    return Rotation.from_quat(np.roll(_written(angles).as_quat(), places, axis=1))


def _written(angles: np.ndarray) -> Rotation:
    return Rotation.from_euler("xyz", angles)
