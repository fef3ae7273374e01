"""Frequencies of platform modes over their amplitude: as JSON, text, columns of a table, and how far to trust them."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.dynamics.backbone import BackboneCurves
from cdpr_struct.reports.text import plain_table
from cdpr_struct.reports.trust import Check


def backbone_told(curves: BackboneCurves) -> dict[str, Any]:
    """What `modes` gives under `large_motion`; modes are numbered from 1."""
    return {
        "amplitudes_m": curves.amplitudes,
        "modes": curves.modes + 1,
        "frequencies_hz": curves.hertz,
        "slack": curves.slack,
    }


def backbone_text(large: Mapping[str, Any]) -> str:
    """Table: a mode a row, an amplitude a column."""
    title = "In large motion, each mode alone: frequency [Hz] at an amplitude of the platform end that moves most"
    names = ["mode", *(f"{1e3 * a:g} mm" for a in large["amplitudes_m"])]
    both = zip(large["modes"], large["frequencies_hz"], large["slack"], strict=True)
    rows = [[str(mode), *map(_cell, hertz, slack)] for mode, hertz, slack in both]
    if not rows:
        return "In large motion: none of these modes is the platform's alone."
    note = "\n* a cable goes slack on the way; take the number as an estimate" if np.any(large["slack"]) else ""
    return plain_table(title, names, rows) + note


def _cell(hertz: float, slack: bool) -> str:
    return f"{hertz:.6f}{'*' if slack else ''}" if np.isfinite(hertz) else "-"


def backbone_columns(large: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of large_motion.csv, one row a mode and amplitude."""
    count, modes = len(large["amplitudes_m"]), np.asarray(large["modes"], dtype=int)
    return {
        "mode": np.repeat(modes, count),
        "amplitude_m": np.tile(large["amplitudes_m"], len(modes)),
        "frequency_hz": np.ravel(large["frequencies_hz"]),
        "slack": np.ravel(large["slack"]),
    }


def backbone_checks(curves: BackboneCurves | None) -> list[Check]:
    """What limits the frequencies of large motion."""
    if curves is None:
        return []
    lost = int(np.isnan(curves.hertz).sum())
    missing = "large motion: for some amplitudes no periodic motion was found; they are too large for the mode to last."
    ringing = curves.modes[curves.ringing] + 1
    heavy = (
        f"large motion: cables have frequencies below three times those of modes {', '.join(map(str, ringing))}. They "
        "vibrate with the harmonics, which is left out: shifts of these modes are estimates."
    )
    return [
        Check.of("amplitudes without a periodic motion", lost, 0.0, missing if lost else None),
        Check.of("modes near the cables' own frequencies", len(ringing), 0.0, heavy if len(ringing) else None),
    ]
