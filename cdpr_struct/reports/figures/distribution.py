"""Cable forces along a trajectory: lower bounds, forces, energy (thesis figs 5.4 to 5.6), and cable frequencies."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.dynamics.trajectory_distribution import TrajectoryDistribution
from cdpr_struct.reports.figures.panels import label_ends
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION, plain_ticks, quiet

PANEL_WIDTH, PANEL_HEIGHT = 2.4, 1.75
ENERGY_SIZE = (9.6, 4.0)
LOOKS: dict[str, dict[str, Any]] = {
    "fixed": {"color": BLUE, "linestyle": "-", "label": "fixed (5.16)"},
    "pose-dependent": {"color": VERMILLION, "linestyle": (0, (4, 2)), "label": "pose-dependent (5.15)"},
    "frequency": {"color": GREEN, "linestyle": (0, (1.5, 1.2)), "label": "frequency"},
}
CABLE_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK)
_COLUMNS = 4
_POINTS = 600


def panels_size(found: Sequence[TrajectoryDistribution]) -> tuple[float, float]:
    """Size of a figure with a panel per cable [inch]."""
    rows = -(-len(found[0].max_force) // _COLUMNS)
    return _COLUMNS * PANEL_WIDTH, rows * PANEL_HEIGHT + 0.7


def draw_bounds(figure: Figure, found: Sequence[TrajectoryDistribution]) -> None:
    """Lower bound of each cable over time (fig. 5.4)."""
    _panels(figure, found, "lower bound [N]", lambda f: f.distribution.lower)


def draw_forces(figure: Figure, found: Sequence[TrajectoryDistribution]) -> None:
    """Force of each cable over time (fig. 5.5)."""
    _panels(figure, found, "cable force [N]", lambda f: f.distribution.tensions)


def draw_together(figure: Figure, found: TrajectoryDistribution) -> None:
    """Forces of all cables over time, in one plot."""
    axes = figure.subplots()
    time, forces = thinned(found.trajectory.time), found.distribution.tensions
    for i, force in enumerate(forces.T):
        style = "-" if i < len(CABLE_COLOURS) else (0, (4, 2))
        axes.plot(time, thinned(force), color=CABLE_COLOURS[i % len(CABLE_COLOURS)], linestyle=style, label=f"{i + 1}")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("cable force at the platform [N]")
    axes.margins(x=0.0)
    quiet(axes)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside right upper", title="cable")


def draw_frequencies(figure: Figure, found: Sequence[TrajectoryDistribution]) -> None:
    """Lowest frequency of each cable over time against the wanted one, as a share of it."""
    axes = _panels(figure, found, "frequency / b [-]", lambda f: f.frequency / f.b)
    shares = np.concatenate([(f.frequency / f.b).ravel() for f in found])
    for panel in axes:
        panel.axhline(1.0, color=BLACK, linewidth=0.9)
        panel.set_yscale("log")
        panel.set_ylim(min(0.8, 0.9 * float(shares.min())), max(2.0, 1.1 * float(shares.max())))
        plain_ticks(panel.yaxis)


def draw_energy(figure: Figure, found: Sequence[TrajectoryDistribution]) -> None:
    """Energy spent up to each instant (fig. 5.6)."""
    axes = figure.subplots()
    for f in found:
        axes.plot(thinned(f.trajectory.time), thinned(f.work.spent) / 1000.0, linewidth=1.8, **LOOKS[f.rule])
    for height, f in _apart([(f.work.total / 1000.0, f) for f in found]):
        axes.annotate(
            f"{f.work.total / 1000.0:.1f} kJ", (f.trajectory.time[-1], height), (5, 0), textcoords="offset points",
            va="center", color=LOOKS[f.rule]["color"],
        )  # fmt: skip
    axes.set_xlabel("time [s]")
    axes.set_ylabel("energy spent [kJ]")
    axes.margins(x=0.0)
    axes.set_ylim(bottom=0.0)
    quiet(axes)
    axes.legend(loc="upper left")


def _panels(
    figure: Figure,
    found: Sequence[TrajectoryDistribution],
    label: str,
    values: Callable[[TrajectoryDistribution], np.ndarray],
) -> list[Axes]:
    cables = len(found[0].max_force)
    rows = -(-cables // _COLUMNS)
    grid = figure.subplots(rows, _COLUMNS, sharex=True, sharey=True, squeeze=False)
    for empty in grid.ravel()[cables:]:
        empty.remove()
    axes = list(grid.ravel()[:cables])
    for i, panel in enumerate(axes):
        for f in found:
            panel.plot(thinned(f.trajectory.time), thinned(values(f)[:, i]), linewidth=1.4, **LOOKS[f.rule])
        panel.set_title(f"cable {i + 1}")
        panel.margins(x=0.0)
        quiet(panel)
    label_ends(axes, label, "time [s]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return axes


def _apart(labels: list[tuple[float, TrajectoryDistribution]]) -> list[tuple[float, TrajectoryDistribution]]:
    """Labels at heights moved up so far that they do not overlap."""
    ordered = sorted(labels, key=lambda label: label[0])
    gap = 0.05 * ordered[-1][0]
    placed: list[tuple[float, TrajectoryDistribution]] = []
    for height, f in ordered:
        placed.append((max(height, placed[-1][0] + gap) if placed else height, f))
    return placed


def thinned(values: np.ndarray) -> np.ndarray:
    """At most about 600 of the values, the last included: more do not show."""
    index = np.unique(np.linspace(0, len(values) - 1, min(len(values), _POINTS)).round().astype(int))
    return values[index]
