"""A map of static pose errors (3.2.2): means, extremes, and the poses that do not count."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.errors import UnholdablePoseError
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.work_list import Columns

PARTS = ("sag", "axial", "global")


@dataclass(frozen=True, slots=True, eq=False)
class PoseErrorMap:
    """Pose errors over a grid.

    mass    : of the platform, load included [kg]
    columns : as `quantities.pose_errors` makes them, n values each
    """

    robot: str
    mass: float
    grid: Grid
    columns: Columns

    @property
    def counts(self) -> np.ndarray:
        """(n,) bool: held at the reference pose by ideal cables, and stable in both other models."""
        return np.asarray(self.columns["held"] & self.columns["stable"])

    @property
    def more_stable(self) -> np.ndarray:
        """(n,) bool: counts, and the spring model has another equilibrium of lower energy."""
        return np.asarray(self.columns["more_stable_pose"] & self.counts)

    def vertical(self, part: str) -> np.ndarray:
        """(n,) error along z of a part (`sag`, `axial`, `global`) [mm]; nan at poses that do not count."""
        return np.where(self.counts, self.columns[f"{part}_z_mm"], np.nan)

    def mean(self, part: str) -> float:
        """Mean error along z over the poses that count [mm]."""
        return float(np.nanmean(self.vertical(part)))

    def extreme(self, part: str) -> tuple[float, np.ndarray]:
        """Error along z of largest size [mm] and its reference position (3,) [m]."""
        value = self.vertical(part)
        worst = int(np.nanargmax(np.abs(value)))
        return float(value[worst]), self.grid.positions[worst]

    def require_some(self) -> "PoseErrorMap":
        """Self, or UnholdablePoseError if not one pose counts."""
        if not self.counts.any():
            held, stable = int(self.columns["held"].sum()), int(self.columns["stable"].sum())
            raise UnholdablePoseError(
                f"no pose of the grid has a pose error: of {self.grid.size}, ideal cables hold {held}, and the sagging "
                f"and spring models find {stable} stable. Move the grid into the workspace."
            )
        return self
