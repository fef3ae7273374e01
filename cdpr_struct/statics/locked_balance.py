"""Balance of a platform on cables of given unstrained lengths."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.generated.platform import geometric_stiffness
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import CableModel
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.energy_descent import Evaluation
from cdpr_struct.statics.equilibrium import (
    PlatformArms,
    cable_wrench,
    load_wrench,
    moment_skew,
    rotation_from_vector,
    tangent_stiffness,
)
from cdpr_struct.statics.guides import behind_guides, free_part

_TOLERANCE = 1e-11  # of weight plus cable tensions


@dataclass(frozen=True, slots=True, eq=False)
class LockedBalance:
    """Balance of the platforms of a flat batch (n) on cables of given lengths.

    length : (n, m) unstrained, paid out beyond the frame anchors [m]
    wrench : (n, 6) on the platform beside its weight, hose and constant force [N, N m]
    """

    arrays: RobotArrays
    length: np.ndarray
    wrench: np.ndarray
    model: CableModel

    def take(self, index: np.ndarray) -> "LockedBalance":
        """Some of the batch."""
        return replace(self, arrays=self.arrays.take(index), length=self.length[index], wrench=self.wrench[index])

    def evaluate(self, position: np.ndarray, rotation: np.ndarray) -> Evaluation:
        """Wrench, tangent and tolerated residual at positions (n, 3) and rotations (n, 3, 3).

        The tangent is the second derivative of the energy along the ways of `moved`, and of an applied moment, which
        has no energy, the part that is not symmetric: at rest it is the whole derivative of the wrench. Of a guided
        platform wrench and tangent are those of its free directions, and a stiffness that is coupled with nothing in
        the others.
        """
        arms = PlatformArms.at(self.arrays, position, rotation)
        states = self.model.states(self.arrays, arms.points, self.length)
        wrench = cable_wrench(states, arms) + load_wrench(self.arrays, arms) + self.wrench
        rounding = 8.0 * np.finfo(float).eps * states.axial_stiffness.sum(axis=-1)
        size = self.arrays.mass * self.arrays.gravity + states.tension_at_platform.sum(axis=-1)
        tangent = tangent_stiffness(self.arrays, states, arms)
        tangent[..., 3:, 3:] += moment_skew(-self.arrays.moment - self.wrench[..., 3:])
        if self.arrays.has_guides:
            wrench, tangent = free_part(wrench, self.arrays), behind_guides(tangent, self.arrays, _held(states))
        else:
            tangent[..., 3:, 3:] -= geometric_stiffness(*wrench[..., :3].T, *self._middle(rotation).T)
        return Evaluation(wrench, tangent, _TOLERANCE * size + rounding)

    def moved(self, position: np.ndarray, rotation: np.ndarray, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Positions (n, 3) and rotations (n, 3, 3) after a motion (n, 6) of the origin and a turn [m, rad].

        The middle of the cables' platform ends goes straight, so that a turn about it strains the cables least: where
        all cables meet in a point, not at all. A guided platform moves with its origin.
        """
        turned = rotation_from_vector(motion[:, 3:]) @ rotation
        before, after = self._middle(rotation), self._middle(turned)
        return position + motion[:, :3] + np.cross(motion[:, 3:], before) + before - after, turned

    def _middle(self, rotation: np.ndarray) -> np.ndarray:
        """(n, 3) from the origin to the middle of the cables' platform ends; zero for a guided platform [m]."""
        middle = self.arrays.platform_anchors.mean(axis=-2) * (0.0 if self.arrays.has_guides else 1.0)
        return np.asarray((rotation @ middle[..., None])[..., 0])

    def states(self, position: np.ndarray, rotation: np.ndarray) -> CableStates:
        """The cables there."""
        return self.model.states(self.arrays, PlatformArms.at(self.arrays, position, rotation).points, self.length)


def _held(states: CableStates) -> float:
    """A stiffness [N/m] like that of the cables."""
    return float((states.axial_stiffness / states.length).max())
