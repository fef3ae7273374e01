"""Residuals before and after, and the evidence for each candidate."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.reports.diagnosis_tables import figure as shown
from cdpr_struct.reports.diagnosis_tables import hypotheses
from cdpr_struct.reports.figures.style import BLUE, GREY, ORANGE, quiet

RESIDUAL_SIZE, EVIDENCE_SIZE, MEASURED_SIZE = (9.6, 3.6), (9.6, 3.2), (9.6, 3.2)

_BARS = 10
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
    """Each residual in its own sigma, as entered and with the causes found, block by block."""
    axes = figure.subplots()
    labels, null = found.entered_setting.labels, found.entered
    sigma = np.sqrt(np.diagonal(null.covariance))
    order = np.argsort([list(_WORDS).index(b) for b in labels.block], kind="stable")
    place = np.arange(len(order))
    axes.axhspan(-2.0, 2.0, color="#f4f7f5", linewidth=0)
    axes.plot(place, (null.r / sigma)[order], ".", color=ORANGE, markersize=4, label="as entered")
    fit = found.selection.fit
    if fit is not None:
        after = fit.ground.null.lower @ fit.white / np.sqrt(np.diagonal(fit.ground.null.covariance))
        axes.plot(
            place[: len(after)],
            after[order] if len(after) == len(order) else after,
            ".",
            color=BLUE,
            markersize=4,
            label="with causes",
        )
    _name_blocks(axes, labels.block[order])
    axes.set_yscale("symlog", linthresh=3.0)
    axes.set_ylabel("residual / its sigma [-]")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2)
    quiet(axes)


def _name_blocks(axes: Axes, blocks: np.ndarray) -> None:
    """Lines between blocks of residuals, their names below."""
    place = np.arange(len(blocks))
    for edge in np.flatnonzero(blocks[1:] != blocks[:-1]) + 0.5:
        axes.axvline(edge, color=GREY, linewidth=0.6)
    present = [b for b in _WORDS if (blocks == b).any()]
    axes.set_xticks([float(place[blocks == b].mean()) for b in present], [_WORDS[b] for b in present])
    axes.tick_params(axis="x", length=0)


def draw_evidence(figure: Figure, result: Mapping[str, Any]) -> None:
    """Log evidence of every cause that was fitted, against nothing being wrong."""
    axes = figure.subplots()
    rows = hypotheses(result["candidates"])[:_BARS][::-1]
    if rows:
        bars = axes.barh([_plain(h.name) for h in rows], [max(h.gain, 0.0) for h in rows], color=BLUE)
        axes.bar_label(bars, [f" {shown(h.gain)}" for h in rows], fontsize=8.5)
    axes.axvline(5.0, color=GREY, linewidth=0.9, linestyle="--")
    axes.set_xlabel("log evidence against nothing being wrong [nats]; dashed: needed to be named")
    quiet(axes, "x")


def _plain(name: str) -> str:
    return name.replace("_", " ")
