"""Quantities that a table may hold in one column a cable: their columns' names, and how these are counted."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class CableQuantity:
    """A quantity of each cable.

    name  : as people say it, in the plural `names`
    long  : its column where a row is a cable; where a row is a pose, cable i has the column `before` i `after`
    unit  : with what must be said of it
    """

    name: str
    names: str
    long: str
    before: str
    after: str
    unit: str

    def column(self, cable: int) -> str:
        """Name of the column of a cable, from 1."""
        return f"{self.before}{cable}{self.after}"

    def columns(self, cables: int) -> list[str]:
        """Names of all columns."""
        return [self.column(i) for i in range(1, cables + 1)]

    def span(self, cables: int) -> str:
        """All columns in short."""
        return f"{self.column(1)} ... {self.column(cables)}"

    def number(self, name: str) -> int | None:
        """Number of the cable, from 1, that a column of this quantity belongs to; None for other columns."""
        digits = name.removeprefix(self.before).removesuffix(self.after)
        return int(digits) if digits.isdecimal() and len(digits) <= 4 and name == self.column(int(digits)) else None


TENSION = CableQuantity("tension", "tensions", "tension_N", "tension_", "_N", "N, at the platform")
LENGTH = CableQuantity("length", "lengths", "length_m", "length_", "_m", "m, unstrained, paid out")
SWIVEL = CableQuantity("swivel angle", "swivel angles", "swivel_deg", "swivel_", "_deg", "deg, of the pulley")
FREQUENCY = CableQuantity("frequency", "frequencies", "frequency_hz", "frequency_", "_hz", "Hz")
APPROACH = CableQuantity("direction", "directions", "approach", "approach_", "", "+1 or -1")
QUANTITIES: dict[str, tuple[CableQuantity, ...]] = {
    "static_state": (TENSION, LENGTH, SWIVEL, APPROACH),
    "loaded_pose": (LENGTH, SWIVEL),
    "cable_frequency": (FREQUENCY, TENSION),
    "free_decay": (LENGTH,),
    "platform_motion": (LENGTH,),
}
"""Quantities that a file of each kind may have in one column a cable."""
EITHER: dict[str, tuple[CableQuantity, ...]] = {
    "static_state": (TENSION, LENGTH, SWIVEL),
    "cable_frequency": (FREQUENCY,),
}
"""Kinds in which a row may be a cable or a pose, and the quantities of which a row that is a pose has one."""
