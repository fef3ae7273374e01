"""A commented robot file to begin with: a plausible robot, every number with its unit and where to get it."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.robot_layout import anchors
from cdpr_struct.robot.robot_writing import printable
from cdpr_struct.robot.ropes import RopeKind

_PLATFORM = 0.1  # of the frame's size
_HOME = 0.4  # of the frame's height


@dataclass(frozen=True, slots=True, eq=False)
class RobotSketch:
    """What a new robot is to be.

    frame    : (3,) width, depth, height [m];  mass : of the platform [kg];  diameter : of the rope [m]
    pulleys  : radius of the swivelling pulleys [m], 0 for fixed points;  force_min : [N], 0 for none
    """

    name: str
    cables: int
    frame: np.ndarray
    mass: float
    rope: RopeKind
    diameter: float
    pulleys: float
    force_min: float

    def text(self) -> str:
        """The robot file (TOML)."""
        lines = [*_head(self), *_platform(self), *_rope(self), *_cables(self)]
        return "\n".join(lines) + "\n"


def _head(robot: RobotSketch) -> list[str]:
    size, height = " x ".join(f"{side:g}" for side in robot.frame), robot.frame[2]
    name = "".join(c if c.isprintable() and c not in '"\\' else " " for c in robot.name)
    return [
        "# A robot to begin with, written by `cdpr-struct new-robot`: replace each number by your own.",
        "# Units: m, kg, N, degrees. World: z up, origin on the floor amid the frame. All keys: docs/files.md",
        f'name = "{name}"',
        f'description = "{robot.cables} cables, frame {size} m, platform {robot.mass:g} kg"',
        "gravity = 9.81                               # m/s^2",
        f"home_pose = [0.0, 0.0, {_round(_HOME * height)}]".ljust(45) + "# x, y, z[, rx, ry, rz]: where commands begin",
    ]


def _platform(robot: RobotSketch) -> list[str]:
    a, b, c = _PLATFORM * robot.frame
    moments = robot.mass / 12.0 * np.array([b * b + c * c, a * a + c * c, a * a + b * b])
    x, y, z = (_digits(value) for value in moments)
    return [
        "",
        "[platform]",
        f"mass = {robot.mass!r}".ljust(45) + "# kg: weigh it, with all that is bolted to it",
        "center_of_mass = [0.0, 0.0, 0.0]             # m, platform frame",
        f"# kg m^2 about the centre of mass: here a solid box of {a:g} x {b:g} x {c:g} m; take yours from CAD",
        f"inertia = [[{x}, 0.0, 0.0], [0.0, {y}, 0.0], [0.0, 0.0, {z}]]",
    ]


def _rope(robot: RobotSketch) -> list[str]:
    limit = f"force_min = {robot.force_min!r}" if robot.force_min else "# force_min = 50.0"
    stiffness, density = robot.rope.axial_stiffness(robot.diameter), robot.rope.linear_density(robot.diameter)
    return [
        "",
        "[cable]                                      # of all cables; an entry below may override each key",
        f"# {robot.rope.name}, {1e3 * robot.diameter:g} mm: estimated, to 30 % or worse. Measure both: docs/ropes.md",
        f"axial_stiffness = {_digits(stiffness)}".ljust(45) + "# EA, N",
        f"linear_density = {_digits(density)}".ljust(45) + "# kg/m",
        "damping_ratio = 0.01                         # of each cable's first mode: a guess",
        f"{limit}".ljust(45) + "# N, at the platform: the least force that your control keeps",
        "# force_max = 2000.0                         # N: a fifth of the breaking load, or what the winches can pull",
    ]


def _cables(robot: RobotSketch) -> list[str]:
    frame, platform = anchors(robot.cables, robot.frame, _PLATFORM * robot.frame)
    lines = ["", "# platform_anchor: where the cable ends, platform frame; frame_anchor: where it begins, world [m]."]
    if robot.pulleys:
        lines.append(
            "# With a pulley frame_anchor is the point where the cable enters it, axis the swivel axis: docs/pulleys.md"
        )
    for i in range(robot.cables):
        lines += ["", f"[[cables]]  # {i + 1}", f"platform_anchor = {_vector(platform[i])}"]
        lines.append(f"frame_anchor = {_vector(frame[i])}")
        lines += [f"pulley = {{ radius = {robot.pulleys!r}, axis = [0.0, 0.0, 1.0] }}"] if robot.pulleys else []
    return [printable(line) for line in lines]


def _vector(values: np.ndarray) -> str:
    return "[" + ", ".join(_round(value) for value in values) + "]"


def _round(value: float) -> str:
    return repr(round(float(value), 4) + 0.0)


def _digits(value: float) -> str:
    """Three digits, as an estimate has."""
    return repr(float(f"{value:.3g}"))
