"""A frequency response that can be zoomed, with the modes below it."""

import numpy as np

from cdpr_struct.dynamics.frequency_sweep import ResponseSweep
from cdpr_struct.measurement.universal_file import response_unit
from cdpr_struct.reports.figures.frf import COLOURS, thinned
from cdpr_struct.reports.figures.plot_parts import Plot, plot_axis, plot_layout, plot_line, short
from cdpr_struct.reports.figures.style import KIND_COLOURS, kind_group, plain_number
from cdpr_struct.reports.typeset import raised, typeset


def frf_plot(sweep: ResponseSweep) -> Plot:
    """Magnitude on a log scale, every mode as a tick that names itself, and the phase, on one frequency axis."""
    found = sweep.response
    units = [typeset(response_unit(port, found.excite, found.quantity)) for port in found.respond]
    curves = [
        curve
        for column, unit in enumerate(units)
        if not sweep.silent[column]
        for curve in _curves(sweep, column, unit)
    ]  # fmt: skip
    shared = units[0] if len(set(units)) == 1 else "unit in the legend"
    low, high = float(found.hertz[0]), float(found.hertz[-1])
    layout = {
        **plot_layout(620),
        "xaxis": {**plot_axis("frequency [Hz]"), "anchor": "y3", "range": [low, high]},
        "yaxis": {
            **plot_axis(f"{found.quantity} under {found.excite.name} [{shared}]"), "domain": [0.42, 1.0], "type": "log",
            **_decades(sweep),
        },
        "yaxis2": {
            **plot_axis(""), "domain": [0.33, 0.38], "range": [0.0, 1.0], "tickvals": [0.5], "ticktext": ["modes"],
            "showgrid": False, "ticks": "", "fixedrange": True,
        },
        "yaxis3": {
            **plot_axis("phase [deg]"), "domain": [0.0, 0.29], "range": [-190.0, 190.0], "dtick": 90,
            "fixedrange": True,
        },
    }  # fmt: skip
    return {"data": [*curves, *_ticks(sweep)], "layout": layout}


def _decades(sweep: ResponseSweep) -> Plot:
    """Ticks of the magnitude at powers of ten, at most eight; plotly's own would have larger letters than the rest."""
    size = np.abs(sweep.response.response)
    size = size[np.isfinite(size) & (size > 0.0)]
    if not size.size:
        return {}
    low, high = np.floor(np.log10(size.min())), np.ceil(np.log10(size.max()))
    powers = np.arange(low, high + 1.0, max(1.0, np.ceil((high - low) / 8.0)))
    return {"tickvals": (10.0**powers).tolist(), "ticktext": [_power(int(p)) for p in powers]}


def _power(exponent: int) -> str:
    """A power of ten, short enough for the margin of a phone."""
    return plain_number(10.0**exponent) if abs(exponent) < 3 else f"10{raised(str(exponent))}"


def _curves(sweep: ResponseSweep, column: int, unit: str) -> list[Plot]:
    """Magnitude and phase of one response, which its entry in the legend shows and hides together."""
    found, colour = sweep.response, COLOURS[column % len(COLOURS)]
    name = f"{found.respond[column].name} [{unit}]"
    values = found.response[:, column]
    size = np.abs(values)
    hertz, thin = thinned(found.hertz, size)
    group = {"legendgroup": name}
    magnitude = np.where(size[thin] > 0.0, size[thin], np.nan)
    upper = plot_line(hertz, magnitude, name, {"color": colour, "width": 1.5}, "%{x:.4g} Hz: %{y:.3g}")
    phase = np.degrees(np.angle(values[thin]))
    lower = plot_line(hertz, phase, name, {"color": colour, "width": 1.2}, "%{x:.4g} Hz: %{y:.0f}°")
    return [upper | group, lower | group | {"yaxis": "y3", "showlegend": False}]


def _ticks(sweep: ResponseSweep) -> list[Plot]:
    modes = sweep.modes
    groups = [kind_group(kind) for kind in modes.kinds]
    ticks = []
    for name, colour in KIND_COLOURS.items():
        own = [i for i, group in enumerate(groups) if group == name]
        if own:
            ticks.append(
                {
                    "type": "scatter", "mode": "markers", "name": f"{name} modes", "yaxis": "y2",
                    "x": short(modes.hertz[own]), "y": [0.5] * len(own),
                    "text": [f"mode {i + 1} ({modes.kinds[i]}): {modes.hertz[i]:.4f} Hz" for i in own],
                    "hovertemplate": "%{text}<extra></extra>",
                    "marker": {"symbol": "line-ns", "size": 20, "line": {"color": colour, "width": 1.6}},
                }
            )  # fmt: skip
    return ticks
