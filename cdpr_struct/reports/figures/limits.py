"""Cable parameters against the printed limits of the closed-form DSM (thesis eqs 2.40, 2.41)."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cdpr_struct.crosscheck.validity_limits import INCLINATION_EPSILON_PAIRS, LAMBDA_SQUARED_LIMIT, ValidityLimits
from cdpr_struct.reports.figures.style import BAD, BLACK, BLUE, GREEN, GREY, plain_ticks, quiet

SIZE = (9.6, 3.9)
_LEFT_PARAMETERS = {"lambda2", "crossover_distance"}


def draw_limits(figure: Figure, limits: ValidityLimits) -> None:
    """lambda^2 of each cable beside its limit; epsilon over inclination beside the admitted region."""
    left, right = figure.subplots(1, 2, width_ratios=[1.0, 1.15])
    _lambda_squared(left, limits)
    _epsilon(right, limits)


def violators(limits: ValidityLimits, left: bool) -> np.ndarray:
    """(m,) bool: the cable breaks a limit that the left (lambda^2) or the right (sag, inclination) panel shows."""
    cables = {v.cable for v in limits.violations if (v.parameter in _LEFT_PARAMETERS) == left}
    return np.isin(np.arange(1, len(limits.epsilon) + 1), list(cables))


def label_groups(
    points: np.ndarray, reach: tuple[float, float], chosen: np.ndarray | None = None
) -> list[tuple[np.ndarray, str]]:
    """Points (m, 2) that lie closer than `reach` share one label like "1, 3–5": list of (place, label).

    Only those of the `chosen` (m,) are labelled; all by default.
    """
    groups = near_groups(points, reach, chosen)
    return [(points[group].max(axis=0), number_ranges([i + 1 for i in group])) for group in groups]


def near_groups(points: np.ndarray, reach: tuple[float, float], chosen: np.ndarray | None = None) -> list[list[int]]:
    """Numbers of points (m, 2), those together that lie closer than `reach` to the first of them."""
    groups: list[list[int]] = []
    for i in range(len(points)) if chosen is None else np.flatnonzero(chosen).tolist():
        near = (g for g in groups if np.all(np.abs(points[g[0]] - points[i]) <= reach))
        found = next(near, None)
        if found is None:
            groups.append([i])
        else:
            found.append(i)
    return groups


def number_ranges(numbers: list[int]) -> str:
    """Ascending numbers as text, runs of three or more shortened: "1, 3, 5–8"."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ", ".join(f"{run[0]}–{run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs)


def _lambda_squared(axes: Axes, limits: ValidityLimits) -> None:
    value, bad = limits.lambda_squared, violators(limits, left=True)
    number = np.arange(1, len(value) + 1)
    low, high = 0.4 * min(value.min(), LAMBDA_SQUARED_LIMIT), 2.5 * max(value.max(), LAMBDA_SQUARED_LIMIT)
    axes.set_yscale("log")
    axes.set_ylim(low, high)
    axes.axhspan(low, LAMBDA_SQUARED_LIMIT, color=GREEN, alpha=0.09, linewidth=0)
    axes.axhline(LAMBDA_SQUARED_LIMIT, color=BLACK, linewidth=0.9, linestyle=(0, (5, 3)))
    axes.annotate(
        f"limit {LAMBDA_SQUARED_LIMIT:g}", (1.0, LAMBDA_SQUARED_LIMIT), (-2, 3), xycoords=("axes fraction", "data"),
        textcoords="offset points", ha="right", fontsize=8,
    )  # fmt: skip
    axes.vlines(number, low, value, color=[BAD if b else BLUE for b in bad], linewidth=1.0, alpha=0.5)
    _points(axes, number.astype(float), value, bad)
    axes.xaxis.set_major_locator(MaxNLocator(12, integer=True))
    axes.set_xlim(0.4, len(value) + 0.6)
    axes.set_xlabel("cable number [-]")
    axes.set_ylabel("λ² [-]")
    axes.set_title("λ²: elastic stretch against sag")
    plain_ticks(axes.yaxis)
    quiet(axes)


def _epsilon(axes: Axes, limits: ValidityLimits) -> None:
    angle, value, bad = limits.inclination_deg, limits.epsilon, violators(limits, left=False)
    low, high = 0.5 * min(value.min(), 0.05), 2.0 * max(value.max(), 0.3)
    axes.set_yscale("log")
    axes.set_ylim(low, high)
    axes.set_xlim(0.0, 90.0)
    before = 0.0
    for largest_angle, largest in INCLINATION_EPSILON_PAIRS:
        axes.fill_between([before, largest_angle], low, largest, color=GREEN, alpha=0.09, linewidth=0)
        axes.plot([before, largest_angle], [largest, largest], color=BLACK, linewidth=0.9, linestyle=(0, (5, 3)))
        axes.annotate(
            f"{largest:g}", (largest_angle, largest), (-2, 3), textcoords="offset points", ha="right", fontsize=8
        )
        before = largest_angle
    axes.annotate("admitted", (before, low), (-4, 5), textcoords="offset points", ha="right", fontsize=8, color=GREY)
    _points(axes, angle, value, bad)
    _labels(axes, angle, value, bad)
    axes.set_xticks(range(0, 91, 15))
    axes.set_xlabel("inclination of the chord |α| [deg]")
    axes.set_ylabel("ε [-]")
    axes.set_title("ε: sag over inclination")
    plain_ticks(axes.yaxis)
    quiet(axes)


def _points(axes: Axes, x: np.ndarray, y: np.ndarray, bad: np.ndarray) -> None:
    axes.plot(x[~bad], y[~bad], "o", color=BLUE, markersize=5.5)
    axes.plot(x[bad], y[bad], "X", color=BAD, markersize=7)


def _labels(axes: Axes, angle: np.ndarray, value: np.ndarray, bad: np.ndarray) -> None:
    low, high = np.log10(axes.get_ylim())
    points = np.column_stack([angle / 90.0, (np.log10(value) - low) / (high - low)])
    for chosen, colour in ((~bad, BLACK), (bad, BAD)):
        for place, label in label_groups(points, (0.10, 0.06), chosen):
            axes.annotate(
                label, tuple(place), (5, 4), xycoords="axes fraction", textcoords="offset points",
                fontsize=8, color=colour, zorder=5,
            )  # fmt: skip


def limits_caption(limits: ValidityLimits) -> str:
    """What to see in the figure."""
    bad = sorted({v.cable for v in limits.violations})
    outcome = (
        f"Cable{'s' * (len(bad) > 1)} {number_ranges(bad)} (red crosses) outside." if bad else "All cables lie inside."
    )
    return (
        "The closed form assumes a shallow, taut cable. Stems: Irvine's λ², which must stay below the first "
        "crossover of symmetric and antisymmetric modes. Points over the inclination: ε, eight times "
        "sag over chord, which may be "
        f"{INCLINATION_EPSILON_PAIRS[0][1]:g} up to {INCLINATION_EPSILON_PAIRS[0][0]:g}° inclination and "
        f"{INCLINATION_EPSILON_PAIRS[1][1]:g} up to {INCLINATION_EPSILON_PAIRS[1][0]:g}°; "
        f"no limit is printed for steeper cables. Numbers are cables. {outcome}"
    )
