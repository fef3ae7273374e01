"""Where a robot comes to rest at locked lengths, with which tensions and frequencies, by finite elements alone."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

import cdpr_struct.fem_reference as fem
from benchmarks.robot_reference import romberg

_MESHES = (20, 40, 80, 160, 320, 640)  # bars a cable
_BY_EACH = 3  # meshes whose limit is taken
SURE = 0.05  # of a sigma of the prediction: so little should the limit change with the finest mesh


@dataclass(frozen=True, slots=True, eq=False)
class FemRest:
    """pose : (6,) position, angles about x, y, z [m, deg];  tension : (m,) at the platform [N];  hertz : (k,) [Hz]."""

    pose: np.ndarray
    tension: np.ndarray
    hertz: np.ndarray

    @property
    def all(self) -> np.ndarray:
        """All of them (6 + m + k,)."""
        return np.concatenate([self.pose, self.tension, self.hertz])


def fem_rest(
    robot: fem.RobotData, position: np.ndarray, rotation: np.ndarray, sigma: FemRest
) -> tuple[FemRest, float, int]:
    """Rest near a pose; how far the finest mesh changed it, in sigmas, and its bars a cable.

    sigma : of predictions, by which the meshes are refined

    Raises
    ------
    FemError : no rest, or no modes.
    """
    found: list[FemRest] = []
    for elements in _MESHES:
        rest = fem.solve_robot(robot, position, rotation, elements)
        position, rotation = rest.position, rest.rotation
        found = [*found, _told(rest, len(sigma.hertz))][-_BY_EACH:]
        if len(found) == _BY_EACH:
            best, coarser = _limit(found), _limit(found[:-1])
            change = float((np.abs(best.all - coarser.all) / sigma.all).max())
            if change <= SURE:
                break
    return best, change, elements


def _told(rest: fem.RobotEquilibrium, count: int) -> FemRest:
    """R = Rz(rz) Ry(ry) Rx(rx)."""
    angles = Rotation.from_matrix(rest.rotation).as_euler("xyz", degrees=True)
    tension = np.linalg.norm([cable.end_force for cable in rest.cables], axis=1)
    return FemRest(np.concatenate([rest.position, angles]), tension, fem.robot_modes(rest, count).frequencies_hz)


def _limit(found: list[FemRest]) -> FemRest:
    return FemRest(*(romberg([getattr(one, name) for one in found]) for name in ("pose", "tension", "hertz")))
