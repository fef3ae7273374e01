"""The robot with its sagging cables, drawn to scale."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D, proj3d
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.reports.figures.limits import label_groups
from cdpr_struct.reports.figures.robot_geometry import RobotGeometry, robot_geometry
from cdpr_struct.reports.figures.style import BLACK, GREY, LIGHT

SIZE = (9.6, 5.6)
COLOUR_MAP = "viridis_r"
TENSION_LABEL = "tension at the platform [N]"
_PANEL, _NARROW_PANEL = (0.05, 0.09, 0.85, 0.97), (0.08, 0.31, 0.88, 0.97)
_BESIDE = 6.0  # width of a figure from which on the scale is beside the robot [inch]
_VIEW = {"elev": 20.0, "azim": -62.0}


def draw_robot(figure: Figure, point: OperatingPoint) -> None:
    """Frame anchors, platform and cables; a cable's colour is its tension."""
    tension = point.cables.tension_at_platform
    scale = Normalize(*tension_range(tension))
    beside = figure.get_figwidth() > _BESIDE
    draw_geometry(figure, robot_geometry(point), colormaps[COLOUR_MAP](scale(tension)))
    bar = figure.add_axes((0.905, 0.2, 0.014, 0.6) if beside else (0.15, 0.15, 0.7, 0.022))
    way = "vertical" if beside else "horizontal"
    drawn = figure.colorbar(ScalarMappable(scale, COLOUR_MAP), cax=bar, label=TENSION_LABEL, orientation=way)
    drawn.outline.set_visible(False)


def draw_geometry(figure: Figure, geometry: RobotGeometry, colours: np.ndarray | str) -> None:
    """Frame anchors, platform and cables, in one colour or in colours (m, 4).

    Right of them is room for a scale, below them in a narrow figure.
    """
    figure.set_layout_engine("none")
    axes: Axes3D = figure.add_axes((0.0, 0.0, 1.0, 1.0), projection="3d")
    _set_view(axes, geometry)
    _ground(axes, geometry)
    axes.add_collection3d(Line3DCollection(list(geometry.curves), colors=colours, linewidths=1.8))
    axes.add_collection3d(Line3DCollection(list(geometry.edges), colors=BLACK, linewidths=1.0))
    if len(geometry.triangles):
        faces = list(geometry.platform[geometry.triangles])
        axes.add_collection3d(Poly3DCollection(faces, facecolors="#9aa3ad", edgecolors="none", alpha=0.35))
    axes.scatter(*geometry.frame.T, s=20, c=colours, depthshade=False, clip_on=False, edgecolors=BLACK, linewidths=0.6)
    _number_cables(axes, geometry)
    _fill_panel(figure, axes)


def tension_range(tension: np.ndarray) -> tuple[float, float]:
    """Ends of the colour scale [N], apart even where all tensions are equal."""
    low, high = float(tension.min()), float(tension.max())
    margin = max(0.0, 0.01 * abs(high) - (high - low))
    return low - margin, high + margin


def _set_view(axes: Axes3D, geometry: RobotGeometry) -> None:
    for setter, ends in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), geometry.box().T.tolist(), strict=True):
        setter(*ends)
    axes.set_aspect("equal")
    axes.view_init(**_VIEW)
    for axis, label in zip((axes.xaxis, axes.yaxis, axes.zaxis), "xyz", strict=True):
        axis.set_label_text(f"{label} [m]")
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
        axis._axinfo["grid"].update(color=LIGHT, linewidth=0.6)
    axes.locator_params(nbins=6)
    axes.locator_params(axis="z", nbins=4)


def _fill_panel(figure: Figure, axes: Axes3D) -> None:
    """Place the square that a 3-D view lives in so that the projected box fills the panel, margins for labels left."""
    corners = np.array(np.meshgrid(axes.get_xlim(), axes.get_ylim(), axes.get_zlim())).reshape(3, -1)
    x, y, _ = proj3d.proj_transform(*corners, axes.get_proj())
    axes.apply_aspect()
    place = axes.transAxes.inverted().transform(axes.transData.transform(np.column_stack([x, y])))
    low, high = place.min(axis=0), place.max(axis=0)
    size = figure.get_size_inches()
    start, end = np.array(_PANEL if size[0] > _BESIDE else _NARROW_PANEL).reshape(2, 2)
    side = float(np.min((end - start) * size / (high - low)))
    left, bottom = 0.5 * (start + end) - 0.5 * (low + high) * side / size
    axes.set_position((left, bottom, side / size[0], side / size[1]))


def _ground(axes: Axes3D, geometry: RobotGeometry) -> None:
    feet = geometry.frame.copy()
    feet[:, 2] = geometry.floor
    posts = np.stack([feet, geometry.frame], axis=1)
    axes.add_collection3d(Line3DCollection(list(posts), colors=GREY, linewidths=0.6, linestyles=":"))


def _number_cables(axes: Axes3D, geometry: RobotGeometry) -> None:
    """Number every cable at its frame anchor; anchors that coincide in this view share a label."""
    x, y, _ = proj3d.proj_transform(*geometry.frame.T, axes.get_proj())
    points = np.column_stack([x, y])
    extent = np.ptp(points, axis=0).max()
    figure = axes.get_figure()
    extent *= SIZE[0] / figure.get_figwidth() if isinstance(figure, Figure) else 1.0
    for place, label in label_groups(points, (0.03 * extent, 0.022 * extent)):
        axes.annotate(label, tuple(place), (4, 4), textcoords="offset points", fontsize=8, annotation_clip=False)


def robot_caption(point: OperatingPoint) -> str:
    """What to see in the figure."""
    cables, tension = point.cables, point.cables.tension_at_platform
    x, y, z = point.position
    worst = int(np.argmax(cables.sag))
    return (
        f"{point.entered.name} at rest at ({x:g}, {y:g}, {z:g}) m, drawn to scale: {len(tension)} cables, platform "
        f"{point.entered.platform.mass:g} kg. Numbers at the frame anchors are cables; colour is the tension, "
        f"{tension.min():.4g} to {tension.max():.4g} N. The cables hang in catenaries; cable {worst + 1} sags most, "
        f"{1000.0 * cables.sag[worst]:.4g} mm on a chord of {cables.chord[worst]:.2f} m."
    )
