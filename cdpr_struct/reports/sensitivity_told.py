"""What moves each prediction: rows for result.json and CSV, tables for terminal and page."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from cdpr_struct.bands.sensitivities import Mover, rates_of
from cdpr_struct.reports.text import paragraphs, plain_table
from cdpr_struct.robot.tolerances import Varied

NAMES = {
    "frame_anchors": "frame_anchor",
    "platform_anchors": "platform_anchor",
    "length_offset": "unstrained_length",
    "mass": "platform_mass",
    "inertia": "platform_inertia",
}
"""Names of parameters in results where they differ from those of the arrays."""
_AXES = "xyz"
_ALIKE = {  # of all cables changed alike, and of the platform: step and words
    "axial_stiffness": (0.01, "axial stiffness of all cables +1 %"),
    "linear_density": (0.01, "linear density of all cables +1 %"),
    "unstrained_length": (0.001, "length of all cables +1 mm"),
    "pulley_radius": (0.001, "radius of all pulleys +1 mm"),
    "platform_mass": (1.0, "platform mass +1 kg"),
}
_EACH = {  # of one cable: the one that moves most
    "axial_stiffness": (0.01, "axial stiffness of one cable +1 %"),
    "unstrained_length": (0.001, "length of one cable +1 mm"),
    "frame_anchor": (0.001, "one coordinate of a frame anchor +1 mm"),
    "platform_anchor": (0.001, "one coordinate of a platform anchor +1 mm"),
    "center_of_mass": (0.001, "centre of mass +1 mm"),
    "platform_inertia": (0.01, "inertia about one axis +1 %"),
}


def parameter(varied: Varied) -> str:
    """Name in results."""
    return NAMES.get(varied.field, varied.field)


def place_of(mover: Mover) -> dict[str, Any]:
    """Which number moves, as keys of a row."""
    axis = None if mover.axis is None else _AXES[mover.axis]
    return {"parameter": parameter(mover.varied), "cable": mover.cable, "axis": axis}


def words_of(row: Mapping[str, Any]) -> str:
    """Which number moves, in words."""
    name = row["parameter"].replace("_", " ")
    where = f" {row['axis']}" if row["axis"] else ""
    cable = "" if row["cable"] is None else f", cable {row['cable']}"
    return f"{name}{where}{cable}"


def frequency_rows(movers: Sequence[Mover], own: np.ndarray) -> Iterator[dict[str, Any]]:
    """One row a mode and number; own (p, k): rates of ln f."""
    for mode in range(own.shape[1]):
        for mover in movers:
            relative = mover.varied.relative
            key = "d_ln_f_d_ln_p" if relative else "d_ln_f_d_p"
            unit = "1" if relative else f"1/{mover.varied.unit}"
            rate = float(rates_of(own[:, mode], mover))
            yield {"mode": mode + 1, **place_of(mover), key: rate, "unit": unit}


def rate_rows(movers: Sequence[Mover], rates: np.ndarray, key: str, names: Sequence[Any], units: Sequence[str]) -> Any:
    """One row a predicted number and number; rates (p, k) in these units."""
    for column, (name, unit) in enumerate(zip(names, units, strict=True)):
        for mover in movers:
            per = "" if mover.varied.relative else f"/{mover.varied.unit}"
            rate = float(rates_of(rates[:, column], mover))
            yield {key: name, **place_of(mover), "rate": rate, "unit": f"{unit}{per}"}


def share_rows(shares: Mapping[str, np.ndarray], names: Sequence[str], sigmas: Sequence[str]) -> list[dict[str, Any]]:
    """Per predicted number its sigma in words, and the share of the variance of each parameter."""
    by_name = {NAMES.get(field, field): share for field, share in shares.items() if not field.startswith("cell_")}
    return [
        {"of": name, "sigma": sigma, "shares": {key: float(value[i]) for key, value in by_name.items()}}
        for i, (name, sigma) in enumerate(zip(names, sigmas, strict=True))
    ]


def effects(result: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    """Column names and rows: change of each frequency in per cent for round changes of the parameters."""
    modes = range(1, len(result["frequencies_hz"]) + 1)
    names = ["change [%] of mode", *(f"{i}: {f:.3f} Hz" for i, f in zip(modes, result["frequencies_hz"], strict=True))]
    rows = []
    for each, table in ((False, _ALIKE), (True, _EACH)):
        for name, (step, words) in table.items():
            found = [_rates(result, mode, name, each) for mode in modes]
            if all(found):
                rows.append([words, *(f"{100.0 * step * max(rates, key=abs):+.3g}" for rates in found)])
    return names, rows


def _rates(result: Mapping[str, Any], mode: int, name: str, each: bool) -> list[float]:
    """Rates of a mode by a parameter: of each single number, or of all cables alike and of the platform."""
    return [
        row.get("d_ln_f_d_ln_p", row.get("d_ln_f_d_p", 0.0))
        for row in result["frequencies"]
        if (row["mode"], row["parameter"]) == (mode, name)
        and each == (row["cable"] is not None or row["axis"] is not None)
    ]


def shares_table(result: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    """Column names and rows: per cent of the variance that each tolerance brings."""
    keys = [
        key for key in result["shares"][0]["shares"] if any(row["shares"][key] >= 0.0005 for row in result["shares"])
    ]
    names = ["", "sigma", *(key.replace("_", " ") for key in keys)]
    rows = [
        [row["of"], row["sigma"], *(f"{100.0 * row['shares'][key]:.0f}" for key in keys)] for row in result["shares"]
    ]
    return names, rows


def tornado(result: Mapping[str, Any], count: int) -> list[tuple[str, float]]:
    """Words and per cent of the frequency of the chosen mode per sigma, of the single numbers that move it most."""
    return [(words_of(row), row["change_percent"]) for row in result["largest"][:count]]


def sensitivity_sentences(result: Mapping[str, Any]) -> list[str]:
    """What moves the chosen mode most, in words."""
    words, change = tornado(result, 1)[0]
    own = result["shares"][result["mode"] - 1]
    name, share = max(own["shares"].items(), key=lambda item: item[1])
    return [
        f"Mode {result['mode']} has a sigma of {own['sigma']}; {100.0 * share:.0f} % of its variance comes of the "
        f"{name.replace('_', ' ')}. Of single numbers one sigma of {words} moves it most, by {change:+.2g} %."
    ]


def sensitivity_text(result: Mapping[str, Any]) -> str:
    """Tables for a terminal."""
    largest = [[words, f"{change:+.3g}"] for words, change in tornado(result, 10)]
    mode = result["mode"]
    parts = [
        plain_table(f"{result['robot']}: what moves the frequencies, winches locked", *effects(result)),
        plain_table(f"What moves mode {mode} most", ["one sigma of", "change [%]"], largest),
        plain_table("Share of the variance [%] by tolerance", *shares_table(result)),
    ]
    if raised := result.get("raise"):
        parts.append(raise_text(raised))
    return paragraphs(*parts)


def raise_rows(raised: Mapping[str, Any]) -> list[list[str]]:
    """Each way to the wanted frequency in words."""
    rows = []
    for way in raised["ways"]:
        change = (
            "; ".join(_change_words(name, value) for name, value in way["to"].items())
            if way["to"] is not None
            else f"does not reach it alone; nearest trial {way['frequency_hz']:.4g} Hz"
        )
        rows.append([way["change"].replace("_", " "), change])
    return rows


def _change_words(name: str, value: Mapping[str, float]) -> str:
    if "factor" not in value:
        return f"at least {value['N']:.4g} N in every cable"
    return f"{name.replace('_', ' ')} {100.0 * (value['factor'] - 1.0):+.2f} %"


def raise_text(raised: Mapping[str, Any]) -> str:
    """The ways to a wanted frequency, as a table."""
    title = f"Mode {raised['mode']} from {raised['from_hz']:.5g} to {raised['to_hz']:.5g} Hz, the pose held"
    return plain_table(title, ["change of", "by"], raise_rows(raised))


def row_columns(rows: Sequence[Mapping[str, Any]]) -> dict[str, list[Any]]:
    """Rows as columns of a table, empty where a row has no such key."""
    names = list(dict.fromkeys(key for row in rows for key in row))
    return {name: ["" if row.get(name) is None else row[name] for row in rows] for name in names}
