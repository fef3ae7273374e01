"""Commands that know only winches that hold lengths say so of other robots."""

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.robot.robot import Robot


def require_locked_lengths(robot: Robot, why: str) -> None:
    """Refuse a robot with a winch that holds the tension of its cable.

    why : what locked lengths are needed for, and what to do instead

    Raises
    ------
    InputError : there is one; the complaint names the field.
    """
    held = np.flatnonzero([cable.winch_tension > 0.0 for cable in robot.cables])
    if held.size:
        first = int(held[0])
        value = robot.cables[first].winch_tension
        raise InputError(robot.name, f"cables[{first + 1}].winch_tension", value, f"leave it out: {why}")
