"""How fine the FEM mesh must be before it can judge the model."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.reports.figures.style import (
    BLACK,
    GREEN,
    GREY,
    KIND_COLOURS,
    KIND_MARKERS,
    KIND_WORDS,
    SKY,
    kind_group,
    plain_ticks,
    quiet,
)
from cdpr_struct.reports.verification_verdict import percent

SIZE = (9.6, 4.3)


def draw_convergence(figure: Figure, trial: Verification) -> None:
    """FEM error over element count, one line a mode; beside it on the same scale the DSM's deviation of each mode."""
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=[2.2, 1.0])
    left.set_xscale("log")
    left.set_yscale("log")
    _mesh_errors(left, trial)
    _slope_triangle(left, trial)
    _deviation_band(left, trial)
    _deviations(right, trial)
    left.set_xticks(trial.elements, [str(n) for n in trial.elements])
    left.set_xticks([], minor=True)
    left.set_xlabel("elements per cable [count]")
    left.set_ylabel("|relative deviation from the FEM limit| [%]")
    left.set_title("FEM: error of the mesh")
    right.set_title("DSM: error of the model")
    plain_ticks(left.yaxis)
    quiet(left)
    quiet(right)
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=3)


def log_percent(ratio: np.ndarray) -> np.ndarray:
    """|ratio| in percent, nan where it is zero so that a log axis can hold it."""
    size = 100.0 * np.abs(ratio)
    return np.where(size > 0.0, size, np.nan)


def _mesh_errors(axes: Axes, trial: Verification) -> None:
    errors = log_percent(trial.mesh_error)
    for i, kind in enumerate(trial.kinds):
        axes.plot(trial.elements, errors[:, i], color=KIND_COLOURS[kind_group(kind)], linewidth=0.7, alpha=0.55)
    median = 100.0 * np.median(trial.mesh_error, axis=1)
    axes.plot(trial.elements, median, "o-", color=BLACK, linewidth=2.0, markersize=4, label="median over the modes")
    consistent = 100.0 * np.median(trial.consistent_mesh_error, axis=1)
    axes.plot(
        trial.elements, consistent, "s:", color=BLACK, linewidth=1.0, markersize=3.5, label="median, consistent mass"
    )
    stiffness = 100.0 * trial.stiffness.fem_error.max(axis=1)
    axes.plot(
        trial.elements, stiffness, "^--", color=GREEN, linewidth=1.4, markersize=4, label="K(ω), largest entry error"
    )


def _slope_triangle(axes: Axes, trial: Verification) -> None:
    first, last = trial.elements[-2], trial.elements[-1]
    top = 2.2 * float(np.nanmax(log_percent(trial.mesh_error)[-2]))
    bottom = top * (first / last) ** 2
    axes.fill([first, last, last], [top, top, bottom], facecolor="none", edgecolor=GREY, linewidth=0.9)
    axes.annotate("1", ((first * last) ** 0.5, top), (0, 3), textcoords="offset points", ha="center", color=GREY)
    axes.annotate("2", (last, (top * bottom) ** 0.5), (4, 0), textcoords="offset points", va="center", color=GREY)


def _deviation_band(axes: Axes, trial: Verification) -> None:
    deviation = log_percent(trial.relative_error)
    low, middle, high = np.nanpercentile(deviation, [10.0, 50.0, 90.0])
    axes.axhspan(low, high, color=SKY, alpha=0.18, linewidth=0, label="DSM deviation, 10th to 90th percentile")
    axes.axhline(middle, color=SKY, linewidth=1.0, label="DSM deviation, median")


def _deviations(axes: Axes, trial: Verification) -> None:
    deviation = log_percent(trial.relative_error)
    groups = [kind_group(kind) for kind in trial.kinds]
    for column, name in enumerate(KIND_COLOURS):
        values = np.sort(deviation[[g == name for g in groups]])
        across = (
            column + np.linspace(-0.28, 0.28, len(values)) if len(values) > 1 else np.full(len(values), float(column))
        )
        axes.plot(across, values, KIND_MARKERS[name], color=KIND_COLOURS[name], markersize=4, alpha=0.85)
    axes.axhline(100.0 * trial.criteria.relative_error, color=BLACK, linewidth=0.9, linestyle=(0, (5, 3)))
    axes.annotate(
        f"tolerance {100.0 * trial.criteria.relative_error:g} %",
        (len(KIND_COLOURS) - 0.52, 100.0 * trial.criteria.relative_error), (0, 3),
        textcoords="offset points", ha="right", fontsize=8,
    )  # fmt: skip
    axes.set_xlim(-0.5, len(KIND_COLOURS) - 0.5)
    axes.set_xticks(range(len(KIND_COLOURS)), list(KIND_COLOURS))
    axes.set_xlabel("kind of mode [-]")


def convergence_caption(trial: Verification) -> str:
    """What to see in the figure."""
    order = trial.observed_order[np.isfinite(trial.observed_order)]
    observed = (
        f"observed order {np.median(order):.2f} (median; {order.min():.2f} to {order.max():.2f})"
        if len(order)
        else "no order observed"
    )
    finest = 100.0 * float(np.median(trial.mesh_error[-1]))
    model = 100.0 * float(np.median(np.abs(trial.relative_error)))
    return (
        f"Thin lines: one mode each, {_colours(trial)}. Two-node elements should gain a factor of four per halving, "
        f"the slope of the triangle; {observed}. A mesh can judge the DSM where its error lies below the DSM's "
        f"own (blue band, and the points of the DSM): at {trial.elements[-1]} elements the median mesh error is "
        f"{finest:.2g} %, the median DSM deviation {model:.2g} %. The DSM is compared with the extrapolated limit, "
        "not with any one mesh. Green: how far the FEM's dynamic stiffness K(ω) of the platform is from the exact "
        f"model's, entry by entry, at {len(trial.stiffness.omega_hertz)} frequencies between the modes, in shares of "
        "the static stiffness. Close to an eigenfrequency K(ω) changes steeply, so that it may be far off where the "
        f"frequencies agree; the DSM's is off by {percent(trial.stiffness.dsm_error.max())} there."
    )


def _colours(trial: Verification) -> str:
    """Which colour is which kind of mode, of those that are there."""
    there = {kind_group(kind) for kind in trial.kinds}
    return ", ".join(f"{KIND_WORDS[name]} for {name} modes" for name in KIND_COLOURS if name in there)
