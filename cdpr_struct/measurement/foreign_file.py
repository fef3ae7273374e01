"""Workbooks, MATLAB and numpy files in place of a CSV file: recognised, and answered with the way to convert them."""

import io
import re
import zipfile
from html import unescape
from pathlib import Path

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.conversion import converted, excel_command

_ZIP, _OLE = b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_HDF, _MATLAB, _NUMPY = b"\x89HDF\r\n\x1a\n", b"MATLAB ", b"\x93NUMPY"
_WORKBOOKS = {  # suffix: what it is, package that pandas reads it with
    ".xlsx": ("an Excel workbook", "openpyxl"),
    ".xlsm": ("an Excel workbook", "openpyxl"),
    ".xlsb": ("an Excel workbook", "pyxlsb"),
    ".xls": ("an Excel workbook", "xlrd"),
    ".ods": ("an OpenDocument spreadsheet", "odfpy"),
}
_ARRAYS = (".mat", ".npz", ".npy")
_SHEETS = {  # member of the archive that lists the sheets, and how
    ".xlsx": ("xl/workbook.xml", re.compile(r"<(?:\w+:)?sheet\s[^>]*?\bname=\"([^\"]*)\"")),
    ".ods": ("content.xml", re.compile(r"<table:table\s[^>]*?\btable:name=\"([^\"]*)\"")),
}
_LARGEST_LIST = 50_000_000  # bytes, unpacked; beyond it the sheets are not told


def refuse_foreign(path: Path, content: bytes) -> None:
    """Refuse what is no text, by its content or else by the file's suffix.

    Raises
    ------
    InputError : a workbook, a MATLAB or numpy file, or an archive; the way to convert it.
    """
    form = _form_of_content(content) or _form_of_suffix(path.suffix.lower(), content)
    if form in _WORKBOOKS:
        raise _workbook(path, form, _sheets(content, form))
    if form in _ARRAYS:
        raise _arrays(path, form)
    if form == ".zip":
        raise InputError(str(path), "", "a zip archive", "a CSV file: unpack the archive and give the file in it")


def _form_of_content(content: bytes) -> str:
    if content.startswith(_ZIP):
        return _form_of_archive(content)
    marks = ((_OLE, ".xls"), (_MATLAB, ".mat"), (_HDF, ".mat"), (_NUMPY, ".npy"))
    return next((form for mark, form in marks if content.startswith(mark)), "")


def _form_of_archive(content: bytes) -> str:
    try:
        names = zipfile.ZipFile(io.BytesIO(content)).namelist()
    except zipfile.BadZipFile:
        return ""
    for member, form in (("xl/workbook.xml", ".xlsx"), ("xl/workbook.bin", ".xlsb"), ("content.xml", ".ods")):
        if member in names:
            return form
    return ".npz" if names and all(name.endswith(".npy") for name in names) else ".zip"


def _form_of_suffix(suffix: str, content: bytes) -> str:
    """Many instruments call a text file .xls: that one is read as text."""
    if suffix == ".xls" and content and b"\0" not in content:
        return ""
    return suffix if suffix in _WORKBOOKS or suffix in _ARRAYS else ""


def _sheets(content: bytes, form: str) -> list[str]:
    """Names of a workbook's sheets; none where they cannot be told."""
    if form not in _SHEETS:
        return []
    member, pattern = _SHEETS[form]
    try:
        archive = zipfile.ZipFile(io.BytesIO(content))
        if archive.getinfo(member).file_size > _LARGEST_LIST:
            return []
        return [unescape(name) for name in pattern.findall(archive.read(member).decode("utf-8", "replace"))]
    except (zipfile.BadZipFile, KeyError, NotImplementedError, RuntimeError, EOFError):
        return []


def _workbook(path: Path, form: str, sheets: list[str]) -> InputError:
    what, package = _WORKBOOKS[form]
    several = len(sheets) > 1
    given = f"{what} with the sheets {', '.join(sheets)}" if several else what
    choice = " (sheet_name is the sheet you need)" if several else ""
    command = excel_command(path, sheets[0] if several else None)
    expected = f"a CSV file. Convert it: pip install {package}, then {command}{choice}, and give {converted(path).name}"
    return InputError(str(path), "", given, expected)


def _arrays(path: Path, form: str) -> InputError:
    name = converted(path).name
    if form == ".mat":
        how = f"in MATLAB, writetable(T, '{name}') with a table T whose variables are named like these columns"
        how += f"; or import it by a mapping of its variables: cdpr-struct import-recording {path.name}"
        return InputError(str(path), "", "a MATLAB file", f"a CSV file with a header line: {how}")
    how = f"in Python, pandas.DataFrame({{'x_m': x, ...}}).to_csv('{name}', index=False) with one array a column"
    return InputError(str(path), "", "a numpy file", f"a CSV file with a header line: {how}")
