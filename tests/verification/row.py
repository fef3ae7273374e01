"""What a row of the verification page says."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Figure:
    """A measured result.

    text : the figure, with its unit
    met  : whether the acceptance is met
    """

    text: str
    met: bool


@dataclass(frozen=True, slots=True)
class Row:
    """One check of the program.

    case, reference, metric, acceptance : what is computed, beside what, by which number, and how large it may be
    figure  : reads the result, or None where nobody has measured it yet
    command : repeats the measurement
    test    : fails if the acceptance is not met
    twin    : feeds the same check something wrong, which must be seen; None where there is none
    source  : page that the figure is read from, or the day on which it was measured
    """

    case: str
    reference: str
    metric: str
    acceptance: str
    command: str
    test: str
    twin: str | None
    source: str
    figure: Callable[[], Figure] | None = None

    def result(self) -> str:
        """The cell of the table."""
        if self.figure is None:
            return "not measured"
        found = self.figure()
        return f"{found.text}: {'met' if found.met else '**not met**'}"


def measured(text: str, met: bool = True) -> Callable[[], Figure]:
    """A figure that stands on no page: typed here, with the day as source."""
    return lambda: Figure(text, met)
