"""Modes of a robot as text and as columns of a table."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.reports.backbone_text import backbone_text
from cdpr_struct.reports.bands_told import band_columns, band_note, band_words
from cdpr_struct.reports.text import paragraphs, plain_table

_AXES = ("x_m", "y_m", "z_m", "rx_rad", "ry_rad", "rz_rad")


def modes_text(result: Mapping[str, Any]) -> str:
    """Table of modes, and whether the count is certified."""
    rows = [
        [str(i), f"{hertz:.6f}", f"{100.0 * share:.1f}", kind, words]
        for i, (hertz, share, kind, words) in enumerate(
            zip(*(result[key] for key in ("frequencies_hz", "platform_energy", "kinds", "motion_words")), strict=True),
            start=1,
        )
    ]
    x, y, z = (round(v, 4) + 0.0 for v in result["pose"][:3])
    title = f"{result['robot']} at ({x:g}, {y:g}, {z:g}) m, model {result['model']}, assembly {result['assembly']}"
    certified = (
        "The count is certified: no eigenfrequency below the last one is missing."
        if result["count_certified"]
        else "The count could not be certified."
    )
    names = ["mode", "[Hz]", "platform energy [%]", "kind", "platform motion"]
    noted = []
    if bands := result.get("bands"):
        names.insert(2, f"{bands['level']:g} % band [Hz]")
        rows = [
            [*row[:2], words, *row[2:]] for row, words in zip(rows, band_words(bands, "frequencies_hz", 4), strict=True)
        ]
        noted = [band_note(bands)]
    table = plain_table(title, names, rows)
    large = [backbone_text(result["large_motion"])] if "large_motion" in result else []
    return paragraphs(table, *large, *noted, certified)


def modes_sentence(result: Mapping[str, Any]) -> str:
    """The range of the frequencies, and whether their count is certified."""
    hertz, count = result["frequencies_hz"], len(result["frequencies_hz"])
    range_text = f"The first {count} eigenfrequencies lie between {hertz[0]:.4g} and {hertz[-1]:.4g} Hz"
    if count == 1:
        range_text = f"The first eigenfrequency is {hertz[0]:.4g} Hz"
    if result["count_certified"]:
        return f"{range_text}; the count is certified, none below the last one is missing."
    return f"{range_text}; the count could not be certified, some may be missing."


def modes_columns(result: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of modes.csv, one row a mode."""
    return {
        "mode": range(1, len(result["frequencies_hz"]) + 1),
        "frequency_hz": result["frequencies_hz"],
        "platform_energy": result["platform_energy"],
        "kind": result["kinds"],
        **(band_columns(result["bands"], "frequencies_hz", "frequency", "hz") if "bands" in result else {}),
    }


def motion_columns(result: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of platform_motion.csv, one row a mode.

    Motion [m, rad], the largest component of the whole mode 1; shares of the directions in the platform's own energy.
    """
    motion, shares = (np.asarray(result[key], dtype=float) for key in ("motion", "platform_directions"))
    return {
        "mode": range(1, len(motion) + 1),
        "platform_motion": result["motion_words"],
        **dict(zip(_AXES, motion.T, strict=True)),
        **{f"share_{name.partition('_')[0]}": share for name, share in zip(_AXES, shares.T, strict=True)},
    }
