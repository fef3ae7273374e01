"""Bands of one cable's frequencies: keys of result.json, table, checks, plate of the page."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.bands.cable_bands import NUMBERS, CableBands
from cdpr_struct.reports.bands_told import TAUT, differing, words_of_band
from cdpr_struct.reports.figures import cable_bands as figure
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import HtmlTable, Plate
from cdpr_struct.reports.text import plain_table
from cdpr_struct.reports.tolerances_told import defaults_used
from cdpr_struct.reports.trust import Check

CABLE_TOLERANCES = (
    "length_m", "anchor_m", "axial_stiffness", "linear_density", "load_cell_gain", "load_cell_bias_N",
)  # fmt: skip
"""Tolerances that one cable has."""
_PLANES = ("out_of_plane", "in_plane")
_TITLE = "Natural frequencies within the tolerances, exact catenary"
_HELD = {
    "force": "the force at the end is that of a load cell, and the end is where the force takes it",
    "ends": "both ends stand where their anchors are, and the force follows",
}
_UNUSED = {"force": ("anchor_m",), "ends": ("load_cell_gain", "load_cell_bias_N")}


def cable_bands_told(found: CableBands, drawn: np.ndarray | None, level: float) -> dict[str, Any]:
    """Bands [Hz] of either plane; drawn : (n, 2 k) frequencies of drawn cables, if there are any."""
    bands = np.stack([found.low, found.high], axis=-1)
    told: dict[str, Any] = {
        "exact_frequencies_hz": _by_plane(bands),
        "sigma_hz": _by_plane(found.sigma),
        "variance_shares": {name: _by_plane(part) for name, part in zip(NUMBERS, found.shares, strict=True)},
    }
    if drawn is None:
        return told
    ends = np.quantile(drawn, [0.5 - 0.5 * level, 0.5 + 0.5 * level], axis=0).T
    count = len(bands) // 2
    differ = [f"{_PLANES[(n - 1) // count]} {(n - 1) % count + 1}" for n in differing(bands, ends)]
    return told | {"samples": {"count": len(drawn), "exact_frequencies_hz": _by_plane(ends), "differ": differ}}


def _by_plane(values: np.ndarray) -> dict[str, np.ndarray]:
    return dict(zip(_PLANES, np.split(values, 2), strict=True))


def cable_bands_text(bands: Mapping[str, Any]) -> list[str]:
    """Table and note for a terminal."""
    return [plain_table(_TITLE, *_rows(bands)), _note(bands)]


def cable_bands_table(bands: Mapping[str, Any]) -> HtmlTable:
    """The same for the page."""
    return HtmlTable(_TITLE, *_rows(bands), _note(bands))


def cable_bands_plate(result: Mapping[str, Any]) -> Plate:
    """The picture on the page."""
    drawn = Drawing("bands", figure.SIZE, lambda empty: figure.draw_bands(empty, result))
    return Plate("bands", "Frequencies within the tolerances", drawn, figure.caption(result["bands"]))


def _rows(bands: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    drawn = bands.get("samples", {})
    rows = []
    for plane in _PLANES:
        for number, ends in enumerate(bands["exact_frequencies_hz"][plane]):
            starred = f"{plane} {number + 1}" in drawn.get("differ", ())
            shown = drawn["exact_frequencies_hz"][plane][number] if starred else ends
            shares = {name: share[plane][number] for name, share in bands["variance_shares"].items()}
            most = max(shares, key=lambda name: shares[name])
            rows.append(
                [
                    f"{plane.replace('_', ' ')} {number + 1}",
                    words_of_band(shown, 4, starred),
                    f"{bands['sigma_hz'][plane][number]:.2g}",
                    f"{most} ({100.0 * shares[most]:.0f} %)",
                ]
            )
    return ["", f"{bands['level']:g} % band [Hz]", "sigma [Hz]", "most of it from"], rows


def _note(bands: Mapping[str, Any]) -> str:
    held = bands["held"]
    text = (
        f"Bands: {bands['level']:g} % of cables whose numbers are off by their tolerances lie inside, each number by "
        f"itself; {_HELD[held]}."
    )
    stated = [name for name, row in bands["tolerances"].items() if row["stated"]]
    text += f" Tolerances given: {', '.join(stated)}." if stated else ""
    text += f" {defaults_used(bands['tolerances'], _UNUSED[held])}".rstrip()
    if differ := bands.get("samples", {}).get("differ"):
        named = ", ".join(name.replace("_", " ") for name in differ)
        text += (
            f" First order and drawn cables differ by more than a fifth of the band at: {named}; the bands marked * "
            "are theirs."
        )
    return text


def cable_band_checks(found: CableBands) -> list[Check]:
    """Whether the tension is linear within the tolerances."""
    margin = found.slack_sigmas
    said = (
        f"the force at the end has a sigma of {1.0 / max(margin, 1e-300):.2g} of itself: bands to first order do not "
        "hold; --samples 500 draws cables and shows theirs"
    )
    return [Check.of("tension in sigmas", margin, TAUT, said if margin < TAUT else None, at_least=True)]
