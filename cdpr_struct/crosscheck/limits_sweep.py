"""Errors over many cables, in chunks that an executor may share out."""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial

import numpy as np

from cdpr_struct.crosscheck.limits_errors import Samples, measure
from cdpr_struct.crosscheck.limits_groups import CableGroups
from cdpr_struct.crosscheck.limits_reference import Effects

CHUNK = 64
Progress = Callable[[str], None]
Measured = dict[str, Samples]


def chunk_count(cables: int) -> int:
    """Calls of `progress` that a sweep over so many cables makes."""
    return max(1, -(-cables // CHUNK))


def sweep(
    groups: CableGroups,
    effects: Effects | None = None,
    executor: Executor | None = None,
    progress: Progress = lambda _: None,
    name: str = "sweep",
) -> Measured:
    """Errors of every quantity at all cables; `progress` is called once a chunk."""
    parts = np.array_split(np.arange(len(groups)), chunk_count(len(groups)))
    work = partial(measure, effects=effects)
    chunks = [groups.take(part) for part in parts]
    results = []
    for found in (executor.map if executor else map)(work, chunks):
        progress(name)
        results.append(found)
    return {quantity: _joined([r[quantity] for r in results]) for quantity in results[0]}


def _joined(parts: list[Samples]) -> Samples:
    error = np.concatenate([p.error for p in parts])
    return replace(parts[0], error=error, frequency=np.concatenate([p.frequency for p in parts]))


def take(measured: Measured, index: np.ndarray) -> Measured:
    """The same at some of the cables."""
    return {q: replace(s, error=s.error[index], frequency=s.frequency[index]) for q, s in measured.items()}
