"""What a campaign says about the analysis of an ambient record; what it leaves open is chosen by the analysis."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from cdpr_struct.errors import InputError

_KEYS = ("band_hz", "order", "frequencies_hz")


@dataclass(frozen=True, slots=True)
class AmbientChoice:
    """The user's choice.

    band        : lowest and highest frequency [Hz], None: what the record shows
    order       : number of states of the model whose poles are taken, None: poles that are stable over many orders
    frequencies : [Hz] of the modes wanted, (): all
    """

    band: tuple[float, float] | None = None
    order: int | None = None
    frequencies: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if self.band is not None and not 0.0 <= self.band[0] < self.band[1]:
            raise InputError("band_hz", "", list(self.band), "two frequencies in Hz, the lower one first")
        if self.order is not None and (self.order < 2 or self.order % 2):
            raise InputError("order", "", self.order, "an even number of states: two for each mode, and more for noise")
        if any(not f > 0.0 for f in self.frequencies):
            raise InputError("frequencies_hz", "", list(self.frequencies), "frequencies in Hz above zero")


def given_choice(ambient: bool, given: Mapping[str, Any], source: str, place: str) -> list[AmbientChoice]:
    """The choice that a measurement of a campaign file makes, by the names of its keys; none of data of another kind.

    ambient : whether it is a file of ambient records;  place : of the measurement in the campaign file

    Raises
    ------
    InputError : such a key beside other data, or a value that makes no sense.
    """
    if not ambient:
        for name in _KEYS:
            if given[name] is not None:
                raise InputError(source, f"{place}.{name}", given[name], 'this key beside kind = "ambient" only')
        return []
    band = given["band_hz"]
    try:
        return [AmbientChoice(band and (band[0], band[1]), given["order"], tuple(given["frequencies_hz"] or ()))]
    except InputError as error:
        raise InputError(source, f"{place}.{error.source}", error.value, error.expected) from error
