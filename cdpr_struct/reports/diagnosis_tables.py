"""Tables of a diagnosis as text, the same on the screen and on the page."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Table:
    """A titled table of ready-made text; the note says how to read it."""

    title: str
    columns: list[str]
    rows: list[list[str]]
    note: str = ""


def gain_table(gain: Mapping[str, Any]) -> Table | None:
    """What was left out, predicted from the rest: the same readings and the same unit as the gain that is claimed."""
    if not gain["per_kind"]:
        return None
    rows = [
        [kind, f"{g['counted']} of {g['of']}", f"{g['before_sigmas']:.2f}", f"{g['after_sigmas']:.2f}",
         f"{g['ratio']:.2f}"]
        for kind, g in gain["per_kind"].items()
    ]  # fmt: skip
    together = [gain["heldout_rms_before"], gain["heldout_rms_after"], gain["ratio"]]
    rows.append(["all of these", f"{gain['counted']} of {gain['of']}", *(f"{v:.2f}" for v in together)])
    note = "Counted are the readings that the causes, fitted to the rest, change by more than one sigma."
    if not gain["confirmed"]:
        note += " This does not confirm the causes, so nothing is claimed from it."
    title = f"Each {gain['left_out']} predicted from the others, rms error in sigmas"
    return Table(title, ["kind", "counted", "before", "after", "times smaller"], rows, note)
