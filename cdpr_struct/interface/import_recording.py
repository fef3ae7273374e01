"""Recordings of real machines: which channels they hold, and a campaign made of them."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import one_of, read_robot
from cdpr_struct.interface.written import write_text
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.recordings.importing import campaign_of, read_back
from cdpr_struct.recordings.listing import ChannelSummary, summaries
from cdpr_struct.recordings.mapping import MappingFile, checked, load_mapping
from cdpr_struct.recordings.opening import open_recording
from cdpr_struct.recordings.template import template
from cdpr_struct.robot.file_complaints import input_error
from cdpr_struct.robot.robot_file import builtin_names

if TYPE_CHECKING:
    import pandas as pd

Path_ = str | os.PathLike[str]
_GIVEN = "mapping"


@dataclass(frozen=True, slots=True, eq=False)
class RecordingChannels:
    """What a recording holds.

    form : what kind of file it is;  channels : with samples, rate and range;  template : a mapping file to fill in
    """

    form: str
    channels: tuple[ChannelSummary, ...]
    template: str

    def frame(self) -> "pd.DataFrame":
        """One row a channel."""
        import pandas as pd

        return pd.DataFrame([dict(channel.answer()) for channel in self.channels])


@dataclass(frozen=True, slots=True, eq=False)
class ImportedRecording:
    """A campaign made of a recording.

    files    : contents by name: the data file and campaign.toml;  campaign : as `diagnose` reads it
    answer   : keys of the command's JSON;  warnings : sentences that a reader must not miss
    """

    files: Mapping[str, str]
    campaign: Campaign
    answer: Mapping[str, Any]
    warnings: tuple[str, ...] = ()

    def write(self, directory: Path_, *, overwrite: bool = False) -> Path:
        """Write the files into a directory, each whole or not at all, and return the path of campaign.toml.

        Raises
        ------
        InputError : one of the files is there already, or cannot be written.
        """
        folder = Path(directory)
        for name in () if overwrite else self.files:
            if (folder / name).exists():
                expected = "a directory without files of these names, or overwrite=True"
                raise InputError("directory", "", str(folder / name), expected)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            expected = f"a directory that can be made ({error.strerror})"
            raise InputError("directory", "", str(folder), expected) from error
        return [write_text(folder / name, text, overwrite) for name, text in self.files.items()][-1]


@answered
def recording_channels(file: Path_, *, clock: str = "stamp") -> RecordingChannels:
    """List the channels of a recording (bag, MCAP, TDMS, MDF, .mat, .xlsx, CSV), with a mapping file to fill in.

    Parameters
    ----------
    file : the recording, or the folder of a ROS 2 bag
    clock : times of a bag: stamp, of the messages' headers where they have one, or received, of the recorder

    Raises
    ------
    InputError : no such file, one that cannot be read, or a package to read it is not installed.
    """
    recording = open_recording(
        Path(file), "received" if one_of(clock, "clock", ("stamp", "received")) == "received" else "stamp"
    )
    found = summaries(recording)
    return RecordingChannels(
        recording.form, found, template(recording.channels, recording.path.name, _is_ros(recording.form))
    )


def _is_ros(form: str) -> bool:
    return "ROS" in form or "MCAP" in form


@answered
def import_recording(
    file: Path_, mapping: Path_ | Mapping[str, Any], *, robot: Path_ | None = None, directory: Path_ = "."
) -> ImportedRecording:
    """Make a campaign of a recording (ROS bag, MCAP, TDMS, MDF, .mat, .xlsx, CSV) and a mapping of its channels.

    Parameters
    ----------
    file : the recording, or the folder of a ROS 2 bag
    mapping : path of a mapping file, or its tables; `recording_channels` makes one to begin with
    robot : built-in name, or path of a robot file; default: that of the mapping
    directory : where the campaign will be, for the robot's path

    Raises
    ------
    InputError : a file, channel, unit or sample that cannot be used, or a package to read it is not installed.
    """
    table, source, place = _mapping(mapping)
    named = _robot(robot, table, source, place)
    machine = read_robot(named)
    recording = open_recording(Path(file), table.time.clock)
    found = campaign_of(recording, table, source, machine)
    campaign = read_back(found, named if named in builtin_names() else str(Path(named).resolve()), Path(directory))
    answer = {
        "file": os.fspath(file), "form": recording.form, "kind": found.kind, "states": len(found.frames.time),
        "left_out": found.frames.left_out, "sampling": found.frames.said, "sigma": dict(found.sigma),
        "zero_s": found.zero, "start_s": float(found.frames.time[0]), "end_s": float(found.frames.time[-1]),
    }  # fmt: skip
    shown = named if named in builtin_names() else os.path.relpath(named, directory)
    return ImportedRecording(found.files(shown), campaign, answer, (*found.notes, *campaign.notes))


def _mapping(given: Path_ | Mapping[str, Any]) -> tuple[MappingFile, str, Path]:
    """The mapping, what complaints call it, and the folder that its robot is looked for in."""
    if not isinstance(given, Mapping):
        return load_mapping(Path(given)), os.fspath(given), Path(given).parent
    try:
        return checked(MappingFile.model_validate(given), _GIVEN), _GIVEN, Path()
    except ValidationError as error:
        raise input_error(_GIVEN, error, MappingFile) from error


def _robot(given: Path_ | None, table: MappingFile, source: str, place: Path) -> str:
    """The robot as a name or path from here."""
    if given is not None:
        return os.fspath(given)
    if table.robot in ("", "?"):
        expected = (
            "the robot that was recorded: a built-in name or the path of a robot file, here or as the option --robot"
        )
        raise InputError(source, "robot", "nothing", expected)
    return table.robot if table.robot in builtin_names() else str(place / table.robot)
