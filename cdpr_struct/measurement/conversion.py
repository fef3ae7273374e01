"""Commands that turn a file of measured data into the CSV file that is read here, file names filled in."""

import re
from pathlib import Path

_SPECIAL = re.compile(r'\\\\|["$`]')  # what a shell reads between double quotes; a single backslash is left alone there
_DECIMAL_COMMA = re.compile(r"\d,\d")


def excel_command(path: Path, sheet: str | None) -> str:
    """Shell command that writes a sheet of a workbook (the first if None) as a CSV file."""
    return _command("read_excel", path, [] if sheet is None else [f"sheet_name={_literal(sheet)}"])


def text_command(path: Path, text: str, separator: str, encoding: str | None = None) -> str:
    """Shell command that writes a text table with another separator or encoding as a CSV file in UTF-8.

    text : of the file, in which decimal commas, comments and Excel's line "sep=;" are looked for
    encoding : of the file, None for UTF-8
    """
    options = [] if separator == "," else [f"sep={_literal(separator)}"]
    if separator != "," and _DECIMAL_COMMA.search(text):
        options.append("decimal=','")
    if encoding:
        options.append(f"encoding={_literal(encoding)}")
    lines = text.splitlines()
    if lines and is_excel_mark(lines[0]):
        options.append("skiprows=1")
    if any(line.startswith("#") for line in lines):
        options.append("comment='#'")
    return _command("read_csv", path, options)


def is_excel_mark(line: str) -> bool:
    """Whether a line is Excel's note on the separator, like sep=; and no part of the table."""
    return re.fullmatch(r'"?sep=.?"?', line.strip(), re.IGNORECASE) is not None


def converted(path: Path) -> Path:
    """Name for the CSV file: that of the original where it is free, since originals are not written over."""
    plain = path.with_suffix(".csv")
    return path.with_name(f"{path.stem}-converted.csv") if plain == path or plain.exists() else plain


def _command(reader: str, path: Path, options: list[str]) -> str:
    arguments = ", ".join([_literal(path.as_posix()), *options])
    program = f"import pandas; pandas.{reader}({arguments}).to_csv({_literal(converted(path).as_posix())}, index=False)"
    return 'python -c "' + _SPECIAL.sub(lambda found: "".join(f"\\{sign}" for sign in found[0]), program) + '"'


def _literal(text: str) -> str:
    """Python literal in single quotes, since the command has double ones around it."""
    if text.isprintable() or text == "\t":
        return "'" + text.replace("\\", "\\\\").replace("'", "\\'").replace("\t", "\\t") + "'"
    return ascii(text)
