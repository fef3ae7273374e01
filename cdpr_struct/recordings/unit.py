"""Units that recordings come in, and the factors to those of a campaign: m, N, rad and s."""

import re
from collections.abc import Mapping
from math import pi
from typing import Literal

from cdpr_struct.errors import NOTHING, InputError, known_names

Kind = Literal["length", "force", "angle", "time"]
_FACTORS: Mapping[Kind, Mapping[str, float]] = {
    "length": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "um": 1e-6, "in": 0.0254, "ft": 0.3048},
    "force": {"N": 1.0, "kN": 1e3, "daN": 10.0, "mN": 1e-3, "kgf": 9.80665, "lbf": 4.4482216152605},
    "angle": {"rad": 1.0, "deg": pi / 180.0, "mrad": 1e-3},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0},
}
_ALSO = {
    "µm": "um", "μm": "um", "°": "deg", "degree": "deg", "degrees": "deg", "radian": "rad", "radians": "rad",
    "µs": "us", "μs": "us", "sec": "s", "second": "s", "seconds": "s", "meter": "m", "metre": "m", "newton": "N",
    "inch": "in", "kp": "kgf", "n": "N", "kn": "kN", "msec": "ms",
}  # fmt: skip
_IN_BRACKETS = re.compile(r"\s*[\[(]([^\])]*)[\])]\s*$")
_AT_THE_END = re.compile(r"_(mm|cm|um|m|kN|daN|N|deg|rad|mrad|ms|us|ns|s)$")


def called(unit: str) -> str:
    """A unit by the name it has here; as it is where none is known."""
    plain = unit.strip().strip("[]()").strip()
    if any(plain in factors for factors in _FACTORS.values()):
        return plain
    return _ALSO.get(plain, _ALSO.get(plain.lower(), plain))


def kind_of(unit: str) -> Kind | None:
    """What is measured in a unit; None if it is not known."""
    return next((kind for kind, factors in _FACTORS.items() if called(unit) in factors), None)


def unit_in_name(name: str) -> str:
    """The unit that a heading has in brackets, or at its end as in x_mm; "" if there is none."""
    if found := _IN_BRACKETS.search(name):
        return found[1].strip()
    ending = _AT_THE_END.search(name)
    return ending[1] if ending else ""


def factor(unit: str, kind: Kind, source: str, field: str) -> float:
    """What readings in a unit are multiplied by.

    Raises
    ------
    InputError : no unit is given, or it is none of this kind.
    """
    known = _FACTORS[kind]
    if not unit:
        raise InputError(
            source, field, NOTHING, f"the unit of these channels, which the file does not say: {_of(kind)}"
        )
    if called(unit) not in known:
        raise InputError(source, field, unit, f"a unit of {kind}; {known_names(unit, list(known))}")
    return known[called(unit)]


def _of(kind: Kind) -> str:
    return ", ".join(_FACTORS[kind])
