"""What a published case is: one number that others print, and what model and referee say of it."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Case:
    """One number of the literature.

    title, source : what hangs or vibrates, and who printed the number
    quantity, unit : what the number is
    published : the number as printed
    accepted : largest relative deviation, and why: digits printed, data rounded, or a theory that leaves something out
    model, referee : the same number by `cdpr_struct` and by `cdpr_struct.fem_reference`
    """

    title: str
    source: str
    quantity: str
    unit: str
    published: float
    accepted: float
    because: str
    model: Callable[[], float]
    referee: Callable[[], float]

    @property
    def name(self) -> str:
        """Short name for lists of tests."""
        return f"{self.title}, {self.quantity}"
