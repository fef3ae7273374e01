"""Error inside the printed limits over the group that each missing limit is about."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.crosscheck.limits_causes import MissingLimit, sample_groups
from cdpr_struct.crosscheck.limits_sweep import take
from cdpr_struct.crosscheck.limits_trial import LimitsTrial
from cdpr_struct.reports.audit_limits_text import CAUSE_NAMES, QUANTITY_NAMES, SYMBOLS
from cdpr_struct.reports.figures.style import BAD, BLACK, BLUE, plain_ticks, quiet

SIZE = (9.6, 6.6)
_MOST = 4
_FLOOR = 1e-4  # percent
_DRAWN = 8000


def draw_evidence(figure: Figure, trial: LimitsTrial) -> None:
    """One panel for each of the limits that explain most errors."""
    shown = shown_limits(trial)
    panels = figure.subplots(2, 2, squeeze=False).ravel()
    for axes, limit in zip(panels, shown, strict=False):
        _panel(axes, trial, limit)
    for axes in panels[len(shown) :]:
        axes.set_visible(False)


def shown_limits(trial: LimitsTrial) -> list[MissingLimit]:
    """The limits with most samples behind them, one a quantity first."""
    ranked = sorted((m for m in trial.missing if m.quantity != "across_frequency"), key=lambda m: -m.samples)
    first = {m.quantity: m for m in reversed(ranked)}
    rest = [m for m in ranked if m is not first[m.quantity]]
    return [*sorted(first.values(), key=lambda m: -m.samples), *rest][:_MOST]


def _panel(axes: Axes, trial: LimitsTrial, limit: MissingLimit) -> None:
    value, error = _points(trial, limit)
    bad = error > 100.0 * trial.tolerance
    axes.set_xscale("log")
    axes.set_yscale("log")
    dots = {"markersize": 2.0, "alpha": 0.4, "markeredgewidth": 0.0, "rasterized": True}
    axes.plot(value[~bad], error[~bad], ".", color=BLUE, **dots)  # type: ignore[arg-type]
    axes.plot(value[bad], error[bad], ".", color=BAD, **dots)  # type: ignore[arg-type]
    axes.axhline(100.0 * trial.tolerance, color=BLACK, linewidth=0.9, linestyle=(0, (5, 3)))
    axes.axvline(limit.limit.threshold, color=BLACK, linewidth=1.2)
    axes.annotate(
        f"{limit.limit.threshold:g}", (limit.limit.threshold, 1.0), (3, -10), xycoords=("data", "axes fraction"),
        textcoords="offset points", fontsize=8,
    )  # fmt: skip
    axes.set_xlabel(f"{SYMBOLS[limit.limit.parameter]} [-]")
    axes.set_ylabel("error [%]")
    axes.set_title(f"{QUANTITY_NAMES[limit.quantity]}\ncause: {CAUSE_NAMES[limit.cause]}", fontsize=8.5)
    plain_ticks(axes.xaxis)
    plain_ticks(axes.yaxis)
    quiet(axes, "both")


def _points(trial: LimitsTrial, limit: MissingLimit) -> tuple[np.ndarray, np.ndarray]:
    """Group and error [%] of the samples that are drawn."""
    admitted = np.flatnonzero(trial.inside)
    samples = take(trial.measured, admitted)[limit.quantity]
    value = sample_groups(trial.groups.take(admitted), samples)[limit.limit.parameter].ravel()
    error = np.maximum(100.0 * samples.error.ravel(), _FLOOR)
    shown = _thinned(error) & (value > 0.0)
    return value[shown], error[shown]


def _thinned(error: np.ndarray) -> np.ndarray:
    """(k,) bool: at most so many samples, the largest errors among them."""
    rank = np.argsort(-error, kind="stable")
    rest = rank[_DRAWN // 4 :]
    shown = np.zeros(len(error), dtype=bool)
    shown[rank[: _DRAWN // 4]] = True
    shown[rest[:: max(1, len(rest) // (3 * _DRAWN // 4))]] = True
    return shown


def evidence_caption(trial: LimitsTrial) -> str:
    """What to see in the figure."""
    return (
        "Every sample inside the printed limits (a cable with a mode, a frequency band or an end mass): its error "
        "over the "
        f"group that a missing limit is about. Red: above {100.0 * trial.tolerance:g} %. Vertical: the further "
        f"limit, with "
        "nothing red of this cause to its left. Red points left of the line have another cause and another limit."
    )
