"""Plotly figures of the report page, as the plain data that plotly.js draws, and plotly.js itself.

Plain data rather than plotly's Python objects: importing and validating those takes longer than the report itself; the
tests validate the data instead.
"""

import base64
import gzip
from importlib import resources
from typing import Any

import numpy as np

from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.reports.figures.determinant import DETERMINANT_LABEL, FREQUENCY_LABEL
from cdpr_struct.reports.figures.mode_stacks import stack_levels
from cdpr_struct.reports.figures.robot_drawing import TENSION_LABEL, tension_range
from cdpr_struct.reports.figures.robot_geometry import robot_geometry
from cdpr_struct.reports.figures.style import BAD, BLACK, BLUE, FONT_STACK, GOOD, GREY, LIGHT

Plot = dict[str, Any]
_STACKS_ACROSS = 130
_TENSION_SCALE = "Viridis"


def plotly_packed() -> str:
    """plotly.js, gzipped, in base64: a third of its size, and no markup of the page can clash with it."""
    source = resources.files("plotly").joinpath("package_data", "plotly.min.js").read_bytes()
    return base64.b64encode(gzip.compress(source, compresslevel=6, mtime=0)).decode("ascii")


def determinant_plot(trial: Verification) -> Plot:
    """The determinant scan that can be zoomed, with a hover text for every mode."""
    scan = trial.scan
    depth = np.interp(scan.minima_hertz, scan.hertz, scan.log_dynamic)
    curves = [
        _line(scan.hertz, scan.log_static, "static K", {"color": GREY, "width": 1.3, "dash": "dash"}),
        _line(scan.hertz, scan.log_dynamic, "dynamic K (DSM, damped)", {"color": BLUE, "width": 1.8}),
        {
            "type": "scatter", "mode": "markers", "name": "minimum of the scan",
            "x": scan.minima_hertz.tolist(), "y": depth.tolist(), "marker": {"color": BLACK, "size": 7},
            "hovertemplate": "minimum at %{x:.2f} Hz<extra></extra>",
        },
    ]  # fmt: skip
    layout = {
        **_layout(560),
        "xaxis": {**_axis(FREQUENCY_LABEL), "anchor": "y2", "range": [0.0, float(scan.hertz[-1])]},
        "yaxis": {**_axis(DETERMINANT_LABEL), "domain": [0.34, 1.0]},
        "yaxis2": {**_axis("FEM modes [count]"), "domain": [0.0, 0.26], "rangemode": "tozero", "fixedrange": True},
    }
    return {"data": curves + _mode_marks(trial), "layout": layout}


def _mode_marks(trial: Verification) -> list[Plot]:
    hertz = trial.fem_limit_hertz
    level = stack_levels(hertz, float(trial.scan.hertz[-1]) / _STACKS_ACROSS)
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
                "text": [f"mode {i + 1}: FEM {hertz[i]:.4f} Hz, DSM {trial.dsm_hertz[i]:.4f} Hz ({trial.kinds[i]})" for i in index],
                "hovertemplate": "%{text}<extra></extra>",
                "marker": {"color": colour, "size": 8, "symbol": symbol, "line": {"color": colour, "width": 2}},
            }
        )  # fmt: skip
    return marks


def robot_plot(point: OperatingPoint) -> Plot:
    """The robot that can be turned, with a hover text for every cable."""
    geometry = robot_geometry(point)
    cables, tension = point.cables, point.cables.tension_at_platform
    low, high = tension_range(tension)
    scale = {"colorscale": _TENSION_SCALE, "reversescale": True, "cmin": low, "cmax": high}
    lines = [
        {
            "type": "scatter3d", "mode": "lines", "name": f"cable {i + 1}", "showlegend": False,
            **_xyz(curve),
            "line": {"width": 6, "color": [float(tension[i])] * len(curve), **scale},
            "hovertemplate": (
                f"cable {i + 1}<br>tension {tension[i]:.1f} N<br>unstrained length {cables.length[i]:.4f} m"
                f"<br>chord {cables.chord[i]:.4f} m<br>sag {1000.0 * cables.sag[i]:.1f} mm<extra></extra>"
            ),
        }
        for i, curve in enumerate(geometry.curves)
    ]  # fmt: skip
    anchors = {
        "type": "scatter3d", "mode": "markers+text", "name": "frame anchors", "showlegend": False,
        **_xyz(geometry.frame),
        "text": [str(i + 1) for i in range(len(tension))], "textposition": "top center",
        "marker": {
            "size": 4, "color": tension.tolist(), **scale,
            "colorbar": {"title": {"text": TENSION_LABEL, "side": "right"}, "thickness": 12, "len": 0.7, "outlinewidth": 0},
        },
        "hovertemplate": "frame anchor of cable %{text}<br>(%{x:.3f}, %{y:.3f}, %{z:.3f}) m<extra></extra>",
    }  # fmt: skip
    layout = {
        **_layout(620),
        "margin": {"l": 0, "r": 0, "t": 10, "b": 0},
        "scene": {
            "aspectmode": "data",
            "camera": {"eye": {"x": 0.75, "y": -1.35, "z": 0.6}},
            **{f"{name}axis": {**_axis(f"{name} [m]"), "backgroundcolor": "white"} for name in "xyz"},
        },
    }
    return {"data": [*lines, anchors, *_platform(geometry.edges, geometry.platform, geometry.triangles)], "layout": layout}


def _platform(edges: np.ndarray, corners: np.ndarray, triangles: np.ndarray) -> list[Plot]:
    gap: list[list[float | None]] = [[None, None, None]]
    points = [row for edge in edges.tolist() for row in [*edge, *gap]]
    x, y, z = zip(*points, strict=True)
    outline = {
        "type": "scatter3d", "mode": "lines", "name": "platform", "showlegend": False, "hoverinfo": "skip",
        "x": list(x), "y": list(y), "z": list(z), "line": {"color": BLACK, "width": 3},
    }  # fmt: skip
    if not len(triangles):
        return [outline]
    i, j, k = triangles.T.tolist()
    faces = {
        "type": "mesh3d", **_xyz(corners), "i": i, "j": j, "k": k,
        "color": "#9aa3ad", "opacity": 0.5, "flatshading": True, "hoverinfo": "skip",
    }  # fmt: skip
    return [outline, faces]


def _line(x: np.ndarray, y: np.ndarray, name: str, line: Plot) -> Plot:
    values = np.round(y, 5).tolist()
    return {
        "type": "scatter", "mode": "lines", "name": name, "x": np.round(x, 9).tolist(), "y": values, "line": line,
        "hovertemplate": "%{x:.2f} Hz: %{y:.2f}<extra>" + name + "</extra>",
    }  # fmt: skip


def _xyz(points: np.ndarray) -> Plot:
    x, y, z = points.T.tolist()
    return {"x": x, "y": y, "z": z}


def _layout(height: int) -> Plot:
    return {
        "height": height,
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "font": {"family": FONT_STACK, "size": 13, "color": BLACK},
        "margin": {"l": 64, "r": 16, "t": 10, "b": 48},
        "legend": {"orientation": "h", "y": 1.02, "yanchor": "bottom", "x": 0.0},
        "hovermode": "closest",
    }


def _axis(title: str) -> Plot:
    return {"title": {"text": title}, "gridcolor": LIGHT, "zeroline": False, "linecolor": GREY, "ticks": "outside"}
