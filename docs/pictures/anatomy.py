"""The robot with its frames, anchors and pulleys; one sagging cable with its symbols; mode shapes."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

import cdpr_struct as cs
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.generated import catenary
from cdpr_struct.reports.figures.robot_geometry import RobotGeometry, robot_geometry
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILLION

ROBOT = Path(__file__).parents[2] / "examples" / "box-robot" / "robot.toml"
ROBOT_SIZE, CABLE_SIZE, MODES_SIZE = (9.6, 4.8), (9.0, 3.6), (9.6, 5.6)
_SHOWN = (0, 1, 10, 19)  # modes, from 0: the platform's first, one of cables and platform, two more of the platform
_VIEW = {"elev": 18.0, "azim": -66.0}


def draw_robot(figure: Figure) -> None:
    """Left the robot, right one pulley seen along its wheel's axle, below it the platform."""
    geometry = robot_geometry(cs.modes(ROBOT, count=1).point)
    grid = figure.add_gridspec(2, 3)
    axes: Any = figure.add_subplot(grid[:, :2], projection="3d")
    _scene(axes, geometry)
    origin = np.array(cs.load_robot(ROBOT).home.position)
    _axes_of(axes, np.zeros(3), 0.9, "O: world frame", BLACK)
    axes.quiver(*np.zeros(3), *origin, color=BLUE, arrow_length_ratio=0.1, linewidth=1.2)
    axes.text(*(0.6 * origin + [0.1, 0.0, 0.0]), "r", color=BLUE, fontweight="bold")
    for number, place in enumerate(geometry.frame, start=1):
        axes.text(*(place + 0.1), f"$B_{number}$", color=VERMILLION, parse_math=True)
    _pulley(figure.add_subplot(grid[0, 2]))
    close: Any = figure.add_subplot(grid[1, 2], projection="3d")
    _scene(close, geometry, reach=0.5)
    _axes_of(close, origin, 0.32, "P: platform frame", BLUE)
    close.scatter(*geometry.platform.T, s=14, color=GREEN, depthshade=False)
    for number, place in enumerate(geometry.platform, start=1):
        close.text(*(place + 0.02), f"$A_{number}$", color=GREEN, parse_math=True)


def _scene(
    axes: Any, geometry: RobotGeometry, colour: str = ORANGE, edges: str = BLACK, reach: float | None = None
) -> None:
    """Cables and platform; only the platform and `reach` [m] around it if that is given."""
    axes.add_collection3d(Line3DCollection(list(geometry.curves), colors=colour, linewidths=1.4))
    axes.add_collection3d(Line3DCollection(list(geometry.edges), colors=edges, linewidths=0.9))
    faces = list(geometry.platform[geometry.triangles])
    axes.add_collection3d(Poly3DCollection(faces, facecolors="#9aa3ad", edgecolors="none", alpha=0.3))
    axes.scatter(*geometry.frame.T, s=14, color=VERMILLION, depthshade=False)
    low, high = geometry.box()
    if reach is not None:
        low, high = (geometry.platform.mean(axis=0) + sign * reach for sign in (-1.0, 1.0))
        axes.collections[0].set_segments([_near(curve, low, high) for curve in geometry.curves])
        axes.collections[3].set_visible(False)
    for setter, ends in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), zip(low, high, strict=True), strict=True):
        setter(*ends)
    axes.set_box_aspect(high - low, zoom=1.15 if reach is None else 1.5)
    axes.view_init(**_VIEW)
    axes.set_axis_off()


