"""Residuals before and after, evidence of each candidate, probabilities of the answers."""

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.diagnosis.left_out import LeftOut
from cdpr_struct.reports.diagnose.tables import figure as shown
from cdpr_struct.reports.diagnose.tables import hypotheses
from cdpr_struct.reports.figures.style import BLUE, GREY, LIGHT, ORANGE, plain_number, quiet

RESIDUAL_SIZE, EVIDENCE_SIZE, PROBABILITY_SIZE, STATES_SIZE = (9.6, 4.2), (9.6, 3.2), (9.6, 2.6), (9.6, 3.6)
_BARS, _MOST_NAMES, _LETTERS, _ANSWERS = 10, 30, 18, 6
_FEWEST = 4  # places for bars: a single bar does not fill the figure
_NARROW = 0.3  # of the width: two blocks together on which their names would touch
_TENS = tuple(10.0**n for n in range(1, 16))
_TICKS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, *_TENS[1:])
ROW_NAMES = {
    "EQ": "wrench balance", "CO": "lengths", "CF": "cable frequencies", "RF": "robot frequencies",
    "FA": "modal constants", "SW": "swivel angles",
}  # fmt: skip
"""Of each kind of residuals."""
_ROWS_OF = {
    "position": ["EQ", "CO"], "rotation": ["EQ", "CO"], "tension": ["EQ"], "length": ["CO"],
    "cable_frequency": ["CF"], "frf": ["FA"], "swivel": ["SW"],
}  # fmt: skip
"""Residuals that a reading of each kind enters."""
_OF_CABLE = ("length", "cable_frequency", "swivel")


def draw_residuals(figure: Figure, found: Diagnosis) -> None:
    """Each row that holds a reading, in its own sigma, as entered and with the causes found, kind by kind."""
    axes = figure.subplots()
    rows, after = found.recorded, found.residuals
    order = np.argsort([list(ROW_NAMES).index(kind) for kind in rows.kind], kind="stable")
    before = (rows.before / rows.sigma)[order]
    axes.axhspan(-2.0, 2.0, color="#f4f7f5", linewidth=0)
    axes.plot(np.arange(len(before)), before, ".", color=ORANGE, markersize=7, label="as entered")
    values = [before]
    if found.chosen.hypothesis.parts or found.correction is not None:
        mended = after.after / after.sigma
        values.append(mended[order] if len(mended) == len(order) else mended)
        axes.plot(np.arange(len(mended)), values[1], ".", color=BLUE, markersize=4, label="with causes")
    doubted = np.flatnonzero(_down_weighted(found, rows)[order])
    if doubted.size:
        last = values[-1] if len(values[-1]) == len(before) else before
        axes.plot(doubted, last[doubted], "o", color=GREY, fillstyle="none", label="down-weighted reading")
    _name_kinds(axes, rows.kind[order])
    _name_states(axes, rows.kind[order], [found.campaign.states.names[i] for i in rows.state[order]])
    _plain_sigmas(axes, values)
    axes.set_ylabel("residual / its sigma [-]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper right", ncols=2)
    quiet(axes)


def _down_weighted(found: Diagnosis, rows: LeftOut) -> np.ndarray:
    """(n,) whether a reading that the fit down-weighted enters a row."""
    marked, names = np.zeros(len(rows.kind), dtype=bool), found.campaign.states.names
    for one in found.set_aside:
        own = np.isin(rows.kind, _ROWS_OF[one.kind]) & (rows.state == names.index(one.case))
        if one.kind in _OF_CABLE:
            own &= rows.cable == one.cable
        if one.hertz and own.any():
            apart = np.where(own, np.abs(rows.hertz - one.hertz), np.inf)
            own = apart == apart.min()
        marked |= own
    return marked


