"""One cause in every kind of reading, as seven small pictures side by side."""

import numpy as np
from compact import compact
from locked import Answer
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from typical import SHOWN, Effect

from cdpr_struct.reports.figures.style import BLUE, GREY, VERMILLION, plain_ticks, svg

SIZE = (9.6, 3.3)
_LEAST = {"tension": 2.0, "balance": 2.0, "length": 0.5, "cable": 0.5, "robot": 0.5}
"""Half the smallest range of an axis: about two sigmas of good sensors, so that less looks like nothing."""
_SECONDS = 1.0


def picture(name: str, effect: Effect) -> str:
    """A cause as SVG text."""
    return compact(svg(name.replace("_", "-"), SIZE, lambda figure: draw(figure, effect)))


def draw(figure: Figure, effect: Effect) -> None:
    """Bars are real less simulated; curves show both."""
    grid = figure.add_gridspec(2, 12)
    cables = np.arange(1, 9)
    _bars(figure.add_subplot(grid[0, 0:3]), "tensions [N]", cables, effect.tension, _LEAST["tension"])
    wrench = figure.add_subplot(grid[0, 3:6])
    _bars(wrench, "wrench balance [N]", np.arange(6), effect.balance, _LEAST["balance"])
    wrench.set_xticks(range(6), ["x", "y", "z", "rx", "ry", "rz"])
    _bars(figure.add_subplot(grid[0, 6:9]), "lengths [mm]", cables, effect.length, _LEAST["length"])
    strings = figure.add_subplot(grid[0, 9:12])
    _bars(strings, "cable frequencies [%]", cables, effect.cable[:, 0], _LEAST["cable"])
    strings.plot(cables, effect.cable[:, 2], "o", color=GREY, markersize=3.0, label="mode 3")
    _within(strings, effect.cable, _LEAST["cable"])
    _modes(figure.add_subplot(grid[1, 0:4]), effect)
    _response(figure.add_subplot(grid[1, 4:8]), effect)
    _decay(figure.add_subplot(grid[1, 8:12]), effect)
    figure.suptitle(effect.size, x=0.01, ha="left", fontsize=9.0)


def _bars(axes: Axes, title: str, x: np.ndarray, values: np.ndarray, least: float) -> None:
    axes.set_title(title, fontsize=8.5, fontweight="normal")
    axes.bar(x, values, color=VERMILLION, width=0.7)
    axes.axhline(0.0, color=GREY, linewidth=0.7)
    axes.grid(visible=False, axis="x")
    axes.set_xticks(x)
    _within(axes, values, least)


def _within(axes: Axes, values: np.ndarray, least: float) -> None:
    most = 1.15 * max(least, float(np.abs(values).max(initial=0.0)))
    axes.set_ylim(-most, most)
    axes.locator_params(axis="y", nbins=5)


def _modes(axes: Axes, effect: Effect) -> None:
    axes.set_title("robot frequencies [%] over Hz", fontsize=8.5, fontweight="normal")
    axes.vlines(effect.hertz, 0.0, effect.robot, color=VERMILLION, linewidth=2.0)
    axes.plot(effect.hertz, effect.robot, "o", color=VERMILLION, markersize=3.5)
    axes.axhline(0.0, color=GREY, linewidth=0.7)
    if np.isfinite(effect.peak):
        axes.axvline(effect.peak, color=VERMILLION, linestyle="--", linewidth=1.0)
        axes.annotate(
            "one peak more", (effect.peak, 0.9), (3, 0), ("data", "axes fraction"), "offset points", fontsize=7.5
        )
    axes.set_xlim(0.0, SHOWN)
    _within(axes, effect.robot, _LEAST["robot"])


def _response(axes: Axes, effect: Effect) -> None:
    axes.set_title("FRF fz to z [(m/s²)/N] over Hz", fontsize=8.5, fontweight="normal")
    for answer, colour, width, label in _curves(effect):
        shown = answer.hertz <= SHOWN
        axes.semilogy(
            answer.hertz[shown][::2], np.abs(answer.response[shown][::2]), color=colour, linewidth=width, label=label
        )
    plain_ticks(axes.yaxis)
    axes.set_xlim(0.0, SHOWN)
    axes.legend(loc="lower right", fontsize=7.5)


def _decay(axes: Axes, effect: Effect) -> None:
    axes.set_title("decay of z [(m/s²)/(N s)] over s", fontsize=8.5, fontweight="normal")
    for answer, colour, width, _ in _curves(effect):
        time, acceleration = answer.decay
        shown = (time > 0.03) & (time < _SECONDS)
        axes.plot(time[shown], acceleration[shown], color=colour, linewidth=width)
    axes.set_xlim(0.0, _SECONDS)


def _curves(effect: Effect) -> list[tuple[Answer, str, float, str]]:
    """The simulated answer, and the real one where it differs."""
    simulated = (effect.simulated, BLUE, 1.6, "simulated")
    if np.array_equal(effect.real.response, effect.simulated.response):
        return [(*simulated[:3], "simulated = real")]
    return [simulated, (effect.real, VERMILLION, 0.9, "real")]
