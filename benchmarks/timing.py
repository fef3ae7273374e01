"""Processor time of several tasks, run in turn so that all see the same machine."""

import time
from collections.abc import Callable, Mapping

import numpy as np

Task = Callable[[], object]


def medians(tasks: Mapping[str, Task], runs: int) -> dict[str, float]:
    """Median processor seconds of each task; one round that is not counted comes first."""
    seconds: dict[str, list[float]] = {name: [] for name in tasks}
    for task in tasks.values():
        task()
    for _ in range(runs):
        for name, task in tasks.items():
            start = time.process_time()
            task()
            seconds[name].append(time.process_time() - start)
    return {name: float(np.median(values)) for name, values in seconds.items()}


def milliseconds(seconds: float) -> str:
    """Three digits."""
    return f"{1e3 * seconds:.3g}"
