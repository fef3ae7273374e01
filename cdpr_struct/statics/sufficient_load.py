"""From which load on is the spring model good enough (4.2.2)?

Load pulls the sag out of the cables. The sag-introduced pose error is computed over a ladder of loads at once; above
the last load at which it exceeds the tolerance, the spring model will do.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.pose_error import PoseError, pose_error

_LADDER = 41
_REFINEMENTS = 3


@dataclass(frozen=True, slots=True, eq=False)
class SufficientLoad:
    """Result of `sufficient_load`.

    mass      : [kg] from which on the sag error stays within the tolerance; nan if not even at the largest. Masses
                that the cables do not hold within their force limits are left out
    tolerance : [m]
    masses, sag_error, axial_error, global_error : (n,) [kg], (n, 3) [m], the ladder that was searched
    """

    mass: float
    tolerance: float
    masses: np.ndarray
    sag_error: np.ndarray
    axial_error: np.ndarray
    global_error: np.ndarray


def sufficient_load(
    robot: Robot | RobotArrays,
    position: npt.ArrayLike,
    rotation: npt.ArrayLike,
    tolerance: float,
    smallest: float = 1.0,
    largest: float = 1000.0,
    direction: npt.ArrayLike = (0.0, 0.0, 1.0),
) -> SufficientLoad:
    """Platform mass from which on the sag-introduced pose error stays within a tolerance.

    Parameters
    ----------
    position, rotation : (3,) [m], (3, 3) the reference pose
    tolerance : on the error along `direction` [m]
    smallest, largest : range of masses that is searched [kg]
    direction : (3,) unit vector in the world; the thesis looks at the vertical

    Raises
    ------
    ValueError : a tolerance or range that is not positive.
    """
    if not (tolerance > 0.0 and 0.0 < smallest < largest):
        raise ValueError(f"tolerance and masses must be positive, got {tolerance!r} m, {smallest!r}..{largest!r} kg")
    axis = np.asarray(direction, dtype=float)
    masses = np.geomspace(smallest, largest, _LADDER)
    ladder = pose_error(robot, position, rotation, mass=masses)
    mass = _last_crossing(masses, ladder, axis, tolerance)
    for _ in range(_REFINEMENTS):
        if np.isnan(mass[0]) or mass[0] == mass[1]:
            break
        fine = np.linspace(mass[0], mass[1], _LADDER)
        mass = _last_crossing(fine, pose_error(robot, position, rotation, mass=fine), axis, tolerance)
    return SufficientLoad(mass[1], tolerance, masses, ladder.sag_error, ladder.axial_error, ladder.global_error)


def _last_crossing(masses: np.ndarray, ladder: PoseError, axis: np.ndarray, tolerance: float) -> tuple[float, float]:
    """Neighbouring masses between which the sag error along an axis comes to stay within the tolerance."""
    masses, error = masses[ladder.held], np.abs(ladder.sag_error @ axis)[ladder.held]
    if not masses.size:
        return float("nan"), float("nan")
    above = np.flatnonzero(error > tolerance)
    if not above.size:
        return float(masses[0]), float(masses[0])
    if above[-1] == len(masses) - 1:
        return float("nan"), float("nan")
    return float(masses[above[-1]]), float(masses[above[-1] + 1])
