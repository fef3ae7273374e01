"""Rows of a measured-data file, checked: columns known and present, numbers finite and in their range."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from cdpr_struct.errors import NOTHING, InputError, known_names
from cdpr_struct.measurement.ambient_columns import ambient_known, ambient_needed
from cdpr_struct.measurement.assumed_angles import ANGLES
from cdpr_struct.measurement.cable_columns import EITHER, LENGTH, QUANTITIES
from cdpr_struct.measurement.campaign import AMBIENT
from cdpr_struct.measurement.column_names import renaming
from cdpr_struct.measurement.data_table import DataTable, read_table
from cdpr_struct.measurement.quaternions import QUATERNION, quaternion_headings, with_angles
from cdpr_struct.measurement.universal_rows import is_universal, universal_columns, universal_modes
from cdpr_struct.measurement.wide_table import check_wide, headings, is_wide, one_row_a_cable
from cdpr_struct.robot.robot_file import LARGEST

POSITION = ("x_m", "y_m", "z_m")
POSE = (*POSITION, *ANGLES)
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
    "static_state": ("tension_N", "length_m", "swivel_deg"),
    "cable_frequency": ("tension_N", "plane"),
    "robot_frequency": ("body", "mode"),
}
_WIDE_NEEDED = POSITION  # where a row is a pose
_WIDE_ALSO = {"static_state": (), "cable_frequency": ("mode", "plane")}
_ALWAYS = ("case", *POSE, *QUATERNION, "payload_kg", "sigma", "temperature_K", "approach", "time_s")
_WORDS = ("case", "respond", "excite", "plane", "body")
_POSITIVE = ("tension", "length", "frequency", "sigma", "temperature", "mode", "cable")  # first words of columns
COMMENTS = ("comment", "note", "remark")  # columns for people, not read
PREDICTED = "predicted_"  # begins the names of others
UNFILLED = "?"  # in a cell of a template
HIGHEST = 1e3  # of any frequency [Hz]
_BLANK_ALLOWED = ("sigma", "temperature_K", "approach", "tension_N", "length_m", "swivel_deg", "time_s")
_MAY_BE_LOST = {"frf": ("real", "imag"), "free_decay": ("ax", "ay", "az"), "platform_motion": POSE}
_READINGS_MAY_LACK = ("static_state", "loaded_pose", "cable_frequency", "robot_frequency")  # of a pose or a cable


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """A checked table: numbers by column (n,), words by column, and the file it came from.

    row      : n numbers of the file's rows that these are, from 1; () if each is one
    headings : of numbers in several columns of the file, these in short: one a cable, or a quaternion
    """

    kind: str
    file: str
    numbers: dict[str, np.ndarray]
    words: dict[str, list[str]]
    row: tuple[int, ...] = ()
    headings: Mapping[str, str] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(next(iter(self.numbers.values())))

    def place(self, i: int) -> str:
        """Where row i stands in the file."""
        return f"row {self.row[i] if self.row else i + 1}"

    def get(self, column: str, default: float = np.nan) -> np.ndarray:
        """Column (n,), or the default throughout."""
        found = self.numbers.get(column)
        return np.full(len(self), default) if found is None else found


def read_rows(kind: str, path: Path, cables: int, planned: bool = False, relative: bool = False) -> Rows:
    """Checked rows of a CSV file of the given kind, for a robot with `cables` cables.

    A file with one row a pose and one column a cable gives the same rows as one with one row a cable.
    planned : cells of a template hold what their columns of predictions say
    relative : lengths count from an unknown start, so that they may have any sign

    Raises
    ------
    InputError : file, column or row that cannot be used.
    """
    if is_universal(path):
        return _universal(kind, path)
    table = _with_predictions(read_table(path)) if planned else read_table(path)
    names = [name for name in table.names if name not in COMMENTS and not name.startswith(PREDICTED)]
    _check_columns(kind, str(path), names, cables)
    table.require_rows()
    _require_filled(table, names)
    wide = is_wide(kind, names)
    blank = _blank_allowed(kind, cables)
    above = tuple(word for word in _POSITIVE if not (relative and word == "length"))
    numbers = {c: _numbers(str(path), c, table.column(c), c in blank, above) for c in names if c not in _WORDS}
    words = {c: table.column(c) for c in names if c in _WORDS}
    rows = Rows(kind, str(path), with_angles(str(path), numbers), words, headings=quaternion_headings(numbers))
    _check_values(rows, cables)
    if "case" not in words:
        named = kind == "platform_motion" or (kind == AMBIENT and not set(POSITION) & set(names))
        words["case"] = [path.stem] * len(rows) if named else _cases_from_poses(rows)
    return _long(rows, cables) if wide else rows


def _with_predictions(table: DataTable) -> DataTable:
    """The table with predictions in cells that are still to be filled, where it has them."""
    names = table.names
    told = [names.index(f"{PREDICTED}{name}") if f"{PREDICTED}{name}" in names else None for name in names]

    def filled(row: Sequence[str]) -> list[str]:
        pairs = zip(row, told, strict=True)
        return [row[place] if cell == UNFILLED and place is not None else cell for cell, place in pairs]

    return replace(table, rows=[filled(row) if len(row) == len(names) else row for row in table.rows])


def _require_filled(table: DataTable, names: Sequence[str]) -> None:
    """Refuse a template: cells that are still to be filled."""
    places = [(i, name) for name in names for i, cell in enumerate(table.column(name), start=1) if cell == UNFILLED]
    if places:
        row, name = min(places, key=lambda place: place[0])
        lacking = f"{len(places)} cells with {UNFILLED}, the first in row {row}, column {name}"
        expected = "the measured value in place of each, or an empty cell where nothing was measured"
        raise InputError(table.file, "not filled yet", lacking, expected)


def _long(rows: Rows, cables: int) -> Rows:
    numbers, words, source = one_row_a_cable(rows.kind, rows.numbers, rows.words, cables)
    if not len(source):
        raise InputError(rows.file, "", "no readings", "at least one reading of a cable")
    shown = {**rows.headings, **headings(rows.kind, list(rows.numbers), cables)}
    return Rows(rows.kind, rows.file, numbers, words, tuple((source + 1).tolist()), shown)


def _universal(kind: str, path: Path) -> Rows:
    if kind not in ("frf", "robot_frequency"):
        expected = "frf or robot_frequency: universal files are read for FRFs and modes only"
        raise InputError(str(path), "kind", kind, f"{expected}; a signal in time comes from import-recording")
    numbers, words = universal_columns(path) if kind == "frf" else universal_modes(path)
    rows = Rows(kind, str(path), numbers, words)
    _check_frequencies(rows)
    return rows


def length_columns(cables: int) -> list[str]:
    """Names of the length columns, one a cable."""
    return LENGTH.columns(cables)


def _check_columns(kind: str, source: str, columns: list[str], cables: int) -> None:
    known = _known(kind, columns, cables)
    if kind == "free_decay" and "ax" not in columns and "x_m_s2" in columns:
        how = "time_s and x_m_s2, y_m_s2, z_m_s2 as ax, ay, az, and the pose at rest as x_m, y_m, z_m (docs/files.md)"
        raise InputError(source, "x_m_s2", "the motion that `transient` writes", how)
    found, how = renaming(columns, known, "" if "cable" in columns else kind, cables)
    if how:
        raise InputError(source, "header", found, f"unknown for {kind}; {how}")
    check_wide(kind, source, columns, cables)
    if kind in _READINGS_MAY_LACK and not {"case", *POSITION} & set(columns):
        expected = f"a {kind} file needs {', '.join(POSITION)}, or the name of each state if no position was measured"
        raise InputError(source, "column case", NOTHING, expected)
    for name in _needed(kind, columns, cables):
        if name not in columns:
            raise InputError(source, f"column {name}", NOTHING, _needs(kind, columns, cables))
    for number, name in enumerate(columns, start=1):
        if not name:
            expected = "a name for each column; pandas writes a nameless one unless to_csv has index=False"
            raise InputError(source, "header", f"no name for column {number}", expected)
        if name not in known:
            raise InputError(source, name, "a column", _unknown(kind, name, known, cables))
    if (
        kind == "static_state"
        and not is_wide(kind, columns)
        and not {"tension_N", "length_m", "swivel_deg"} & set(columns)
    ):
        raise InputError(source, "column tension_N", NOTHING, "give tension_N or length_m or both, or swivel_deg")


def _needed(kind: str, columns: Sequence[str], cables: int) -> tuple[str, ...]:
    if kind == AMBIENT:
        return ambient_needed(columns)
    own = _WIDE_NEEDED if is_wide(kind, columns) else _NEEDED[kind]
    if kind in _READINGS_MAY_LACK and not set(POSITION) & set(columns):
        own = tuple(name for name in own if name not in POSITION)  # a state without a measured position
    return (*own, *(length_columns(cables) if kind == "loaded_pose" else ()))


def _needs(kind: str, columns: Sequence[str], cables: int) -> str:
    text = f"a {kind} file needs {', '.join(_needed(kind, columns, cables))}"
    if kind not in EITHER or is_wide(kind, columns):
        return text
    return f"{text}; or, with one row a pose, {' or '.join(q.span(cables) for q in EITHER[kind])} in place of cable"


def _known(kind: str, columns: Sequence[str], cables: int) -> list[str]:
    """Columns that a file of this kind and form may have."""
    if kind == AMBIENT:
        return ambient_known(columns)
    own = [name for q in QUANTITIES.get(kind, ()) for name in q.columns(cables)]
    if is_wide(kind, columns):
        return [*_ALWAYS, *_WIDE_ALSO[kind], *own]
    known = [*_ALWAYS, *_NEEDED[kind], *_ALSO.get(kind, ()), *length_columns(cables)]
    return known if "cable" in columns else list(dict.fromkeys([*known, *own]))


def _blank_allowed(kind: str, cables: int) -> set[str]:
    """Columns in which a cell may be empty: any reading of a pose or a cable, but of signals the pose is needed."""
    if kind not in _READINGS_MAY_LACK:
        return {*_BLANK_ALLOWED, *_MAY_BE_LOST.get(kind, ())} - ({"time_s"} if kind in _MAY_BE_LOST else set())
    if kind == "robot_frequency":
        return {*_BLANK_ALLOWED, *POSE, *QUATERNION, "mode"}
    return {
        *_BLANK_ALLOWED,
        *POSE,
        *QUATERNION,
        *(name for q in QUANTITIES.get(kind, ()) for name in q.columns(cables)),
    }


def _unknown(kind: str, name: str, known: Sequence[str], cables: int) -> str:
    """A column that nothing reads is refused, since it may be a known one misspelt; remarks have names of their own."""
    spans = {n: q.span(cables) for q in (*QUANTITIES.get(kind, ()), LENGTH) for n in q.columns(cables)}
    shown = sorted({spans.get(n, n) for n in known})
    return f"unknown for {kind}; {known_names(name, sorted(known), shown)}; remarks go into a column {COMMENTS[0]}"


def _number_wanted(text: str) -> str:
    """What a cell should hold in place of this text."""
    point = text.replace(",", ".")
    try:
        float(point)
    except ValueError:
        return "a number"
    return f"a number with a decimal point: {point}"


def _numbers(source: str, name: str, cells: Sequence[str], blank: bool, above_zero: Sequence[str]) -> np.ndarray:
    """Numbers of a column; nan for an empty cell where `blank` ones are allowed.

    above_zero : first words of the columns whose numbers are
    """
    values = np.empty(len(cells))
    positive = name.partition("_")[0] in above_zero
    for i, text in enumerate(cells):
        place = f"row {i + 1}, column {name}"
        if not text:
            if blank:
                values[i] = np.nan
                continue
            raise InputError(source, place, "nothing", "a number")
        try:
            values[i] = float(text)
        except ValueError as error:
            raise InputError(source, place, text, _number_wanted(text)) from error
        if not np.isfinite(values[i]):
            raise InputError(source, place, text, "a finite number")
        if abs(values[i]) > LARGEST:
            raise InputError(source, place, text, f"a number not above {LARGEST:g}")
        if positive and not values[i] > 0.0:
            raise InputError(source, place, text, "a number above zero")
        if name == "payload_kg" and values[i] < 0.0:
            raise InputError(source, place, text, "a mass in kg, zero or more")
    return values


def _check_frequencies(rows: Rows) -> None:
    """The model's modes are computed up to the highest peak: at 1e9 Hz there are more than fit into memory."""
    for name in (name for name in rows.numbers if name.startswith("frequency_")):
        for i, hertz in enumerate(rows.numbers[name]):
            if hertz > HIGHEST:
                expected = f"a frequency in Hz, not above {HIGHEST:g}; leave out what lies higher"
                raise InputError(rows.file, f"row {i + 1}, column {name}", hertz, expected)


