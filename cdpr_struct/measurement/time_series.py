"""Time series in CSV files: one row an instant, one column a quantity."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from cdpr_struct.errors import InputError
from cdpr_struct.statics.trajectory import Trajectory, through_samples

ACCELERATION_COLUMNS = ("ax", "ay", "az")
TRANSIENT_COLUMNS = ("x_m_s2", "y_m_s2", "z_m_s2")  # of transient.csv
_POSITION, _ANGLES = ("x_m", "y_m", "z_m"), ("rx_deg", "ry_deg", "rz_deg")
_EVEN = 0.01  # largest relative deviation of a time step from their mean
_FEWEST_SAMPLES = 64


def read_columns(path: Path, required: Sequence[str], optional: Sequence[str] = ()) -> dict[str, np.ndarray]:
    """Named columns of numbers of a CSV file; other columns are left alone.

    Raises
    ------
    InputError : no such file, not a table, a column that is missing, or a cell that is not a finite number.
    """
    try:
        table = pd.read_csv(path)
    except (OSError, UnicodeDecodeError, pd.errors.ParserError, pd.errors.EmptyDataError) as error:
        raise InputError(str(path), "", str(error).splitlines()[0], "a CSV file with a header line") from error
    missing = [name for name in required if name not in table.columns]
    if missing:
        raise InputError(str(path), missing[0], "nothing", f"columns {', '.join(required)} are required")
    names = [*required, *(name for name in optional if name in table.columns)]
    return {name: _numbers(path, name, table[name]) for name in names}


def _numbers(path: Path, name: str, column: pd.Series) -> np.ndarray:
    values = pd.to_numeric(column, errors="coerce").to_numpy(dtype=float)
    bad = np.flatnonzero(~np.isfinite(values))
    if len(bad):
        raise InputError(f"{path}, line {bad[0] + 2}", name, str(column.iloc[int(bad[0])]), "a finite number")
    return values


def read_accelerations(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Evenly spaced time (n,) [s] and accelerations (n, 3) [m/s^2] from columns time_s, ax, ay, az, or a transient.csv.

    Raises
    ------
    InputError : as `read_columns`; or uneven or too few instants.
    """
    names = TRANSIENT_COLUMNS if _is_transient(path) else ACCELERATION_COLUMNS
    columns = read_columns(path, ("time_s", *names))
    time = columns["time_s"]
    if len(time) < _FEWEST_SAMPLES:
        raise InputError(str(path), "time_s", f"{len(time)} rows", f"at least {_FEWEST_SAMPLES} instants")
    steps = np.diff(time)
    mean = (time[-1] - time[0]) / len(steps)
    worst = int(np.abs(steps - mean).argmax())
    if not (mean > 0.0 and abs(steps[worst] - mean) <= _EVEN * mean):
        raise InputError(
            f"{path}, line {worst + 3}", "time_s", f"a step of {steps[worst]:.6g} s", f"even steps, here {mean:.6g} s"
        )
    return time, np.stack([columns[name] for name in names], axis=1)


def _is_transient(path: Path) -> bool:
    """Whether the header is that of a file which `transient` wrote; False also if there is none to read."""
    try:
        with path.open(encoding="utf-8") as lines:
            header = [name.strip() for name in lines.readline().split(",")]
    except (OSError, UnicodeDecodeError):
        return False
    return set(TRANSIENT_COLUMNS) <= set(header) and not set(ACCELERATION_COLUMNS) & set(header)


def read_trajectory(path: Path) -> Trajectory:
    """Nominal motion from columns time_s, x_m, y_m, z_m and optionally rx_deg, ry_deg, rz_deg.

    Raises
    ------
    InputError : as `read_columns`; or times that do not ascend, or fewer than four instants.
    """
    columns = read_columns(path, ("time_s", *_POSITION), _ANGLES)
    time = columns["time_s"]
    if len(time) < 4:
        raise InputError(str(path), "time_s", f"{len(time)} rows", "at least four instants")
    back = np.flatnonzero(~(np.diff(time) > 0.0))
    if len(back):
        raise InputError(f"{path}, line {back[0] + 3}", "time_s", time[back[0] + 1], "times that ascend")
    zero = np.zeros(len(time))
    angles = np.radians(np.stack([columns.get(name, zero) for name in _ANGLES], axis=1))
    return through_samples(time, np.stack([columns[name] for name in _POSITION], axis=1), angles)
