"""Position and orientation of the platform."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.arrays import frozen_array


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """Pose of the platform frame in the world frame.

    position : (3,) r [m]
    angles   : (3,) rx, ry, rz [rad]; R = Rz(rz) Ry(ry) Rx(rx), platform to world
    """

    position: np.ndarray
    angles: np.ndarray

    def __post_init__(self) -> None:
        for name in ("position", "angles"):
            object.__setattr__(self, name, frozen_array(getattr(self, name), (3,), f"Pose.{name}"))

    @classmethod
    def from_degrees(cls, values: list[float] | np.ndarray) -> "Pose":
        """Pose from x, y, z [m] and optional rx, ry, rz [deg]."""
        values = np.asarray(values, dtype=float)
        if values.shape not in ((3,), (6,)):
            raise ValueError(f"a pose is x,y,z or x,y,z,rx,ry,rz, got {values.size} numbers")
        return cls(values[:3], np.radians(values[3:]) if values.size == 6 else np.zeros(3))

    @property
    def rotation(self) -> np.ndarray:
        """(3, 3) rotation matrix, platform to world."""
        return rotation_from_angles(*self.angles)

    def in_degrees(self) -> list[float]:
        """[x, y, z, rx, ry, rz] in m and deg, as files and the command line write a pose."""
        return [*self.position.tolist(), *np.degrees(self.angles).tolist()]


def angle_between(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Angle (...) [rad] by which rotation matrices (..., 3, 3) differ."""
    cosine = 0.5 * (np.einsum("...ij,...ij->...", first, second) - 1.0)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def angles_from_rotation(rotation: np.ndarray) -> np.ndarray:
    """Angles rx, ry, rz [rad] (..., 3) of rotation matrices (..., 3, 3) = Rz Ry Rx.

    Near ry = 90 deg the axes of rx and rz meet, and rx is uncertain; rz then makes up for it: it turns the y axis from
    the world to where R Rx^-1 has it.
    """
    ry = np.arctan2(-rotation[..., 2, 0], np.hypot(rotation[..., 0, 0], rotation[..., 1, 0]))
    rx = np.arctan2(rotation[..., 2, 1], rotation[..., 2, 2])
    turned = rotation[..., 1] * np.cos(rx)[..., None] - rotation[..., 2] * np.sin(rx)[..., None]
    rz = np.arctan2(-turned[..., 0], turned[..., 1])
    return np.stack([rx, ry, rz], axis=-1)
