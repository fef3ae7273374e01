"""The robot with its causes as a robot file: plain values where these can say it, the rest in [extensions].

What acts in every command: anchors, EA, density, mass, centre, inertia, pulleys. A compliance in line with a cable is
put into EA at the campaign's mean length, EA / (1 + c EA / L), and listed. What belongs to sensors or to the world
around (gains, zeros, tracker, forces, masts) is listed only: no command applies it yet.
"""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.diagnosis.extended_robot import robot_of
from cdpr_struct.diagnosis.refit import world_with
from cdpr_struct.diagnosis.world import World
from cdpr_struct.robot.robot import Robot

LISTED = (
    "length_offset",
    "length_scale",
    "series_compliance",
    "frame_compliance",
    "cell_gain",
    "cell_bias",
    "friction",
    "force",
    "hose",
    "tracker",
    "tilt",
    "bending_stiffness",
    "added_mass",
    "nonlinearity",
    "creep",
    "slip",
)


def extended_world(found: Diagnosis) -> World:
    """The world with the chosen causes."""
    fit = found.selection.fit
    return found.ground.world if fit is None else world_with(found.ground.world, fit.choices, fit.theta)


def extended_robot_toml(found: Diagnosis) -> str:
    """Text of extended_robot.toml."""
    world, robot = extended_world(found), found.campaign.robot
    entered = found.ground.world
    plain = robot_of(robot, world)
    if np.any(world.series_compliance):
        spread = robot.frame_anchors - found.ground.setting.known.center
        length = np.linalg.norm(spread, axis=1)
        stiff = world.axial_stiffness / (1.0 + world.series_compliance * world.axial_stiffness / length)
        plain = robot_of(robot, world.times(axial_stiffness=stiff / world.axial_stiffness))
    listed = {}
    for name in LISTED:
        value = getattr(world, name)
        if not np.allclose(value, getattr(entered, name), rtol=0.0, atol=1e-15):
            listed[name] = value.tolist()
    causes = [c.cause for c, _ in found.corrections]
    causes += list(found.selection.fit.names) if found.selection.fit else []
    return robot_toml(plain, f"{robot.name}-extended", causes, listed)


def robot_toml(robot: Robot, name: str, causes: Sequence[str], listed: dict[str, object]) -> str:
    """A robot file."""
    body = robot.platform
    lines = [
        f'name = "{name}"',
        f"gravity = {robot.gravity!r}",
        *_home(robot),
        "",
        "[platform]",
        f"mass = {float(body.mass)!r}",
        f"center_of_mass = {body.center_of_mass.tolist()}",
        f"inertia = {body.inertia.tolist()}",
        "",
        "[extensions]",
        f"causes = {_words(causes)}",
    ]
    lines += [f"{key} = {value}" for key, value in listed.items()]
    for i, cable in enumerate(robot.cables):
        lines += [
            "",
            f"[[cables]]  # {i + 1}",
            f"axial_stiffness = {cable.axial_stiffness!r}",
            f"linear_density = {cable.linear_density!r}",
            f"damping_ratio = {cable.damping_ratio!r}",
            f"platform_anchor = {robot.platform_anchors[i].tolist()}",
            f"frame_anchor = {robot.frame_anchors[i].tolist()}",
        ]
        pulley = robot.pulleys[i]
        if pulley is not None:
            lines.append(f"pulley = {{ radius = {pulley.radius!r}, axis = {pulley.axis.tolist()} }}")
    return "\n".join(lines) + "\n"


def _home(robot: Robot) -> list[str]:
    if robot.home is None:
        return []
    pose = [*robot.home.position.tolist(), *np.degrees(robot.home.angles).tolist()]
    return [f"home_pose = {pose}"]


def _words(causes: Sequence[str]) -> str:
    return "[" + ", ".join(f'"{c}"' for c in causes) + "]"
