"""Plotly figures of the report page, as the plain data that plotly.js draws.

Plain data rather than plotly's Python objects: importing and validating those takes longer than the report itself; the
tests validate the data instead.
"""

import numpy as np

from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.reports.figures.determinant import DETERMINANT_LABEL, FREQUENCY_LABEL, zoom_window
from cdpr_struct.reports.figures.mode_stacks import stack_levels
from cdpr_struct.reports.figures.plot_parts import Plot, plot_axis, plot_layout, plot_line
from cdpr_struct.reports.figures.robot_drawing import TENSION_LABEL, tension_range
from cdpr_struct.reports.figures.robot_geometry import RobotGeometry, robot_geometry
from cdpr_struct.reports.figures.solid_scene import anchor_labels, solid_scene
from cdpr_struct.reports.figures.style import BAD, BLACK, BLUE, GOOD, GREY, LIGHT

_STACKS_ACROSS = 130
_TENSION_SCALE = "Viridis"


def determinant_plot(trial: Verification) -> Plot:
    """The determinant scan that can be zoomed, with a hover text for every mode."""
    scan = trial.scan
    depth = np.interp(scan.minima_hertz, scan.hertz, scan.log_dynamic)
    curves = [
        plot_line(scan.hertz, scan.log_static, "static K", {"color": GREY, "width": 1.3, "dash": "dash"}),
        plot_line(scan.hertz, scan.log_dynamic, "dynamic K (DSM, damped)", {"color": BLUE, "width": 1.8}),
        {
            "type": "scatter", "mode": "markers", "name": "minimum of the scan",
            "x": scan.minima_hertz.tolist(), "y": depth.tolist(), "marker": {"color": BLACK, "size": 7},
            "hovertemplate": "minimum at %{x:.2f} Hz<extra></extra>",
        },
    ]  # fmt: skip
    layout = {
        **plot_layout(560),
        "xaxis": {**plot_axis(FREQUENCY_LABEL), "anchor": "y2", "range": [0.0, float(scan.hertz[-1])]},
        "yaxis": {**plot_axis(DETERMINANT_LABEL), "domain": [0.34, 1.0]},
        "yaxis2": {
            **plot_axis("FEM modes [count]"), "domain": [0.0, 0.26], "rangemode": "tozero", "fixedrange": True,
            "dtick": _whole_step(trial),
        },
        "shapes": [_shade(*zoom_window(trial))],
    }  # fmt: skip
    return {"data": curves + _mode_marks(trial), "layout": layout}


def _levels(trial: Verification) -> np.ndarray:
    return stack_levels(trial.fem_limit_hertz, float(trial.scan.hertz[-1]) / _STACKS_ACROSS)


def _whole_step(trial: Verification) -> int:
    """Step of the ticks of a count, some three of them."""
    return max(1, round(float(_levels(trial).max(initial=1)) / 3.0))


def _shade(low: float, high: float) -> Plot:
    return {
        "type": "rect", "x0": low, "x1": high, "xref": "x", "y0": 0.0, "y1": 1.0, "yref": "paper",
        "fillcolor": LIGHT, "opacity": 0.6, "layer": "below", "line": {"width": 0},
    }  # fmt: skip


def _mode_marks(trial: Verification) -> list[Plot]:
    hertz = trial.fem_limit_hertz
    level = _levels(trial)
    missed = np.isnan(trial.determinant_hertz)
    marks = []
    for chosen, name, colour, symbol in (
        (~missed, "FEM mode, seen by the scan", GOOD, "circle"),
        (missed, "FEM mode, missed", BAD, "x-thin"),
    ):
        index = np.flatnonzero(chosen)
        marks.append(
            {
                "type": "scatter", "mode": "markers", "name": name, "yaxis": "y2",
                "x": hertz[index].tolist(), "y": level[index].tolist(),
                "text": [_mode_text(trial, i) for i in index.tolist()],
                "hovertemplate": "%{text}<extra></extra>",
                "marker": {"color": colour, "size": 8, "symbol": symbol, "line": {"color": colour, "width": 2}},
            }
        )  # fmt: skip
    return marks


def _mode_text(trial: Verification, i: int) -> str:
    fem, dsm = trial.fem_limit_hertz[i], trial.dsm_hertz[i]
    return f"mode {i + 1} ({trial.kinds[i]})<br>FEM {fem:.4f} Hz<br>DSM {dsm:.4f} Hz"


def robot_plot(point: OperatingPoint) -> Plot:
    """The robot that can be turned, with a hover text for every cable."""
    geometry = robot_geometry(point)
    low, high = tension_range(point.cables.tension_at_platform)
    scale = {"colorscale": _TENSION_SCALE, "reversescale": True, "cmin": low, "cmax": high}
    lines = [_cable_line(point, i, curve, scale) for i, curve in enumerate(geometry.curves)]
    anchors = _frame_anchors(geometry, point.cables.tension_at_platform, scale)
    return {"data": [*lines, anchors, *_platform(geometry)], **solid_scene(geometry.box(), bar=True)}


def _cable_line(point: OperatingPoint, i: int, curve: np.ndarray, scale: Plot) -> Plot:
    cables = point.cables
    tension = float(cables.tension_at_platform[i])
    return {
        "type": "scatter3d", "mode": "lines", "name": f"cable {i + 1}", "showlegend": False,
        **_xyz(curve),
        "line": {"width": 6, "color": [tension] * len(curve), **scale},
        "hovertemplate": (
            f"cable {i + 1}<br>tension {tension:.1f} N<br>unstrained length {cables.length[i]:.4f} m"
            f"<br>chord {cables.chord[i]:.4f} m<br>sag {1000.0 * cables.sag[i]:.1f} mm<extra></extra>"
        ),
    }  # fmt: skip


def _frame_anchors(geometry: RobotGeometry, tension: np.ndarray, scale: Plot) -> Plot:
    title = {"text": TENSION_LABEL, "side": "right", "font": {"size": 13}}
    bar = {"title": title, "thickness": 12, "len": 0.7, "outlinewidth": 0}
    return {
        "type": "scatter3d", "mode": "markers+text", "name": "frame anchors", "showlegend": False,
        **_xyz(geometry.frame),
        "text": anchor_labels(geometry.frame, geometry.box()), "textposition": "top center",
        "marker": {"size": 4, "color": tension.tolist(), **scale, "colorbar": bar},
        "customdata": list(range(1, len(tension) + 1)),
        "hovertemplate": "frame anchor of cable %{customdata}<br>(%{x:.3f}, %{y:.3f}, %{z:.3f}) m<extra></extra>",
    }  # fmt: skip


def _platform(geometry: RobotGeometry) -> list[Plot]:
    gap: list[list[float | None]] = [[None, None, None]]
    points = [row for edge in geometry.edges.tolist() for row in [*edge, *gap]]
    x, y, z = zip(*points, strict=True)
    outline = {
        "type": "scatter3d", "mode": "lines", "name": "platform", "showlegend": False, "hoverinfo": "skip",
        "x": list(x), "y": list(y), "z": list(z), "line": {"color": BLACK, "width": 3},
    }  # fmt: skip
    if not len(geometry.triangles):
        return [outline]
    i, j, k = geometry.triangles.T.tolist()
    faces = {
        "type": "mesh3d", **_xyz(geometry.platform), "i": i, "j": j, "k": k,
        "color": "#9aa3ad", "opacity": 0.5, "flatshading": True, "hoverinfo": "skip",
    }  # fmt: skip
    return [outline, faces]


def _xyz(points: np.ndarray) -> Plot:
    x, y, z = points.T.tolist()
    return {"x": x, "y": y, "z": z}
