"""Which columns of which files a correction of the data changes."""

import numpy as np

from cdpr_struct.hypotheses.correction import Correction
from cdpr_struct.measurement.campaign import Campaign


def corrected(entered: Campaign, correction: Correction) -> str:
    """The correction in words, with the columns and files to correct."""
    return correction.sentence + _columns(entered, correction)


def _columns(entered: Campaign, correction: Correction) -> str:
    """Columns that a correction changes, the files that hold them, and the factor if there is one."""
    places = []
    for sheet in entered.sheets:
        columns = changed_columns(entered, correction.campaign, sheet.kind)
        names = [sheet.headings.get(name, name) for name in sheet.columns if name in columns]
        places += [f"column {name} of {sheet.file}" for name in names]
    if not places:
        return ""
    factor = correction.parameters.get("factor")
    return f" (correct {', '.join(dict.fromkeys(places))}" + (f": times {factor:.4g})" if factor else ")")


def changed_columns(before: Campaign, after: Campaign, kind: str) -> set[str]:
    """Columns of a kind of file in which two campaigns differ; the pose is three of position and three of angles."""
    cables = range(1, before.states.tension.shape[1] + 1)
    names = {
        "tension": ["tension_N"], "length": ["length_m", *(f"length_{i}_m" for i in cables)],
        "position": ["x_m", "y_m", "z_m"], "angles": ["rx_deg", "ry_deg", "rz_deg"], "payload": ["payload_kg"],
        "swivel": ["swivel_deg", *(f"swivel_{i}_deg" for i in cables)],
    }  # fmt: skip
    found: set[str] = set()
    for field, columns in names.items():
        old, new = getattr(before.states, field), getattr(after.states, field)
        differ = np.isfinite(old) & np.isfinite(new) & (old != new)
        if field in ("position", "angles"):
            found |= {name for name, own in zip(columns, differ.T, strict=True) if own.any()}
        elif differ.any():
            found |= set(columns)
    own = "cable_frequencies" if kind == "cable_frequency" else "robot_frequencies"
    if not np.array_equal(getattr(before, own).hertz, getattr(after, own).hertz):
        found.add("frequency_hz")
    return found
