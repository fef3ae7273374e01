"""Motion of the platform in a CSV file: columns time_s, x_m, y_m, z_m and, where the platform turns, its angles."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.assumed_angles import ANGLES, angle_note
from cdpr_struct.measurement.data_table import DataTable, read_table
from cdpr_struct.measurement.time_series import columns_of
from cdpr_struct.statics.trajectory import Trajectory, through_samples

PLACE = ("time_s", "x_m", "y_m", "z_m")
SHORTEST = 1e-6  # s between two rows


@dataclass(frozen=True, slots=True, eq=False)
class TrajectoryFile:
    """The motion that a file gives; `notes` say what was assumed where it says nothing, in sentences for a person."""

    trajectory: Trajectory
    notes: tuple[str, ...]


def read_trajectory(path: Path, fewest: int = 1) -> TrajectoryFile:
    """Trajectory through the rows of a file; an angle whose column is missing is zero, and a note says so.

    fewest : instants that are needed; one is a pose at rest

    Raises
    ------
    InputError : a file, column or cell that cannot be used, times that do not ascend, or too few instants.
    """
    table = read_table(path)
    columns = columns_of(table, PLACE, ANGLES)
    time = columns["time_s"]
    if len(time) < fewest:
        raise InputError(str(path), "time_s", f"{len(time)} rows", f"at least {fewest} instants")
    _check_ascent(table, time)
    zero = np.zeros(len(time))
    angles = np.radians(np.stack([columns.get(name, zero) for name in ANGLES], axis=1))
    motion = through_samples(time, np.stack([columns[name] for name in PLACE[1:]], axis=1), angles)
    return TrajectoryFile(motion, tuple(filter(None, [angle_note(str(path), table.names)])))


def _check_ascent(table: DataTable, time: np.ndarray) -> None:
    back = np.flatnonzero(~(np.diff(time) >= SHORTEST))
    if len(back):
        row = int(back[0]) + 1
        expected = f"times must ascend from row to row, by {SHORTEST:g} s at least"
        raise InputError(table.file, f"line {table.line[row]}, time_s", float(time[row]), expected)
