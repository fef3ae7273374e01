"""How do time and memory grow with the size of a task?

    python -m benchmarks growth

Every size runs in a process of its own, whose largest memory is read at its end; the time is the least processor time
of some repetitions. The exponents are slopes of lines through the larger half of the sizes in logarithmic axes.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.growth_cases import (
    campaign_task,
    certified_task,
    distribution_task,
    elements_task,
    first_frequencies_task,
    frequencies_task,
    ring_inverse_task,
    ring_modes_task,
    ring_poses_task,
)
from benchmarks.growth_figure import draw_growth
from benchmarks.markdown_page import table
from benchmarks.question import Answer, Question, paragraphs

REPETITIONS, LONG = 3, 10.0  # a run longer than so many seconds is not repeated


@dataclass(frozen=True)
class Growth:
    """One line of the table: what grows, over which sizes, and why it grows as it does."""

    what: str
    over: str
    sizes: tuple[int, ...]
    task: Callable[[int], Callable[[], object]]
    why: str


CABLES = (6, 8, 12, 16, 24, 32, 48, 64)
GROWTHS: dict[str, Growth] = {
    "inverse-cables": Growth(
        "inverse kinematics, 256 poses", "cables", CABLES, ring_inverse_task,
        "each cable is closed by itself, and one 6 x 6 system a pose joins them: linear up to 32 cables. Of more, each "
        "pulls so little that some hang slack: these poses go to the general solver",
    ),
    "first-cables": Growth(
        "first frequency, 256 poses", "cables", CABLES, ring_poses_task,
        "condensing is linear in the cables, the eigenproblem of order 6 + 2 m is cubic and takes over slowly",
    ),
    "modes-cables": Growth(
        "12 certified modes, one pose", "cables", CABLES, ring_modes_task,
        "more cables have more string modes in the same band: the eigenproblem grows with them",
    ),
    "map-poses": Growth(
        "map of first frequencies", "poses", (100, 1000, 10_000, 100_000, 1_000_000), first_frequencies_task,
        "poses do not know of each other; below a thousand the fixed costs show. Memory: only the columns grow",
    ),
    "modes-count": Growth(
        "certified modes, one pose", "modes", (12, 24, 48, 96, 192), certified_task,
        "the polynomials of a cable grow with the band; the eigenproblems are still small enough to cost less than "
        "their cube",
    ),
    "frf-frequencies": Growth(
        "frequency response", "frequencies", (1000, 10_000, 100_000, 1_000_000), frequencies_task,
        "each frequency is a 6 x 6 system of its own: linear. Below, the cable model dominates",
    ),
    "fem-elements": Growth(
        "FEM, 12 modes, one pose", "elements a cable", (10, 20, 40, 80, 160), elements_task,
        "sparse matrices with a bandwidth that does not grow: linear at most; fixed costs dominate",
    ),
    "distribution-instants": Growth(
        "force distribution, frequency bound", "instants", (30, 300, 3000, 30_000), distribution_task,
        "instants share only their first guesses: linear",
    ),
    "diagnosis-readings": Growth(
        "diagnosis of static states", "readings", (80, 160, 320, 640, 1280), campaign_task,
        "readings of a state are linear; hypotheses about single readings (outliers, exchanged rows) grow with them",
    ),
}  # fmt: skip


def measured(name: str, size: int) -> tuple[float, float]:
    """Processor seconds and largest memory [MB] of one size, in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.growth", name, str(size)],
        cwd=Path(__file__).parents[1], capture_output=True, text=True, check=True,
        env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
    )  # fmt: skip
    seconds, megabytes = json.loads(done.stdout)
    return seconds, megabytes


def alone(name: str, size: int) -> tuple[float, float]:
    """The same in this process."""
    task = GROWTHS[name].task(size)
    best = np.inf
    for _ in range(REPETITIONS):
        start = time.process_time()
        task()
        best = min(best, time.process_time() - start)
        if best > LONG:
            break
    return best, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def exponent(sizes: np.ndarray, values: np.ndarray) -> float:
    """Slope of ln(value) over ln(size), the larger half of the sizes."""
    half = len(sizes) // 2
    return float(np.polyfit(np.log(sizes[half:]), np.log(values[half:]), 1)[0])


def answer(quick: bool) -> Answer:
    """Each task over its sizes."""
    rows, curves = [], {}
    for name, growth in GROWTHS.items():
        sizes = np.array(growth.sizes[:3] if quick else growth.sizes)
        seconds, memory = np.array([measured(name, int(size)) for size in sizes]).T
        curves[growth.what] = (growth.over, sizes, seconds)
        rows.append([
            growth.what, f"{sizes[0]:,} to {sizes[-1]:,} {growth.over}",
            f"{1e3 * seconds[0]:.3g} to {1e3 * seconds[-1]:.4g}",
            f"{exponent(sizes, seconds):.2f}", f"{memory[0]:.0f} to {memory[-1]:.0f}", growth.why,
        ])  # fmt: skip
    head = ["task", "sizes", "time [ms]", "exponent", "memory [MB]", "why"]
    said = "Exponents are those of the larger half of the sizes. Memory is that of the whole process, 80 MB of it code."
    figures = {"benchmarks_growth.svg": lambda path: draw_growth(path, curves)}
    return Answer(paragraphs(table(head, rows), said), figures)


QUESTION = Question("growth", "How time and memory grow with the size of a task", answer)

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        os.environ["GROWTH_PLACE"] = place
        print(json.dumps(alone(sys.argv[1], int(sys.argv[2]))))
