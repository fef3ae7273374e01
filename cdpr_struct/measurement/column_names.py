"""Headers as people write them: which known column each name perhaps means, said as a renaming; no unit is guessed."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from cdpr_struct.measurement.cable_columns import FREQUENCY, LENGTH, QUANTITIES, TENSION, CableQuantity

_UNITS = {
    "n": TENSION, "kn": TENSION, "dan": TENSION, "lbf": TENSION, "lb": TENSION, "kgf": TENSION, "kg": TENSION,
    "m": LENGTH, "mm": LENGTH, "cm": LENGTH, "ft": LENGTH, "in": LENGTH, "hz": FREQUENCY, "khz": FREQUENCY,
}  # fmt: skip
_OURS = ("n", "m", "hz")
_WORDS = {
    TENSION: {"t", "f", "tension", "force", "load", "kraft", "seilkraft", "tensioncable", "forcecable"}
    | {f"{body}{what}" for body in ("cable", "rope", "wire") for what in ("tension", "force", "load")},
    LENGTH: {"l", "length", "lengthcable", "laenge", "länge", "seillänge", "cablelength", "ropelength", "wirelength"},
    FREQUENCY: {"f", "freq", "frequency", "frequenz", "cablefrequency", "frequencycable"},
}
_ANY = {"", "cable", "rope", "wire", "seil", "c"}  # one reading a cable, but of what?
_ALIASES = {"t": "time_s"}
_LONGEST = 80  # characters of a name that is compared with known ones
_NUMBERED = re.compile(r"(\D*)(\d{1,4})(\D*)")
_PARTS = re.compile(r"[^\W\d_]+")
_FOREIGN = {  # unit at the end of a known column, and others that its readings often have
    "m": ("mm", "cm", "ft", "in"), "deg": ("rad",), "N": ("kn", "lbf", "kg"), "hz": ("khz",), "kg": ("g", "lb"),
    "s": ("ms",), "K": ("c", "degc"),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Group:
    """Columns that differ in the cable's number only: their names in its order, the word and the unit ("")."""

    names: tuple[str, ...]
    word: str
    unit: str

    def __str__(self) -> str:
        return f"{self.names[0]} ... {self.names[-1]}"


def renaming(names: Sequence[str], known: Sequence[str], kind: str = "", cables: int = 0) -> tuple[str, str]:
    """Names of a header that perhaps mean known columns, and how to rename them; twice "" if there are none.

    known : columns that the file may have
    kind, cables : of the measured data, and of the robot; for columns that a file has once per cable
    """
    unknown = [name for name in names if 0 < len(name) <= _LONGEST and name not in known]
    free = [name for name in dict.fromkeys(known) if name not in names]
    found, said = [], []
    for group in _groups(unknown):
        if words := _as_cables(group, kind, cables):
            found.append(str(group))
            said.append(words)
            unknown = [name for name in unknown if name not in group.names]
    pairs = [(name, meant) for name in unknown if (meant := _meant(name, free))]
    if pairs:
        found.append(", ".join(name for name, _ in pairs))
        said.append("rename " + ", ".join(f"{name} to {meant}{_unit(name, meant)}" for name, meant in pairs))
    return ", ".join(found), "; ".join(said)


def _squashed(name: str) -> str:
    """Letters and digits of a name, in lower case."""
    return re.sub(r"[\W_]", "", name).lower()


def _meant(name: str, free: Sequence[str]) -> str:
    """The known column that differs in case, spaces and signs only, or in its unit; "" if there is none."""
    own = _squashed(name)
    same = [k for k in free if _squashed(k) == own]
    same = same or [k for k in free if own in {_squashed(_stem(k)) + unit for unit in ("", *_foreign(k))}]
    same = same or [k for k in free if _in_other_unit(name, k)]
    if not same and _ALIASES.get(name) in free:
        return _ALIASES[name]
    return same[0] if len(same) == 1 else ""


