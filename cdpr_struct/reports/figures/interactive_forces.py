"""Forces of all cables along a trajectory, in one plot that can be zoomed."""

from collections.abc import Sequence

from cdpr_struct.dynamics.trajectory_distribution import TrajectoryDistribution
from cdpr_struct.reports.figures.distribution import CABLE_COLOURS, thinned
from cdpr_struct.reports.figures.plot_parts import Plot, plot_axis, plot_layout, plot_line

_DASHES = ("solid", "dash", "dot", "dashdot")


def forces_plot(found: Sequence[TrajectoryDistribution]) -> Plot:
    """A curve a cable under the bound that was asked for, which its entry in the legend hides; its bound in grey."""
    first = found[0]
    time = thinned(first.trajectory.time)
    curves = []
    for i, (force, lower) in enumerate(zip(first.distribution.tensions.T, first.distribution.lower.T, strict=True)):
        name, turn = f"cable {i + 1}", i // len(CABLE_COLOURS) % len(_DASHES)
        line = {"color": CABLE_COLOURS[i % len(CABLE_COLOURS)], "width": 1.8, "dash": _DASHES[turn]}
        bound = {**line, "width": 1.0, "dash": "dot"}
        group = {"legendgroup": name}
        curves.append(plot_line(time, thinned(force), name, line, "%{x:.2f} s: %{y:.0f} N") | group)
        least = plot_line(time, thinned(lower), f"{name}, lower bound", bound, "%{x:.2f} s: %{y:.0f} N")
        curves.append(least | group | {"showlegend": False, "opacity": 0.6})
    layout = {
        **plot_layout(480),
        "xaxis": plot_axis("time [s]"),
        "yaxis": {**plot_axis("cable force at the platform [N]"), "rangemode": "tozero"},
    }
    return {"data": curves, "layout": layout}
