"""result.json of the list of robots, its text, and its columns as a table."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from cdpr_struct.robot.robot import Robot


def robots_json(robots: Sequence[Robot]) -> dict[str, Any]:
    """The result under the keys that scripts rely on."""
    return {"robots": [{"name": r.name, "cables": len(r.cables), "description": r.description} for r in robots]}


def robots_text(result: Mapping[str, Any]) -> str:
    """One line a robot."""
    return "\n".join(f"{row['name']:<16} {row['cables']} cables  {row['description']}" for row in result["robots"])


def robots_sentence(rows: Sequence[Mapping[str, Any]]) -> str:
    """How many robots there are, and their names."""
    return f"{len(rows)} robots: {', '.join(row['name'] for row in rows)}."


def robots_columns(robots: Sequence[Robot]) -> dict[str, Any]:
    """Columns of robots.csv, one row a robot."""
    size = np.array([frame_size(robot) for robot in robots])
    return {
        "name": [robot.name for robot in robots],
        "cables": [len(robot.cables) for robot in robots],
        "platform_mass_kg": [robot.platform.mass for robot in robots],
        "axial_stiffness_N": [_common(robot.axial_stiffness) for robot in robots],
        "linear_density_kg_m": [_common(robot.linear_density) for robot in robots],
        **{f"frame_{name}_m": size[:, i] for i, name in enumerate("xyz")},
        "description": [robot.description for robot in robots],
    }


def _common(values: np.ndarray) -> float:
    """The value of all cables; nan where they differ."""
    return float(values[0]) if np.ptp(values) == 0.0 else float("nan")


def frame_size(robot: Robot) -> np.ndarray:
    """(3,) extent of the frame anchors [m]."""
    return np.ptp(robot.frame_anchors, axis=0)
