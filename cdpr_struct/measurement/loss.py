"""What mistakes of a diagnosis cost: three numbers that a campaign file may give."""

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Loss:
    """What mistakes cost, in the unit of one name too many.

    wrong_name : a class in which no cause is there
    too_wide   : one more name in a class
    unknown    : a cause of the library that is not spoken of, be it beside others or by `adequate` or `unknown`
    """

    wrong_name: float = 20.0
    too_wide: float = 1.0
    unknown: float = 10.0

    @property
    def nats_of_a_class(self) -> float:
        """Log odds [nat] within which a rival belongs into a class: its name costs less than leaving it out."""
        return math.log(self.wrong_name / self.too_wide - 1.0)

    @property
    def least_said(self) -> float:
        """Probability from which a cause is rather said than left unknown."""
        return self.wrong_name / (self.wrong_name + self.unknown)

    def __post_init__(self) -> None:
        if not self.wrong_name > self.unknown > self.too_wide > 0.0:
            given = f"{self.wrong_name:g}, {self.unknown:g}, {self.too_wide:g}"
            raise ValueError(f"a loss needs wrong_name > unknown > too_wide > 0, got {given}")
