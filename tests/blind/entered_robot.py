"""The robot as its owner entered it: numbers of a robot file, read here without the package under test."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

BUILTIN = Path(__file__).resolve().parents[2] / "cdpr_struct" / "robot" / "builtin"
OWN = Path(__file__).with_name("robots")  # robots with few cables, which are not built in
PULLEY_SUFFIX = "-pulleys"
INCLINED_SUFFIX, UNREAD_SUFFIX = "-inclined", "-unread"
HALF_SUFFIX, BARE_PART = "-half", "-bare-"
PULLEY_RADIUS = 0.05  # m, entered for the robots whose name ends in -pulleys
FREEDOMS = 6
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class EnteredRobot:
    """Plain numbers, SI; m cables, anchors (m, 3), platform frame and world.

    home          : (3,) [m]
    pulley_radius : [m], None without pulleys;  axes : (m, 3) of their swivels, nan where a cable has none
    text          : the robot file
    tracked       : whether a tracker reads poses;  inclined : whether else an inclinometer reads rx and ry
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
    axes: np.ndarray
    tracked: bool = True
    inclined: bool = False

    @property
    def own(self) -> bool:
        """Whether its file is handed out, since it is not one of the program's own."""
        return self.pulley_radius is not None or (OWN / f"{plain_name(self.name)}.toml").exists()

    @property
    def hangs(self) -> bool:
        """Whether lengths and gravity alone say where it rests: it has fewer cables than freedoms."""
        return self.cables < FREEDOMS

    @property
    def home_lengths(self) -> np.ndarray:
        """Straight lengths (m,) [m] at home, untilted."""
        return np.asarray(np.linalg.norm(self.home + self.platform_anchors - self.frame_anchors, axis=1))

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

    `NAME-pulleys` is NAME with a swivelling pulley at every exit, `NAME-half` at every other one;
    `NAME-bare-WAY-MM` has pulleys of so many mm at all exits that its file lacks, their axes `up` or `outwards`. Of
    `NAME-inclined` nobody
    reads the position, of `NAME-unread` nothing of the pose.
    """
    plain = plain_name(name)
    base = wheelless(plain)
    folder = OWN if (OWN / f"{base}.toml").exists() else BUILTIN
    text = (folder / f"{base}.toml").read_text("utf-8")
    if plain != base and BARE_PART not in plain:
        text = _with_pulleys(text, plain)
    table = tomllib.loads(text)
    entries, cable, platform = table["cables"], table["cable"], table["platform"]
    anchors = np.array([entry["frame_anchor"] for entry in entries])
    radius, axes = _wheels(plain, anchors)
    return EnteredRobot(
        name,
        text,
        anchors,
        np.array([entry["platform_anchor"] for entry in entries]),
        np.full(len(entries), cable["axial_stiffness"]),
        np.full(len(entries), cable["linear_density"]),
        platform["mass"],
        np.array(platform["center_of_mass"]),
        np.array(platform["inertia"]),
        table["gravity"],
        np.array(table["home_pose"][:3]),
        radius,
        axes,
        plain == name,
        name.endswith(INCLINED_SUFFIX),
    )


def plain_name(name: str) -> str:
    """Name of a robot without what is said of the reading of its pose."""
    return name.removesuffix(INCLINED_SUFFIX).removesuffix(UNREAD_SUFFIX)


def wheelless(name: str) -> str:
    """Name of a robot's file without what is said of its pulleys."""
    return name.partition(BARE_PART)[0].removesuffix(PULLEY_SUFFIX).removesuffix(HALF_SUFFIX)


def _wheels(name: str, anchors: np.ndarray) -> tuple[float | None, np.ndarray]:
    """Radius of the pulleys [m] and axes (m, 3) of their swivels."""
    axes = np.tile(UP, (len(anchors), 1))
    if BARE_PART in name:
        way, millimetres = name.partition(BARE_PART)[2].split("-")
        if way == "outwards":
            away = (anchors - anchors.mean(axis=0)) * [1.0, 1.0, 0.0]
            axes = away / np.linalg.norm(away, axis=1, keepdims=True)
        return 1e-3 * float(millimetres), axes
    if name.endswith(HALF_SUFFIX):
        return PULLEY_RADIUS, np.where(np.arange(len(anchors))[:, None] % 2, np.nan, axes)
    return (PULLEY_RADIUS, axes) if name.endswith(PULLEY_SUFFIX) else (None, np.full_like(axes, np.nan))


def _with_pulleys(text: str, name: str) -> str:
    """The robot file with a pulley line after every frame anchor, or every other one, and another name."""
    lines, step, exits = [], 2 if name.endswith(HALF_SUFFIX) else 1, 0
    for line in text.splitlines():
        lines.append(f'name = "{name}"' if line.startswith("name =") else line)
        if line.startswith("frame_anchor"):
            exits += 1
        if line.startswith("frame_anchor") and (exits - 1) % step == 0:
            lines.append(f"pulley = {{ radius = {PULLEY_RADIUS}, axis = [0.0, 0.0, 1.0] }}")
    return "\n".join(lines) + "\n"
