"""What do 12 modes at each of many poses cost, as one batch and pose by pose with another code?

    python -m benchmarks pose-batch

625 poses of the eight-cable robot of Table 3.1. Ours: tensions, lengths and 12 frequencies, each in its proved bracket.
Exudyn: from our lengths to its own equilibrium and 12 frequencies with four elements a cable (`robot-modes` has its
errors), at every `STRIDE`-th pose, scaled up. Errors are against certified modes of single poses.
"""

import numpy as np

from benchmarks.markdown_page import table
from benchmarks.peers import exudyn_cables, present
from benchmarks.question import Answer, Question, paragraphs
from benchmarks.timing import medians, milliseconds
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.many_poses import FrequenciesOfPoses, lowest_frequencies, poses_of
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

COUNT, STRIDE, ELEMENTS = 12, 25, 4


class PoseBatch:
    """asv-shaped; the parameter is the number of poses along each side of the map."""

    params = (5, 25)
    param_names = ("poses_a_side",)

    def setup(self, poses_a_side: int) -> None:
        self.robot = load_robot("thesis-3-1")
        x, y = np.meshgrid(np.linspace(-3.0, 3.0, poses_a_side), np.linspace(-2.0, 2.0, poses_a_side), indexing="ij")
        self.positions = np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.8)], axis=-1)
        self.rotations = np.broadcast_to(np.eye(3), (x.size, 3, 3))
        self.point = self.rest()
        lengths = self.point.cables.total_length
        self.sample = np.arange(0, x.size, STRIDE)
        self.models = [to_fem(self.robot, lengths[i]) for i in self.sample]

    def rest(self) -> OperatingPoint:
        cables = inverse(self.robot, self.positions, self.rotations).cables
        return OperatingPoint(self.robot, self.positions, self.rotations, cables)

    def modes(self) -> FrequenciesOfPoses:
        return lowest_frequencies(self.rest(), COUNT)

    def by_exudyn(self) -> np.ndarray:
        """(sample, 12) [Hz]."""
        each = zip(self.models, self.positions[self.sample], strict=True)
        return np.array([exudyn_cables.robot_frequencies(model, place, ELEMENTS, COUNT) for model, place in each])

    def certified(self) -> np.ndarray:
        """(sample, 12) [Hz], one pose after the other."""
        points = (poses_of(self.point, int(i)) for i in self.sample)
        return np.array([certified_modes(point, "exact", COUNT).frequencies.hertz for point in points])

    def time_batch(self, poses_a_side: int) -> None:
        self.modes()

    def time_exudyn_sample(self, poses_a_side: int) -> None:
        self.by_exudyn()


def answer(quick: bool) -> Answer:
    """Time a pose of each."""
    case = PoseBatch()
    case.setup(PoseBatch.params[0] if quick else PoseBatch.params[1])
    peers, absent = present(("Exudyn",))
    tasks = {"cdpr-struct, one batch": (case.modes, len(case.positions))}
    if peers:
        tasks[f"Exudyn, {ELEMENTS} ANCF cables each, pose by pose"] = (case.by_exudyn, len(case.sample))
    seconds = medians({name: task for name, (task, _) in tasks.items()}, 1 if quick else 5)
    a_pose = {name: seconds[name] / poses for name, (_, poses) in tasks.items()}
    ours, exact = a_pose["cdpr-struct, one batch"], case.certified()
    found = [case.modes().hertz[case.sample]] + ([case.by_exudyn()] if peers else [])
    rows = [
        [name, milliseconds(time), f"{time / ours:.0f}", f"{np.abs(hertz / exact - 1.0).max():.1e}"]
        for (name, time), hertz in zip(a_pose.items(), found, strict=True)
    ]
    head = ["code", "time a pose [ms]", "of ours", "largest error"]
    return Answer(paragraphs(f"{len(case.positions)} poses.", table(head, rows), *absent))


QUESTION = Question("pose-batch", f"{COUNT} modes at each of many poses", answer)
