"""The trajectory that an argument names: one that was made already, a built-in one, a straight line, or a CSV file."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

from cdpr_struct.errors import InputError
from cdpr_struct.interface.arguments import LARGEST

if TYPE_CHECKING:
    from cdpr_struct.interface.given import TrajectoryLike
    from cdpr_struct.measurement.trajectory_file import TrajectoryFile
    from cdpr_struct.robot.pose import Pose
    from cdpr_struct.statics.trajectory import Trajectory

NAME = "trajectory"
FORMS = "helix, line:X,Y,Z[,RX,RY,RZ]:X,Y,Z[,RX,RY,RZ]:SECONDS, or a CSV file time_s,x_m,y_m,z_m[,rx_deg,ry_deg,rz_deg]"
MOST_INSTANTS = 1_000_000
SHORTEST = 1e-6  # s, of a line


def read_trajectory(given: "TrajectoryLike", instants: int | None, fewest: int = 1) -> tuple["Trajectory", list[str]]:
    """The trajectory, and sentences on what was assumed where a file says nothing.

    instants : default 3001 for built-in ones, the file's own rows;  fewest : rows that a file must have

    Raises
    ------
    InputError : not one of the forms, or a file with unusable rows.
    """
    from cdpr_struct.statics.trajectory import Trajectory, helix, straight_line

    if isinstance(given, Trajectory):
        if instants is not None:
            raise InputError("instants", "", instants, "a Trajectory has its own instants, leave the argument out")
        return given, []
    if not isinstance(given, str | os.PathLike):
        raise InputError(NAME, "", given, f"give a Trajectory, or {FORMS}")
    text = os.fspath(given)
    if instants is not None and not 2 <= instants <= MOST_INSTANTS:
        raise InputError("instants", "", instants, f"give a number from 2 to {MOST_INSTANTS}")
    if text == "helix":
        return helix(instants or 3001), []
    if text.startswith("line:"):
        start, end, seconds = _line(text)
        return straight_line(start, end, seconds, instants or 3001), []
    if instants is not None:
        raise InputError("instants", "", instants, "a trajectory file has its own instants, leave the option out")
    found = _from_file(Path(text), fewest)
    return found.trajectory, list(found.notes)


def _line(text: str) -> tuple["Pose", "Pose", float]:
    from cdpr_struct.robot.pose import Pose

    try:
        start, end, seconds = text.removeprefix("line:").split(":")
        poses = [Pose.from_degrees([float(v) for v in part.split(",")]) for part in (start, end)]
        duration = float(seconds)
    except ValueError as error:
        raise InputError(NAME, "", text, f"give {FORMS}") from error
    if not SHORTEST <= duration <= LARGEST:
        raise InputError(NAME, "", text, f"the line's duration must be above 0 s, and {SHORTEST:g} s at least")
    if not all(abs(v) <= LARGEST for pose in poses for v in pose.position):
        raise InputError(NAME, "", text, f"give coordinates of at most {LARGEST:g} m")
    return poses[0], poses[1], duration


def _from_file(path: Path, fewest: int) -> "TrajectoryFile":
    from cdpr_struct.measurement.trajectory_file import read_trajectory as read_file

    try:
        known = path.exists() and not path.is_dir()
    except (OSError, ValueError):  # a name that no file can have
        known = False
    if not known:
        raise InputError(NAME, "", str(path), f"no such file; give {FORMS}")
    return read_file(path, fewest)
