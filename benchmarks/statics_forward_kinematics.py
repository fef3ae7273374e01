"""How many poses a second does the forward kinematics solve, beside MoorPy's system equilibrium?

    python -m benchmarks forward-kinematics

Fixed case: the eight-cable robot of Table 3.1, 4 mm cables, 60 kg, poses x, y in -3..3 m at z = 0.5 m, cable lengths
of the ideal model, every solver started at the reference pose. Both answers are compared.
"""

import numpy as np

from benchmarks.markdown_page import table
from benchmarks.peers import moorpy_lines, present
from benchmarks.question import Answer, Question, paragraphs
from benchmarks.timing import medians
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.pose_error import pose_error, reference_lengths


def grid(count: int) -> np.ndarray:
    """(count^2, 3) poses."""
    x, y = np.meshgrid(*[np.linspace(-3.0, 3.0, count)] * 2, indexing="ij")
    return np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.5)], axis=-1)


class ForwardKinematics:
    """Poses a second; the parameter is the number of poses along each side of the map."""

    params = (5, 61)
    param_names = ("poses_a_side",)

    def setup(self, poses_a_side: int) -> None:
        self.robot = load_robot("thesis-3-1")
        self.poses = grid(poses_a_side)
        self.lengths = reference_lengths(self.robot, self.poses, np.eye(3))

    def time_batched(self, poses_a_side: int) -> None:
        """Sagging model, all poses at once."""
        forward(self.robot, self.lengths, self.poses)

    def time_pose_error_map(self, poses_a_side: int) -> None:
        """Sagging and spring model with continuation: the map of figs 3.4-3.7."""
        pose_error(self.robot, self.poses, np.eye(3))


class MoorPyEquilibrium:
    """The peer on the same robot, pose by pose; its models are built beforehand."""

    params = (5,)
    param_names = ("poses_a_side",)

    def setup(self, poses_a_side: int) -> None:
        robot, self.poses = load_robot("thesis-3-1"), grid(poses_a_side)
        lengths = reference_lengths(robot, self.poses, np.eye(3))
        self.systems = [moorpy_lines.robot_system(robot, *case) for case in zip(self.poses, lengths, strict=True)]

    def time_one_by_one(self, poses_a_side: int) -> None:
        each = zip(self.systems, self.poses, strict=True)
        self.positions = np.array([moorpy_lines.rest_position(system, pose) for system, pose in each])


def answer(quick: bool) -> Answer:
    """Poses a second of both."""
    cases = {side: ForwardKinematics() for side in ForwardKinematics.params[: 1 if quick else 2]}
    tasks, poses = {}, {}
    for side, case in cases.items():
        case.setup(side)
        name = f"cdpr-struct, one batch of {side} x {side} poses"
        tasks[name], poses[name] = (lambda c=case, s=side: c.time_batched(s)), side**2
    peers, absent = present(("MoorPy",))
    if peers:
        peer = MoorPyEquilibrium()
        peer.setup(5)
        tasks["MoorPy, 25 poses one by one"], poses["MoorPy, 25 poses one by one"] = (
            (lambda: peer.time_one_by_one(5)), 25,
        )  # fmt: skip
    seconds = medians(tasks, 1 if quick else 5)
    rates = {name: poses[name] / seconds[name] for name in tasks}
    slowest = min(rates.values())
    rows = [[name, f"{rate:.0f}", f"{rate / slowest:.0f}"] for name, rate in rates.items()]
    apart = ""
    if peers:
        found = forward(cases[5].robot, cases[5].lengths, cases[5].poses).position
        apart = f"The two answers differ by {np.abs(found - peer.positions).max():.0e} m at most."
    return Answer(paragraphs(table(["code", "poses a second", "of the slowest"], rows), apart, *absent))


QUESTION = Question("forward-kinematics", "Poses a second from locked lengths", answer)
