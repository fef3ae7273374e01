"""Time series in CSV files: one row an instant, one column a quantity."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.column_names import renaming
from cdpr_struct.measurement.data_table import DataTable, read_table
from cdpr_struct.robot.robot_file import LARGEST

ACCELERATION_COLUMNS = ("ax", "ay", "az")
TRANSIENT_COLUMNS = ("x_m_s2", "y_m_s2", "z_m_s2")  # of transient.csv
_EVEN = 0.01  # largest relative deviation of a time step from their mean
_FEWEST_SAMPLES = 64


def columns_of(table: DataTable, required: Sequence[str], optional: Sequence[str] = ()) -> dict[str, np.ndarray]:
    """Named columns of numbers (n,) of a table; those that are optional where they are given, others are left alone.

    Raises
    ------
    InputError : a column that is missing, another name that is perhaps meant for one, no rows, or a cell that is not a
                 finite number.
    """
    missing = [name for name in required if name not in table.names]
    _, how = renaming(table.names, [*required, *optional])
    if missing:
        expected = f"column {missing[0]} is missing: " + (how or f"columns {', '.join(required)} are required")
        raise InputError(table.file, "header", ",".join(table.names), expected)
    if optional and how:
        raise InputError(table.file, "header", ",".join(table.names), how)
    table.require_rows()
    return {name: _numbers(table, name) for name in (*required, *optional) if name in table.names}


def _numbers(table: DataTable, name: str) -> np.ndarray:
    cells = table.column(name)
    try:
        values = np.array(list(map(float, cells)))
    except ValueError:
        values = np.array([_number(cell) for cell in cells])
    bad = np.flatnonzero(~(np.abs(values) <= LARGEST))
    if len(bad):
        place, expected = f"line {table.line[bad[0]]}, {name}", f"a finite number, at most {LARGEST:g} in size"
        raise InputError(table.file, place, cells[bad[0]], expected)
    return values


def _number(cell: str) -> float:
    """The number that a cell holds, nan if it holds none."""
    try:
        return float(cell)
    except ValueError:
        return float("nan")


def read_accelerations(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Evenly spaced time (n,) [s] and accelerations (n, 3) [m/s^2] from columns time_s, ax, ay, az, or a transient.csv.

    Raises
    ------
    InputError : as `read_table` and `columns_of`; or uneven or too few instants.
    """
    table = read_table(path)
    names = TRANSIENT_COLUMNS if _is_transient(table.names) else ACCELERATION_COLUMNS
    columns = columns_of(table, ("time_s", *names))
    time = columns["time_s"]
    if len(time) < _FEWEST_SAMPLES:
        raise InputError(str(path), "time_s", f"{len(time)} rows", f"at least {_FEWEST_SAMPLES} instants")
    steps = np.diff(time)
    mean = (time[-1] - time[0]) / len(steps)
    worst = int(np.abs(steps - mean).argmax())
    if not (mean > 0.0 and abs(steps[worst] - mean) <= _EVEN * mean):
        place = f"line {table.line[worst + 1]}, time_s"
        raise InputError(str(path), place, f"a step of {steps[worst]:.6g} s", f"even steps, here {mean:.6g} s")
    return time, np.stack([columns[name] for name in names], axis=1)


def _is_transient(names: Sequence[str]) -> bool:
    """Whether a header is that of a file which `transient` wrote."""
    return set(TRANSIENT_COLUMNS) <= set(names) and not set(ACCELERATION_COLUMNS) & set(names)
