"""A frequency response as text for a terminal."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.text import paragraphs, place, plain_table

_MOST_ROWS = 30
SILENT = "does not answer beyond rounding errors"


def frf_text(result: Mapping[str, Any]) -> str:
    """Peaks of every response, and how they compare with the eigenfrequencies."""
    title = (
        f"{result['robot']} at {place(result['pose'][:3])}, cables {result['model']}, damping {result['damping']}: "
        f"{result['quantity']} under {result['excite']}, {result['frequencies']} frequencies"
    )
    return paragraphs(title, *(_peaks(result, response) for response in result["responses"]), frf_summary(result))


def frf_summary(result: Mapping[str, Any]) -> str:
    """How many eigenfrequencies lie in the band, and how many of them show as peaks."""
    modes, peaks = len(result["natural_frequencies_hz"]), len(result["peaks_hz"])
    proof = "certified complete by counting" if result["count_certified"] else "not certified"
    peak = "1 peak" if peaks == 1 else f"{peaks} peaks"
    if not result["all_modes_of_the_band"]:
        return f"{peak} in the band; the robot has at least {modes} eigenfrequencies there, more than are listed."
    return f"{peak} in the band; the robot has {modes} eigenfrequencies there ({proof})."


def _peaks(result: Mapping[str, Any], response: Mapping[str, Any]) -> str:
    if response["silent"]:
        return f"{response['respond']} [{response['unit']}]: {SILENT}."
    rows = []
    for hertz, size in list(zip(response["peaks_hz"], response["peak_magnitudes"], strict=True))[:_MOST_ROWS]:
        near, kind = nearest_mode(result, hertz)
        rows.append([f"{hertz:.4f}", f"{size:.4g}", "-" if near is None else f"{near:.4f}", kind])
    hidden = len(response["peaks_hz"]) - len(rows)
    title = f"{response['respond']} [{response['unit']}]" + (
        f", first {_MOST_ROWS} of {len(response['peaks_hz'])}" if hidden > 0 else ""
    )
    return plain_table(title, ["peak [Hz]", "magnitude", "nearest mode [Hz]", "kind"], rows)


def nearest_mode(result: Mapping[str, Any], hertz: float) -> tuple[float | None, str]:
    """The eigenfrequency [Hz] next to a peak, and its kind; (None, "") if the band holds none."""
    modes = result["natural_frequencies_hz"]
    if len(modes) == 0:
        return None, ""
    index = min(range(len(modes)), key=lambda i: abs(modes[i] - hertz))
    return float(modes[index]), result["kinds"][index]
