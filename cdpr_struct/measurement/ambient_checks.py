"""What makes a recorded channel unusable: it is dead, drops out, or is clipped."""

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.signal_records import SignalRecord

_DEAD = 3  # different values, at most, of a channel in which nothing moves
_LONGEST = 20  # equal values in a row, of which a sensor that works has fewer
_CLIPPED, _FEWEST_CLIPPED = 0.001, 10  # share and number of samples at the largest or smallest value


def check_channels(record: SignalRecord) -> None:
    """Refuse channels that are dead, stand still for a while, or are clipped.

    Raises
    ------
    InputError : the first such channel, and where.
    """
    for name, values in zip(record.channels, record.signal.T, strict=True):
        place = f"case {record.case}, column {name}"
        if np.unique(values).size <= _DEAD:
            said = f"a dead channel, {values[0]:g} throughout" if np.ptp(values) == 0.0 else "a dead channel"
            raise InputError(record.file, place, said, "accelerations that vary; leave the column out")
        start, length = _longest_stay(values)
        clipped = [int((values == end).sum()) for end in (values.max(), values.min())]
        if max(clipped) >= max(_FEWEST_CLIPPED, _CLIPPED * len(values)):
            end = values.max() if clipped[0] >= clipped[1] else values.min()
            said = f"{max(clipped)} samples at {end:g}: clipped"
            raise InputError(record.file, place, said, "a range of the sensor that the vibration does not reach")
        if length >= _LONGEST:
            said = f"{values[start]:g} in {length} samples from {record.axis[start]:g} s on"
            raise InputError(record.file, place, said, "a signal without drop-outs; cut the record there")


def _longest_stay(values: np.ndarray) -> tuple[int, int]:
    """First sample and length of the longest run of equal values."""
    ends = np.flatnonzero(np.diff(values) != 0.0)
    edges = np.concatenate([[-1], ends, [len(values) - 1]])
    longest = int(np.diff(edges).argmax())
    return int(edges[longest]) + 1, int(np.diff(edges)[longest])