def _in_other_unit(name: str, known: str) -> str:
    """The other unit that stands in a name beside all of a known column's, as in tension_kN_1_N; "" if none does."""
    own, ours = (re.findall(r"[^\W\d_]+|\d+", text) for text in (name, known))
    for unit in (part for part in own if part.lower() in _foreign(known)):
        rest = [part for part in own if part is not unit]
        if rest in (ours, ours[:-1]):
            return unit
    return ""


def _stem(name: str) -> str:
    """A known column without its unit."""
    return name.rpartition("_")[0] if name.rpartition("_")[2] in _FOREIGN else name


def _foreign(name: str) -> tuple[str, ...]:
    """Other units that the readings of a known column often have."""
    return _FOREIGN.get(name.rpartition("_")[2], ())


def _unit(name: str, meant: str) -> str:
    """The unit to be told where the name given has none, or another one."""
    own, ours = _squashed(name), meant.rpartition("_")[2]
    if own == _squashed(meant):
        return ""
    other = next((unit for unit in _foreign(meant) if own == _squashed(_stem(meant)) + unit), "")
    other = other or _in_other_unit(name, meant)
    return f" ({'Hz' if ours == 'hz' else ours}{_conversion(name, other)})"


def _conversion(name: str, unit: str) -> str:
    """What to do with values in a unit (lower case, "" for ours), which is called as in the column's name."""
    called = next((part for part in _PARTS.findall(name) if part.lower() == unit.lower()), unit)
    return f"; convert the values from {called}" if unit else ""


def _groups(names: Sequence[str]) -> list[_Group]:
    """Names that are numbered without a gap, from 0 or 1."""
    found: dict[tuple[str, str], dict[int, str]] = {}
    for name in names:
        if match := _NUMBERED.fullmatch(name):
            found.setdefault(_word_and_unit(match[1], match[3]), {}).setdefault(int(match[2]), name)
    groups = []
    for (word, unit), members in found.items():
        first = min(members)
        if len(members) > 1 and first in (0, 1) and sorted(members) == list(range(first, first + len(members))):
            groups.append(_Group(tuple(members[i] for i in sorted(members)), word, unit))
    return groups


def _word_and_unit(before: str, after: str) -> tuple[str, str]:
    """Of the text around a number, in lower case: all words as one, and the unit that ends it or ""."""
    words = [word.lower() for word in _PARTS.findall(before) + _PARTS.findall(after)]
    unit = words.pop() if words and words[-1] in _UNITS and (len(words) > 1 or not before.strip()) else ""
    if unit in _OURS and len(words) > 1 and words[-1] in _UNITS:
        unit = words.pop()  # named in front of ours: tension_kN_1_N
    return "".join(words), unit


def _as_cables(group: _Group, kind: str, cables: int) -> str:
    """What a group of columns, one a cable, is to be called; "" if it is none of the kind's quantities."""
    possible = [q for q in QUANTITIES.get(kind, ()) if q in _WORDS and _UNITS.get(group.unit, q) == q]
    named = [q for q in possible if group.word in _WORDS[q]][:1]
    meant = named or [q for q in possible if group.word in _ANY]
    if not meant:
        return ""
    looks = f"columns {group} look like one {meant[0].name if len(meant) == 1 else 'reading'} per cable"
    if len(group.names) != cables:
        return f"{looks}, but this robot has {cables} cables, which need {meant[0].span(cables)} ({meant[0].unit})"
    if len(meant) == 1:
        return f"{looks}: name them {_names(meant[0], group)}"
    return f"{looks}: " + ", or ".join(f"{q.names} are named {_names(q, group)}" for q in meant)


def _names(quantity: CableQuantity, group: _Group) -> str:
    """All new names in short, the unit, and which becomes which."""
    foreign = "" if group.unit in _OURS else group.unit
    which = f"{group.names[0]} becomes {quantity.column(1)} and so on"
    return f"{quantity.span(len(group.names))} ({quantity.unit}{_conversion(group.names[0], foreign)}; {which})"
