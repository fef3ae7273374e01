"""All causes by name, and which of them a campaign's data can show."""

import math
from collections.abc import Mapping
from dataclasses import replace

from cdpr_struct.diagnosis.hypotheses import accelerometers, cables, geometry, platform, sensors, stiffness
from cdpr_struct.diagnosis.hypotheses.cause import Cause, Seen
from cdpr_struct.errors import InputError, known_names

FAMILIES = (stiffness, geometry, platform, cables, sensors, accelerometers)
LIBRARY: dict[str, Cause] = {cause.name: cause for family in FAMILIES for cause in family.CAUSES}


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
    found, hidden = [], {}
    for name, cause in LIBRARY.items():
        reason = cause.needs(seen) or ("" if set(cause.seen_in) & seen.kinds else "not seen in these kinds of data")
        if reason:
            hidden[name] = reason
        else:
            found.append(_bounded(cause, checked.get(name, math.inf)))
    return found, hidden


def _bounded(cause: Cause, sigma: float) -> Cause:
    parameters = [replace(p, prior=min(p.prior, math.sqrt(sigma) if p.squared else sigma)) for p in cause.parameters]
    return replace(cause, parameters=tuple(parameters))
