"""Rows of a measured-data file, checked: columns known and present, numbers finite and in their range."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from cdpr_struct.errors import InputError, known_names, not_utf8
from cdpr_struct.measurement.universal_rows import is_universal, universal_columns
from cdpr_struct.robot.robot_file import LARGEST

POSE = ("x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg")
_NEEDED: dict[str, tuple[str, ...]] = {
    "static_state": ("x_m", "y_m", "z_m", "cable"),
    "loaded_pose": ("x_m", "y_m", "z_m"),
    "cable_frequency": ("x_m", "y_m", "z_m", "cable", "mode", "frequency_hz"),
    "robot_frequency": ("x_m", "y_m", "z_m", "frequency_hz"),
    "frf": ("frequency_hz", "real", "imag", "respond", "excite"),
    "free_decay": ("time_s", "ax", "ay", "az"),
    "platform_motion": ("x_m", "y_m", "z_m", "time_s"),
}
_ALSO: dict[str, tuple[str, ...]] = {
    "static_state": ("tension_N", "length_m"),
    "cable_frequency": ("tension_N", "plane"),
}
_ALWAYS = ("case", *POSE, "payload_kg", "sigma", "temperature_K", "approach", "time_s")
_WORDS = ("case", "respond", "excite", "plane")
_POSITIVE = ("tension_N", "length_m", "frequency_hz", "sigma", "temperature_K", "mode", "cable")
COMMENTS = ("comment", "note", "remark")  # columns for people, not read
HIGHEST = 1e3  # of any frequency [Hz]
_BLANK_ALLOWED = ("sigma", "temperature_K", "approach", "tension_N", "length_m", "time_s")


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """A checked table: numbers by column (n,), words by column, and the file it came from."""

    kind: str
    file: str
    numbers: dict[str, np.ndarray]
    words: dict[str, list[str]]

    def __len__(self) -> int:
        return len(next(iter(self.numbers.values())))

    def get(self, column: str, default: float = np.nan) -> np.ndarray:
        """Column (n,), or the default throughout."""
        found = self.numbers.get(column)
        return np.full(len(self), default) if found is None else found


def read_rows(kind: str, path: Path, cables: int) -> Rows:
    """Checked rows of a CSV file of the given kind, for a robot with `cables` cables.

    Raises
    ------
    InputError : file, column or row that cannot be used.
    """
    if is_universal(path):
        return _universal(kind, path)
    _check_separator(path)
    try:
        table = pd.read_csv(path, dtype=str, keep_default_na=False, skipinitialspace=True, comment="#")
    except UnicodeDecodeError as error:
        raise not_utf8(str(path), error) from error
    except OSError as error:
        raise InputError(str(path), "", path.name, "a CSV file that can be read") from error
    except pd.errors.ParserError as error:
        told = str(error).strip().rpartition("error: ")[2]
        raise InputError(str(path), "", told, "as many values as in the header, decimals with a point") from error
    except pd.errors.EmptyDataError as error:
        raise InputError(str(path), "", "an empty file", "a CSV file with a header line") from error
    if not isinstance(table.index, pd.RangeIndex):
        row = ", ".join([str(table.index[0]), *table.iloc[0]])
        raise InputError(
            str(path), "row 1", row, f"{len(table.columns)} values as in the header, decimals with a point"
        )
    table = table.drop(columns=[name for name in table.columns if name in COMMENTS])
    _check_columns(kind, str(path), list(table.columns), cables)
    if not len(table):
        raise InputError(str(path), "", "no rows", "at least one row of data")
    numbers = {str(c): _numbers(str(path), str(c), table[c]) for c in table.columns if c not in _WORDS}
    words = {str(c): [str(v).strip() for v in table[c]] for c in table.columns if c in _WORDS}
    rows = Rows(kind, str(path), numbers, words)
    _check_values(rows, cables)
    if "case" not in words and kind == "platform_motion":
        words["case"] = [path.stem] * len(table)
    if "case" not in words:
        words["case"] = _cases_from_poses(rows)
    return rows


def _universal(kind: str, path: Path) -> Rows:
    if kind != "frf":
        raise InputError(str(path), "kind", kind, "frf: universal files are read for FRFs only")
    numbers, words = universal_columns(path)
    rows = Rows(kind, str(path), numbers, words)
    _check_frequencies(rows)
    return rows


def length_columns(cables: int) -> list[str]:
    """Names of the length columns, one a cable."""
    return [f"length_{i}_m" for i in range(1, cables + 1)]


def _check_separator(path: Path) -> None:
    with path.open("rb") as file:
        head = next((line for line in file if not line.startswith(b"#")), b"").decode("utf-8", "replace")
    for mark, name in ((";", "';'"), ("\t", "tabs")):
        if mark in head and "," not in head:
            expected = "columns separated by commas, decimals with a point"
            raise InputError(str(path), "header", f"columns separated by {name}", expected)


def _check_columns(kind: str, source: str, columns: list[str], cables: int) -> None:
    lengths = length_columns(cables)
    needed = [*_NEEDED[kind], *(lengths if kind == "loaded_pose" else [])]
    if kind == "free_decay" and "ax" not in columns and "x_m_s2" in columns:
        how = "time_s and x_m_s2, y_m_s2, z_m_s2 as ax, ay, az, and the pose at rest as x_m, y_m, z_m (docs/files.md)"
        raise InputError(source, "x_m_s2", "the motion that `transient` writes", how)
    for name in needed:
        if name not in columns:
            raise InputError(source, name, "no such column", f"a {kind} file needs {', '.join(needed)}")
    known = {*_ALWAYS, *_NEEDED[kind], *_ALSO.get(kind, ()), *lengths}
    for name in columns:
        if name not in known:
            raise InputError(source, name, "a column", _unknown(kind, name, known))
    if kind == "static_state" and not {"tension_N", "length_m"} & set(columns):
        raise InputError(source, "tension_N", "no such column", "give tension_N or length_m or both")


def _unknown(kind: str, name: str, known: set[str]) -> str:
    """A column that nothing reads is refused, since it may be a known one misspelt; remarks have names of their own."""
    return f"unknown for {kind}; {known_names(name, sorted(known))}; remarks go into a column {COMMENTS[0]}"


def _numbers(source: str, name: str, column: pd.Series) -> np.ndarray:
    values = np.empty(len(column))
    for i, text in enumerate(column):
        place = f"row {i + 1}, column {name}"
        if not str(text).strip():
            if name in _BLANK_ALLOWED:
                values[i] = np.nan
                continue
            raise InputError(source, place, "nothing", "a number")
        try:
            values[i] = float(text)
        except ValueError as error:
            raise InputError(source, place, text, "a number") from error
        if not np.isfinite(values[i]):
            raise InputError(source, place, text, "a finite number")
        if abs(values[i]) > LARGEST:
            raise InputError(source, place, text, f"a number not above {LARGEST:g}")
        if (name in _POSITIVE or name.startswith("length_")) and not values[i] > 0.0:
            raise InputError(source, place, text, "a number above zero")
        if name == "payload_kg" and values[i] < 0.0:
            raise InputError(source, place, text, "a mass in kg, zero or more")
    return values


def _check_frequencies(rows: Rows) -> None:
    """The model's modes are computed up to the highest peak: at 1e9 Hz there are more than fit into memory."""
    for i, hertz in enumerate(rows.get("frequency_hz", 0.0)):
        if hertz > HIGHEST:
            expected = f"a frequency in Hz, not above {HIGHEST:g}; leave out what lies higher"
            raise InputError(rows.file, f"row {i + 1}, column frequency_hz", hertz, expected)


