"""Which mode of the FEM has the shape of which mode of a model."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure

from cdpr_struct.crosscheck.mode_pairing import CLUSTER_GAP
from cdpr_struct.crosscheck.verdicts import Judged
from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.reports.figures.style import quiet

SIZE = (9.6, 4.4)
_MODELS: tuple[tuple[Judged, str], ...] = (("exact", "exact catenary"), ("dsm", "closed form (DSM)"))
_TICKS = 10


def draw_mac(figure: Figure, trial: Verification) -> None:
    """Modal assurance criterion of every FEM mode with every mode of the exact model, and of the DSM."""
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    for axes, (model, words) in zip((left, right), _MODELS, strict=True):
        image = _matrix(axes, trial.mac(model))
        axes.set_xlabel(f"mode of the {words} [-]")
    left.invert_yaxis()
    left.set_ylabel("FEM mode [-]")
    figure.colorbar(image, ax=(left, right), label="MAC [-]", fraction=0.04, pad=0.02)


def _matrix(axes: Axes, mac: np.ndarray) -> QuadMesh:
    axes.grid(False)
    number = np.arange(1, len(mac) + 1)
    image = axes.pcolormesh(number, number, mac, cmap="Blues", vmin=0.0, vmax=1.0, shading="nearest", rasterized=True)
    axes.set_aspect("equal")
    named = number[:: -(-len(number) // _TICKS)]
    axes.set_xticks(named)
    axes.set_yticks(named)
    quiet(axes)
    return image


def mac_caption(trial: Verification) -> str:
    """What to see in the matrices."""
    parts = []
    for model, words in _MODELS:
        own = np.diag(trial.mac(model))
        worst = int(own.argmin())
        parts.append(f"{words}: at least {own.min():.3f} (mode {worst + 1}, {trial.fem_limit_hertz[worst]:.3f} Hz)")
    hertz = np.sort(trial.fem_limit_hertz)
    double = bool((np.diff(hertz) < CLUSTER_GAP * hertz[1:]).any())
    return (
        "MAC (modal assurance criterion) of shapes, weighted by mass: 1 is the same shape, 0 another. Columns are the "
        f"model's modes in the order of their FEM partners, so a diagonal of ones is agreement. {'; '.join(parts)}."
        + (" Modes of nearly equal frequency mix: squares beside the diagonal, of which the row sums count." * double)
    )
