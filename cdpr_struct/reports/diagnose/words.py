"""Causes with their sizes, readings and places, in words for a person."""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.diagnosis.diagnosis import DAMPING, NULL_SPACE, Location
from cdpr_struct.diagnosis.recommended import Recommendation
from cdpr_struct.diagnosis.sensor_sigmas import Doubt
from cdpr_struct.diagnosis.whole_sizes import WholeSize
from cdpr_struct.hypotheses.causes.cause import Pattern

_FEW = 3  # numbers that a sentence lists

PLACES = {
    "EQ": "the wrench balance (forces and moments on the platform)", "CO": "the cable lengths",
    "CF": "the cable frequencies", "RF": "the robot frequencies",
    "FA": "the modal constants of the FRFs", "SW": "the swivel angles of the pulleys", DAMPING: "the damping ratios",
    NULL_SPACE: "the internal forces (null space of the structure matrix)",
}  # fmt: skip


def described(size: WholeSize) -> str:
    """The cause's sentence with its size; a single number with its sign, and what the sign means.

    far : mean square length of vectors of three numbers, or of the only one of fewer;  parts : one length a unit
    named : each number with its name, of many their size
    """
    cause, pattern, value = size.part.cause, size.part.pattern, size.mean
    first = pattern.parameters[0].shown(float(value[0]), 0.0)
    rms, norm = float(np.sqrt(np.mean(value**2))), float(np.linalg.norm(value))
    single = len(value) == 1
    words = {
        "value": f"{first['value']:.3g}", "percent": _per_cent(float(np.exp(value.mean()))),
        "rms": f"{value[0]:+.2g}" if single else f"{rms:.2g}", "norm": f"{norm:.2g}", "unit": str(first["unit"]),
        "far": f"{value[0]:+.2g}" if single else f"{norm / np.sqrt(max(len(value) // 3, 1)):.2g}",
        "size": f"{abs(value.mean()):.3g}", "sense": cause.senses[int(value.mean() < 0.0)],
        "parts": _by_unit(pattern, value), "named": _by_name(pattern, value),
    }  # fmt: skip
    text = cause.sentence.format(**words)
    text = text.replace(" on average", "") if single else text
    notes = [pattern.label, cause.sign if single and "{sense}" not in cause.sentence else ""]
    if "{percent}" in cause.sentence and not single:
        notes.append(f"from {_per_cent(float(np.exp(value.min())))} to {_per_cent(float(np.exp(value.max())))}")
    note = ", ".join(filter(None, notes))
    return f"{text} ({note})" if note else text


def listed(names: Sequence[str], last: str = "and") -> str:
    """Names of causes as "a, b and c"."""
    *first, end = (plain(name) for name in names)
    return f"{', '.join(first)} {last} {end}" if first else end


def plain(name: str) -> str:
    """A name without underscores."""
    return name.replace("_", " ")


def quantity(kind: str, hertz: float | None = None) -> str:
    """What a kind of readings is called, and at which frequency one of them was."""
    name = {"frf": "modal constant"}.get(kind, plain(kind))
    return f"{name} at {hertz:.4g} Hz" if hertz else name


def reading(kind: str, case: str, cable: int, hertz: float = 0.0) -> str:
    """Which reading it is; cable from 0, -1 for none; frequency [Hz], 0 for none."""
    of = f" of cable {cable + 1}" if cable >= 0 else ""
    return f"the {quantity(kind, hertz)}{of} in case {case}"


def place(where: Location | None) -> str:
    """Where the error sits: kind of rows, case and cable."""
    if where is None:
        return ""
    cable = f", cable {where.cable + 1}" if where.cable >= 0 else ""
    return PLACES[where.rows] + (f", most in case {where.case}{cable}" if where.case else "")


def recommendation(one: Recommendation) -> str:
    """What to measure next, without full stop."""
    if one.purpose == "repeat":
        return f"measure {reading(one.kind, one.case, one.cable, one.hertz)} again"
    nats = "" if one.nats is None else f", expected {one.nats:.0f} nats"
    why = {
        "tell_apart": "tests", "confirm": "confirms or refutes", "find": "tests",
    }[one.purpose]  # fmt: skip
    return f"{one.measurement} ({why} {listed(one.causes)}{nats})"


def doubt(one: Doubt) -> str:
    """What is odd about a sigma or tolerance."""
    size = "large" if one.large else "small"
    if one.about == "errors" and one.large:
        return (
            f"The {quantity(one.name)} readings scatter by {one.words} times their stated sigma, outliers apart "
            f"(p = {one.probability:.0e} if it was right). The larger sigma was used; check the stated one."
        )
    if one.about == "errors":
        return (
            f"The errors of the {plain(one.name)} readings are improbably small (p = {one.probability:.0e}; their "
            f"scatter is {one.words} times the stated sigma). Check the unit and size of the stated sigmas."
        )
    if one.about == "tolerance":
        asked = f"in {one.unit}" if one.unit else "relative to the value"
        return f"the tolerance {one.name}, {one.words}, is very {size}: is it {asked}?"
    return f"sigma.{one.name} of {one.file}, {one.words}, is very {size}: is it in {one.unit}?"


def _by_unit(pattern: Pattern, value: np.ndarray) -> str:
    """Length of the vector that the numbers of each unit make, as "0.002 m and 0.001 rad"."""
    units = np.array([p.unit for p in pattern.parameters])
    squared = {p.unit for p in pattern.parameters if p.squared}
    roots = {str(unit): np.linalg.norm(value[units == unit]) for unit in dict.fromkeys(units.tolist())}
    sizes = {unit: size**2 if unit in squared else size for unit, size in roots.items()}
    return " and ".join(f"{size:.2g} {unit}" for unit, size in sizes.items())


def _by_name(pattern: Pattern, value: np.ndarray) -> str:
    """Few numbers as "exponent 0.3, level 1.2"; of more the root mean square of each kind."""
    kinds = [p.name.rstrip("0123456789").rstrip("_") for p in pattern.parameters]
    if len(kinds) <= _FEW:
        told = [(p.name, p.shown(float(v), 0.0)) for p, v in zip(pattern.parameters, value, strict=True)]
        return ", ".join(f"{plain(name)} {one['value']:.3g} {_unit(str(one['unit']))}".strip() for name, one in told)
    units = dict(zip(kinds, (p.unit for p in pattern.parameters), strict=True))
    sizes = {kind: np.sqrt(np.mean(value[np.array(kinds) == kind] ** 2)) for kind in units}
    return ", ".join(
        f"{plain(kind)} {size:.2g} {_unit(units[kind])}".strip() + " on average" for kind, size in sizes.items()
    )


def _unit(unit: str) -> str:
    return "" if unit in ("1", "ratio") else unit


def _per_cent(ratio: float) -> str:
    """A ratio in per cent; what is near one keeps its digits."""
    return f"{100.0 * ratio:.{1 if abs(ratio - 1.0) > 0.01 else 3}f} %"
