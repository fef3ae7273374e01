"""How long do statics and vibrations of many poses take, in units of NumPy's own eigenproblems?

    python benchmarks/vibration_floor.py [poses]

One floor is the time a pose of batched `numpy.linalg.eigh` of eight matrices 24 x 24 and one 54 x 54. Everything runs
alternately in one thread, by processor time; printed are medians and their ratio to the floor's, and the errors against
certified modes of single poses.
"""

import os
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from cdpr_struct.dynamics.batched_modes import Batch, first_mode, lowest_modes
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.many_poses import poses_of
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.workspace.vibration import first_frequencies

POSES, RUNS, CHECKED, COUNT = 625, 7, 12, 12
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


def medians(tasks: dict[str, Callable[[], None]]) -> dict[str, float]:
    """Processor seconds of each task, the median of alternating runs."""
    seconds: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(RUNS):
        for name, task in tasks.items():
            start = time.process_time()
            task()
            seconds[name].append(time.process_time() - start)
    return {name: float(np.median(values)) for name, values in seconds.items()}


def main() -> None:
    """Print ratios and errors, robot by robot."""
    poses = int(sys.argv[1]) if len(sys.argv) > 1 else POSES
    for name in ROBOTS:
        bench = VibrationFloor()
        bench.setup(name, poses)
        tasks = {
            "floor": bench.time_floor,
            "inverse kinematics": bench.time_inverse,
            "first frequency": bench.time_first,
            f"{COUNT} modes": bench.time_many,
            "map of first frequencies": bench.time_map,
        }
        found, errors = medians(tasks), bench.errors()
        print(f"{name}, {poses} poses, {1e6 * found['floor'] / poses:.0f} us a floor")
        for task, seconds in found.items():
            print(f"  {task:<26} {seconds / found['floor']:7.3f} floors   {errors.get(task, '')}")


if __name__ == "__main__":
    main()
