"""The robot with its causes as a robot file: plain values where these can say it, the rest in [extensions]."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.causes.internal_mode import NAME
from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.diagnosis.extended_robot import extensions_of, robot_of
from cdpr_struct.diagnosis.refit import world_with
from cdpr_struct.diagnosis.whole_change import whole_change
from cdpr_struct.diagnosis.world import World
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_writing import printable as printable
from cdpr_struct.robot.robot_writing import robot_toml as robot_toml


def extended_world(found: Diagnosis) -> World:
    """The world with the chosen causes, their parameters as a whole."""
    fit, entered = found.selection.fit, found.ground.entered
    return entered if fit is None else _embodied(world_with(entered, fit.choices, whole_change(fit)[0]))


def _embodied(world: World) -> World:
    """The world with the nearest inertia that a rigid body can have: no principal moment above the sum of the others.

    Of a moment that the data do not show a fit says little, so it may end up beyond.
    """
    if world.bodies_exist():
        return world
    moments, axes = np.linalg.eigh(world.inertia)
    moments[2] = min(moments[2], moments[:2].sum())
    return replace(world, inertia=(axes * moments) @ axes.T)


def extended_robot(found: Diagnosis) -> Robot:
    """The robot of the campaign with the chosen causes."""
    world, known, robot = extended_world(found), found.ground.setting.known, found.campaign.robot
    more = extensions_of(world, known.center, known.mean_tension)
    causes = [*robot.extensions.causes, *(c.cause for c, _ in found.corrections if c.cause != NAME)]
    causes += found.selection.fit.names if found.selection.fit else []
    return replace(robot_of(robot, world), extensions=replace(more, causes=tuple(dict.fromkeys(causes))))


def extended_robot_toml(found: Diagnosis, comments: Sequence[str] = ()) -> str:
    """Text of extended_robot.toml, comments at its head."""
    head = "".join(f"# {printable(line)}\n" for line in comments)
    return head + robot_toml(extended_robot(found), f"{found.campaign.robot.name}-extended")
