"""Tables with one row a pose and one column a cable: checked, and turned into rows of one cable each."""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.errors import NOTHING, InputError
from cdpr_struct.measurement.cable_columns import APPROACH, EITHER, QUANTITIES, CableQuantity


def is_wide(kind: str, names: Sequence[str]) -> bool:
    """Whether a row of a file with this header is a pose with one reading a cable, and not one cable of it."""
    return "cable" not in names and any(_given(quantity, names) for quantity in EITHER.get(kind, ()))


def check_wide(kind: str, source: str, names: Sequence[str], cables: int) -> None:
    """Hold the header of a file whose rows are poses, or cables, against the other form.

    Raises
    ------
    InputError : columns of both forms, or a quantity without a column for each cable.
    """
    if kind not in EITHER:
        return
    wide = is_wide(kind, names)
    for quantity in QUANTITIES[kind]:
        given = _given(quantity, names)
        if given and "cable" in names and quantity in EITHER[kind]:
            both = "either one row a cable, with the column cable, or one row a pose, with one column a cable"
            raise InputError(source, "header", f"cable and {given[0]}", both)
        if wide and quantity.long in names and (given or quantity is not APPROACH):
            expected = f"one column a cable, {quantity.span(cables)}, since a row is a pose in this file"
            raise InputError(source, "header", quantity.long, expected)
        if wide and given:
            _check_numbers(quantity, source, given, cables)


def _check_numbers(quantity: CableQuantity, source: str, given: Sequence[str], cables: int) -> None:
    wanted = quantity.columns(cables)
    if quantity.column(0) in given:
        expected = f"cables are numbered from 1: {quantity.column(0)} becomes {quantity.column(1)} and so on"
        raise InputError(source, "header", quantity.column(0), f"{expected} to {quantity.column(cables)}")
    for name in (*(n for n in wanted if n not in given), *(n for n in given if n not in wanted)):
        place, value = (name, "a column") if name in given else (f"column {name}", NOTHING)
        raise InputError(source, place, value, f"this robot has {cables} cables: give {quantity.span(cables)}")


def headings(kind: str, names: Sequence[str], cables: int) -> dict[str, str]:
    """Of each quantity that a wide file gives, the column of the long form: its columns in the file in short."""
    return {q.long: q.span(cables) for q in QUANTITIES[kind] if _given(q, names)}


def one_row_a_cable(
    kind: str, numbers: dict[str, np.ndarray], words: dict[str, list[str]], cables: int
) -> tuple[dict[str, np.ndarray], dict[str, list[str]], np.ndarray]:
    """Numbers and words by column with one row a cable, and the row of the file (from 0) that each comes from.

    Columns of the row hold for all its cables. A cable whose frequency was not read has no row.
    """
    wide = [quantity for quantity in QUANTITIES[kind] if _given(quantity, list(numbers))]
    own = {name for quantity in wide for name in quantity.columns(cables)}
    rows = len(next(iter(numbers.values())))
    source = np.repeat(np.arange(rows), cables)
    long = {name: values[source] for name, values in numbers.items() if name not in own}
    long["cable"] = np.tile(np.arange(1.0, cables + 1.0), rows)
    for quantity in wide:
        long[quantity.long] = np.stack([numbers[name] for name in quantity.columns(cables)], axis=1).ravel()
    if kind == "cable_frequency":
        long.setdefault("mode", np.ones(rows * cables))
        kept = np.flatnonzero(np.isfinite(long["frequency_hz"]))
        long, source = {name: values[kept] for name, values in long.items()}, source[kept]
    return long, {name: [cells[i] for i in source] for name, cells in words.items()}, source


def _given(quantity: CableQuantity, names: Sequence[str]) -> list[str]:
    """Columns of a header that hold this quantity, one a cable."""
    return [name for name in names if quantity.number(name) is not None]
