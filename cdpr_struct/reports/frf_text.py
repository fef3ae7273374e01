"""A frequency response as text for a terminal."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.text import paragraphs, plain_table

_MOST_ROWS = 30


def frf_text(result: Mapping[str, Any]) -> str:
    """Peaks of every response, and how they compare with the eigenfrequencies."""
    x, y, z = (round(float(v), 4) + 0.0 for v in result["pose"][:3])
    title = (
        f"{result['robot']} at ({x:g}, {y:g}, {z:g}) m, cables {result['model']}, damping {result['damping']}: "
        f"{result['quantity']} under {result['excite']}, {result['frequencies']} frequencies"
    )
    return paragraphs(title, *(_peaks(result, response) for response in result["responses"]), frf_summary(result))


def frf_summary(result: Mapping[str, Any]) -> str:
    """How many eigenfrequencies lie in the band, and how many of them show as peaks."""
    modes, peaks = len(result["natural_frequencies_hz"]), len(result["peaks_hz"])
    proof = "certified complete by counting" if result["count_certified"] else "not certified"
    more = "" if result["all_modes_of_the_band"] else ", and more that were not listed"
    return f"{peaks} peaks in the band; the robot has {modes} eigenfrequencies there ({proof}){more}."


def _peaks(result: Mapping[str, Any], response: Mapping[str, Any]) -> str:
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
