"""The robot as its owner entered it: numbers of a robot file, read here without the package under test."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

BUILTIN = Path(__file__).resolve().parents[2] / "cdpr_struct" / "robot" / "builtin"
OWN = Path(__file__).with_name("robots")  # robots with few cables, which are not built in
PULLEY_SUFFIX = "-pulleys"
INCLINED_SUFFIX = "-inclined"
PULLEY_RADIUS = 0.05  # m, entered for the robots whose name ends in -pulleys
FREEDOMS = 6
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class EnteredRobot:
    """Plain numbers, SI; m cables, anchors (m, 3), platform frame and world.

    home          : (3,) [m]
    pulley_radius : [m], None without pulleys; swivel axes point up
    text          : the robot file
    tracked       : whether a tracker reads poses; else an inclinometer reads rx and ry
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
    tracked: bool = True

    @property
    def own(self) -> bool:
        """Whether its file is handed out, since it is not one of the program's own."""
        return self.pulley_radius is not None or (OWN / f"{self.name.removesuffix(INCLINED_SUFFIX)}.toml").exists()

    @property
    def hangs(self) -> bool:
        """Whether lengths and gravity alone say where it rests: it has fewer cables than freedoms."""
        return self.cables < FREEDOMS

    @property
    def cables(self) -> int:
        """Number m of cables."""
        return len(self.frame_anchors)

    @property
    def masts(self) -> np.ndarray:
        """Index (m,) of the corner that carries each exit point: exits in one quadrant share a mast."""
        return np.array([2 * int(x > 0.0) + int(y > 0.0) for x, y, _ in self.frame_anchors])


def entered_robot(name: str) -> EnteredRobot:
    """Robot of a file, built in or of this room.

    `NAME-pulleys` is NAME with a swivelling pulley at every exit, `NAME-inclined` one whose position nobody reads.
    """
    plain = name.removesuffix(INCLINED_SUFFIX)
    base = plain.removesuffix(PULLEY_SUFFIX)
    folder = OWN if (OWN / f"{base}.toml").exists() else BUILTIN
    text = (folder / f"{base}.toml").read_text("utf-8")
    if plain != base:
        text = _with_pulleys(text, plain)
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
        PULLEY_RADIUS if plain != base else None,
        plain == name,
    )


def _with_pulleys(text: str, name: str) -> str:
    """The robot file with a pulley line after every frame anchor and another name."""
    lines = []
    for line in text.splitlines():
        lines.append(f'name = "{name}"' if line.startswith("name =") else line)
        if line.startswith("frame_anchor"):
            lines.append(f"pulley = {{ radius = {PULLEY_RADIUS}, axis = [0.0, 0.0, 1.0] }}")
    return "\n".join(lines) + "\n"
