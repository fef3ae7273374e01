"""Error of the closed form over lambda^2 and epsilon at several inclinations, with the printed limits drawn in."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from cdpr_struct.crosscheck.limits_domain import MAX_STRAIN, MAX_WEIGHT
from cdpr_struct.crosscheck.limits_trial import LimitsTrial
from cdpr_struct.crosscheck.validity_limits import CROSSOVER_DISTANCE, LAMBDA_SQUARED_LIMIT, epsilon_limit
from cdpr_struct.reports.figures.style import BLACK, GREY, LIGHT, VERMILLION, plain_number, plain_ticks

SIZE = (9.6, 6.6)
PANELS = 4
_LEVELS = np.array([0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0])  # percent; the tolerance is one of them
_COLOURS = ListedColormap(
    ["#f7fbff", "#d6e6f4", "#abcfe6", "#6aaed6", "#3f8fc5", "#fdd0a2", "#fdae6b", "#f16913", "#d94801", "#8c2d04"]
)


def draw_error_map(figure: Figure, trial: LimitsTrial, quantity: str) -> None:
    """One panel an inclination."""
    shown = panel_inclinations(trial)
    panels = figure.subplots(2, 2, sharex=True, sharey=True).ravel()
    error = np.full(np.prod(trial.extent.domain.shape), np.nan)
    error[trial.number] = 100.0 * trial.error(quantity)
    error = error.reshape(trial.extent.domain.shape)
    norm = BoundaryNorm(_LEVELS, _COLOURS.N, extend="both")
    for axes, k in zip(panels, shown, strict=False):
        image = _panel(axes, trial, error[k], norm)
        _printed_limits(axes, trial, float(trial.extent.domain.inclination_deg[k]))
    for axes in panels[2:]:
        axes.set_xlabel("λ² [-]")
    for axes in panels[::2]:
        axes.set_ylabel("ε [-]")
    bar = figure.colorbar(image, ax=panels, shrink=0.9, ticks=_LEVELS, format=lambda v, _: plain_number(v))
    bar.set_label("1 − MAC, worst of six modes [%]" if quantity == "mode_shape" else "largest relative error [%]")
    bar.outline.set_visible(False)
    figure.legend(handles=_legend(), loc="outside lower center", ncols=3)


def panel_inclinations(trial: LimitsTrial) -> list[int]:
    """Which inclinations of the domain are drawn: horizontal, the two of the print, and a steeper one."""
    angles = trial.extent.domain.inclination_deg
    return [int(np.abs(angles - wanted).argmin()) for wanted in (0.0, 30.0, 60.0, 80.0)]


def _panel(axes: Axes, trial: LimitsTrial, error: np.ndarray, norm: BoundaryNorm) -> QuadMesh:
    domain = trial.extent.domain
    axes.grid(False)
    axes.set_facecolor(LIGHT)
    axes.patch.set(hatch="////", edgecolor=GREY, linewidth=0)
    axes.set_xscale("log")
    axes.set_yscale("log")
    return axes.pcolormesh(
        domain.lambda_squared,
        domain.epsilon,
        np.ma.masked_invalid(error),
        norm=norm,
        cmap=_COLOURS,
        shading="nearest",
        rasterized=True,
    )


def _printed_limits(axes: Axes, trial: LimitsTrial, angle: float) -> None:
    """The admitted region as a frame, and the crossovers with their 20 % as bands."""
    domain = trial.extent.domain
    low_x, high_x = float(domain.lambda_squared[0]), float(domain.lambda_squared[-1])
    low_y, high_y = float(domain.epsilon[0]), float(domain.epsilon[-1])
    largest = epsilon_limit(angle)
    if largest > 0.0:
        axes.plot([low_x, LAMBDA_SQUARED_LIMIT], [largest, largest], color=BLACK, linewidth=1.4)
        axes.plot([LAMBDA_SQUARED_LIMIT] * 2, [low_y, largest], color=BLACK, linewidth=1.4)
    for n in (1, 2):
        crossover = 4.0 * n**2 * np.pi**2
        for factor in (1.0 - CROSSOVER_DISTANCE, 1.0 + CROSSOVER_DISTANCE):
            axes.axvline(crossover * factor, color=VERMILLION, linewidth=0.8, linestyle=(0, (4, 2)))
    axes.set_xlim(low_x, high_x)
    axes.set_ylim(low_y, high_y)
    admitted = f"ε up to {largest:g} admitted" if largest > 0.0 else "nothing admitted"
    axes.set_title(f"α = {angle:g}°: {admitted}")
    plain_ticks(axes.xaxis)
    plain_ticks(axes.yaxis)


def _legend() -> list[Line2D | Patch]:
    return [
        Line2D([], [], color=BLACK, linewidth=1.4, label="printed limits: inside is below and to the left"),
        Line2D([], [], color=VERMILLION, linewidth=0.8, linestyle=(0, (4, 2)), label="20 % around a crossover 4n²π²"),
        Patch(facecolor=LIGHT, edgecolor=GREY, hatch="////", linewidth=0, label="not tried"),
    ]


def error_map_caption(trial: LimitsTrial, quantity: str) -> str:
    """What to see in the figure."""
    what = {
        "in_plane_frequency": "the first six in-plane frequencies of the clamped cable",
        "mode_shape": "the shapes of the first six in-plane modes",
        "end_mass_frequency": "the frequencies of a mass of 1 to 100 cable masses at the cable's end",
    }[quantity]
    inside = trial.error(quantity)[trial.inside]
    share = trial.volume[trial.inside][inside > trial.tolerance].sum() / trial.volume[trial.inside].sum()
    return (
        f"Largest error in {what}, closed form against catenary: blue below 1 %, orange above. Each panel has one "
        "inclination and its own printed limits (black). Inside them, over all inclinations, the error reaches "
        f"{100.0 * inside.max():.2g} % and exceeds {100.0 * trial.tolerance:g} % in {100.0 * share:.2g} % of the "
        f"volume. "
        f"Hatched: strain above {MAX_STRAIN:.0%} or weight above {MAX_WEIGHT:g} tensions."
    )
