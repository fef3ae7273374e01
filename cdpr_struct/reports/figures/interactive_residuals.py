"""Residuals of a diagnosis that name themselves."""

from collections.abc import Mapping
from html import escape
from itertools import pairwise
from typing import Any

import numpy as np

from cdpr_struct.reports.figures.plot_parts import Plot, plot_axis, plot_layout, short
from cdpr_struct.reports.figures.style import BLUE, GREY, ORANGE, plain_number

_EVEN = 3.0  # sigmas up to which the axis is even; logarithmic beyond
_TICKS = (0.0, 1.0, 2.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1e3, 1e4, 1e5, 1e6)
_BAND = "#009e73"


def residuals_plot(columns: Mapping[str, Any], names: Mapping[str, str]) -> Plot:
    """Each residual in its own sigma, as entered and with the causes.

    columns : as the table of residuals has them
    names   : of each kind of rows, in the order in which they are shown
    """
    kinds = np.asarray(columns["block"])
    order = np.argsort([list(names).index(kind) for kind in kinds], kind="stable")
    before = (np.asarray(columns["residual"]) / np.asarray(columns["sigma"]))[order]
    after = (np.asarray(columns["with_causes"]) / np.asarray(columns["sigma"]))[order]
    said = [_said(columns, i, names) for i in order.tolist()]
    series = [_points(before, said, "as entered", ORANGE, 8)]
    if np.isfinite(after).any() and not np.allclose(after, before, equal_nan=True):
        series.append(_points(after, said, "with causes", BLUE, 6))
    top = max(float(np.nanmax(np.abs(v))) for v in (before, after, np.array([5.0])) if np.isfinite(v).any())
    ticks = [t for t in _TICKS if t <= 1.1 * top]
    both = [-t for t in ticks[:0:-1]] + ticks
    edges = np.flatnonzero(kinds[order][1:] != kinds[order][:-1]) + 0.5
    layout = {
        **plot_layout(460),
        "xaxis": {**plot_axis("number of the residual [-]"), "showgrid": False, "range": [-1.0, len(before)]},
        "yaxis": {
            **plot_axis("residual / its sigma [-]"), "tickvals": short(_bent(np.array(both))),
            "ticktext": [plain_number(t) for t in both], "range": [-1.05 * float(_bent(top)), 1.05 * float(_bent(top))],
        },
        "shapes": [_band(), *(_edge(float(edge)) for edge in edges)],
        "annotations": _headings(kinds[order], edges, names),
    }  # fmt: skip
    return {"data": series, "layout": layout}


def _bent(value: np.ndarray | float) -> np.ndarray:
    """Place on the axis: even near zero, logarithmic beyond, with equal slope where they meet."""
    size = np.abs(value)
    far = _EVEN * (1.0 + np.log(np.maximum(size, _EVEN) / _EVEN))
    return np.sign(value) * np.where(size <= _EVEN, size, far)


def _points(values: np.ndarray, said: list[str], name: str, colour: str, size: int) -> Plot:
    return {
        "type": "scatter", "mode": "markers", "name": name, "x": list(range(len(values))), "y": short(_bent(values)),
        "text": [f"{text}<br>{name}: {value:+.3g} sigma" for text, value in zip(said, values.tolist(), strict=True)],
        "hovertemplate": "%{text}<extra></extra>", "marker": {"color": colour, "size": size},
    }  # fmt: skip


def _said(columns: Mapping[str, Any], i: int, names: Mapping[str, str]) -> str:
    cable = f", cable {columns['cable'][i]}" if columns["cable"][i] != "" else ""
    unit = columns["unit"][i]
    return (
        f"{names[columns['block'][i]]}, state {escape(str(columns['case'][i]))}{cable}, row {columns['row'][i]}"
        f"<br>{columns['residual'][i]:+.4g} {unit}, with causes {columns['with_causes'][i]:+.4g} {unit}"
        f" (sigma {columns['sigma'][i]:.3g})"
    )


def _band() -> Plot:
    return {
        "type": "rect", "x0": 0.0, "x1": 1.0, "xref": "paper", "y0": -2.0, "y1": 2.0, "fillcolor": _BAND,
        "opacity": 0.08, "layer": "below", "line": {"width": 0},
    }  # fmt: skip


def _edge(place: float) -> Plot:
    return {
        "type": "line", "x0": place, "x1": place, "y0": 0.0, "y1": 1.0, "yref": "paper",
        "line": {"color": GREY, "width": 1},
    }  # fmt: skip


def _headings(kinds: np.ndarray, edges: np.ndarray, names: Mapping[str, str]) -> list[Plot]:
    """Name of each kind of rows above its points; upright over narrow blocks."""
    ends = [-0.5, *edges.tolist(), len(kinds) - 0.5]
    return [
        {
            "x": 0.5 * (low + high), "y": 0.0, "yref": "paper", "yanchor": "bottom", "showarrow": False,
            "text": names[kinds[int(low + 0.5)]], "textangle": 0 if high - low > 0.18 * len(kinds) else -90,
            "font": {"size": 12},
        }
        for low, high in pairwise(ends)
    ]  # fmt: skip
