"""The first modes of the robot on paper: at rest, and at the end of a swing."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from cdpr_struct.crosscheck.mode_motion import ModeMotion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.reports.figures.robot_geometry import RobotGeometry, cable_curves, robot_geometry
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREY, ORANGE

SHOWN = 6
_ACROSS = 3
_WIDTH, _TITLE = 9.6, 0.3  # inch
_ROOM = 0.15  # for the motion, beside the robot's height over its width
_YAW, _PITCH = np.radians(28.0), np.radians(20.0)
_SMALLEST = 1e-9  # m: a robot on one vertical line has no width, and turning about it moves nothing that is drawn
_MOVED = 0.07  # of the robot's size moves the point that moves most


def size(point: OperatingPoint, modes: int) -> tuple[float, float]:
    """Width and height [inch] of the figure of so many modes: panels as high as the robot is in them."""
    wide, high = np.ptp(_flat(robot_geometry(point).curves).reshape(-1, 2), axis=0)
    row = _TITLE + min(float(high / max(wide, _SMALLEST)) + _ROOM, 1.0) * _WIDTH / _ACROSS
    return _WIDTH, row * _rows(modes)


def draw_shapes(figure: Figure, point: OperatingPoint, result: Mapping[str, Any], motion: ModeMotion) -> None:
    """A panel for each of the first modes, seen along the same parallel rays; the figure has the `size` for them."""
    count = min(len(motion.platform), SHOWN)
    geometry, rest = robot_geometry(point), cable_curves(point, motion.fractions)
    reach = _MOVED * float(np.linalg.norm(np.ptp(geometry.box(), axis=0)))
    panels = figure.subplots(_rows(count), _ACROSS, squeeze=False).ravel()
    for axes in panels:
        axes.set_axis_off()
    for k, axes in enumerate(panels[:count]):
        gain, every = reach / max(motion.reach[k], _SMALLEST), slice(None, None, int(motion.stride[k]))
        cables = (rest + gain * motion.cables[k])[:, every]
        _robot(axes, geometry, rest[:, every], None)
        _robot(axes, geometry, cables, geometry.edges + gain * _carried(point, geometry, motion.platform[k]))
        axes.set_aspect("equal")
        axes.set_title(f"{k + 1}: {float(result['frequencies_hz'][k]):.4g} Hz, {result['kinds'][k]}", fontsize=9.0)


def _rows(modes: int) -> int:
    return -(-min(modes, SHOWN) // _ACROSS)


def shapes_caption(modes: int) -> str:
    """What to see in the figure, moving or on paper."""
    first = "mode" if modes == 1 else f"{min(modes, SHOWN)} modes"
    return (
        "Cables (orange) and platform (blue) in a mode, the robot at rest in grey, in parallel projection. On the "
        "screen the mode can be chosen, and cables with more of the energy are drawn stronger; numbers at the frame "
        f"anchors are cables. On paper: the first {first} at the end of a swing, where the point that moves most is "
        f"{100 * _MOVED:.0f} % of the robot's size away from rest. A mode shape has no size of its own."
    )


def _carried(point: OperatingPoint, geometry: RobotGeometry, platform: np.ndarray) -> np.ndarray:
    """Motion of the ends of the platform's edges (e, 2, 3)."""
    return np.asarray(platform[:3] + np.cross(platform[3:], geometry.edges - point.position))


def _robot(axes: Axes, geometry: RobotGeometry, cables: np.ndarray, edges: np.ndarray | None) -> None:
    """At rest where no moved edges are given."""
    colours = (GREY, GREY) if edges is None else (ORANGE, BLUE)
    widths = (0.6, 0.6) if edges is None else (1.1, 1.3)
    lines = (cables, geometry.edges if edges is None else edges)
    for line, colour, width in zip(lines, colours, widths, strict=True):
        axes.add_collection(LineCollection(list(_flat(line)), colors=colour, linewidths=width))
    if edges is None:
        axes.plot(*_flat(geometry.frame).T, "s", color=BLACK, markersize=2.5)


def _flat(points: np.ndarray) -> np.ndarray:
    """(..., 2) of (..., 3)."""
    sin, cos = np.sin([_YAW, _PITCH]), np.cos([_YAW, _PITCH])
    right = np.array([cos[0], sin[0], 0.0])
    up = np.array([-sin[1] * sin[0], sin[1] * cos[0], cos[1]])
    return np.stack([points @ right, points @ up], axis=-1)
