"""A robot file to begin with."""

import math
import os
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from cdpr_struct.dynamics.certified_modes import certified_frequencies
from cdpr_struct.errors import CdprError, InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import one_of, read_numbers, real, whole
from cdpr_struct.interface.given import Numbers
from cdpr_struct.interface.operating_point import rest
from cdpr_struct.interface.written import write_text
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import robot_of_text
from cdpr_struct.robot.robot_layout import COUNTS
from cdpr_struct.robot.robot_template import RobotSketch
from cdpr_struct.robot.ropes import ROPES

CABLES, SIZE, MASS, ROPE, DIAMETER, PULLEYS = 8, (6.0, 4.0, 3.0), 25.0, "steel-6x19", 4.0, 0.0
_PRELOAD = (0.5, 0.2, 0.05)  # force_min over the weight: the first that the robot can hold at home
_GRAVITY = 9.81


@dataclass(frozen=True, slots=True, eq=False)
class NewRobot:
    """A robot to begin with.

    text : the commented robot file;  robot : what it describes
    """

    text: str
    robot: Robot

    def write(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
        """Write the robot file and return its path.

        Raises
        ------
        InputError : there is another file already, or it cannot be written.
        """
        return write_text(Path(path), self.text, overwrite)


@answered
def new_robot(
    name: str,
    *,
    cables: int = CABLES,
    size: Numbers = SIZE,
    mass: float = MASS,
    rope: str = ROPE,
    diameter: float = DIAMETER,
    pulleys: float = PULLEYS,
) -> NewRobot:
    """Make a commented robot file to begin with, of a robot that holds its home pose.

    Parameters
    ----------
    name : of the robot
    cables : 4, or 6 to 16;  size : width, depth, height of the frame [m];  mass : of the platform [kg]
    rope : steel-6x19, steel-7x19, steel-1x19, dyneema or aramid;  diameter : of the rope [mm]
    pulleys : radius of swivelling pulleys [m]; 0: cables begin at fixed points

    Raises
    ------
    InputError : an unusable argument.
    CdprError : cables of this weight, in a frame of this size, hold no such platform.
    """
    if not isinstance(name, str) or not name.strip():
        raise InputError("name", "", name, "a name for the robot")
    whole(cables, "cables", COUNTS[0], COUNTS[-1])
    if cables not in COUNTS:
        raise InputError("cables", "", cables, f"give {COUNTS[0]}, or a number from {COUNTS[1]} to {COUNTS[-1]}")
    frame = np.array(read_numbers(size, "size", (3,), "numbers in m: width, depth, height of the frame"))
    if not (frame > 0.0).all():
        raise InputError("size", "", size, "width, depth and height above zero")
    kind = ROPES[one_of(rope, "rope", ROPES)]
    real(mass, "mass", "give a mass in kg above zero", 0.0)
    real(diameter, "diameter", "give a diameter in mm, above 0 and at most 100", 0.0, 100.0 + 1e-9)
    most = 0.1 * float(frame.min())
    real(pulleys, "pulleys", f"give a radius in m from 0 to {most:g}, a tenth of the frame", -1e-300, most * (1 + 1e-9))
    sketch = RobotSketch(name, cables, frame, float(mass), kind, 1e-3 * diameter, float(pulleys), 0.0)
    return _first_that_holds(sketch)


def _first_that_holds(sketch: RobotSketch) -> NewRobot:
    """The robot with the largest of the usual preloads at which it is at rest and vibrates; hanging ones need none."""
    weight = sketch.mass * _GRAVITY
    preloads = [_rounded(share * weight) for share in _PRELOAD] if sketch.cables >= 8 else []
    for force in [*preloads, 0.0]:
        text = replace(sketch, force_min=force).text()
        robot = robot_of_text(text, "new robot")
        try:
            certified_frequencies(rest(robot, None, None).point, "exact", 6)
        except CdprError as error:
            if force == 0.0:
                width = " x ".join(f"{side:g}" for side in sketch.frame)
                reason = f"{sketch.cables} such cables in a frame of {width} m do not hold {sketch.mass:g} kg: {error}"
                raise CdprError(reason) from error
            continue
        return NewRobot(text, robot)
    raise AssertionError("the last preload is zero")


def _rounded(force: float) -> float:
    """A force with two digits."""
    return round(force, 1 - math.floor(math.log10(force)))
