"""What a test plan would confuse, and what one more measurement would be worth."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure
from scipy.sparse.csgraph import connected_components

from cdpr_struct.reports.figures.style import BLACK, BLUE, LIGHT, quiet

NAMED = 3.0  # nats: a factor of 20 in probability
GAINS_SHOWN = 20
_CELL = (0.8, 0.32)  # of the matrix, at most so wide and so high [inch]
_MOST_WIDE = 0.625  # of the figure: all cells together


def confused_causes(result: Mapping[str, Any]) -> list[str]:
    """Causes of all pairs; those that are confused with each other, directly or by way of others, stand together."""
    names = list(dict.fromkeys(name for pair in result["confusable"] for name in pair))
    index = {name: i for i, name in enumerate(names)}
    joined = np.zeros((len(names), len(names)))
    for cause, rival in result["confusable"]:
        joined[index[cause], index[rival]] = 1.0
    _, group = connected_components(joined, directed=False)
    return [names[i] for i in np.argsort(group, kind="stable")]


def confusion_size(result: Mapping[str, Any]) -> tuple[float, float]:
    """Size of the matrix [inch]."""
    return 9.6, 1.5 + _CELL[1] * len(confused_causes(result))


def draw_confusions(figure: Figure, result: Mapping[str, Any]) -> None:
    """Matrix of the pairs: a true cause along each row, what it would be taken for along the columns."""
    names = confused_causes(result)
    index = {name: i for i, name in enumerate(names)}
    nats = np.full((len(names), len(names)), np.nan)
    for (cause, rival), value in zip(result["confusable"], result["confusable_nats"], strict=True):
        nats[index[cause], index[rival]] = value
    axes = figure.subplots()
    axes.set_facecolor("white")
    colours = ListedColormap(colormaps["YlOrRd_r"](np.linspace(0.15, 0.95, 256)))
    image = axes.pcolormesh(np.ma.masked_invalid(nats), norm=Normalize(0.0, NAMED), cmap=colours)
    for row, column in zip(*np.nonzero(np.isfinite(nats)), strict=True):
        dark = nats[row, column] < 0.25 * NAMED
        axes.text(
            column + 0.5, row + 0.5, f"{nats[row, column]:.1f}", ha="center", va="center", fontsize=7.5,
            color="white" if dark else BLACK,
        )  # fmt: skip
    _lattice(figure, names)
    height = _CELL[1] * len(names)
    axes.set_box_aspect(height / min(_CELL[0] * len(names), _MOST_WIDE * float(figure.get_figwidth())))
    bar = figure.colorbar(image, ax=axes, shrink=min(1.0, 2.2 / height))
    bar.ax.set_title("[nats]", fontsize=8, fontweight="normal", loc="left")
    bar.outline.set_visible(False)


def _lattice(figure: Figure, names: Sequence[str]) -> None:
    (axes,) = figure.axes
    count, shown = len(names), [name.replace("_", " ") for name in names]
    for i in range(count):
        axes.fill([i, i + 1, i + 1, i], [i, i, i + 1, i + 1], color=LIGHT, linewidth=0)
    axes.set_xticks(np.arange(count) + 0.5, shown, rotation=40, ha="left", rotation_mode="anchor")
    axes.set_yticks(np.arange(count) + 0.5, shown)
    axes.xaxis.tick_top()
    axes.xaxis.set_label_position("top")
    axes.tick_params(length=0)
    axes.set_xticks(np.arange(count + 1), minor=True)
    axes.set_yticks(np.arange(count + 1), minor=True)
    axes.grid(False)
    axes.grid(True, which="minor", color=LIGHT, linewidth=0.6)
    axes.tick_params(which="minor", length=0)
    axes.set_ylim(count, 0)
    axes.set_xlim(0, count)
    axes.set_xlabel("would be taken for")
    axes.set_ylabel("true cause")
    for spine in axes.spines.values():
        spine.set_visible(False)


def confusion_caption(result: Mapping[str, Any]) -> str:
    """What to see in the figure."""
    pairs = zip(result["confusable_nats"], result["confusable"], strict=True)
    worst, (cause, rival) = min(pairs, key=lambda p: p[0])
    return (
        "Expected log evidence for the true cause (row) against another one (column), at twice the smallest detectable "
        f"size. Dark: the data hardly distinguish the two. Below {NAMED:g} nats, a factor of 20 in probability, the "
        "verdict is a class of causes; empty cells are at or above this value. Worst: "
        f"{cause.replace('_', ' ')} taken for {rival.replace('_', ' ')}, {worst:.2g} nats."
    )


def gain_size(result: Mapping[str, Any]) -> tuple[float, float]:
    """Size of the bars [inch]."""
    return 9.6, 1.0 + 0.27 * max(min(len(result["next"]), GAINS_SHOWN), 2)


def draw_gains(figure: Figure, result: Mapping[str, Any]) -> None:
    """A bar a measurement, best on top, with the number of pairs that it helps to tell apart."""
    axes = figure.subplots()
    shown = result["next"][:GAINS_SHOWN]
    nats = [row["gain_nats"] for row in shown]
    place = np.arange(len(shown))
    axes.barh(place, nats, color=BLUE, height=0.66)
    for y, (value, row) in enumerate(zip(nats, shown, strict=True)):
        count = len(row["separates"])
        text = f"{value:.1f}" + (f" ({count} pair{'s' if count > 1 else ''})" if count else "")
        axes.annotate(text, (value, y), (4, 0), textcoords="offset points", va="center", fontsize=8, color=BLACK)
    axes.set_yticks(place, [row["measurement"] for row in shown])
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.set_xlim(0.0, 1.18 * max(nats))
    axes.set_xlabel("expected gain [nats]")
    quiet(axes, "x")


def gain_caption(result: Mapping[str, Any]) -> str:
    """What to see in the figure."""
    best, hidden = result["next"][0], len(result["next"]) - GAINS_SHOWN
    more = f" {hidden} measurements with a smaller gain are in next.csv." if hidden > 0 else ""
    return (
        "Expected gain of log evidence from one more measurement, summed over all confused pairs, at most 5 nats each. "
        "In brackets: the number of pairs that gain. "
        f"Best: {best['measurement']}, {best['gain_nats']:.1f} nats.{more}"
    )
