"""CSV tables as tables of a paper: Markdown, or LaTeX with booktabs; units in the headings, digits that can be read."""

import io
import math
from collections.abc import Iterable, Mapping
from itertools import islice
from typing import Literal

import pandas as pd

Form = Literal["md", "latex"]
SUFFIX: Mapping[str, str] = {"md": "md", "latex": "tex"}
LONGEST = 2000  # rows of a table; what lies beyond is counted
_DIGITS = 5  # of the largest number of a column
_WIDE = 1e4  # largest over smallest number of a column: beyond, each number gets digits of its own
_UNITS = {
    "N_m": "N/m", "N_mm": "N/mm", "m_s2": "m/s²", "rad_s2": "rad/s²", "m_s": "m/s", "rad_s": "rad/s", "kg_m": "kg/m",
    "m_N": "m/N", "kg_m2": "kg m²", "hz": "Hz", "m": "m", "mm": "mm", "N": "N", "kN": "kN", "deg": "deg", "rad": "rad",
    "kg": "kg", "s": "s", "J": "J", "K": "K", "percent": "%",
}  # fmt: skip


def paper_tables(files: Mapping[str, str | bytes | Iterable[bytes]], form: Form) -> dict[str, str]:
    """Each CSV file of a result once more, as Markdown or LaTeX under its own name."""
    return {
        f"{name.removesuffix('.csv')}.{SUFFIX[form]}": paper_table(content, form, name)
        for name, content in files.items()
        if name.endswith(".csv")
    }


def paper_table(content: str | bytes | Iterable[bytes], form: Form, name: str = "") -> str:
    """A CSV text as a table of `LONGEST` rows at most; a last line counts the rows that are left to the file `name`."""
    whole, rows = _begin(content)
    table = pd.read_csv(io.StringIO(whole), dtype=str, keep_default_na=False)
    shown = table.apply(lambda column: _cells(list(column)))
    more = f"{rows - len(table)} more rows: {name}" if rows > len(table) else ""
    return _latex(shown, more) if form == "latex" else _markdown(shown, more)


def heading(name: str, form: Form) -> str:
    """Name of a column as a heading: words, and the unit in brackets; an axis stays a sign."""
    parts = name.split("_")
    for start in range(1, len(parts)):
        if (unit := _UNITS.get("_".join(parts[start:]))) is not None:
            words, label = " ".join(parts[:start]), unit
            return f"{_text(words, form)} [{_unit(label, form)}]"
    return _text(" ".join(parts), form)


def _begin(content: str | bytes | Iterable[bytes]) -> tuple[str, int]:
    """The header and first rows of a CSV text, and how many rows it has; cells hold no line ends."""
    if isinstance(content, str):
        lines = content.splitlines(keepends=True)
        return "".join(lines[: LONGEST + 1]), len(lines) - 1
    if isinstance(content, bytes):
        return _begin(content.decode("utf-8"))
    rest = (line for part in content for line in part.decode("utf-8").splitlines(keepends=True))
    first = list(islice(rest, LONGEST + 1))
    return "".join(first), len(first) - 1 + sum(1 for _ in rest)


def _cells(cells: list[str]) -> pd.Series:
    """A column as it is shown: whole numbers and words as they are, others with the digits that their size asks for."""
    numbers = [_number(cell) for cell in cells]
    if any(number is None and cell for number, cell in zip(numbers, cells, strict=True)):
        return pd.Series(cells, dtype=object)
    sizes = [abs(n) for n in numbers if n is not None and n != 0.0 and math.isfinite(n)]
    if not sizes or all("." not in cell and "e" not in cell for cell in cells):
        return pd.Series(cells, dtype=object)
    if max(sizes) > _WIDE * min(sizes) and not 1e-3 < max(sizes) < 1e6:
        return pd.Series(["" if n is None else f"{n:.{_DIGITS - 1}g}" for n in numbers], dtype=object)
    places = max(0, _DIGITS - 1 - math.floor(math.log10(max(sizes))))
    style = f".{places}f" if places < 9 else f".{_DIGITS - 1}e"
    return pd.Series(["" if n is None else _plain(f"{n:{style}}") for n in numbers], dtype=object)


def _plain(text: str) -> str:
    """A number without a negative zero."""
    return text.removeprefix("-") if not text.strip("-0.") else text


def _number(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None


def _markdown(table: pd.DataFrame, more: str) -> str:
    right = [all(_number(cell) is not None for cell in table[name] if cell) for name in table]
    rows = [[heading(str(name), "md") for name in table], ["---:" if r else "---" for r in right]]
    rows += [[cell.replace("|", "\\|") for cell in row] for row in table.itertuples(index=False, name=None)]
    text = "\n".join("| " + " | ".join(row) + " |" for row in rows) + "\n"
    return text + (f"\n{more}\n" if more else "")


def _latex(table: pd.DataFrame, more: str) -> str:
    right = [all(_number(cell) is not None for cell in table[name] if cell) for name in table]
    shown = table.map(lambda cell: _text(cell, "latex"))
    shown.columns = [heading(str(name), "latex") for name in table]
    text = shown.to_latex(index=False, escape=False, column_format="".join("r" if r else "l" for r in right))
    return "% \\usepackage{booktabs}\n" + text + (f"% {more}\n" if more else "")


def _unit(unit: str, form: Form) -> str:
    return unit.replace("²", "$^2$").replace("%", "\\%") if form == "latex" else unit


_SIGNS = {"\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}"}


def _text(text: str, form: Form) -> str:
    """Words without what LaTeX takes for its own; a minus sign of a number is one."""
    if form == "md":
        return text
    if _number(text) is not None:
        return _power(text)
    return "".join(_SIGNS.get(c, f"\\{c}" if c in "&%$#_{}" else c) for c in text)


def _power(number: str) -> str:
    mantissa, _, exponent = number.partition("e")
    if not exponent:
        return f"${number}$" if number.startswith("-") else number
    return f"${mantissa} \\cdot 10^{{{int(exponent)}}}$"
