"""The trajectory that an option names: a built-in one, a straight line, or a CSV file."""

import csv
import math
from pathlib import Path
from typing import TYPE_CHECKING

from cdpr_struct.cli.options import LARGEST
from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    import numpy as np

    from cdpr_struct.robot.pose import Pose
    from cdpr_struct.statics.trajectory import Trajectory

OPTION = "--trajectory"
FORMS = "helix, line:X,Y,Z[,RX,RY,RZ]:X,Y,Z[,RX,RY,RZ]:SECONDS, or a CSV file time_s,x_m,y_m,z_m[,rx_deg,ry_deg,rz_deg]"
PLACE, TURN = ("time_s", "x_m", "y_m", "z_m"), ("rx_deg", "ry_deg", "rz_deg")
MOST_INSTANTS = 1_000_000
SHORTEST = 1e-6  # s, of a line and between two rows


def read_trajectory(text: str, instants: int | None) -> "Trajectory":
    """Trajectory of --trajectory, sampled at `instants` (default: 3001 for built-in ones, the file's own rows).

    Raises
    ------
    InputError : not one of the forms, or a file with unusable rows.
    """
    from cdpr_struct.statics.trajectory import helix, straight_line

    if instants is not None and not 2 <= instants <= MOST_INSTANTS:
        raise InputError("--instants", "", instants, f"give a number from 2 to {MOST_INSTANTS}")
    if text == "helix":
        return helix(instants or 3001)
    if text.startswith("line:"):
        start, end, seconds = _line(text)
        return straight_line(start, end, seconds, instants or 3001)
    if instants is not None:
        raise InputError("--instants", "", instants, "a trajectory file has its own instants, leave the option out")
    return _from_file(Path(text))


def _line(text: str) -> tuple["Pose", "Pose", float]:
    from cdpr_struct.robot.pose import Pose

    try:
        start, end, seconds = text.removeprefix("line:").split(":")
        poses = [Pose.from_degrees([float(v) for v in part.split(",")]) for part in (start, end)]
        duration = float(seconds)
    except ValueError as error:
        raise InputError(OPTION, "", text, f"give {FORMS}") from error
    if not SHORTEST <= duration <= LARGEST:
        raise InputError(OPTION, "", text, f"the line's duration must be above 0 s, and {SHORTEST:g} s at least")
    if not all(abs(v) <= LARGEST for pose in poses for v in pose.position):
        raise InputError(OPTION, "", text, f"give coordinates of at most {LARGEST:g} m")
    return poses[0], poses[1], duration


def _from_file(path: Path) -> "Trajectory":
    import numpy as np

    from cdpr_struct.statics.trajectory import through_samples

    table = _table(path)
    pause = np.diff(table[:, 0])
    if not (pause >= SHORTEST).all():
        row = int(np.flatnonzero(~(pause >= SHORTEST))[0]) + 1
        raise InputError(
            str(path),
            f"line {row + 2}, time_s",
            float(table[row, 0]),
            f"times must ascend from row to row, by {SHORTEST:g} s at least",
        )
    angles = np.radians(table[:, 4:]) if table.shape[1] > 4 else None
    return through_samples(table[:, 0], table[:, 1:4], angles)


def _table(path: Path) -> "np.ndarray":
    """Columns of the file in fixed order."""
    import numpy as np

    try:
        lines = path.read_text("utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "not a text file"
        raise InputError(OPTION, "", str(path), f"{reason}; give {FORMS}") from error
    rows = [row for row in enumerate(csv.reader(lines), start=1) if any(field.strip() for field in row[1])]
    if not rows:
        raise InputError(str(path), "", "an empty file", f"columns {','.join(PLACE)}[,{','.join(TURN)}]")
    names = [name.strip() for name in rows[0][1]]
    if len(names) == 1:
        raise InputError(str(path), "header", names[0], f"columns {','.join(PLACE)} with commas between them")
    wanted = (*PLACE, *TURN) if any(name in names for name in TURN) else PLACE
    for name in wanted:
        if name not in names:
            raise InputError(str(path), "header", ",".join(names), f"column {name} is missing")
    order = [names.index(name) for name in wanted]
    values = [
        [_number(path, line, name, row, i) for name, i in zip(wanted, order, strict=True)] for line, row in rows[1:]
    ]
    if not values:
        raise InputError(str(path), "", "no rows", "at least one row below the header")
    return np.array(values)


def _number(path: Path, line: int, name: str, row: list[str], index: int) -> float:
    text = row[index].strip() if index < len(row) else ""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not abs(value) <= LARGEST:
        raise InputError(str(path), f"line {line}, {name}", text, f"a finite number, at most {LARGEST:g} in size")
    return value
