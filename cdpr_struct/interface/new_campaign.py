"""A campaign to begin with: the files of measured data, to be filled."""

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import one_of, read_numbers, read_robot, real
from cdpr_struct.interface.cable_wind import require_cables_without_drag
from cdpr_struct.interface.given import PoseLike
from cdpr_struct.interface.written import write_text
from cdpr_struct.measurement.assumed_angles import ANGLES
from cdpr_struct.measurement.campaign_template import KINDS, READINGS, campaign_files, planned
from cdpr_struct.measurement.data_table import read_table
from cdpr_struct.measurement.time_series import columns_of
from cdpr_struct.robot.plausibility import implausible
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import builtin_names

USUAL, PAYLOAD = ("tensions", "lengths"), 10.0
_PLACE = ("x_m", "y_m", "z_m")
_MOST = 1000
_FORM = "poses X,Y,Z[,RX,RY,RZ] in m and deg with ; between them, or a CSV file with columns x_m, y_m, z_m, ..."


@dataclass(frozen=True, slots=True, eq=False)
class NewCampaign:
    """Files of a campaign to begin with.

    files : contents by name: campaign.toml and the data files;  cases : names of the poses, in order
    warnings : numbers of the robot that can hardly be meant
    """

    files: Mapping[str, str]
    cases: tuple[str, ...]
    warnings: tuple[str, ...] = ()

    def write(self, directory: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
        """Write the files into a directory and return the path of campaign.toml.

        Raises
        ------
        InputError : one of the files is there already, or cannot be written.
        """
        folder = Path(directory)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(
                "directory", "", str(folder), f"a directory that can be made ({error.strerror})"
            ) from error
        for name in () if overwrite else self.files:
            if (folder / name).exists():
                expected = "a directory without files of these names, or overwrite=True"
                raise InputError("directory", "", str(folder / name), expected)
        for name, text in self.files.items():
            write_text(folder / name, text, overwrite)
        return folder / "campaign.toml"


@answered
def new_campaign(
    robot: str | os.PathLike[str],
    *,
    kinds: str | Iterable[str] = USUAL,
    poses: str | os.PathLike[str] | Iterable[PoseLike] | None = None,
    payload: float = PAYLOAD,
    directory: str | os.PathLike[str] = ".",
) -> NewCampaign:
    """Make a campaign file and data files with the planned poses and what the simulation predicts, to be filled.

    Parameters
    ----------
    robot : built-in name, or path of a robot file
    kinds : of tensions, lengths, swivels, cable_frequency, robot_frequency, loaded; text with commas, or a list; kinds
        of files, such as loaded_pose, stand for all readings in them but swivels
    poses : list of poses, text with ; between them, or path of a CSV file; default: the home pose
    payload : of the loaded poses [kg];  directory : where the files will be, for the robot's path

    Raises
    ------
    InputError : an unusable argument.
    UnholdablePoseError : the cables cannot hold a pose.
    """
    if isinstance(robot, Robot):
        raise InputError("robot", "", robot.name, "a built-in name or the path of a robot file: a campaign names it")
    machine = read_robot(robot)
    require_cables_without_drag(machine, "wind on cables is not among what is diagnosed")
    names = [part.strip() for part in (kinds.split(",") if isinstance(kinds, str) else kinds)]
    chosen = [one_of(name, "kinds", READINGS) for name in dict.fromkeys(own for name in names for own in _own(name))]
    real(payload, "payload", "give a mass in kg above zero", 0.0)
    cases, places = _poses(poses, machine)
    if "swivels" in chosen and not any(machine.pulleys):
        expected = f"a robot with pulleys: no cable of {machine.name} has one in its robot file"
        raise InputError("kinds", "", "swivels", expected)
    plan = planned(machine, cases, places)
    files = campaign_files(plan, _named(robot, Path(directory)), chosen, float(payload))
    return NewCampaign(files, tuple(cases), implausible(machine))


def _own(name: str) -> list[str]:
    """The kinds of readings that a name means: itself, or all that a file of that kind usually holds."""
    return [own for own, kind in KINDS.items() if kind == name and name not in READINGS and own != "swivels"] or [name]


def _named(robot: str | os.PathLike[str], directory: Path) -> str:
    """The robot as a campaign file in the directory names it."""
    text = os.fspath(robot)
    return text if text in builtin_names() else os.path.relpath(text, directory)


def _poses(given: str | os.PathLike[str] | Iterable[PoseLike] | None, robot: Robot) -> tuple[list[str], list[Pose]]:
    """Names of cases, and the poses."""
    if given is None:
        if robot.home is None:
            raise InputError("poses", "", "nothing", f"robot {robot.name} has no home_pose, so give {_FORM}")
        return ["home"], [robot.home]
    if isinstance(given, str | os.PathLike) and (os.fspath(given).endswith(".csv") or Path(given).is_file()):
        return _of_file(Path(given))
    parts = [part for part in given.split(";") if part.strip()] if isinstance(given, str) else list(given)  # type: ignore[arg-type]
    if not 1 <= len(parts) <= _MOST:
        raise InputError("poses", "", f"{len(parts)} poses", f"1 to {_MOST} {_FORM}")
    return _numbered(len(parts)), [part if isinstance(part, Pose) else _pose(part) for part in parts]


def _pose(given: str | Iterable[float]) -> Pose:
    return Pose.from_degrees(read_numbers(given, "poses", (3, 6), f"numbers a pose: {_FORM}"))


def _of_file(path: Path) -> tuple[list[str], list[Pose]]:
    table = read_table(path)
    columns = columns_of(table, _PLACE, ANGLES)
    values = np.stack([columns.get(name, np.zeros(len(table.rows))) for name in (*_PLACE, *ANGLES)], axis=1)
    if not 1 <= len(values) <= _MOST:
        raise InputError(str(path), "", f"{len(values)} poses", f"1 to {_MOST}")
    names = table.column("case") if "case" in table.names else _numbered(len(values))
    if "" in names or len(set(names)) < len(names) or any("," in name for name in names):
        raise InputError(str(path), "case", ", ".join(names)[:80], "a name of its own for each pose, without commas")
    return names, [Pose.from_degrees(row) for row in values]


def _numbered(count: int) -> list[str]:
    return [f"pose {i}" for i in range(1, count + 1)]
