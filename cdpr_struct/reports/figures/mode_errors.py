"""How far each DSM frequency is from the FEM's."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.reports.figures.style import (
    BAD,
    BLACK,
    GREY,
    KIND_COLOURS,
    KIND_MARKERS,
    kind_group,
    plain_number,
    quiet,
)
from cdpr_struct.reports.verification_verdict import cause_sentence

SIZE = (9.6, 3.9)
_FAR = 8.0  # tolerances
_NAME = 32.0  # width of a frequency above the axis [pt]


def draw_mode_errors(figure: Figure, trial: Verification) -> None:
    """Signed relative error per mode; far beyond the tolerance the scale is logarithmic, but linear near zero."""
    axes = figure.subplots()
    tolerance = 100.0 * trial.criteria.relative_error
    if _is_even(trial):
        _even_scale(axes, trial, tolerance)
    else:
        _symmetric_scale(axes, trial, tolerance)
    axes.axhspan(-tolerance, tolerance, color="#f4f7f5", linewidth=0, zorder=0)
    for sign in (-1.0, 1.0):
        axes.axhline(sign * tolerance, color=BLACK, linewidth=0.9, linestyle=(0, (5, 3)))
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.annotate(
        f"tolerance ±{tolerance:g} %", (1.0, tolerance), (-2, 3), xycoords=("axes fraction", "data"),
        textcoords="offset points", ha="right", fontsize=8,
    )  # fmt: skip
    _stems(axes, trial)
    axes.set_xlim(0.2, len(trial.kinds) + 0.8)
    axes.set_xlabel("mode number [-]")
    axes.set_ylabel("DSM / FEM limit − 1 [%]")
    quiet(axes)
    _name_modes(axes, trial, figure.get_figwidth())
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=6)


def _is_even(trial: Verification) -> bool:
    """Whether an even scale shows every error: none is larger than eight tolerances."""
    return float(np.abs(trial.relative_error).max()) <= _FAR * trial.criteria.relative_error


def _even_scale(axes: Axes, trial: Verification, tolerance: float) -> None:
    reach = 1.25 * max(100.0 * float(np.abs(trial.relative_error).max()), tolerance)
    axes.set_ylim(-reach, reach)
    axes.yaxis.set_major_locator(MaxNLocator(8, steps=[1, 2, 5, 10]))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:+.10g}" if value else "0"))


def _symmetric_scale(axes: Axes, trial: Verification, tolerance: float) -> None:
    linear = 0.1 * tolerance
    axes.set_yscale("symlog", linthresh=linear, linscale=1.0)
    reach = max(100.0 * float(np.abs(trial.relative_error).max()), tolerance)
    top = int(np.ceil(np.log10(reach / linear) + 1e-9))
    powers = [linear * 10.0**p for p in range(top + 1)]
    ticks = [-t for t in reversed(powers)] + [0.0] + powers
    axes.set_yticks(ticks, [plain_number(t) if t <= 0 else f"+{plain_number(t)}" for t in ticks])
    axes.set_yticks([], minor=True)
    axes.set_ylim(-1.8 * reach, 1.8 * reach)


def _stems(axes: Axes, trial: Verification) -> None:
    number = np.arange(1, len(trial.kinds) + 1)
    error = 100.0 * trial.relative_error
    spread = 100.0 * trial.fem_uncertainty_hertz / trial.fem_limit_hertz
    exact = 100.0 * (trial.exact_hertz / trial.fem_limit_hertz - 1.0)
    groups = np.array([kind_group(kind) for kind in trial.kinds])
    for name, colour in KIND_COLOURS.items():
        mine = groups == name
        if mine.any():
            axes.vlines(number[mine], 0.0, error[mine], color=colour, linewidth=1.0)
            axes.plot(number[mine], error[mine], KIND_MARKERS[name], color=colour, markersize=5, label=f"{name} mode")
    axes.errorbar(
        number, error, yerr=spread, fmt="none", ecolor=BLACK, elinewidth=0.8, capsize=2, label="FEM uncertainty"
    )
    axes.plot(number, exact, "_", color=BLACK, markersize=8, mew=1.4, label="exact catenary")
    outside = np.abs(trial.relative_error) > trial.criteria.relative_error
    if outside.any():
        axes.plot(
            number[outside], error[outside], "o", color=BAD, markersize=11, fillstyle="none", mew=1.4, label="outside"
        )


def _name_modes(axes: Axes, trial: Verification, width: float) -> None:
    """Numbers of the modes below and their frequencies above, as many as the figure [inch] has room for."""
    count = len(trial.kinds)
    step = -(-count // int(0.85 * 72.0 * width / _NAME))
    named = list(range(1, count + 1, step))
    axes.set_xticks(named)
    top = axes.secondary_xaxis("top")
    top.set_xticks(named, [f"{trial.fem_limit_hertz[i - 1]:.2f}" for i in named])
    top.set_xlabel("FEM eigenfrequency [Hz]")


def _cause(trial: Verification) -> str:
    if not trial.agreement("dsm").failing.any() or "dsm" not in trial.judged:
        return ""
    return f"{cause_sentence(trial, 'dsm')} "


def mode_errors_caption(trial: Verification) -> str:
    """What to see in the figure."""
    error = 100.0 * trial.relative_error
    exact = 100.0 * float(np.abs(trial.exact_hertz / trial.fem_limit_hertz - 1.0).max())
    worst = int(np.argmax(np.abs(error)))
    parts = []
    for name in KIND_COLOURS:
        mine = error[[kind_group(kind) == name for kind in trial.kinds]]
        if len(mine):
            parts.append(f"{name} modes {mine.min():+.2g} to {mine.max():+.2g} % ({len(mine)})")
    return (
        "Each stem is one mode, paired with the FEM by shape, above zero where the DSM is too stiff: "
        f"{'; '.join(parts)}. Largest: mode {worst + 1} ({trial.kinds[worst]}) at "
        f"{trial.fem_limit_hertz[worst]:.3f} Hz with {error[worst]:+.3f} %. Black dashes are the exact catenary's "
        f"frequencies, at most {exact:.2g} % off: a stem is the error of the closed form. {_cause(trial)}Bars are "
        "the uncertainty of the extrapolated FEM."
        + ("" if _is_even(trial) else " The scale is linear near zero, and logarithmic farther out.")
    )
