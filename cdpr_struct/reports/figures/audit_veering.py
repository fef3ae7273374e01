"""Frequencies at the crossovers: they cross in the closed form and veer in an inclined cable."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.crosscheck.limits_trial import LimitsTrial
from cdpr_struct.crosscheck.limits_veering import Veering
from cdpr_struct.crosscheck.validity_limits import CROSSOVER_DISTANCE, LAMBDA_SQUARED_LIMIT
from cdpr_struct.reports.figures.style import BLUE, GREY, LIGHT, ORANGE, quiet

SIZE = (9.6, 7.2)
_ZOOM = (1.7, 2.3)


def draw_veering(figure: Figure, trial: LimitsTrial) -> None:
    """Above, Omega / pi over lambda / pi, horizontal and inclined; below, the first crossover enlarged."""
    panels = figure.subplots(2, 2, sharex="row", sharey="row", height_ratios=[1.35, 1.0])
    for column, curve in enumerate(trial.curves):
        _frequencies(panels[0, column], curve, legend=column == 0)
        _frequencies(panels[1, column], curve, legend=False)
        panels[0, column].set_title(f"α = {curve.inclination_deg:g}°, ε = {curve.epsilon:g}")
        panels[1, column].set_title(f"first crossover: gap {100.0 * curve.gap:.2g} %")
        panels[1, column].set_xlabel("λ/π [-]")
    for row in panels:
        row[0].set_ylabel("Ω/π [-]")
    panels[0, 0].set_ylim(0.8, 6.6)
    panels[1, 0].set_xlim(*_ZOOM)
    panels[1, 0].set_ylim(1.82, 2.2)


def _frequencies(axes: Axes, curve: Veering, legend: bool) -> None:
    ratio = np.sqrt(curve.lambda_squared) / np.pi
    for n in (1, 2):
        low, high = (2.0 * n * np.sqrt(1.0 + s * CROSSOVER_DISTANCE) for s in (-1.0, 1.0))
        axes.axvspan(low, high, color=LIGHT, linewidth=0, label="20 % around 4n²π²" if n == 1 else None)
    axes.axvline(
        np.sqrt(LAMBDA_SQUARED_LIMIT) / np.pi, color=GREY, linewidth=0.9, linestyle=(0, (5, 3)), label="λ² = 24"
    )
    for k in range(curve.catenary.shape[1]):
        axes.plot(ratio, curve.closed_form[:, k] / np.pi, color=ORANGE, linewidth=2.4, alpha=0.75,
                  label="closed form" if k == 0 else None)  # fmt: skip
    for k in range(curve.catenary.shape[1]):
        axes.plot(ratio, curve.catenary[:, k] / np.pi, color=BLUE, linewidth=1.1, label="catenary" if k == 0 else None)
    quiet(axes, "both")
    if legend:
        axes.figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=4)


def veering_caption(trial: LimitsTrial) -> str:
    """What to see in the figure."""
    flat, steep = trial.curves[0], trial.curves[-1]
    return (
        "In-plane frequencies over λ. Level lines are antisymmetric modes, which do not stretch the cable; rising ones "
        "symmetric modes, which do. In the closed form the two kinds are uncoupled and cross at λ = "
        "2nπ. In "
        f"the horizontal cable that is so (gap {100.0 * flat.gap:.1g} %, the resolution of the curve). In the "
        f"inclined one "
        "the weight along the chord makes one end tighter than the other, no mode is symmetric any more, and the "
        f"frequencies veer: they never come closer than {100.0 * steep.gap:.2g} % (at λ² = {steep.gap_at:.3g}), and "
        f"the "
        f"modes exchange their shapes (1 − MAC up to {steep.mode_shape_error.max():.2f})."
    )
