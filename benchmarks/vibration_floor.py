"""How long do statics and vibrations of many poses take, in units of NumPy's own eigenproblems?

    python -m benchmarks vibration-floor

One floor is the time a pose of batched `numpy.linalg.eigh` of eight matrices 24 x 24 and one 54 x 54. Everything runs
alternately in one thread, by processor time; printed are medians and their ratio to the floor's, and the errors against
certified modes of single poses.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from benchmarks.markdown_page import table
from benchmarks.question import Answer, Question
from benchmarks.timing import medians
from cdpr_struct.dynamics.batched_modes import Batch, first_mode, lowest_modes
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.many_poses import poses_of
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.mode_map import ModeMap
from cdpr_struct.workspace.vibration import first_frequencies

POSES, RUNS, CHECKED, COUNT, FOLLOWED = 625, 7, 12, 12, 3
RADIUS, TILTED, IN_LINE = 0.05, (1.0, 0.5, 1.0), 2e-5  # m; axis; m/N


def on_pulleys(name: str, axis: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> Robot:
    """The robot with pulleys at all frame anchors."""
    robot = load_robot(name)
    return replace(robot, pulleys=(Pulley(RADIUS, np.array(axis)),) * len(robot.cables))


def elastic_in_line(name: str) -> Robot:
    """The robot with an elastic element in line with every cable."""
    robot = load_robot(name)
    return replace(robot, extensions=Extensions.of(len(robot.cables), {"series_compliance": IN_LINE}))


ROBOTS: dict[str, Callable[[], Robot]] = {
    **{name: partial(load_robot, name) for name in ("thesis-3-1", "thesis-3-1-8mm", "cogiro", "thesis-5")},
    "thesis-3-1, 2e-5 m/N in line": partial(elastic_in_line, "thesis-3-1"),
    "thesis-3-1, 50 mm pulleys": partial(on_pulleys, "thesis-3-1"),
    "cogiro, 50 mm pulleys": partial(on_pulleys, "cogiro"),
    "thesis-3-1, 50 mm pulleys on oblique axes": partial(on_pulleys, "thesis-3-1", TILTED),
}


class VibrationFloor:
    """asv-shaped."""

    params = (list(ROBOTS),)
    param_names = ("robot",)

    def setup(self, name: str, poses: int = POSES) -> None:
        self.robot = ROBOTS[name]()
        rng = np.random.default_rng(1)
        spread = np.array([1.5, 1.5, 0.3])
        self.positions = self.robot.home.position + rng.uniform(-1.0, 1.0, (poses, 3)) * spread
        self.rotations = np.broadcast_to(np.eye(3), (poses, 3, 3))
        self.matrices = [
            root @ np.swapaxes(root, 1, 2)
            for root in (rng.normal(size=(8 * poses, 24, 24)), rng.normal(size=(poses, 54, 54)))
        ]
        self.point = self.rest()

    def rest(self) -> OperatingPoint:
        cables = inverse(self.robot, self.positions, self.rotations).cables
        return OperatingPoint(self.robot, self.positions, self.rotations, cables)

    def time_floor(self) -> None:
        for matrices in self.matrices:
            np.linalg.eigh(matrices)

    def time_inverse(self) -> None:
        inverse(self.robot, self.positions, self.rotations)

    def time_first(self) -> None:
        first_mode(Batch.of(self.rest()))

    def time_many(self) -> None:
        lowest_modes(Batch.of(self.rest()), COUNT)

    def time_map(self) -> None:
        first_frequencies(self.robot, self.positions, np.eye(3))

    def time_mode(self, number: int = FOLLOWED) -> None:
        """One mode, followed over a square of as many poses in the plane of home."""
        x, y, z = self.robot.home.position
        steps = np.linspace(-1.0, 1.0, round(len(self.positions) ** 0.5))
        grid, what = Grid(x + steps, y + steps, np.array([z]), np.zeros(3)), ModeMap(number)
        what.finish(self.robot, grid, what.evaluate(self.robot, grid.positions, grid.rotation))

    def errors(self) -> dict[str, str]:
        """Largest relative errors and the widths that are proved, of the first poses."""
        point = poses_of(self.point, np.arange(CHECKED))
        hertz = [certified_modes(poses_of(point, i), "exact", COUNT).frequencies.hertz for i in range(CHECKED)]
        exact, batch = (2.0 * np.pi * np.array(hertz)) ** 2, Batch.of(point)
        first, many = first_mode(batch), lowest_modes(batch, COUNT)
        missed = int((~np.isfinite(lowest_modes(Batch.of(self.point), COUNT).squared)).any(axis=1).sum())
        return {
            "first frequency": f"{_error(first.squared, exact[:, 0]):.1e}, enclosed within {first.width.max():.1e}",
            f"{COUNT} modes": f"{_error(many.squared, exact):.1e}, counted within {np.nanmax(many.width):.0e}, "
            f"not proved at {missed} poses",
        }


def _error(ours: np.ndarray, exact: np.ndarray) -> float:
    return float(np.nanmax(np.abs(0.5 * np.log(ours / exact))))


def answer(quick: bool) -> Answer:
    """Ratios and errors, robot by robot."""
    rows = []
    for name in ROBOTS[:1] if quick else ROBOTS:
        bench = VibrationFloor()
        bench.setup(name, CHECKED if quick else POSES)
        tasks = {
            "inverse kinematics": bench.time_inverse,
            "first frequency": bench.time_first,
            f"{COUNT} modes": bench.time_many,
            "map of first frequencies": bench.time_map,
            "map of mode 1": partial(bench.time_mode, 1),
            f"map of mode {FOLLOWED}": bench.time_mode,
        }
        found, errors = medians({"floor": bench.time_floor} | tasks, 1 if quick else RUNS), bench.errors()
        rows += [[name, task, f"{found[task] / found['floor']:.3f}", errors.get(task, "")] for task in tasks]
    return Answer(table(["robot", "task", "time [floors]", "error"], rows))


QUESTION = Question(
    "vibration-floor", "Statics and vibrations of many poses, in units of NumPy's own eigenproblems", answer
)
