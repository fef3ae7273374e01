"""Processor time of several tasks, run in turn so that all see the same machine."""

import time
from collections.abc import Callable, Mapping

import numpy as np

Task = Callable[[], object]


def medians(tasks: Mapping[str, Task], runs: int) -> dict[str, float]:
    """Median processor seconds of each task, child processes included; one round that is not counted comes first."""
    seconds: dict[str, list[float]] = {name: [] for name in tasks}
    for task in tasks.values():
        task()
    for _ in range(runs):
        for name, task in tasks.items():
            start = _spent()
            task()
            seconds[name].append(_spent() - start)
    return {name: float(np.median(values)) for name, values in seconds.items()}


def _spent() -> float:
    """Processor seconds of this process, to the nanosecond, and of children that have ended."""
    return time.process_time() + _children()


def _children() -> float:
    try:
        import resource
    except ImportError:  # not a POSIX system: no peer runs as a child there
        return 0.0
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def milliseconds(seconds: float) -> str:
    """Three digits."""
    return f"{1e3 * seconds:.3g}"
