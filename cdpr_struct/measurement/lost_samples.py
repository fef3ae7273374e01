"""Samples that a recorder lost: rows that are not there, or have empty cells, get their place and no weight.

A sample that nobody read says nothing. Where a method needs even samples, a lost one has the value that the fit to all
others gives it there, so that it pulls at nothing.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from cdpr_struct.errors import InputError

FEWEST = 64  # samples or lines
MOST_LOST = 0.2  # of a record
_EVEN = 0.01  # of a step, by which times may be off an even grid


def even_samples(
    file: str, case: str, columns: Mapping[str, np.ndarray], channels: Sequence[str], gaps: bool = True
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Columns (n,) of one vibration on even times, and which (n,) samples were lost: these lie on straight lines.

    columns : time_s and others, one row a sample;  channels : names of those that were measured
    gaps : whether samples may be lost

    Raises
    ------
    InputError : uneven or too few instants, or more than a fifth of them lost.
    """
    time = columns["time_s"]
    place = _places(file, case, time, gaps)
    known = np.isfinite(np.stack([columns[name] for name in channels])).all(axis=0)
    lost = np.ones(place[-1] + 1, dtype=bool)
    lost[place[known]] = False
    _check_lost(file, case, lost, "samples")
    if len(lost) == len(time) and not lost.any():
        return dict(columns), lost
    even = np.interp(np.arange(len(lost)), place, time)
    return {name: _filled(even, time, known, values) for name, values in columns.items()} | {"time_s": even}, lost


def common_lines(
    file: str, case: str, found: Mapping[str, tuple[np.ndarray, np.ndarray]]
) -> tuple[np.ndarray, np.ndarray, int]:
    """Lines (f,) [Hz] that all responses of a case have, the responses (f, c) there, and how many lines were lost.

    found : lines (n,) and complex values (n,) of each response, nan where nothing was read

    Raises
    ------
    InputError : responses on different lines, or more than a fifth of the lines lost.
    """
    width = 1e-6 * max(float(lines[-1]) for lines, _ in found.values())
    keys = {name: np.rint(lines / width).astype(np.int64) for name, (lines, _) in found.items()}
    every = np.unique(np.concatenate(list(keys.values())))
    columns, lines = np.full((len(every), len(found)), np.nan, dtype=complex), np.zeros(len(every))
    for column, name in enumerate(found):
        at = np.searchsorted(every, keys[name])
        columns[at, column], lines[at] = found[name][1], found[name][0]
    lost = ~np.isfinite(columns).all(axis=1)
    if lost.mean() > MOST_LOST:
        name = max(found, key=lambda one: len(every) - len(found[one][0]))
        told = f"{np.isfinite(found[name][1]).sum()} lines, {len(every)} in all responses together"
        raise InputError(file, f"case {case}, response {name}", told, "the same lines for all responses of a case")
    return lines[~lost], columns[~lost], int(lost.sum())


def _places(file: str, case: str, time: np.ndarray, gaps: bool) -> np.ndarray:
    """(n,) numbers of samples on an even grid."""
    if len(time) < FEWEST:
        raise InputError(file, f"case {case}", f"{len(time)} samples", f"at least {FEWEST} samples of one vibration")
    if not np.isfinite(time).all():
        raise InputError(file, f"case {case}, column time_s", "nothing", "a time for every sample")
    steps = np.diff(time)
    usual = float(np.median(steps))
    whole = np.maximum(np.rint(steps / usual), 1.0) if gaps and usual > 0.0 else np.ones(len(steps))
    mean = float((time[-1] - time[0]) / whole.sum())
    worst = int(np.abs(steps - whole * mean).argmax())
    if not (mean > 0.0 and abs(steps[worst] - whole[worst] * mean) <= _EVEN * mean):
        expected = f"even steps, here {mean:.6g} s" + (", or multiples of it where samples were lost" if gaps else "")
        raise InputError(file, f"case {case}, column time_s", f"a step of {steps[worst]:.6g} s", expected)
    return np.concatenate([[0], np.cumsum(whole)]).astype(int)


def _check_lost(file: str, case: str, lost: np.ndarray, what: str) -> None:
    if lost.mean() > MOST_LOST:
        told = f"{int(lost.sum())} of {len(lost)} {what} missing"
        expected = f"at most {MOST_LOST:.0%} missing, or the stretch without gaps alone"
        raise InputError(file, f"case {case}", told, expected)


def _filled(even: np.ndarray, time: np.ndarray, known: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values at even times, straight over what is not known."""
    return np.interp(even, time[known], values[known])
