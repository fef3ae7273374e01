"""Measured against predicted, state by state, in newtons, millimetres and hertz: as entered, and with the causes."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.diagnosis.left_out import LeftOut
from cdpr_struct.reports.html import HtmlTable

PHYSICAL = {
    "EQ": ("wrench balance", "N"), "CO": ("cable lengths", "mm"), "CF": ("cable frequencies", "Hz"),
    "RF": ("robot frequencies", "Hz"), "SW": ("swivel angles", "deg"),
}  # fmt: skip
"""Kinds of rows that have a physical unit: name and unit. Moments of the balance are over the platform's radius."""

_FACTOR = {"CO": 1e3, "SW": np.degrees(1.0)}


def state_errors(found: Diagnosis) -> list[dict[str, Any]]:
    """Root mean square of each kind of reading in each state; `after` is null where the verdict has no causes."""
    changed = bool(found.chosen.hypothesis.parts) or found.correction is not None
    rows = []
    for kind, (name, unit) in PHYSICAL.items():
        for state in np.unique(found.recorded.state[found.recorded.kind == kind]).tolist():
            after = _rms(found.residuals, kind, state, found.residuals.after) if changed else None
            rows.append({
                "case": found.campaign.states.names[state], "kind": name, "unit": unit,
                "before": _rms(found.recorded, kind, state, found.recorded.before), "after": after,
            })  # fmt: skip
    return rows


def _rms(rows: LeftOut, kind: str, state: int, values: np.ndarray) -> float | None:
    own = (rows.kind == kind) & (rows.state == state)
    if not own.any():
        return None
    factor = rows.hertz[own] if PHYSICAL[kind][1] == "Hz" else _FACTOR.get(kind, 1.0)
    sure = rows.sigma[own] ** -2 if kind == "RF" else None  # a mode counts as far as a peak is its own
    return float(np.sqrt(np.average((factor * values[own]) ** 2, weights=sure)))


def state_table(result: Mapping[str, Any], most: int | None = None) -> HtmlTable | None:
    """Errors in physical units, before and with the causes; on a screen the `most` largest of each kind."""
    rows = result["errors_by_state"]
    kinds = dict.fromkeys(row["kind"] for row in rows)
    ranked = [sorted((r for r in rows if r["kind"] == kind), key=lambda row: -row["before"])[:most] for kind in kinds]
    cells = [
        [row["kind"], row["case"], f"{row['before']:.3g}", "" if row["after"] is None else f"{row['after']:.3g}",
         row["unit"]]
        for own in ranked for row in own
    ]  # fmt: skip
    columns = ["kind", "case", "as entered", "with the causes", "unit"]
    note = "Rms of measured less predicted at the measured pose and tensions; moments over the platform's radius."
    return HtmlTable("Errors by state", columns, cells, note, prose=frozenset({1, 4})) if cells else None


def tension_table(result: Mapping[str, Any], most: int | None = None) -> HtmlTable | None:
    """Measured against simulated tensions, state by state; on a screen the `most` that differ most."""
    own = result["internal_force"]
    if own is None:
        return None
    ranked = sorted(own["states"], key=lambda row: -row["rms_N"])
    cells = [
        [row["case"], *(f"{row[key]:.3g}" for key in ("rms_N", "internal_rms_N", "balance_rms_N")),
         f"{row['internal_percent']:.0f}"]
        for row in ranked[:most]
    ]  # fmt: skip
    more = len(ranked) - len(cells)
    note = "Internal force does no work on the platform; the rest has to balance. Share of the squared difference."
    note = f"{more} more states differ by {ranked[-1]['rms_N']:.3g} N or more. {note}" if more > 0 else note
    columns = ["case", "rms [N]", "internal force [N]", "rest [N]", "internal share [%]"]
    return HtmlTable("Measured against simulated tensions", columns, cells, note)