def _near(curve: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """The end of a cable within a box, as a straight line."""
    ends = np.linspace(curve[-1], curve[-2], 2)
    direction = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    with np.errstate(divide="ignore"):
        room = np.where(direction > 0.0, high - curve[-1], low - curve[-1]) / direction
    return np.array([curve[-1], curve[-1] + 0.95 * float(room.min()) * direction])


def _axes_of(axes: Any, origin: np.ndarray, size: float, name: str, colour: str) -> None:
    for direction, label in zip(np.eye(3), "xyz", strict=True):
        axes.quiver(*origin, *(size * direction), color=colour, arrow_length_ratio=0.2, linewidth=1.4)
        axes.text(*(origin + 1.12 * size * direction), label, color=colour, fontsize=8)
    axes.text(*(origin - size * np.array([1.4, 0.0, 0.75])), name, color=colour, fontweight="bold")


def _pulley(axes: Axes) -> None:
    """B at the origin, the swivel axis upwards, the wheel beside it; the cable leaves at the wrap angle phi."""
    radius, phi = 1.0, np.radians(115.0)
    turn = np.linspace(0.0, 2.0 * np.pi, 90)
    axes.fill(radius + radius * np.cos(turn), radius * np.sin(turn), facecolor="#eef0f2", edgecolor=GREY)
    wrap = np.linspace(0.0, phi, 40)
    on_wheel = np.array([radius - radius * np.cos(wrap), radius * np.sin(wrap)])
    leaves = on_wheel[:, -1] + np.outer([0.0, 1.9], [np.sin(phi), np.cos(phi)])
    axes.plot([0.0, 0.0], [-2.0, 0.0], color=ORANGE, linewidth=2.2)
    axes.plot(*on_wheel, color=ORANGE, linewidth=2.2)
    axes.plot(*leaves.T, color=ORANGE, linewidth=2.2)
    axes.plot([0.0, 0.0], [-2.2, 2.0], color=VERMILLION, linewidth=0.9, linestyle="-.")
    axes.plot([0.0, radius, on_wheel[0, -1]], [0.0, 0.0, on_wheel[1, -1]], color=GREY, linewidth=0.8)
    axes.plot(0.0, 0.0, "o", color=VERMILLION)
    for text, place, colour in (
        ("$B$: frame_anchor", (-0.15, -0.1), VERMILLION), ("swivel axis", (-0.15, 1.8), VERMILLION),
        ("from the winch", (0.12, -1.9), ORANGE), ("to $A$", (leaves[1, 0] - 0.2, leaves[1, 1] + 0.2), ORANGE),
        ("φ", (0.72, 0.22), GREY), ("radius", (0.2, -0.35), GREY),
    ):  # fmt: skip
        side = "right" if place[0] < 0.0 else "left"
        axes.text(*place, text, color=colour, ha=side, fontsize=8.5, parse_math=True)
    axes.set_xlim(-3.0, 3.9)
    axes.set_ylim(-2.6, 2.3)
    axes.set_aspect("equal")
    axes.set_axis_off()


@dataclass(frozen=True, slots=True)
class _Hanging:
    """A heavy, soft cable from B to C, to see everything: force at C [N], length [m], EA [N], weight [N/m]."""

    force: tuple[float, float] = (60.0, 62.0)
    length: float = 10.0
    stiffness: float = 2000.0
    weight: float = 9.0

    def at(self, s: np.ndarray) -> np.ndarray:
        """(n, 2) places."""
        return np.column_stack(catenary.profile(s, *self.force, self.length, self.stiffness, self.weight))


def draw_cable(figure: Figure) -> None:
    """A sagging cable in its plane with the thesis's symbols and both local frames."""
    axes, cable = figure.add_subplot(), _Hanging()
    places = cable.at(np.linspace(0.0, cable.length, 201))
    end = places[-1]
    along = end / np.linalg.norm(end)
    across = np.array([-along[1], along[0]])
    axes.plot(*places.T, color=ORANGE, linewidth=2.4)
    axes.plot(*np.array([[0.0, 0.0], end]).T, color=GREY, linestyle="--", linewidth=1.0)
    _sag(axes, places, along, across)
    axes.text(*(0.62 * end + 0.2 * across), "$l_c$", color=GREY, parse_math=True)
    axes.text(*(places[165] + [0.35, -0.3]), "$l_{us}$ unstrained, $l_s$ strained", color=ORANGE, parse_math=True)
    angle = np.linspace(0.0, np.arctan2(end[1], end[0]), 30)
    axes.plot(2.4 * np.cos(angle), 2.4 * np.sin(angle), color=GREY, linewidth=0.9)
    axes.text(2.5, 0.22, "α", color=GREY)
    pull = np.array(cable.force) / 35.0
    _arrow(axes, end, end + pull, "$f_C$", VERMILLION)
    _arrow(axes, end, end + np.array([pull[0], 0.0]), "$f_{Cx}$: lead force, H", VERMILLION)
    _arrow(axes, end, end + np.array([0.0, pull[1]]), "$f_{Cz}$", VERMILLION)
    _arrow(axes, np.zeros(2), np.array([1.5, 0.0]), "x", BLACK)
    _arrow(axes, np.zeros(2), np.array([0.0, 1.5]), "z, up (static frame)", BLACK)
    _arrow(axes, np.zeros(2), 1.5 * along, "x", GREEN, (-0.1, 0.22))
    _arrow(axes, np.zeros(2), 1.5 * across, "z (dynamic frame)", GREEN, (-2.9, 0.05))
    for place, name in ((np.zeros(2), "B, fixed end"), (end, "C, moving end")):
        axes.plot(*place, "o", color=BLACK)
        axes.text(*(place + np.array([0.1, -0.55])), name)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_xlim(-3.6, 12.6)
    axes.set_ylim(-1.4, 4.4)


def _sag(axes: Axes, places: np.ndarray, along: np.ndarray, across: np.ndarray) -> None:
    """The largest distance d from the chord, where the tension tau is parallel to it."""
    drop = places @ across
    low = int(drop.argmin())
    foot = places[low] - drop[low] * across
    arrow = {"arrowstyle": "<->", "color": BLUE, "shrinkA": 0.0, "shrinkB": 0.0}
    axes.annotate("", foot, places[low], arrowprops=arrow)
    axes.text(*(0.5 * (foot + places[low]) + [0.15, -0.05]), "d", color=BLUE)
    _arrow(axes, places[low], places[low] + 1.6 * along, "τ", VERMILLION, (0.1, -0.3))


def _arrow(
    axes: Axes, start: np.ndarray, end: np.ndarray, text: str, colour: str, shift: tuple[float, float] = (0.08, 0.05)
) -> None:
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "shrinkA": 0.0, "shrinkB": 0.0})
    axes.text(end[0] + shift[0], end[1] + shift[1], text, color=colour, parse_math=True)


