"""All causes by name, and which of them a campaign's data can show."""

import math
from collections.abc import Mapping
from dataclasses import replace
from importlib.metadata import entry_points

from cdpr_struct.errors import InputError, known_names
from cdpr_struct.hypotheses.causes import (
    accelerometers,
    cables,
    clocks,
    geometry,
    platform,
    pulleys,
    sensors,
    stiffness,
)
from cdpr_struct.hypotheses.causes.cause import Cause, Parameter, Seen

FAMILIES = (stiffness, geometry, pulleys, platform, cables, sensors, clocks, accelerometers)
LIBRARY: dict[str, Cause] = {cause.name: cause for family in FAMILIES for cause in family.CAUSES}

_CHECKED = 4.0  # sigmas of a check: no larger size is left
ENTRY_POINTS = "cdpr_struct.causes"
"""Group in which an installed package names its causes: each entry is a `Cause`, or a sequence of them."""


def register(*causes: Cause) -> None:
    """Add causes of one's own to the library, for all diagnoses of this process.

    Raises
    ------
    ValueError : there is a cause of this name already.
    """
    for cause in causes:
        if LIBRARY.setdefault(cause.name, cause) is not cause:
            raise ValueError(f"there is a cause called {cause.name!r} already: give yours another name")


def installed() -> None:
    """Register the causes of all installed packages; those that are known already stay."""
    for entry in entry_points(group=ENTRY_POINTS):
        found = entry.load()
        register(*([found] if isinstance(found, Cause) else found))


def require_known(source: str, checked: Mapping[str, float]) -> None:
    """Raises `InputError` if the table [checked] of a campaign file names what is no cause."""
    for name, sigma in checked.items():
        if name not in LIBRARY:
            expected = f"no such cause; {known_names(name.lower(), sorted(LIBRARY))}"
            raise InputError(source, f"checked.{name}", sigma, expected)


def testable(seen: Seen, checked: Mapping[str, float]) -> tuple[list[Cause], dict[str, str]]:
    """Causes that the data can show in principle, with priors no wider than a check has left, and why not the others.

    checked : by cause, one sigma of what it may still be, in the unit of its parameters
    """
    installed()
    found, hidden = [], {}
    for name, cause in LIBRARY.items():
        reason = cause.needs(seen) or ("" if set(cause.seen_in) & seen.kinds else "no effect on these kinds of data")
        if reason:
            hidden[name] = reason
        else:
            found.append(_bounded(cause, checked.get(name, math.inf), seen))
    return found, hidden


def _bounded(cause: Cause, sigma: float, seen: Seen) -> Cause:
    return replace(cause, parameters=tuple(_within(p, sigma, seen) for p in cause.parameters))


def _within(p: Parameter, sigma: float, seen: Seen) -> Parameter:
    """The parameter with the prior that it has in this campaign."""
    if p.in_band:
        return replace(p, prior=p.prior * seen.highest)
    left = math.sqrt(sigma) if p.squared else sigma
    return replace(p, prior=min(p.prior, left), most=min(p.most, _CHECKED * left))
