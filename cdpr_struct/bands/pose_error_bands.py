"""Static pose errors of robots within the tolerances, at the lengths that are commanded to the robot as entered."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtri

from cdpr_struct.bands.drawn_robots import DrawnRobots, drawn_robots
from cdpr_struct.bands.frequency_bands import drawn_changes
from cdpr_struct.bands.likeliest_robot import likeliest_rests
from cdpr_struct.bands.locked_response import LockedResponse, locked_response
from cdpr_struct.bands.rest_bands import pose_by_motion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.tolerances import Spread
from cdpr_struct.statics.pose_error import PoseError

PARTS = ("global", "axial", "sag", "turn")
"""Three numbers each: position errors along x, y, z [m], of sag and stretch and of each alone, and the angles
rx, ry, rz of the whole error in reference platform axes [rad]."""
_AXES = 3


@dataclass(frozen=True, slots=True, eq=False)
class PoseErrorNumbers:
    """Pose errors of robots (...).

    components : (..., 12) of `PARTS`
    """

    components: np.ndarray

    @property
    def sizes(self) -> np.ndarray:
        """(..., 4) length of the error, of its parts, and size of the small turn [m], [rad]."""
        parts = self.components.reshape((*self.components.shape[:-1], len(PARTS), _AXES))
        return np.asarray(np.linalg.norm(parts, axis=-1))

    @property
    def all(self) -> np.ndarray:
        """(..., 16) components and behind them sizes."""
        return np.concatenate([self.components, self.sizes], axis=-1)


@dataclass(frozen=True, slots=True, eq=False)
class PoseErrorBands:
    """Of 16 numbers, components first, then sizes.

    band : (16, 2);  sigma : (16,)
    """

    band: np.ndarray
    sigma: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class ErringRobot:
    """One robot at rest on its sagging cables and on massless springs, both at the lengths that ideal cables need.

    reference_position, reference_rotation : (3,) [m], (3, 3) of the pose that was commanded
    """

    reference_position: np.ndarray
    reference_rotation: np.ndarray
    sagging: OperatingPoint
    spring: OperatingPoint

    @classmethod
    def of(cls, robot: Robot, error: PoseError) -> "ErringRobot":
        """The robot of a pose error without batch axes, held and stable."""
        sagging, spring = (
            OperatingPoint(robot, rest.position, rest.rotation, rest.cables) for rest in (error.sagging, error.spring)
        )
        return cls(error.reference_position, error.reference_rotation, sagging, spring)

    @staticmethod
    def likeliest(entered: "Sequence[ErringRobot]", spread: Spread) -> "list[ErringRobot | None]":
        """Each robot with its numbers at their means, at the lengths commanded to it as entered; None: no rest."""
        rests = [
            likeliest_rests([getattr(one, model) for one in entered], spread, model) for model in ("sagging", "spring")
        ]
        return [
            None if sagging is None or spring is None else replace(one, sagging=sagging, spring=spring)
            for one, sagging, spring in zip(entered, *rests, strict=True)
        ]

    def numbers(self) -> PoseErrorNumbers:
        """The errors of this robot."""
        sagging, spring = self.sagging, self.spring
        return self._numbers(sagging.position, sagging.rotation, spring.position)

    def bands(self, response: LockedResponse, spread: Spread, level: float) -> PoseErrorBands:
        """Central bands to first order that hold with a probability `level`, each number by itself.

        response : of the robot on its sagging cables;  spread : which robots are probable, about this one

        The size of an error is no linear function of it where it is small: its band is that of drawn components.
        """
        rates, own = self.rates(response, spread), self.numbers()
        middle, sigma = own.components, spread.sigma(rates)
        reach = ndtri(0.5 + 0.5 * level) * np.array([-1.0, 1.0])
        sizes = PoseErrorNumbers(own.components + drawn_changes(spread) @ rates).sizes
        ends = np.quantile(sizes, [0.5 - 0.5 * level, 0.5 + 0.5 * level], axis=0).T
        band = np.concatenate([middle[:, None] + sigma[:, None] * reach, ends])
        return PoseErrorBands(band, np.concatenate([sigma, sizes.std(axis=0)]))

    def drawn(self, spread: Spread, count: int) -> tuple[np.ndarray, DrawnRobots]:
        """(n, 16) errors of robots drawn like this one as entered, each brought to rest twice, and the sagging ones."""
        sagging, spring = (
            drawn_robots(point, spread, count, model=model)
            for point, model in ((self.sagging, "sagging"), (self.spring, "spring"))
        )
        _, first, second = np.intersect1d(sagging.number, spring.number, return_indices=True)
        place, there = sagging.pose[first], spring.pose[second]
        found = self._numbers(place[:, :3], rotation_from_angles(*place[:, 3:].T), there[:, :3])
        return found.all, sagging

    def rates(self, response: LockedResponse, spread: Spread) -> np.ndarray:
        """(p, 12) of the components by the numbers of a spread."""
        sagging, spring = response.pose, locked_response(self.spring, model="spring", spread=spread).pose[:, :3]
        back = self.reference_rotation.T
        angles = pose_by_motion(back @ self.sagging.rotation)[3:, 3:] @ back
        return np.concatenate([sagging[:, :3], spring, sagging[:, :3] - spring, sagging[:, 3:] @ angles.T], axis=1)

    def _numbers(self, sagging: np.ndarray, rotation: np.ndarray, spring: np.ndarray) -> PoseErrorNumbers:
        whole, axial = sagging - self.reference_position, spring - self.reference_position
        turn = angles_from_rotation(self.reference_rotation.T @ rotation)
        return PoseErrorNumbers(np.concatenate([whole, axial, whole - axial, turn], axis=-1))
