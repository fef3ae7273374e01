"""Eigenfrequencies of a robot at rest: which are the platform's, how close they lie, and the tensions behind them."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cdpr_struct.reports.figures.mode_stacks import stack_levels
from cdpr_struct.reports.figures.style import BLACK, GREY, KIND_COLOURS, KIND_MARKERS, kind_group, quiet

SIZE = (9.6, 5.4)
STACKS_ACROSS = 70
"""Columns that the frequency axis has for stacked marks."""
_NAMED = 0.1  # share of the platform from which on a stem carries its frequency
_APART = 0.035  # of the axis: labels nearer than that would overlap


def draw_ladder(figure: Figure, result: Mapping[str, Any]) -> None:
    """Stems of the platform's share over frequency; below, every mode as a mark; beside, the cables' tensions."""
    left, right = figure.subplots(1, 2, width_ratios=[3.4, 1.0], squeeze=False)[0]
    space = left.get_subplotspec().subgridspec(2, 1, height_ratios=[2.2, 1.0], hspace=0.04)
    left.remove()
    upper = figure.add_subplot(space[0])
    lower = figure.add_subplot(space[1], sharex=upper)
    hertz = np.asarray(result["frequencies_hz"], dtype=float)
    groups = np.array([kind_group(kind) for kind in result["kinds"]])
    low, high = frequency_range(hertz)
    upper.set_xlim(low, high)
    _stems(upper, hertz, 100.0 * np.asarray(result["platform_energy"], dtype=float), groups)
    _stacks(lower, hertz, groups, (high - low) / STACKS_ACROSS)
    if "bands" in result:
        _bands(lower, np.asarray(result["bands"]["frequencies_hz"], dtype=float), hertz, (high - low) / STACKS_ACROSS)
    _tensions(right, np.asarray(result["tensions_N"], dtype=float))
    figure.legend(*upper.get_legend_handles_labels(), loc="outside lower left", ncols=3)


def frequency_range(hertz: np.ndarray) -> tuple[float, float]:
    """Ends of the frequency axis [Hz]: all modes, with a margin also around a single one."""
    low, high = float(hertz.min()), float(hertz.max())
    margin = max(0.04 * (high - low), 0.02 * high)
    return max(low - margin, 0.0), high + margin


def _stems(axes: Axes, hertz: np.ndarray, share: np.ndarray, groups: np.ndarray) -> None:
    for name, colour in KIND_COLOURS.items():
        mine = groups == name
        if mine.any():
            axes.vlines(hertz[mine], 0.0, share[mine], color=colour, linewidth=1.4)
            label = f"{name} modes ({int(mine.sum())})"
            axes.plot(
                hertz[mine], share[mine], KIND_MARKERS[name], color=colour, markersize=5, label=label, clip_on=False
            )
    for index in _labelled(hertz, share, axes.get_xlim()):
        axes.annotate(
            f"{hertz[index]:.2f}", (hertz[index], share[index]), (0, 6), textcoords="offset points", ha="center",
            fontsize=7.5, color=BLACK,
        )  # fmt: skip
    axes.set_ylim(0.0, 112.0)
    axes.set_yticks([0, 25, 50, 75, 100])
    axes.set_ylabel("platform's share of the\nkinetic energy [%]")
    axes.tick_params(labelbottom=False)
    quiet(axes)


def _labelled(hertz: np.ndarray, share: np.ndarray, ends: tuple[float, float]) -> list[int]:
    """Stems that carry their frequency: the highest first, and none where a label stands already."""
    width, chosen = _APART * (ends[1] - ends[0]), list[int]()
    for index in np.argsort(-share, kind="stable").tolist():
        near = [i for i in chosen if abs(hertz[i] - hertz[index]) < width]
        if share[index] >= 100.0 * _NAMED and all(abs(share[i] - share[index]) > 8.0 for i in near):
            chosen.append(index)
    return chosen


def _stacks(axes: Axes, hertz: np.ndarray, groups: np.ndarray, width: float) -> None:
    level = stack_levels(hertz, width)
    size = float(np.clip(60.0 / level.max(), 2.5, 6.0))
    for name, colour in KIND_COLOURS.items():
        mine = groups == name
        axes.plot(hertz[mine], level[mine], KIND_MARKERS[name], color=colour, markersize=size, markeredgewidth=0.0)
    axes.set_ylim(0.0, max(level.max(), 4) + 1.0)
    axes.yaxis.set_major_locator(MaxNLocator(4, integer=True))
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("modes [count]")
    quiet(axes)


def _bands(axes: Axes, ends: np.ndarray, hertz: np.ndarray, width: float) -> None:
    """Bars from end to end of each mode's band, at the height of its mark."""
    axes.hlines(stack_levels(hertz, width), ends[:, 0], ends[:, 1], color=GREY, linewidth=1.0, zorder=0.5)


def _tensions(axes: Axes, tension: np.ndarray) -> None:
    number = np.arange(1, len(tension) + 1)
    axes.barh(number, tension, color=GREY, height=0.7)
    for cable, value in zip(number.tolist(), tension.tolist(), strict=True):
        axes.annotate(f"{value:.3g}", (value, cable), (3, 0), textcoords="offset points", va="center", fontsize=7.5)
    axes.set_yticks(number if len(number) <= 16 else number[:: len(number) // 8])
    axes.set_ylim(len(tension) + 0.6, 0.4)
    axes.set_xlim(0.0, 1.22 * max(float(tension.max()), 1e-12))
    axes.xaxis.set_major_locator(MaxNLocator(3))
    axes.set_xlabel("tension at the platform [N]")
    axes.set_ylabel("cable number [-]")
    quiet(axes, "x")


def ladder_caption(result: Mapping[str, Any]) -> str:
    """What to see in the figure."""
    hertz = np.asarray(result["frequencies_hz"], dtype=float)
    low, high = frequency_range(hertz)
    apart = (high - low) / STACKS_ACROSS
    crowd = int(stack_levels(hertz, apart).max())
    crowded = (
        f"up to {crowd} lie within {apart:.2g} Hz of each other, too close for a short record to separate"
        if crowd > 1
        else f"no two lie within {apart:.2g} Hz"
    )
    return (
        "Above: every mode at its frequency, as high as the platform's share of the kinetic energy. High stems are the "
        "modes that a sensor on the platform sees and a payload changes; in those at the bottom cables vibrate alone. "
        f"Below: the same modes, stacked where they are close; {crowded}.{_of_bands(result)} Bars: the tensions at "
        "rest, on which the frequencies of the cables depend."
    )


def _of_bands(result: Mapping[str, Any]) -> str:
    bands = result.get("bands")
    return f" Grey lines: the {bands['level']:g} % band of each mode." if bands else ""
