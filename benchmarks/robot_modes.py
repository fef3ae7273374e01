"""What do certified modes of a robot cost at one pose, beside other codes and the finite elements?

    python -m benchmarks robot-modes

The eight-cable robot of Table 3.1 off centre. Ours: from the pose to tensions, lengths, and frequencies with the proof
that none is missing, once with mode shapes. Peers: from our lengths to their own static equilibrium and as many lowest
frequencies; no proof, and no tensions to be found. Errors are the largest of all frequencies, against extrapolated
finite elements (`robot_reference`).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

import cdpr_struct.fem_reference as fem
from benchmarks.markdown_page import table
from benchmarks.peers import exudyn_cables, opensees, present
from benchmarks.question import Answer, Question, paragraphs
from benchmarks.robot_reference import Converged, converged_frequencies
from benchmarks.timing import medians, milliseconds
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.dynamics.certified_modes import certified_frequencies, certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

POSITION = np.array([0.5, -1.0, 0.8])
OURS = "cdpr-struct, certified"
Solve = Callable[[Robot, fem.RobotData, int], np.ndarray]


def our_frequencies(robot: Robot, data: fem.RobotData, count: int) -> np.ndarray:
    """Inverse kinematics and certified frequencies [Hz]."""
    return certified_frequencies(_at_rest(robot), "exact", count).hertz


def our_modes(robot: Robot, data: fem.RobotData, count: int) -> np.ndarray:
    """The same with mode shapes."""
    return certified_modes(_at_rest(robot), "exact", count).frequencies.hertz


def _at_rest(robot: Robot) -> OperatingPoint:
    return OperatingPoint(robot, POSITION, np.eye(3), inverse(robot, POSITION, np.eye(3)).cables)


def _finite_elements(elements: int) -> Solve:
    def solve(robot: Robot, data: fem.RobotData, count: int) -> np.ndarray:
        return fem.robot_modes(fem.solve_robot(data, POSITION, np.eye(3), elements), count).frequencies_hz

    return solve


def _exudyn(elements: int, element: exudyn_cables.Element = "ANCF") -> Solve:
    def solve(robot: Robot, data: fem.RobotData, count: int) -> np.ndarray:
        return exudyn_cables.robot_frequencies(data, POSITION, elements, count, "spring", element)

    return solve


def _opensees(elements: int) -> Solve:
    def solve(robot: Robot, data: fem.RobotData, count: int) -> np.ndarray:
        return opensees.robot_frequencies(data, POSITION, elements, count)

    return solve


@dataclass(frozen=True)
class Way:
    """name, the peer it belongs to (none: ours or the referee), what solves, and for how many modes it is tried."""

    name: str
    peer: str
    solve: Solve
    counts: tuple[int, ...] = (12, 60)


WAYS = (
    Way(OURS, "", our_frequencies),
    Way(f"{OURS}, with shapes", "", our_modes),
    Way("Exudyn, 4 ANCF cables each", "Exudyn", _exudyn(4), (12,)),
    Way("Exudyn, 6 ANCF cables each", "Exudyn", _exudyn(6), (12,)),
    Way("Exudyn, 24 ANCF cables each", "Exudyn", _exudyn(24), (60,)),
    Way("Exudyn, 64 points and springs each", "Exudyn", _exudyn(64, "points"), (12,)),
    Way("OpenSees, 32 trusses each", "OpenSeesPy", _opensees(32), (12,)),
    Way("OpenSees, 64 trusses each", "OpenSeesPy", _opensees(64)),
    Way("fem_reference, 256 bars each", "", _finite_elements(256)),
)


class RobotModes:
    """asv-shaped: one way to a number of modes."""

    params = tuple((way.name, count) for way in WAYS for count in way.counts)
    param_names = ("way_and_count",)

    def setup(self, case: tuple[str, int]) -> None:
        name, self.count = case
        self.way = next(way for way in WAYS if way.name == name)
        self.robot = load_robot("thesis-3-1")
        self.data = to_fem(self.robot, inverse(self.robot, POSITION, np.eye(3)).cables.total_length)

    def frequencies(self) -> np.ndarray:
        """(count,) ascending [Hz]."""
        return self.way.solve(self.robot, self.data, self.count)

    def time_modes(self, case: tuple[str, int]) -> None:
        self.frequencies()

    def track_error(self, case: tuple[str, int]) -> float:
        """Largest relative error."""
        return self.error(converged_frequencies(self.data, POSITION, self.count))

    def error(self, reference: Converged) -> float:
        """Largest relative error against a reference of at least as many modes."""
        return float(np.abs(self.frequencies() / reference.hertz[: self.count] - 1.0).max())


def answer(quick: bool) -> Answer:
    """Table for 12 and 60 modes."""
    peers, absent = present(("Exudyn", "OpenSeesPy"))
    cases = {}
    for name, count in RobotModes.params:
        way = next(way for way in WAYS if way.name == name)
        if way.peer in ("", *peers) and not (quick and count > 12):
            cases[name, count] = case = RobotModes()
            case.setup((name, count))
    reference = converged_frequencies(cases[OURS, 12].data, POSITION, 12 if quick else 60)
    tasks = {f"{name} {count}": case.frequencies for (name, count), case in cases.items()}
    seconds = dict(zip(cases, medians(tasks, 1 if quick else 9).values(), strict=True))
    errors = {key: case.error(reference) for key, case in cases.items()}
    rows = [
        [name, str(count), milliseconds(seconds[name, count]), f"{seconds[name, count] / seconds[OURS, 12]:.2f}",
         f"{errors[name, count]:.1e}"]
        for name, count in cases
    ]  # fmt: skip
    head = ["code", "modes", "time [ms]", "of our time for 12", "largest error"]
    spread = f"The reference itself is known within {reference.spread.max():.0e}."
    return Answer(paragraphs(table(head, rows), _verdict(seconds, errors), spread, *absent))


def _verdict(seconds: dict[tuple[str, int], float], errors: dict[tuple[str, int], float]) -> str:
    """The fastest peer with 12 modes within 1e-5, beside ours."""
    peers = {way.name for way in WAYS if way.peer}
    good = {key: seconds[key] for key in seconds if key[0] in peers and key[1] == 12 and errors[key] <= 1e-5}
    if not good:
        return ""
    (name, _), quickest = min(good.items(), key=lambda item: item[1])
    text = f"The fastest peer with 12 modes within 1e-5 is {name}: {quickest / seconds[OURS, 12]:.2f} times our time"
    more = seconds.get((OURS, 60))
    return text + (f" for 12 certified modes, {quickest / more:.2f} times that for 60." if more else ".")


QUESTION = Question("robot-modes", "Modes of a robot at one pose, statics included", answer)
