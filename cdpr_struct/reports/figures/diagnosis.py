"""Residuals before and after, and the evidence for each candidate."""

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.diagnosis.simulation_error import rows_read
from cdpr_struct.reports.diagnosis_tables import figure as shown
from cdpr_struct.reports.diagnosis_tables import hypotheses
from cdpr_struct.reports.figures.style import BLUE, GREY, LIGHT, ORANGE, plain_number, quiet

RESIDUAL_SIZE, EVIDENCE_SIZE, MEASURED_SIZE = (9.6, 4.2), (9.6, 3.2), (9.6, 3.2)

_BARS, _MOST_NAMES, _LETTERS = 10, 30, 18
_NARROW = 0.3  # of the width: two blocks together on which their names would touch
_TENS = tuple(10.0**n for n in range(1, 16))
_TICKS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, *_TENS[1:])
_WORDS = {
    "EQ": "wrench balance",
    "CO": "lengths",
    "NS": "internal force",
    "LP": "locked poses",
    "CF": "cable frequencies",
    "RF": "robot frequencies",
    "FA": "modal constants",
}


def draw_residuals(figure: Figure, found: Diagnosis) -> None:
    """Each residual that holds a reading, in its own sigma, as entered and with the causes found, block by block."""
    axes = figure.subplots()
    labels, null = found.entered_setting.labels, found.entered
    sigma = np.sqrt(np.diagonal(null.covariance))
    order = np.argsort([list(_WORDS).index(b) for b in labels.block], kind="stable")
    order = order[rows_read(found)[order]]
    place = np.arange(len(order))
    axes.axhspan(-2.0, 2.0, color="#f4f7f5", linewidth=0)
    axes.plot(place, (null.r / sigma)[order], ".", color=ORANGE, markersize=7, label="as entered")
    fit = found.selection.fit
    if fit is not None:
        after = fit.left / np.sqrt(np.diagonal(fit.ground.null.covariance))
        mended = after[order] if len(after) == len(null.r) else after
        axes.plot(np.arange(len(mended)), mended, ".", color=BLUE, markersize=4, label="with causes")
    _name_blocks(axes, labels.block[order])
    _name_states(axes, labels.block[order], [found.campaign.states.names[i] for i in labels.state[order]])
    _plain_sigmas(axes, [(null.r / sigma)[order], *([] if fit is None else [mended])])
    axes.set_ylabel("residual / its sigma [-]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper right", ncols=2)
    quiet(axes)


def _name_blocks(axes: Axes, blocks: np.ndarray) -> None:
    """Lines between blocks of residuals, their names below, on two levels where narrow ones follow each other."""
    place = np.arange(len(blocks))
    for edge in np.flatnonzero(blocks[1:] != blocks[:-1]) + 0.5:
        axes.axvline(edge, color=GREY, linewidth=0.6)
    present = [b for b in _WORDS if (blocks == b).any()]
    share = [float((blocks == b).mean()) for b in present]
    low = [False]
    for left, right in pairwise(share):
        low.append(left + right < _NARROW and not low[-1])
    words = ["\n" * below + _WORDS[b] for below, b in zip(low, present, strict=True)]
    axes.set_xticks([float(place[blocks == b].mean()) for b in present], words)
    axes.tick_params(axis="x", length=0)


def _name_states(axes: Axes, blocks: np.ndarray, names: list[str]) -> None:
    """Faint lines between the states of a block, their names above, upright where they would not fit side by side."""
    starts = [i for i in range(len(names)) if i == 0 or names[i] != names[i - 1] or blocks[i] != blocks[i - 1]]
    ends = [*starts[1:], len(names)]
    for start in starts[1:]:
        axes.axvline(start - 0.5, color=LIGHT, linewidth=0.6, zorder=0)
    if len(starts) > _MOST_NAMES:
        return
    room = 100.0 / len(names)  # letters that fit over one residual
    level = all(len(names[a]) < room * (b - a) for a, b in zip(starts, ends, strict=True))
    for start, end in zip(starts, ends, strict=True):
        axes.text(
            0.5 * (start + end - 1), 1.01, _short(names[start]), transform=axes.get_xaxis_transform(), fontsize=7.0,
            color=GREY, ha="center", va="bottom", rotation=0.0 if level else 90.0,
        )  # fmt: skip


def _short(name: str) -> str:
    return name if len(name) <= _LETTERS else f"{name[: _LETTERS - 1]}…"


def _plain_sigmas(axes: Axes, values: list[np.ndarray]) -> None:
    """A vertical axis that is even up to three sigmas and logarithmic beyond, with plain numbers on both sides."""
    most = 1.1 * max(float(np.abs(v).max()) for v in values)
    top = next((t for t in _TICKS if t >= max(most, 5.0)), most)
    ticks = [t for t in _TICKS if t <= top]
    if len(ticks) > 7:
        tens = [t for t in ticks if t in _TENS]
        ticks = [2.0, *tens[:: max(1, len(tens) // 5)]]
    axes.set_yscale("symlog", linthresh=3.0, linscale=1.0)
    axes.set_ylim(-1.04 * top, 1.04 * top)
    axes.set_xlim(-0.7, len(values[0]) - 0.3)
    both = [-t for t in ticks[::-1]] + [0.0] + ticks
    axes.set_yticks(both, [plain_number(t) for t in both])
    axes.yaxis.set_minor_locator(NullLocator())


def draw_evidence(figure: Figure, result: Mapping[str, Any]) -> None:
    """Log evidence of every cause that was fitted, against nothing being wrong."""
    axes = figure.subplots()
    rows = hypotheses(result["candidates"])[:_BARS][::-1]
    bars = axes.barh([_plain(h.name) for h in rows], [max(h.gain, 0.0) for h in rows], color=BLUE)
    axes.bar_label(bars, [f" {shown(h.gain)}" for h in rows], fontsize=8.5, padding=3)
    axes.axvline(5.0, color=GREY, linewidth=0.9, linestyle="--")
    axes.set_xlabel("log evidence against nothing being wrong [nats]; dashed: needed to be named")
    quiet(axes, "x")


def _plain(name: str) -> str:
    return name.replace("_", " ")
