"""Which form of recording a file is, by its content; its ending must not say something else."""

from pathlib import Path
from typing import Literal
from zipfile import BadZipFile, ZipFile

from cdpr_struct.errors import InputError

Form = Literal["bag", "ros2", "mcap", "db3", "tdms", "mdf", "mat", "mat73", "xlsx", "uff", "text"]
CALLED: dict[Form, str] = {
    "bag": "a ROS 1 bag", "ros2": "a ROS 2 bag", "mcap": "an MCAP file", "db3": "a ROS 2 bag (SQLite)",
    "tdms": "a TDMS file", "mdf": "an MDF file", "mat": "a MATLAB file", "mat73": "a MATLAB file (v7.3)",
    "xlsx": "an Excel workbook", "uff": "a universal file", "text": "a text table",
}  # fmt: skip
_MARKS: tuple[tuple[bytes, Form], ...] = (
    (b"#ROSBAG V", "bag"), (b"\x89MCAP0\r\n", "mcap"), (b"SQLite format 3\0", "db3"), (b"TDSm", "tdms"),
    (b"MDF     ", "mdf"), (b"UnFinMF ", "mdf"), (b"MATLAB 5.0", "mat"), (b"MATLAB 7.3", "mat73"),
    (b"\x89HDF\r\n\x1a\n", "mat73"),
)  # fmt: skip
_ENDINGS: dict[str, tuple[Form, ...]] = {
    ".bag": ("bag",), ".mcap": ("mcap",), ".db3": ("db3",), ".tdms": ("tdms",), ".mf4": ("mdf",), ".mdf": ("mdf",),
    ".dat": ("mdf", "text"), ".mat": ("mat", "mat73"), ".xlsx": ("xlsx",), ".xlsm": ("xlsx",), ".uff": ("uff",),
    ".unv": ("uff",), ".bunv": ("uff",), ".uf": ("uff",), ".csv": ("text",), ".tsv": ("text",), ".txt": ("text",),
}  # fmt: skip
KNOWN = "ROS 1 and 2 bags, MCAP, TDMS, MDF (.mf4, .mdf), .mat, .xlsx, universal files, CSV and other text tables"
_HEAD = 4096  # bytes that are looked at
_METADATA = "metadata.yaml"  # in the folder of a ROS 2 bag


def form_of(path: Path) -> Form:
    """The form of a file or folder.

    Raises
    ------
    InputError : not there, empty, of no known form, or of another one than its ending says.
    """
    try:
        if path.is_dir():
            return _form_of_folder(path)
        with path.open("rb") as file:
            head = file.read(_HEAD)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(str(path), "", reason, f"a recording that can be read: {KNOWN}") from error
    if not head.strip():
        raise InputError(str(path), "", "an empty file", f"a recording: {KNOWN}")
    form = _form_of_content(path, head)
    expected = _ENDINGS.get(path.suffix.lower())
    if form is None:
        what = "an unknown binary file" if expected is None else f"something else than {CALLED[expected[0]]}"
        raise InputError(str(path), "", what, f"{'a recording' if expected is None else 'a whole one'}: {KNOWN}")
    if expected is not None and form not in expected:
        said = f"{CALLED[form]}, although its name ends with {path.suffix}"
        raise InputError(str(path), "", said, f"{CALLED[expected[0]]}, or an ending that says what the file is")
    return form


def _form_of_folder(path: Path) -> Form:
    if (path / _METADATA).is_file():
        return "ros2"
    expected = f"a file, or the folder of a ROS 2 bag with the file {_METADATA}"
    raise InputError(str(path), "", "a folder", expected)


def _form_of_content(path: Path, head: bytes) -> Form | None:
    """None where it is binary and no mark is known."""
    for mark, form in _MARKS:
        if head.startswith(mark):
            return form
    if head.startswith(b"PK\x03\x04"):
        return _form_of_archive(path)
    if path.suffix.lower() == ".mat" and b"\0" in head:
        return "mat"  # version 4 has no mark
    if head.lstrip(b"\r\n").startswith(b"    -1") or (b"\n    -1" in head and b"\n    58" in head):
        return "uff"
    return None if b"\0" in head and not head.startswith((b"\xff\xfe", b"\xfe\xff")) else "text"


def _form_of_archive(path: Path) -> Form | None:
    try:
        with ZipFile(path) as archive:
            return "xlsx" if "xl/workbook.xml" in archive.namelist() else None
    except (BadZipFile, OSError, ValueError, NotImplementedError):
        return "xlsx" if path.suffix.lower() in (".xlsx", ".xlsm") else None  # its reader says what is wrong
