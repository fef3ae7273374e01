"""From a recording and a mapping to a campaign that the diagnosis reads."""

import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.recordings.campaign_text import (
    CAMPAIGN,
    FILES,
    KINDS,
    campaign_file,
    data_file,
    has_times,
    sigmas,
)
from cdpr_struct.recordings.channel import Recording
from cdpr_struct.recordings.frames import Frames, moving_frames
from cdpr_struct.recordings.mapping import MappingFile
from cdpr_struct.recordings.measured import measure
from cdpr_struct.recordings.still import still_frames
from cdpr_struct.robot.robot import Robot


@dataclass(frozen=True, slots=True, eq=False)
class CampaignOfRecording:
    """A campaign from a recording.

    frames : its states;  sigma : one sigma of each quantity, by the campaign's keys
    zero   : time of the recording at which time_s is zero [s];  data : text of the data file
    about  : sentences on where the data come from;  notes : what a reader must not miss
    """

    mapping: MappingFile
    frames: Frames
    sigma: Mapping[str, float]
    zero: float
    data: str
    about: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def kind(self) -> str:
        """Of the data file."""
        return KINDS[self.mapping.sampling.mode]

    def files(self, robot: str) -> dict[str, str]:
        """Contents by name: the data file and campaign.toml, which names the robot so."""
        campaign = campaign_file(self.mapping, robot, self.sigma, (*self.about, *self.notes))
        return {FILES[self.mapping.sampling.mode]: self.data, CAMPAIGN: campaign}


def campaign_of(recording: Recording, mapping: MappingFile, source: str, robot: Robot) -> CampaignOfRecording:
    """The campaign of a recording.

    source : the mapping file, for complaints

    Raises
    ------
    InputError : channels, units, times or samples that cannot be used, or nothing stands still.
    """
    _check_cables(mapping, robot, source)
    measured = measure(recording, mapping, source)
    read = still_frames if mapping.sampling.mode == "still" else moving_frames
    frames = read(measured, mapping.sampling, str(recording.path))
    sigma, lacking = sigmas(frames, mapping)
    notes = (*measured.notes, *_notes(frames, mapping, lacking))
    zero = f" time_s is zero at {measured.zero:.12g} s of its clock." if measured.zero else ""
    about = (f"From {recording.path.name}, {recording.form}, by import-recording.{zero}", frames.said)
    name = "".join(c if c.isprintable() and c not in ',"' else " " for c in recording.path.stem).strip() or "state"
    return CampaignOfRecording(mapping, frames, sigma, measured.zero, data_file(frames, mapping, name), about, notes)


def _check_cables(mapping: MappingFile, robot: Robot, source: str) -> None:
    cables = len(robot.cables)
    for name, table in (("lengths", mapping.lengths), ("tensions", mapping.tensions)):
        if table is not None and len(table.channels) != cables:
            expected = f'{cables}, one for each cable of {robot.name}; "" for a cable without a sensor'
            raise InputError(source, f"{name}.channels", f"{len(table.channels)} channels", expected)


def _notes(frames: Frames, mapping: MappingFile, lacking: list[str]) -> Iterator[str]:
    if frames.left_out:
        yield f"{frames.left_out} frames that lie in gaps were left out; {len(frames.time)} remain."
    if lacking:
        yield (
            f"No sigma of {', '.join(lacking)} is given, nor can be told from the recording: the usual one of a "
            "campaign file is taken. Give it under [sigma]."
        )
    if mapping.sampling.mode == "still" and set(frames.sigma) - {k for k, v in mapping.sigma.model_dump().items() if v}:
        yield "Sigmas from the scatter leave out what is the same in all samples, such as calibration: enlarge them."
    if mapping.sampling.mode == "still" and not has_times(frames):
        yield "Some stretches are less than 2 s apart: time_s is left out, since they would be taken for a motion."


def read_back(found: CampaignOfRecording, robot: str, directory: Path) -> Campaign:
    """The campaign as `diagnose` reads it; complaints name its files in `directory`.

    robot : built-in name, or path from anywhere

    Raises
    ------
    InputError : what the reader of campaigns says of the data.
    """
    with tempfile.TemporaryDirectory(prefix="import-") as folder:
        for name, text in found.files(robot).items():
            (Path(folder) / name).write_text(text, "utf-8", newline="\n")
        try:
            return load_campaign(Path(folder) / CAMPAIGN)
        except InputError as error:
            source, field = (text.replace(folder, str(directory)) for text in (error.source, error.field))
            raise InputError(source, field, error.value, error.expected.replace(folder, str(directory))) from error
