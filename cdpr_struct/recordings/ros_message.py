"""The numbers in a ROS message, each under the path that leads to it, with the time that its header says."""

from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass
from typing import Any, NamedTuple

import numpy as np

_LONGEST = 64  # entries of an array that are channels each; longer ones are images, scans and clouds
_SECOND = 1_000_000_000  # ns


class Reading(NamedTuple):
    """A number of a message: its path, as in pose.position.x, and the time of its header [ns], 0 if there is none."""

    name: str
    value: float
    stamp: int


def readings(message: Any, path: str = "", stamp: int = 0) -> Iterator[Reading]:
    """All numbers of a message, of the messages in it, and of arrays of at most 64 entries.

    Entries of an array are counted from 0, or called as the message calls them: joints by `name`, transforms by
    `child_frame_id`. What lies below a header has that header's time.
    """
    stamp = _stamp(message) or stamp
    names = getattr(message, "name", None)
    for field in fields(message):
        value = getattr(message, field.name)
        inner = f"{path}.{field.name}" if path else field.name
        if field.name == "header" or field.name.startswith("__"):
            continue
        if is_dataclass(value):
            yield from readings(value, inner, stamp)
        elif isinstance(value, np.ndarray | list | tuple):
            yield from _entries(value, inner, stamp, names if field.name != "name" else None)
        elif isinstance(value, bool | int | float | np.number | np.bool_):
            yield Reading(inner, float(value), stamp)


def _entries(values: Any, path: str, stamp: int, names: object) -> Iterator[Reading]:
    if len(values) > _LONGEST:
        return
    labels: Sequence[object] = range(len(values))
    if isinstance(names, list) and len(names) == len(values) and all(isinstance(name, str) for name in names):
        labels = names
    for label, value in zip(labels, values, strict=True):
        if is_dataclass(value):
            yield from readings(value, f"{path}[{getattr(value, 'child_frame_id', label)}]", stamp)
        elif isinstance(value, bool | int | float | np.number | np.bool_):
            yield Reading(f"{path}[{label}]", float(value), stamp)


def _stamp(message: Any) -> int:
    """Time of a message's header [ns]; 0 if it has none, or one that was not filled."""
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    seconds, rest = getattr(stamp, "sec", 0), getattr(stamp, "nanosec", 0)
    return int(seconds) * _SECOND + int(rest)
