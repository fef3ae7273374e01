"""A frequency response as text for a terminal."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.dynamics.resonances import PEAK_REACH
from cdpr_struct.reports.text import paragraphs, place, plain_table

_MOST_ROWS = 30
SILENT = "does not answer beyond rounding errors"
UNBOUNDED = "unbounded (no damping)"
WIDTH, RATIO = "half-power width [Hz]", "damping ratio"


def frf_text(result: Mapping[str, Any]) -> str:
    """Damping, peaks of every response, and how they compare with the eigenfrequencies."""
    title = (
        f"{result['robot']} at {place(result['pose'][:3])}, cables {result['model']}, damping {result['damping']}: "
        f"{result['quantity']} under {result['excite']}, {result['frequencies']} frequencies"
    )
    blocks = (_peaks(result, response) for response in result["responses"])
    return paragraphs(f"{title}\n{result['damping_note']}", *blocks, frf_summary(result))


def frf_summary(result: Mapping[str, Any]) -> str:
    """How many eigenfrequencies lie in the band, and how many of them show as peaks."""
    modes, peaks = len(result["natural_frequencies_hz"]), len(result["peaks_hz"])
    proof = "certified complete by counting" if result["count_certified"] else "not certified"
    if not result["all_modes_of_the_band"]:
        last = result["natural_frequencies_hz"][-1]
        peak = "1 peak" if peaks == 1 else f"{peaks} peaks"
        return (
            f"{peak} in the band; the robot has at least {modes} eigenfrequencies there, more than are listed. Above "
            f"{last:.4g} Hz peaks are only as fine as the step of the band."
        )
    seen = len({nearest_mode(result, float(hertz)) for one in result["responses"] for hertz in one["peaks_hz"]})
    show = "shows as a peak" if seen == 1 else "show as peaks"
    return f"The robot has {modes} eigenfrequencies in the band ({proof}); {seen} of them {show}."


def _peaks(result: Mapping[str, Any], response: Mapping[str, Any]) -> str:
    if response["silent"]:
        return f"{response['respond']} [{response['unit']}]: {SILENT}."
    every = peak_rows(result, response)
    if not every:
        return f"{response['respond']} [{response['unit']}]: no peak in the band."
    rows = every[:_MOST_ROWS]
    hidden = len(every) - len(rows)
    title = f"{response['respond']} [{response['unit']}]" + (
        f", first {_MOST_ROWS} of {len(every)}" if hidden > 0 else ""
    )
    columns = ["peak [Hz]", "magnitude", WIDTH, RATIO, "nearest mode [Hz]", "kind"]
    return plain_table(title, columns, rows)


def peak_rows(result: Mapping[str, Any], response: Mapping[str, Any]) -> list[list[str]]:
    """Frequency, magnitude, half-power width, damping ratio, nearest mode and its kind of every peak, as text."""
    rows = []
    columns = ("peaks_hz", "peak_magnitudes", "half_power_widths_hz", "damping_ratios")
    for hertz, size, width, ratio in zip(*(response[name] for name in columns), strict=True):
        near, kind = nearest_mode(result, float(hertz))
        magnitude = UNBOUNDED if math.isinf(size) else f"{size:.4g}"
        wide = ["-", "-"] if math.isnan(width) else [f"{width:.3g}", f"{ratio:.3g}"]
        rows.append([f"{hertz:.4f}", magnitude, *wide, "-" if near is None else f"{near:.4f}", kind])
    return rows


def nearest_mode(result: Mapping[str, Any], hertz: float) -> tuple[float | None, str]:
    """The eigenfrequency [Hz] that a peak belongs to, and its kind; (None, "") if the band holds none.

    The nearest of those within ten half widths of the peak, as far as peaks are looked for about a mode; the nearest of
    all if there is none.
    """
    modes = np.asarray(result["natural_frequencies_hz"], dtype=float)
    if not (modes > 0.0).any():
        return None, ""
    apart = np.abs(modes - hertz)
    own = apart <= PEAK_REACH * np.asarray(result["natural_damping_ratios"], dtype=float) * modes
    index = int(np.where(own, apart, np.inf).argmin() if own.any() else apart.argmin())
    return float(modes[index]), result["kinds"][index]
