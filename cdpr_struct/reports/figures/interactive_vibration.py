"""A vibration over time and its spectrogram, which zoom together."""

from cdpr_struct.dynamics.frequency_sweep import ModesInBand
from cdpr_struct.reports.figures.plot_parts import Plot, colour_bar, plot_axis, plot_layout, plot_line, short
from cdpr_struct.reports.figures.spectrogram import COLOURS, DECADES, DENSITY_LABEL, Vibration
from cdpr_struct.reports.figures.style import KIND_COLOURS, kind_group

_MOST_CELLS = 60_000


def vibration_plot(shown: Vibration) -> Plot:
    """Acceleration over time; below it the spectrogram, and beside it every mode with its number."""
    time, stride, highest_hertz = shown.time, shown.stride, shown.highest_hertz
    curves = [
        plot_line(
            time[::stride], shown.acceleration[::stride, i], name, {"color": COLOURS[i % len(COLOURS)], "width": 1.2},
            "%{x:.3f} s: %{y:.3g} m/s²",
        )
        | {"yaxis": "y2"}
        for i, name in enumerate(shown.names)
    ]  # fmt: skip
    layout = {
        **plot_layout(640),
        "xaxis": {**plot_axis("time [s]"), "domain": [0.0, 0.93], "range": [float(time[0]), float(time[-1])]},
        "yaxis": {**plot_axis("frequency [Hz]"), "domain": [0.0, 0.62], "range": [0.0, highest_hertz]},
        "yaxis2": {**plot_axis("acceleration [m/s²]"), "domain": [0.7, 1.0], "fixedrange": True},
        "xaxis2": {
            "domain": [0.94, 1.0], "range": [0.0, 1.0], "anchor": "y", "showticklabels": False, "showgrid": False,
            "zeroline": False, "fixedrange": True, "title": {"text": "modes", "font": {"size": 13}},
        },
    }  # fmt: skip
    return {"data": [*curves, _heat(shown), *_marks(shown.modes, highest_hertz)], "layout": layout}


def _heat(shown: Vibration) -> Plot:
    spectrum, level = shown.spectrum, shown.level
    hertz = spectrum.hertz[spectrum.hertz <= shown.highest_hertz]
    step = max(1, -(-len(spectrum.time) * len(hertz) // _MOST_CELLS))
    return {
        "type": "heatmap", "name": "", "x": short(spectrum.time[::step]), "y": short(hertz),
        "z": [[round(v, 2) for v in row] for row in level[:, ::step].tolist()], "colorscale": "Viridis",
        "zmin": float(level.max()) - DECADES, "zmax": float(level.max()),
        "colorbar": {**colour_bar(DENSITY_LABEL), "len": 0.65, "y": 0.31},
        "hovertemplate": "%{x:.3f} s, %{y:.3f} Hz: 10^%{z:.2f} (m/s²)²/Hz<extra></extra>",
    }  # fmt: skip


def _marks(modes: ModesInBand, highest_hertz: float) -> list[Plot]:
    groups = [kind_group(kind) for kind in modes.kinds]
    marks = []
    for name, colour in KIND_COLOURS.items():
        own = [i for i, group in enumerate(groups) if group == name and modes.hertz[i] <= highest_hertz]
        if own:
            marks.append(
                {
                    "type": "scatter", "mode": "markers", "name": f"{name} modes", "xaxis": "x2",
                    "x": [0.5] * len(own), "y": short(modes.hertz[own]),
                    "text": [f"mode {i + 1} ({modes.kinds[i]}): {modes.hertz[i]:.4f} Hz" for i in own],
                    "hovertemplate": "%{text}<extra></extra>",
                    "marker": {"symbol": "line-ew", "size": 22, "line": {"color": colour, "width": 1.6}},
                }
            )  # fmt: skip
    return marks
