"""Reference poses on a regular grid."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.arrays import frozen_array

AXES = ("x", "y", "z")


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Every combination of positions x, y, z at one orientation.

    x, y, z : (nx,), (ny,), (nz,) strictly ascending [m]
    angles  : (3,) rx, ry, rz [rad], the same at every pose
    """

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    angles: np.ndarray

    def __post_init__(self) -> None:
        for name in AXES:
            values = np.asarray(getattr(self, name), dtype=float)
            if values.ndim != 1 or not values.size or not (np.diff(values) > 0.0).all():
                raise ValueError(f"Grid.{name} must be strictly ascending, got {values.tolist()!s:.200}")
            object.__setattr__(self, name, frozen_array(values, values.shape, f"Grid.{name}"))
        object.__setattr__(self, "angles", frozen_array(self.angles, (3,), "Grid.angles"))

    @property
    def axes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """x, y and z [m]."""
        return self.x, self.y, self.z

    @property
    def shape(self) -> tuple[int, int, int]:
        """(nx, ny, nz)."""
        return len(self.x), len(self.y), len(self.z)

    @property
    def size(self) -> int:
        """Number of poses n."""
        return int(np.prod(self.shape))

    @property
    def free(self) -> tuple[int, ...]:
        """Axes (0 for x, 1, 2) along which there is more than one position."""
        return tuple(i for i, count in enumerate(self.shape) if count > 1)

    @property
    def positions(self) -> np.ndarray:
        """(n, 3) [m]; z runs fastest, then y."""
        return np.stack(np.meshgrid(*self.axes, indexing="ij"), axis=-1).reshape(-1, 3)

    @property
    def rotation(self) -> np.ndarray:
        """(3, 3) platform to world."""
        return rotation_from_angles(*self.angles)

    @property
    def neighbours(self) -> np.ndarray:
        """(n, 6) numbers of the next poses along x (ahead, back), y and z; -1 where the grid ends."""
        number = np.arange(self.size).reshape(self.shape)
        found = np.full((*self.shape, 6), -1)
        for axis in range(3):
            ahead, back = np.moveaxis(found[..., 2 * axis : 2 * axis + 2], axis, 0).transpose(3, 0, 1, 2)
            along = np.moveaxis(number, axis, 0)
            ahead[:-1], back[1:] = along[1:], along[:-1]
        return found.reshape(-1, 6)

    def fixed_text(self) -> str:
        """The coordinates that all poses share, like `z = 0.5 m`; empty if there are none."""
        parts = [f"{AXES[i]} = {self.axes[i][0]:g} m" for i in range(3) if i not in self.free]
        degrees = np.degrees(self.angles)
        turned = [f"{n} = {v:g}°" for n, v in zip(("rx", "ry", "rz"), degrees, strict=True) if abs(v) > 1e-12]
        return ", ".join(parts + turned)

    def summary(self) -> dict[str, object]:
        """Ends and counts as result.json tells them."""
        ends: dict[str, object] = {
            f"{n}_m": [float(v[0]), float(v[-1]), len(v)] for n, v in zip(AXES, self.axes, strict=True)
        }
        return {**ends, "angles_deg": np.degrees(self.angles).tolist()}