def draw_state_errors(figure: Figure, result: Mapping[str, Any]) -> None:
    """Errors of every kind in its unit, a bar a state, as entered and with the causes."""
    rows = result["errors_by_state"]
    kinds = list(dict.fromkeys(row["kind"] for row in rows))
    grid = figure.subplots(1, len(kinds), squeeze=False)[0]
    for axes, kind in zip(grid, kinds, strict=True):
        own = [row for row in rows if row["kind"] == kind]
        place = np.arange(len(own))
        both = any(row["after"] is not None for row in own)
        axes.bar(place - 0.2 * both, [row["before"] for row in own], 0.4, color=ORANGE, label="as entered")
        if both:
            after = [np.nan if row["after"] is None else row["after"] for row in own]
            axes.bar(place + 0.2, after, 0.4, color=BLUE, label="with causes")
        shown_at = place[:: 1 + len(place) // 12]
        axes.set_xticks(shown_at, [own[i]["case"] for i in shown_at], rotation=60, ha="right", fontsize=7.5)
        axes.set_ylabel(f"{kind} [{own[0]['unit']}]")
        quiet(axes, "y")
    figure.legend(*grid[0].get_legend_handles_labels(), loc="outside upper right", ncols=2)


def draw_evidence(figure: Figure, result: Mapping[str, Any]) -> None:
    """Log evidence of every candidate, the nominal model at zero."""
    axes = figure.subplots()
    rows = hypotheses(result["candidates"])[:_BARS][::-1]
    bars = axes.barh([_plain(h.name) for h in rows], [h.gain for h in rows], color=BLUE)
    axes.bar_label(bars, [f" {shown(h.gain)}" for h in rows], fontsize=8.5, padding=3)
    axes.axvline(0.0, color=GREY, linewidth=0.9)
    axes.set_ylim(min(-0.5, len(rows) - _FEWEST - 0.5), len(rows) - 0.5)
    axes.set_xlabel("log evidence against the nominal model, which stands at 0 [nats]")
    quiet(axes, "x")


def draw_probabilities(figure: Figure, result: Mapping[str, Any]) -> None:
    """Probabilities of the likeliest sets of causes."""
    axes = figure.subplots()
    rows = result["probabilities"][:_ANSWERS][::-1]
    names = [_plain(" + ".join(row["causes"])) or "nothing wrong" for row in rows]
    said = {name for names in result["verdict"]["class"] for name in names}
    own = [set(row["causes"]) <= said if row["causes"] else not said for row in rows]
    values = [row["probability"] for row in rows]
    bars = axes.barh(names, values, color=[BLUE if mine else GREY for mine in own])
    axes.bar_label(bars, [f" {value:.2g}" for value in values], fontsize=8.5, padding=3)
    axes.set_xlim(0.0, 1.1)
    axes.set_xlabel("probability [-]")
    quiet(axes, "x")


def _name_kinds(axes: Axes, kinds: np.ndarray) -> None:
    """Lines between kinds of rows, their names below, on two levels where narrow ones follow each other."""
    place = np.arange(len(kinds))
    for edge in np.flatnonzero(kinds[1:] != kinds[:-1]) + 0.5:
        axes.axvline(edge, color=GREY, linewidth=0.6)
    present = [kind for kind in ROW_NAMES if (kinds == kind).any()]
    share = [float((kinds == kind).mean()) for kind in present]
    low = [False]
    for left, right in pairwise(share):
        low.append(left + right < _NARROW and not low[-1])
    words = ["\n" * below + ROW_NAMES[kind] for below, kind in zip(low, present, strict=True)]
    axes.set_xticks([float(place[kinds == kind].mean()) for kind in present], words)
    axes.tick_params(axis="x", length=0)


def _name_states(axes: Axes, kinds: np.ndarray, names: list[str]) -> None:
    """Faint lines between the states of a kind, their names above, upright where they would not fit side by side."""
    starts = [i for i in range(len(names)) if i == 0 or names[i] != names[i - 1] or kinds[i] != kinds[i - 1]]
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


def _plain(name: str) -> str:
    return name.replace("_", " ")
