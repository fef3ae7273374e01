"""How long does the force distribution along the thesis's helix take, beside general nonlinear solvers?

    python -m benchmarks distribution

The peers are SciPy's SLSQP and IPOPT on the thesis's formulation with exact derivatives (`general_solver.py`), pose by
pose, each started at its neighbour's solution; they are timed on every `STRIDE`-th pose and scaled up.
"""

from collections.abc import Callable

import numpy as np

from benchmarks.general_solver import PoseProblem, slsqp
from benchmarks.markdown_page import table
from benchmarks.peers import present
from benchmarks.peers.ipopt import Distribution
from benchmarks.question import Answer, Question, paragraphs
from benchmarks.timing import medians
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

    def tensions(self, bound: BoundRule) -> np.ndarray:
        """(3001, m) at the platform [N]."""
        return distribute_along(self.robot, self.path, bound).distribution.tensions

    def time_distribution_only(self, bound: BoundRule) -> None:
        """Bounds as tensions and distribution; a bound of 237.8 N for every rule."""
        holding = holding_problem(self.robot, self.path.position, self.path.rotation, self.wrench)
        problem = bounded_problem(holding, chord_tension_at(holding, constant(FIXED)), np.inf, np.inf, EuclideanNorm())
        solve_distribution(problem, str)


class GeneralSolver:
    """A general solver on the same poses."""

    params = (("fixed", "pose-dependent"), ("SLSQP", "IPOPT"))
    param_names = ("bound", "solver")

    def setup(self, bound: str, solver: str, stride: int = STRIDE) -> None:
        robot, path = load_robot("thesis-5"), helix()
        load = path.inertia_wrench(robot.platform)
        load[:, 2] -= robot.platform.mass * robot.gravity
        per_length = bound == "pose-dependent"
        low = (THESIS_B / np.pi) ** 2 * robot.weight_per_length if per_length else FIXED
        self.total = len(path)
        self.warm = np.arange(0, len(path) - 1, stride) + 1
        self.pairs = [
            [PoseProblem.at(robot, path.position[i], load[i], low, per_length=per_length) for i in (at - 1, at)]
            for at in self.warm
        ]
        self.solve: Callable[[PoseProblem, np.ndarray], np.ndarray] = _slsqp
        if solver == "IPOPT":
            self.solve = Distribution(self.pairs[0][0]).solve
        self.starts = [_slsqp(cold, cold.straight_start()) for cold, _ in self.pairs]

    def tensions(self) -> np.ndarray:
        """(poses, m) [N] at the second pose of each pair, started at the first one's solution."""
        each = zip(self.pairs, self.starts, strict=True)
        return np.array([warm.tensions(self.solve(warm, start)) for (_, warm), start in each])

    def time_every_stride(self, bound: str, solver: str) -> None:
        self.tensions()

    def seconds_for_all(self, seconds: float) -> float:
        """Seconds for all poses of the path from those for the timed ones."""
        return seconds / len(self.pairs) * self.total


def _slsqp(problem: PoseProblem, start: np.ndarray) -> np.ndarray:
    return slsqp(problem, start, tolerance=1e-12)[0]


def answer(quick: bool) -> Answer:
    """Seconds for 3001 poses of each, and how far the tensions are apart."""
    peers, absent = present(("CasADi",))
    rows = []
    for bound in GeneralSolver.params[0][: 1 if quick else 2]:
        ours = HelixDistribution()
        ours.setup(bound)
        general = {}
        for solver in ("SLSQP", "IPOPT")[: 1 + bool(peers)]:
            general[solver] = GeneralSolver()
            general[solver].setup(bound, solver, 20 * STRIDE if quick else STRIDE)
        tasks = {"ours": lambda o=ours, b=bound: o.time_distribution_only(b)}
        tasks |= {"whole": lambda o=ours, b=bound: o.time_whole_command(b)}
        seconds = medians(tasks | {name: one.tensions for name, one in general.items()}, 1 if quick else 5)
        scaled = {name: one.seconds_for_all(seconds[name]) for name, one in general.items()}
        rows += _rows(bound, seconds, scaled, general, ours)
    head = ["bound", "code", "3001 poses [s]", "of ours", "largest difference of a tension"]
    return Answer(paragraphs(table(head, rows), *absent))


def _rows(
    bound: str,
    seconds: dict[str, float],
    scaled: dict[str, float],
    general: dict[str, GeneralSolver],
    ours: HelixDistribution,
) -> list[list[str]]:
    best = ours.tensions(bound)
    rows = [[bound, "cdpr-struct, distribution", f"{seconds['ours']:.2f}", "1", ""]]
    rows += [[bound, "cdpr-struct, with frequencies and work", f"{seconds['whole']:.2f}", "", ""]]
    for name, one in general.items():
        apart = np.abs(one.tensions() / best[one.warm] - 1.0).max()
        rows.append([bound, name, f"{scaled[name]:.1f}", f"{scaled[name] / seconds['ours']:.0f}", f"{apart:.0e}"])
    return rows


QUESTION = Question("distribution", "Cable forces along the thesis's helix, beside general solvers", answer)
