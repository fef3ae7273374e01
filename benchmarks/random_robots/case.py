"""One question: a robot, a pose, and what is left free."""

from dataclasses import dataclass

from cdpr_struct import Pose, Robot

GRAVITY = 9.81


@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """What is asked: the cables that hold a robot at a pose, `free` angles left to hang; `start` of the way back."""

    seed: int
    kind: str
    robot: Robot
    pose: Pose
    free: str | None
    start: Pose | None
