"""Preload: the internal force that a robot's force limits ask for, and the cable that winches take up for it.

With straight, weightless, inextensible cables the tensions of least norm within the limits and those of least norm that
only pull balance the same load at the same pose. Their difference balances nothing: it lies in the null space of the
structure matrix. Winches bring it about by taking up the cable by which it stretches the cables and what is in line.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.inverse_kinematics import inverse


@dataclass(frozen=True, slots=True, eq=False)
class Preload:
    """Tensions of straight, weightless, inextensible cables at reference poses; leading axes (...) are the batch.

    within_limits : (..., m) within the robot's limits [N]; `pulling` where these cannot be met
    pulling       : (..., m) that balance the load without limits [N]
    held          : (...) bool, the limits can be met
    """

    within_limits: np.ndarray
    pulling: np.ndarray
    held: np.ndarray

    @classmethod
    def of(
        cls,
        arrays: RobotArrays,
        position: np.ndarray,
        rotation: np.ndarray,
        external_wrench: npt.ArrayLike | None = None,
    ) -> "Preload":
        """At poses (..., 3), (..., 3, 3) under a wrench (..., 6) beside the platform's weight."""
        limited = inverse(arrays, position, rotation, "ideal", external_wrench, allow_unheld=True)
        if not arrays.has_force_limits:
            return cls(limited.tensions, limited.tensions, limited.held)
        free = inverse(arrays, position, rotation, "ideal", external_wrench, 0.0, np.inf, allow_unheld=True)
        return cls(np.where(limited.held[..., None], limited.tensions, free.tensions), free.tensions, limited.held)

    @property
    def internal_force(self) -> np.ndarray:
        """(..., m) what the limits add to the tensions [N]."""
        return self.within_limits - self.pulling

    def taken_up(self, arrays: RobotArrays, points: np.ndarray) -> np.ndarray:
        """(..., m) unstrained length by which cables that end at `points` (..., m, 3) are shortened for it [m].

        On straight springs over their pulleys, with what is in line and masts giving way.
        """
        if not self.internal_force.any():
            return np.zeros(self.pulling.shape)
        return _spring_length(arrays, points, self.pulling) - _spring_length(arrays, points, self.within_limits)


def _spring_length(arrays: RobotArrays, points: np.ndarray, tension: np.ndarray) -> np.ndarray:
    ends = np.broadcast_to(points, (*tension.shape, 3))
    at_tension = replace(arrays, axial_stiffness=arrays.stiffness_at(tension))
    return cable_model("spring").hold(at_tension, ends, tension).states.total_length
