"""Commands that know only winches that hold lengths say so of other robots."""

from cdpr_struct.errors import InputError
from cdpr_struct.robot.robot import Robot


def require_locked_lengths(robot: Robot, why: str) -> None:
    """Refuse a robot with a winch that holds the tension of its cable.

    why : what locked lengths are needed for, and what to do instead

    Raises
    ------
    InputError : there is one; the complaint names the field.
    """
    if robot.tension_winches:
        first = robot.tension_winches[0]
        value = robot.cables[first - 1].winch_tension
        raise InputError(robot.name, f"cables[{first}].winch_tension", value, f"leave it out: {why}")