def _check_approach(rows: Rows) -> None:
    for name in (name for name in rows.numbers if name.startswith("approach")):
        for i, sign in enumerate(rows.numbers[name]):
            if np.isfinite(sign) and abs(sign) > 1.0:
                raise InputError(rows.file, f"row {i + 1}, column {name}", sign, "+1 or -1 (0 if neither)")


def _check_values(rows: Rows, cables: int) -> None:
    _check_frequencies(rows)
    _check_approach(rows)
    for name, last in (("cable", cables), ("mode", 50)):
        for i, value in enumerate(rows.numbers.get(name, ())):
            blank = np.isnan(value) and rows.kind == "robot_frequency"  # a label, which a peak may lack
            if not blank and (value != np.floor(value) or not 1 <= value <= last):
                raise InputError(rows.file, f"row {i + 1}, column {name}", value, f"a whole number from 1 to {last}")
    for i, plane in enumerate(rows.words.get("plane", ())):
        if plane not in ("in", "out", ""):
            raise InputError(rows.file, f"row {i + 1}, column plane", plane, "in or out")
    for name, words in rows.words.items():
        if name not in ("plane", "body") and "" in words:
            raise InputError(rows.file, f"row {words.index('') + 1}, column {name}", "nothing", "a name")


def _cases_from_poses(rows: Rows) -> list[str]:
    """Without a case column, equal poses and payloads are one case."""
    columns = [rows.get(name, 0.0) for name in (*POSE, "payload_kg")]
    return ["pose " + ",".join(f"{v:g}" for v in values) for values in zip(*columns, strict=True)]
