"""The files of a campaign from the states of a recording."""

import csv
import io
from collections.abc import Mapping, Sequence

import numpy as np

from cdpr_struct.measurement.assumed_angles import ANGLES
from cdpr_struct.measurement.cable_columns import LENGTH, TENSION
from cdpr_struct.measurement.campaign_rows import POSITION
from cdpr_struct.measurement.quaternions import QUATERNION
from cdpr_struct.recordings.frames import Frames
from cdpr_struct.recordings.mapping import MappingFile
from cdpr_struct.robot.pose import angles_from_rotation

KINDS = {"still": "static_state", "motion": "static_state", "free_motion": "platform_motion"}
FILES = {"still": "states.csv", "motion": "states.csv", "free_motion": "motion.csv"}
CAMPAIGN = "campaign.toml"
_DIGITS = 10
_APART = 2.0  # s: states that follow each other sooner are taken for frames of a motion
_LEAST_SIGMA = 1e-9  # in the unit of each: a sensor without any scatter


def data_file(frames: Frames, mapping: MappingFile, name: str) -> str:
    """Text of the CSV file of the states, one row each. Cases are called `name` and their number."""
    mode = mapping.sampling.mode
    columns: dict[str, np.ndarray] = {}
    if frames.position is not None:
        columns |= dict(zip(POSITION, frames.position.T, strict=True))
    columns |= _rotation(frames, mapping)
    if mapping.payload_kg:
        columns["payload_kg"] = np.full(len(frames.time), mapping.payload_kg)
    if mode != "still" or has_times(frames):
        columns["time_s"] = frames.time
    for quantity, values in ((TENSION, frames.tensions), (LENGTH, frames.lengths)):
        if values is not None and not (mode == "free_motion" and quantity is TENSION):
            columns |= dict(zip(quantity.columns(values.shape[1]), values.T, strict=True))
    cases = [name] * len(frames.time) if mode == "free_motion" else _cases(name, len(frames.time))
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["case", *columns])
    writer.writerows(
        [case, *map(_cell, row)] for case, row in zip(cases, zip(*columns.values(), strict=True), strict=True)
    )
    return file.getvalue()


def has_times(frames: Frames) -> bool:
    """Whether states at rest are far enough apart to be filed with their times."""
    return bool((np.diff(frames.time) > _APART).all())


def _rotation(frames: Frames, mapping: MappingFile) -> Mapping[str, np.ndarray]:
    """A quaternion where the recording has one, else angles; empty cells where the rotation was not measured."""
    if frames.rotation is None:
        empty = mapping.sampling.mode != "free_motion" and frames.position is not None
        return dict.fromkeys(ANGLES, np.full(len(frames.time), np.nan)) if empty else {}
    if mapping.rotation is not None and mapping.rotation.form == "quaternion":
        return dict(zip(QUATERNION, np.roll(frames.rotation.as_quat(canonical=True), 1, axis=1).T, strict=True))
    return dict(zip(ANGLES, np.degrees(angles_from_rotation(frames.rotation.as_matrix())).T, strict=True))


def _cases(name: str, count: int) -> list[str]:
    width = len(str(count))
    return [f"{name} {number:0{width}d}" for number in range(1, count + 1)]


def _cell(value: float) -> str:
    return f"{value:.{_DIGITS}g}" if np.isfinite(value) else ""


def sigmas(frames: Frames, mapping: MappingFile) -> tuple[dict[str, float], list[str]]:
    """Sigmas by the campaign's keys: those of the mapping, else those of the scatter; and the keys that have none."""
    parts = {
        "position_m": frames.position, "rotation_deg": frames.rotation, "length_m": frames.lengths,
        "tension_N": None if mapping.sampling.mode == "free_motion" else frames.tensions,
    }  # fmt: skip
    given = mapping.sigma.model_dump()
    found, lacking = {}, []
    for key in (key for key, part in parts.items() if part is not None):
        value = given[key] or float(f"{frames.sigma.get(key, 0.0):.2g}")
        if value > _LEAST_SIGMA:
            found[key] = value
        else:
            lacking.append(key)
    return found, lacking


def campaign_file(mapping: MappingFile, robot: str, sigma: Mapping[str, float], about: Sequence[str]) -> str:
    """Text of campaign.toml.

    robot : as the campaign file names it;  about : sentences on where the data come from
    """
    mode = mapping.sampling.mode
    lines = [
        *(f"# {_one_line(sentence)}" for sentence in about),
        f"robot = {_text(robot)}",
        f'model = "{mapping.model}"                              # simulation under test: static, dsm, exact, spring',
        *(['encoders = "relative"'] if mapping.encoders == "relative" else []),
        "",
        "[tolerances]                                 # one sigma of what is never exactly known: yours differ",
        "# anchor_m = 0.001                           # each coordinate of each anchor",
        "# axial_stiffness = 0.03                     # relative; 0.3 where it was estimated",
        "",
        "[[measurement]]",
        f'kind = "{KINDS[mode]}"',
        f'file = "{FILES[mode]}"',
    ]
    if sigma:
        lines.append(f"sigma = {{ {', '.join(f'{key} = {value:g}' for key, value in sigma.items())} }}")
    return "\n".join(lines) + "\n"


def _text(text: str) -> str:
    """A TOML string."""
    escaped = text.replace("\\", "/").replace('"', '\\"')
    return '"' + _one_line(escaped) + '"'


def _one_line(text: str) -> str:
    return "".join(c if c.isprintable() else " " for c in text)
