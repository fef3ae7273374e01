"""How exact are the first 20 frequencies of one hanging cable, and how long do they take, code by code?

    python -m benchmarks single-cable

From unstrained length and end points to ten frequencies in the cable's plane and ten across it, each code's own statics
and the building of its model included. Errors are the largest of the 20, against the exact solution (`exact_cable.py`).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from benchmarks.error_figure import draw_curves
from benchmarks.exact_cable import exact_frequencies
from benchmarks.held_cable import GRAVITY, HeldCable, single_cable
from benchmarks.markdown_page import table
from benchmarks.peers import exudyn_cables, moorpy_lines, opensees, present
from benchmarks.question import Answer, Question, paragraphs
from benchmarks.timing import medians, milliseconds
from cdpr_struct.crosscheck.clamped_frequencies import pulled_cable
from cdpr_struct.dynamics.clamped_catenary import clamped_frequencies
from cdpr_struct.statics.catenary import solve_end_forces

COUNT = 10  # of each plane
OURS, FIGURE = "cdpr-struct", "benchmarks_single_cable.svg"
TOLERANCES = (1e-3, 1e-6, 1e-10)


def our_frequencies(cable: HeldCable, order: int, count: int) -> np.ndarray:
    """The linearised catenary in polynomials of an order [Hz]."""
    weight, offset = cable.linear_density * GRAVITY, cable.end - cable.start
    end = float(offset[0]), float(offset[2])
    force = solve_end_forces(*end, cable.unstrained_length, cable.axial_stiffness, weight)
    pull = float(force.force_x), float(force.force_z)
    state = pulled_cable(pull, end, cable.unstrained_length, cable.axial_stiffness, weight)
    planes = clamped_frequencies(state, np.array([cable.linear_density]), order)
    return np.sort(np.concatenate([plane[0] for plane in planes]))[:count] / (2.0 * np.pi)


@cache
def reference() -> np.ndarray:
    """(20,) exact frequencies [Hz]."""
    return np.sort(np.concatenate(exact_frequencies(single_cable(), COUNT)))


@dataclass(frozen=True)
class Code:
    """name, the peer it belongs to (none: ours), what is refined, how far, and what computes `count` frequencies."""

    name: str
    peer: str
    refines: str
    sizes: tuple[int, ...]
    frequencies: Callable[[HeldCable, int, int], np.ndarray]


def _points(cable: HeldCable, elements: int, count: int) -> np.ndarray:
    return exudyn_cables.cable_frequencies(cable, elements, count, "points")


CODES = (
    Code(OURS, "", "order", (16, 18, 20, 22, 23, 24, 26, 28, 30, 34), our_frequencies),
    Code("Exudyn, ANCF cables", "Exudyn", "elements", (8, 12, 16, 24, 32, 40, 48, 50, 64, 96),
         exudyn_cables.cable_frequencies),
    Code("Exudyn, points and springs", "Exudyn", "elements", (16, 32, 64, 128, 256, 512), _points),
    Code("OpenSees, trusses", "OpenSeesPy", "elements", (16, 32, 64, 128, 192, 256, 320, 512, 1024),
         opensees.cable_frequencies),
    Code("MoorPy, lumped masses", "MoorPy", "elements", (16, 32, 64, 128), moorpy_lines.cable_frequencies),
)  # fmt: skip


class SingleCable:
    """asv-shaped: one code at one size."""

    params = tuple((code.name, size) for code in CODES for size in code.sizes)
    param_names = ("code_and_size",)

    def setup(self, case: tuple[str, int]) -> None:
        name, self.size = case
        self.code = next(code for code in CODES if code.name == name)
        self.cable = single_cable()

    def frequencies(self) -> np.ndarray:
        """(20,) ascending [Hz]."""
        return self.code.frequencies(self.cable, self.size, 2 * COUNT)

    def time_frequencies(self, case: tuple[str, int]) -> None:
        self.frequencies()

    def track_error(self, case: tuple[str, int]) -> float:
        """Largest relative error of the 20 frequencies."""
        return float(np.abs(self.frequencies() / reference() - 1.0).max())


@dataclass(frozen=True)
class Point:
    """One code at one size."""

    code: Code
    size: int
    seconds: float
    error: float


def measure(quick: bool, peers: list[str]) -> list[Point]:
    """All codes at all sizes, run in turn."""
    cases = {}
    for code in CODES:
        if code.peer in ("", *peers):
            for size in code.sizes[:2] if quick else code.sizes:
                cases[f"{code.name} {size}"] = case = SingleCable()
                case.setup((code.name, size))
    exact = reference()
    seconds = medians({name: case.frequencies for name, case in cases.items()}, 1 if quick else 7)
    errors = {name: float(np.abs(case.frequencies() / exact - 1.0).max()) for name, case in cases.items()}
    return [Point(case.code, case.size, seconds[name], errors[name]) for name, case in cases.items()]


def fastest(points: list[Point], code: str, tolerance: float) -> Point | None:
    """The quickest of a code's points that are as exact as asked."""
    good = [point for point in points if point.code.name == code and point.error <= tolerance]
    return min(good, key=lambda point: point.seconds, default=None)


def _row(points: list[Point], code: Code) -> list[str]:
    own = [point for point in points if point.code == code]
    cells = [code.name]
    for tolerance in TOLERANCES:
        found, ours = fastest(own, code.name, tolerance), fastest(points, OURS, tolerance)
        if found is None:
            cells.append("not reached")
        else:
            ratio = "" if ours is None or code.name == OURS else f", {found.seconds / ours.seconds:.1f} times ours"
            cells.append(f"{milliseconds(found.seconds)} ms ({found.size} {code.refines}{ratio})")
    best = min(own, key=lambda point: point.error)
    return [*cells, f"{best.error:.1e} ({best.size} {code.refines})"]


def _verdict(points: list[Point]) -> str:
    ours, rivals = fastest(points, OURS, 1e-6), [fastest(points, code.name, 1e-6) for code in CODES if code.peer]
    reached = [point for point in rivals if point is not None]
    sharp = fastest(points, OURS, 1e-10)
    if ours is None or sharp is None or not reached:
        return ""
    first = min(reached, key=lambda point: point.seconds)
    return (
        f"The fastest peer with errors below 1e-6 is {first.code.name}: {first.seconds / ours.seconds:.1f} times our "
        f"time at 1e-6, and {first.seconds / sharp.seconds:.1f} times our time at 1e-10."
    )


def answer(quick: bool) -> Answer:
    """Table and picture."""
    peers, absent = present(("Exudyn", "OpenSeesPy", "MoorPy"))
    points = measure(quick, peers)
    shown = [code for code in CODES if any(point.code == code for point in points)]
    head = ["code", *(f"20 frequencies within {tolerance:.0e}" for tolerance in TOLERANCES), "smallest error"]
    text = paragraphs(table(head, [_row(points, code) for code in shown]), _verdict(points), *absent)
    curves = {code.name: [(point.seconds, point.error) for point in points if point.code == code] for code in shown}
    return Answer(text, {FIGURE: lambda path: draw_curves(path, curves, "largest relative error of 20 frequencies")})


QUESTION = Question("single-cable", "20 frequencies of one cable: error over time", answer)
