"""From options to the robot at rest: `interface.operating_point`, loaded when it is needed."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cdpr_struct.interface.operating_point import AtRest
    from cdpr_struct.robot.robot import Robot


def rest(robot: "Robot", pose: str | None, lengths: str | None, start: str | None = None) -> "AtRest":
    """The robot at rest as `interface.operating_point.rest` finds it."""
    from cdpr_struct.interface import operating_point

    return operating_point.rest(robot, pose, lengths, start)
