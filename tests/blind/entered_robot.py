"""The robot as its owner entered it: numbers of a robot file, read here without the package under test."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

BUILTIN = Path(__file__).resolve().parents[2] / "cdpr_struct" / "robot" / "builtin"
PULLEY_SUFFIX = "-pulleys"
PULLEY_RADIUS = 0.05  # m, entered for the robots whose name ends in -pulleys
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class EnteredRobot:
    """Plain numbers, SI; m cables, anchors (m, 3), platform frame and world.

    home          : (3,) [m]
    pulley_radius : [m], None without pulleys; swivel axes point up
    text          : the robot file
    """

    name: str
    text: str
    frame_anchors: np.ndarray
    platform_anchors: np.ndarray
    axial_stiffness: np.ndarray
    linear_density: np.ndarray
    mass: float
    center_of_mass: np.ndarray
    inertia: np.ndarray
    gravity: float
    home: np.ndarray
    pulley_radius: float | None

    @property
    def cables(self) -> int:
        """Number m of cables."""
        return len(self.frame_anchors)

    @property
    def masts(self) -> np.ndarray:
        """Index (m,) of the corner that carries each exit point: exits in one quadrant share a mast."""
        return np.array([2 * int(x > 0.0) + int(y > 0.0) for x, y, _ in self.frame_anchors])


def entered_robot(name: str) -> EnteredRobot:
    """Robot of a built-in file; `NAME-pulleys` is NAME with a swivelling pulley at every exit."""
    base = name.removesuffix(PULLEY_SUFFIX)
    text = (BUILTIN / f"{base}.toml").read_text("utf-8")
    if name != base:
        text = _with_pulleys(text, name)
    table = tomllib.loads(text)
    entries, cable, platform = table["cables"], table["cable"], table["platform"]
    return EnteredRobot(
        name,
        text,
        np.array([entry["frame_anchor"] for entry in entries]),
        np.array([entry["platform_anchor"] for entry in entries]),
        np.full(len(entries), cable["axial_stiffness"]),
        np.full(len(entries), cable["linear_density"]),
        platform["mass"],
        np.array(platform["center_of_mass"]),
        np.array(platform["inertia"]),
        table["gravity"],
        np.array(table["home_pose"][:3]),
        PULLEY_RADIUS if name != base else None,
    )


def _with_pulleys(text: str, name: str) -> str:
    """The robot file with a pulley line after every frame anchor and another name."""
    lines = []
    for line in text.splitlines():
        lines.append(f'name = "{name}"' if line.startswith("name =") else line)
        if line.startswith("frame_anchor"):
            lines.append(f"pulley = {{ radius = {PULLEY_RADIUS}, axis = [0.0, 0.0, 1.0] }}")
    return "\n".join(lines) + "\n"
