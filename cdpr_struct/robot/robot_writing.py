"""Robots as robot files (TOML): what `robot_file` reads again is the same robot, to the last digit."""

import math
from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from cdpr_struct.robot.body_table import body_lines
from cdpr_struct.robot.cable import STEEL, Cable
from cdpr_struct.robot.lump import lump_lines
from cdpr_struct.robot.remainder import Remainder
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.tolerances import Spread


def robot_toml(robot: Robot, name: str, comments: Sequence[str] = ()) -> str:
    """Text of a robot file, comments at its head; every cable has its own entry, only active extensions are written."""
    body = robot.platform
    lines = [
        *(f"# {printable(line)}" for line in comments),
        f'name = "{_quotable(name)}"',
        f"gravity = {_gravity(robot)}",
        *_home(robot),
        "",
        "[platform]",
        f"mass = {float(body.mass)!r}",
        f"center_of_mass = {body.center_of_mass.tolist()}",
        f"inertia = {body.inertia.tolist()}",
        *([f"guided = {_words(robot.guided)}"] if robot.guided else []),
        "",
        "[extensions]",
        f"causes = {_words(robot.extensions.causes)}",
        *(f"{key} = {value}" for key, value in robot.extensions.entered.items()),
    ]
    for i in range(len(robot.cables)):
        lines += ["", *_cable(robot, i)]
    for lump in robot.lumps:
        lines += ["", *lump_lines(lump)]
    for obstacle in robot.bodies:
        lines += ["", *body_lines(obstacle, _quotable)]
    if robot.tolerances:
        lines += ["", "[tolerances]", *(f"{name} = {float(size)!r}" for name, size in robot.tolerances.items())]
    if robot.posterior is not None:
        lines += ["", *_posterior(robot.posterior)]
    if robot.remainder is not None:
        lines += ["", *_remainder(robot.remainder)]
    return "\n".join(lines) + "\n"


def _posterior(spread: Spread) -> list[str]:
    """Lines of the table of what a diagnosis left uncertain."""
    order = ", ".join(one.field for one in spread.varied)
    return [
        "[posterior]  # normal changes of the numbers above that readings leave probable, in place of [tolerances];",
        f"# of {order}; covariance = root root'",
        *([f"found = {_words([one.field for one in spread.found])}"] if spread.found else []),
        f"mean = [{_numbers(spread.mean)}]",
        "root = [",
        *(f"  [{_numbers(row)}]," for row in spread.root),
        "]",
    ]


def _remainder(law: Remainder) -> list[str]:
    """Lines of the table of what a diagnosis left unexplained."""
    sizes = [f"{name} = {_rounded(size)}" for name, size in asdict(law).items()]
    return ["[remainder]  # unexplained: rms of errors that are new at every rest", *sizes]


def _rounded(size: float | Sequence[float]) -> str:
    """A number, or several as a list, to seven digits."""
    if isinstance(size, Sequence):
        return f"[{', '.join(map(_rounded, size))}]"
    return repr(float(f"{size:.6e}"))


def _numbers(values: np.ndarray) -> str:
    return ", ".join(f"{value:.6e}" if value else "0.0" for value in values.tolist())


def printable(line: str) -> str:
    """A comment of one line: names of cases may hold anything."""
    return "".join(c if c.isprintable() else " " for c in line)


def _cable(robot: Robot, i: int) -> list[str]:
    """Lines of one cable."""
    cable, pulley = robot.cables[i], robot.pulleys[i]
    lines = [
        f"[[cables]]  # {i + 1}",
        f"axial_stiffness = {float(cable.axial_stiffness)!r}",
        f"linear_density = {float(cable.linear_density)!r}",
        f"damping_ratio = {float(cable.damping_ratio)!r}",
        *_expansion(cable),
        *_force_limits(cable),
        *([f"winch_tension = {float(cable.winch_tension)!r}"] if cable.winch_tension else []),
        *([f'winch = "{_quotable(cable.winch)}"'] if cable.winch else []),
        *([f"winch_ratio = {float(cable.winch_ratio)!r}"] if cable.winch_ratio != 1.0 else []),
        *([f"home_length = {float(cable.home_length)!r}"] if cable.home_length else []),
        f"platform_anchor = {robot.platform_anchors[i].tolist()}",
        f"frame_anchor = {robot.frame_anchors[i].tolist()}",
    ]
    if pulley is not None:
        lines.append(f"pulley = {{ radius = {float(pulley.radius)!r}, axis = {pulley.axis.tolist()} }}")
    return lines


def _gravity(robot: Robot) -> str:
    """A number where it acts along world -z, else a vector."""
    straight = robot.down.tolist() == [0.0, 0.0, -1.0] or robot.gravity == 0.0
    return repr(float(robot.gravity)) if straight else str(robot.gravity_vector.tolist())


def _home(robot: Robot) -> list[str]:
    if robot.home is None:
        return []
    pose = [*robot.home.position.tolist(), *np.degrees(robot.home.angles).tolist()]
    return [f"home_pose = {pose}"]


def _expansion(cable: Cable) -> list[str]:
    """The line of an expansion other than that of steel."""
    alpha = float(cable.thermal_expansion)
    return [] if alpha == STEEL else [f"thermal_expansion = {alpha!r}"]


def _force_limits(cable: Cable) -> list[str]:
    """Lines of the limits that a cable has."""
    lower = [f"force_min = {float(cable.force_min)!r}"] if cable.force_min > 0.0 else []
    return lower + ([f"force_max = {float(cable.force_max)!r}"] if cable.force_max < math.inf else [])


def _words(causes: Sequence[str]) -> str:
    return "[" + ", ".join(f'"{c}"' for c in causes) + "]"


def _quotable(name: str) -> str:
    """A name as TOML text in quotes may hold it."""
    return printable(name).replace("\\", "\\\\").replace('"', '\\"')
