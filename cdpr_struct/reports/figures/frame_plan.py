"""Where a map lies: the robot's frame, its platform and the mapped rectangle, in the plane of the map."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from scipy.spatial import ConvexHull

from cdpr_struct.reports.figures.limits import label_groups
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREY
from cdpr_struct.robot.robot import Robot, anchors_in_world
from cdpr_struct.workspace.grid import AXES, Grid

_NEAR = (0.07, 0.06)  # of the plan: anchors nearer than that share a label


@dataclass(frozen=True, slots=True, eq=False)
class FramePlan:
    """Anchors of a robot whose platform is in the middle of a grid, world frame [m].

    anchors, platform : (m, 3) frame end and platform end of each cable
    """

    anchors: np.ndarray
    platform: np.ndarray

    @classmethod
    def of(cls, robot: Robot, grid: Grid) -> "FramePlan":
        """The platform in the middle of the grid, at the grid's orientation."""
        middle = np.array([0.5 * (axis[0] + axis[-1]) for axis in grid.axes])
        return cls(np.array(robot.frame_anchors), anchors_in_world(robot, middle, grid.rotation)[0])

    def frame_outline(self, across: int, up: int) -> np.ndarray:
        """(k, 2) line around the frame anchors in a plane, closed."""
        return outline(self.anchors[:, (across, up)])

    def platform_outline(self, across: int, up: int) -> np.ndarray:
        """(k, 2) line around the platform anchors in a plane, closed."""
        return outline(self.platform[:, (across, up)])


def outline(points: np.ndarray) -> np.ndarray:
    """The points (n, 2) around the others, the first again at the end; all of them if they lie in a row."""
    if len(points) < 3 or np.linalg.matrix_rank(points - points.mean(axis=0), tol=1e-9) < 2:
        return points
    around = ConvexHull(points).vertices
    return points[np.append(around, around[0])]


def draw_plan(axes: Axes, plan: FramePlan, grid: Grid, across: int, up: int) -> None:
    """The frame with numbered anchors, the platform, and the mapped rectangle in blue."""
    anchors = plan.anchors[:, (across, up)]
    axes.plot(*plan.frame_outline(across, up).T, color=GREY, linewidth=0.9)
    axes.plot(*anchors.T, "o", color=BLACK, markersize=3)
    axes.plot(*plan.platform_outline(across, up).T, color=BLACK, linewidth=1.1)
    ends = [(float(grid.axes[i][0]), float(np.ptp(grid.axes[i]))) for i in (across, up)]
    (x, width), (y, height) = ends
    axes.add_patch(Rectangle((x, y), width, height, facecolor=BLUE, alpha=0.18, linewidth=0))
    axes.add_patch(Rectangle((x, y), width, height, facecolor="none", edgecolor=BLUE, linewidth=1.0))
    extent = float(np.ptp(anchors, axis=0).max())
    for place, label in label_groups(anchors, (_NEAR[0] * extent, _NEAR[1] * extent)):
        axes.annotate(label, tuple(place), (3, 3), textcoords="offset points", fontsize=7.5, annotation_clip=False)
    axes.set_aspect("equal")
    axes.margins(0.14)
    axes.grid(False)
    axes.tick_params(labelsize=7.5)
    axes.set_xlabel(f"{AXES[across]} [m]")
    axes.set_title("in the frame")
