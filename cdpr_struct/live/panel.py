"""The tables and sentences beside the picture, as Markdown."""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.live.measured_state import MeasuredState
from cdpr_struct.live.view_modes import NoModes, ViewModes
from cdpr_struct.live.view_state import Refusal, ViewState

LEGEND = (
    "Cables: light to dark blue with the tension; orange below force_min, red above force_max, grey slack. With a "
    "campaign: red where the measured value is above the prediction, blue where it is below (full colour at 5 sigma)."
)
_MARKS = {-1: " **low**", 0: "", 1: " **high**"}


def status(state: ViewState | Refusal) -> str:
    """One line if all is well, else what is not."""
    if isinstance(state, Refusal):
        return f"**Cannot be held.** {state.message}"
    if state.messages:
        return "\n\n".join(f"**Note.** {message}" for message in state.messages)
    return "Held; every cable is taut and within its force limits."


def cable_table(state: ViewState | Refusal) -> str:
    """Tension, length and sag of every cable; nothing for a robot that is not at rest."""
    if isinstance(state, Refusal):
        return ""
    columns = zip(state.tensions, state.exceeded.tolist(), state.lengths, 1e3 * state.sag, strict=True)
    rows = [
        [str(i), f"{pull:.1f}{_MARKS[mark]}", f"{length:.4f}", f"{sag:.1f}"]
        for i, (pull, mark, length, sag) in enumerate(columns, start=1)
    ]
    x, y, z, *angles = state.pose.in_degrees()
    turned = ", ".join(f"{angle + 0.0:.2f}" for angle in angles)
    table = _table(["cable", "N", "length m", "sag mm"], rows)
    return "\n\n".join([table, f"Platform at ({x:.3f}, {y:.3f}, {z:.3f}) m, turned ({turned}) deg."])


def mode_table(modes: ViewModes | NoModes) -> str:
    """Frequency, kind and platform motion of every mode."""
    if isinstance(modes, NoModes):
        return f"No vibrations: {modes.message}" if modes.message else ""
    columns = enumerate(zip(modes.hertz, modes.kinds, modes.words, strict=True), start=1)
    rows = [[str(i), f"{hertz:.3f}", kind, words] for i, (hertz, kind, words) in columns]
    return _table(["mode", "Hz", "kind", "platform"], rows)


def residual_table(state: MeasuredState) -> str:
    """Measured less predicted, per cable, and how far the platform missed."""
    columns = zip(
        state.tension, state.predicted_tension, state.tension_residual, 1e3 * state.length_residual, state.in_sigmas,
        strict=True,
    )  # fmt: skip
    rows = [[str(i), *(_number(value) for value in row)] for i, row in enumerate(columns, start=1)]
    said = [f"State {state.name}: measured less predicted at the measured pose."]
    if np.isfinite(state.missed).all():
        millimetres = ", ".join(f"{1e3 * value:.1f}" for value in state.missed)
        said.append(f"Measured position less that computed at the measured lengths: ({millimetres}) mm.")
    table = _table(["cable", "meas. N", "pred. N", "diff. N", "diff. mm", "sigmas"], rows)
    return "\n\n".join([" ".join(said), table])


def _table(names: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Cells with room beside them, which the window's own style leaves out."""
    lines = [names, ["---"] * len(names), *([f"&nbsp;{cell}&nbsp;&nbsp;" for cell in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _number(value: float) -> str:
    return f"{value:.1f}" if np.isfinite(value) else "-"