def _check_values(rows: Rows, cables: int) -> None:
    _check_frequencies(rows)
    for name, last in (("cable", cables), ("mode", 50)):
        for i, value in enumerate(rows.numbers.get(name, ())):
            if value != int(value) or not 1 <= value <= last:
                raise InputError(rows.file, f"row {i + 1}, column {name}", value, f"a whole number from 1 to {last}")
    for i, plane in enumerate(rows.words.get("plane", ())):
        if plane not in ("in", "out", ""):
            raise InputError(rows.file, f"row {i + 1}, column plane", plane, "in or out")
    for i, sign in enumerate(rows.numbers.get("approach", ())):
        if np.isfinite(sign) and abs(sign) > 1.0:
            raise InputError(rows.file, f"row {i + 1}, column approach", sign, "+1 or -1 (0 if neither)")
    for name, words in rows.words.items():
        if name != "plane" and "" in words:
            raise InputError(rows.file, f"row {words.index('') + 1}, column {name}", "nothing", "a name")


def _cases_from_poses(rows: Rows) -> list[str]:
    """Without a case column, equal poses and payloads are one case."""
    columns = [rows.get(name, 0.0) for name in (*POSE, "payload_kg")]
    return ["pose " + ",".join(f"{v:g}" for v in values) for values in zip(*columns, strict=True)]
