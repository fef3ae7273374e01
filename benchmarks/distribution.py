"""How long does the force distribution along the thesis's helix take, beside a general nonlinear solver?

asv-shaped. The peer is SciPy's SLSQP on the thesis's formulation with exact derivatives (`general_solver.py`), pose by
pose, each started at its neighbour's solution; it is timed on every `STRIDE`-th pose and scaled up.

Run: python -m benchmarks.distribution
"""

import argparse
import time

import numpy as np

from benchmarks.general_solver import PoseProblem, slsqp
from cdpr_struct.dynamics.trajectory_distribution import THESIS_B, BoundRule, distribute_along
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.tension_bound import chord_tension_at, constant
from cdpr_struct.statics.tension_cost import EuclideanNorm
from cdpr_struct.statics.tension_distribution import bounded_problem, holding_problem, solve_distribution
from cdpr_struct.statics.trajectory import helix

FIXED = 237.82018987
STRIDE = 60


class HelixDistribution:
    """thesis-5 on the helix, 3001 instants."""

    params = ("fixed", "pose-dependent", "frequency")
    param_names = ("bound",)

    def setup(self, bound: BoundRule) -> None:
        self.robot, self.path, self.bound = load_robot("thesis-5"), helix(), bound
        self.wrench = self.path.inertia_wrench(self.robot.platform)

    def time_whole_command(self, bound: BoundRule) -> None:
        """Bounds, distribution, exact cable frequencies, work."""
        distribute_along(self.robot, self.path, bound)

    def time_distribution_only(self, bound: BoundRule) -> None:
        """Bounds as tensions and distribution; a bound of 237.8 N for every rule."""
        holding = holding_problem(self.robot, self.path.position, self.path.rotation, self.wrench)
        problem = bounded_problem(holding, chord_tension_at(holding, constant(FIXED)), np.inf, np.inf, EuclideanNorm())
        solve_distribution(problem, str)


class GeneralSolver:
    """SLSQP on the same poses."""

    params = ("fixed", "pose-dependent")
    param_names = ("bound",)

    def setup(self, bound: str) -> None:
        robot, path = load_robot("thesis-5"), helix()
        load = path.inertia_wrench(robot.platform)
        load[:, 2] -= robot.platform.mass * robot.gravity
        per_length = bound == "pose-dependent"
        low = (THESIS_B / np.pi) ** 2 * robot.weight_per_length if per_length else FIXED
        self.problems = [
            PoseProblem.at(robot, path.position[i], load[i], low, per_length=per_length)
            for start in range(0, len(path) - 1, STRIDE)
            for i in (start, start + 1)
        ]

    def time_every_stride(self, bound: str) -> None:
        """The second of each pair of neighbours only counts in `seconds_for_all`: it is warm."""
        for cold, warm in zip(self.problems[::2], self.problems[1::2], strict=True):
            slsqp(warm, slsqp(cold, tolerance=1e-12)[0], tolerance=1e-12)

    def seconds_for_all(self) -> float:
        """Seconds for 3001 warm-started poses."""
        spent = 0.0
        for cold, warm in zip(self.problems[::2], self.problems[1::2], strict=True):
            start = slsqp(cold, tolerance=1e-12)[0]
            begin = time.process_time()
            slsqp(warm, start, tolerance=1e-12)
            spent += time.process_time() - begin
        return spent / (len(self.problems) / 2) * 3001


def _median(function, repeats: int = 5) -> float:
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        function()
        times.append(time.process_time() - begin)
    return float(np.median(times))


def main() -> None:
    """Print the record (processor time, so that a busy machine does not disturb it)."""
    argparse.ArgumentParser(
        prog="python -m benchmarks.distribution", description=(__doc__ or "").split("\n")[0]
    ).parse_args()
    for bound in ("fixed", "pose-dependent"):
        ours, peer = HelixDistribution(), GeneralSolver()
        ours.setup(bound)
        peer.setup(bound)
        whole = _median(lambda o=ours, b=bound: o.time_whole_command(b))
        alone = _median(lambda o=ours, b=bound: o.time_distribution_only(b))
        general = float(np.median([peer.seconds_for_all() for _ in range(3)]))
        print(
            f"{bound}: distribution {alone:.2f} s, with bounds by rule, frequencies and work {whole:.2f} s; "
            f"SLSQP {general:.0f} s: {general / alone:.0f} and {general / whole:.0f} times faster"
        )


if __name__ == "__main__":
    main()
