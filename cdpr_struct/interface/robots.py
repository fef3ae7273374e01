"""The robots that come with the package, and robots as files."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.written import write_text
from cdpr_struct.reports.robots_result import robots_columns, robots_json, robots_sentence, robots_text
from cdpr_struct.reports.trust_without_robot import robots_trust, with_trust
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import builtin_names, load_robot
from cdpr_struct.robot.robot_writing import robot_toml

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RobotsResult(Result):
    """The built-in robots.

    robots : `Robot` objects, in the order of their names
    """

    robots: tuple[Robot, ...]

    @property
    def title(self) -> str:
        """What is listed."""
        return "Built-in robots"

    def text(self) -> str:
        """One line a robot."""
        return robots_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """How many there are."""
        return [robots_sentence(self.answer["robots"])]

    def columns(self) -> Mapping[str, Any]:
        """Columns of robots.csv."""
        return robots_columns(self.robots)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """The frames from above, to one scale."""
        from cdpr_struct.reports.figures import footprints

        return lambda figure: footprints.draw_footprints(figure, self.robots), footprints.SIZE

    def files(self) -> Files:
        """Table, drawings and page."""
        from cdpr_struct.reports.robots_page import robots_files

        return robots_files(self.robots, self.answer["robots"])


@answered
def robots() -> RobotsResult:
    """List the robots that come with the package."""
    found = tuple(load_robot(name) for name in builtin_names())
    return RobotsResult(with_trust(robots_json(found), robots_trust(found)), found)


def write_robot(robot: Robot, path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
    """Write a robot to a robot file, which `load_robot` and every command read again, and return its path.

    Raises
    ------
    InputError : there is a file already, or it cannot be written.
    """
    if not isinstance(robot, Robot):
        raise InputError("robot", "", robot, "a Robot")
    return write_text(Path(path), robot_toml(robot, robot.name), overwrite)
