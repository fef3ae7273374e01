"""What virtual sensors say, as a table, JSON and sentences."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from scipy.special import ndtri

from cdpr_struct.diagnosis.predicted_frames import PredictedFrames
from cdpr_struct.diagnosis.virtual_sensors import VirtualSensors
from cdpr_struct.reports.html import HtmlTable

LEVEL = 90.0  # percent, of the bands
_AXES = ("x", "y", "z")


def quantile() -> float:
    """Sigmas to either side of a band."""
    return float(ndtri(0.5 + LEVEL / 200.0))


def kinds(cables: int) -> Iterator[tuple[str, str, str, float, int]]:
    """Sensor, its axis or cable, unit, factor from SI, and place among the 6 + 2 m numbers."""
    numbers = [str(i + 1) for i in range(cables)]
    groups = (
        ("position", _AXES, "m", 1.0), ("rotation", _AXES, "deg", float(np.degrees(1.0))),
        ("tension", numbers, "N", 1.0), ("length", numbers, "m", 1.0),
    )  # fmt: skip
    place = 0
    for sensor, names, unit, factor in groups:
        for name in names:
            yield sensor, name, unit, factor, place
            place += 1


def virtual_columns(found: VirtualSensors) -> dict[str, Any]:
    """One row a state and sensor: prediction, its band, and the reading where there is one."""
    rows: dict[str, list[Any]] = {}
    reach = quantile()
    for sensor, number, unit, factor, at in kinds(found.cables):
        value, sigma = factor * found.value[:, at], factor * found.sigma[:, at]
        columns = {
            "case": list(found.names), "time_s": found.time.tolist(), "sensor": [sensor] * len(value),
            "number": [number] * len(value), "unit": [unit] * len(value), "predicted": value.tolist(),
            "low": (value - reach * sigma).tolist(), "high": (value + reach * sigma).tolist(),
            "reading": (factor * found.reading[:, at]).tolist(),
            "reading_sigma": np.where(np.isfinite(found.reading[:, at]), factor * found.noise[:, at], np.nan).tolist(),
        }  # fmt: skip
        for name, own in columns.items():
            rows.setdefault(name, []).extend(own)
    return rows


def virtual_json(found: PredictedFrames | None) -> dict[str, Any] | None:
    """Level, and what each sensor's bands are like and hold, of the campaign and of a later one."""
    if found is None:
        return None
    later = None if found.later is None else _told(found.later)
    return {"level": LEVEL, **_told(found.own), "later": later}


def _told(found: VirtualSensors) -> dict[str, Any]:
    off, reach, rows = found.off(), quantile(), []
    for sensor, number, unit, factor, at in kinds(found.cables):
        read = np.isfinite(off[:, at])
        held = 100.0 * float(np.mean(np.abs(off[read, at]) <= reach)) if read.any() else None
        width = reach * factor * float(np.median(found.sigma[:, at]))
        rows.append(
            {
                "sensor": sensor,
                "number": number,
                "unit": unit,
                "half_band": width,
                "readings": int(read.sum()),
                "inside_percent": held,
            }
        )
    unsettled = [name for name, done in zip(found.names, found.settled.tolist(), strict=True) if not done]
    return {"states": len(found.names), "unsettled": unsettled, "sensors": rows}


def virtual_tables(result: Mapping[str, Any]) -> list[HtmlTable]:
    """A row a sensor; none where nothing was asked."""
    told = result.get("virtual_sensors")
    if not told:
        return []
    parts = [("this campaign", told)] + ([("the later one", told["later"])] if told["later"] else [])
    return [_table(f"Virtual sensors: {part['states']} states of {name}", part, told["level"]) for name, part in parts]


def _table(title: str, part: Mapping[str, Any], level: float) -> HtmlTable:
    rows = [
        [
            f"{row['sensor']} {row['number']}",
            f"±{row['half_band']:.3g}",
            row["unit"],
            str(row["readings"]),
            "" if row["inside_percent"] is None else f"{row['inside_percent']:.0f}",
        ]
        for row in part["sensors"]
    ]
    note = f"Half of the {level:g} % band, median over the states; a sensor that is there is predicted without its own "
    note += "reading. Inside: share of its readings within band and noise together."
    if part["unsettled"]:
        note += f" Rough in {len(part['unsettled'])} states whose readings lead far from where they were linearised."
    header = ["sensor", "band", "unit", "readings", "inside [%]"]
    return HtmlTable(title, header, rows, note)
