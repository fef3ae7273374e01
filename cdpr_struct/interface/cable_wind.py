"""Commands that have no room for wind on cables say so of robots that have drag_width."""

from cdpr_struct.errors import InputError
from cdpr_struct.robot.robot import Robot


def require_cables_without_drag(robot: Robot, why: str) -> None:
    """Refuse a robot whose cables wind pushes.

    why : what has no room for it

    Raises
    ------
    InputError : there is drag_width; the complaint names the field.
    """
    if robot.extensions.drag_width.any():
        value = robot.extensions.drag_width.tolist()
        raise InputError(robot.name, "extensions.drag_width", value, f"leave it out: {why}")
