"""What results say of tolerances: sizes, which of them a file states, and which are defaults."""

from collections.abc import Collection, Mapping
from dataclasses import fields
from typing import Any

from cdpr_struct.robot.tolerances import Tolerances, tolerance_unit

SWIVEL = "swivel_deg"
"""Of the zeros of encoders on pulleys, which move no robot."""


def tolerances_told(used: Tolerances, stated: Collection[str], left_out: Collection[str] = ()) -> dict[str, Any]:
    """Size of each, and whether a file states it."""
    names = [field.name for field in fields(Tolerances) if field.name not in left_out]
    return {name: {"value": getattr(used, name), "stated": name in stated} for name in names}


def of_a_robot(stated: Mapping[str, float]) -> dict[str, Any]:
    """Those of a robot file, without what only sensors have."""
    return tolerances_told(Tolerances(**stated), stated, (SWIVEL,))


def defaults_used(told: Mapping[str, Any], left_out: Collection[str] = ()) -> str:
    """A sentence about those that no file states, "" if there are none."""
    sizes = [
        f"{name} {row['value']:g} {tolerance_unit(name)}".rstrip()
        for name, row in told.items() if not row["stated"] and name not in left_out
    ]  # fmt: skip
    return f"Tolerances not given, defaults used: {', '.join(sizes)}." if sizes else ""