def draw_modes(figure: Figure) -> None:
    """Shapes of four modes, enlarged; grey is the robot at rest."""
    point = cs.modes(ROBOT, count=1).point
    geometry = robot_geometry(point)
    top = 2.0 * np.pi * 30.0
    shapes = ritz_modes(point, cable_dynamics(point, "exact", top).expansion(top), max(_SHOWN) + 1)
    moved = shapes.expansion.motion(
        np.linspace(0.0, 1.0, geometry.curves.shape[1]), shapes.end, shapes.modal, shapes.mast
    )  # fmt: skip
    kinds = shapes.kinds()
    for place, mode in enumerate(_SHOWN, start=1):
        axes: Any = figure.add_subplot(2, 2, place, projection="3d")
        _scene(axes, geometry, "#c9ced4", "#c9ced4")
        scale = 0.45 / np.abs(moved[mode]).max()
        curves = list(geometry.curves + scale * moved[mode])
        axes.add_collection3d(Line3DCollection(curves, colors=BLUE, linewidths=1.2))
        shift, turn = scale * shapes.platform[mode, :3], scale * shapes.platform[mode, 3:]
        edges = geometry.edges + shift + np.cross(turn, geometry.edges - point.position)
        axes.add_collection3d(Line3DCollection(list(edges), colors=BLUE, linewidths=1.4))
        hertz = shapes.omega[mode] / (2.0 * np.pi)
        axes.set_title(f"mode {mode + 1}: {hertz:.2f} Hz, {kinds[mode]}", y=0.98, fontsize=9.0)
