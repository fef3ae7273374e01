"""The robot object that a world means, as far as plain parameters can say it."""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.world import World
from cdpr_struct.robot.cable import Cable, Pulley
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.robot import Robot


def robot_of(robot: Robot, world: World) -> Robot:
    """The robot with the world's anchors, masses, stiffness and density; joints become part of the platform."""
    cables = tuple(
        Cable(float(ea), float(rho), cable.damping_ratio)
        for ea, rho, cable in zip(world.axial_stiffness, world.linear_density, robot.cables, strict=True)
    )
    pulleys = tuple(
        Pulley(float(radius), np.array(axis)) if radius > 0.0 else None
        for radius, axis in zip(world.pulley_radius, world.pulley_axis, strict=True)
    )
    return replace(
        robot, cables=cables, pulleys=pulleys, platform=platform_of(world), frame_anchors=world.frame_anchors,
        platform_anchors=world.platform_anchors,
    )  # fmt: skip


def platform_of(world: World) -> Platform:
    """Platform and joints as one rigid body."""
    joints = np.maximum(world.joint_mass, -0.2 * float(world.mass) / world.cables)
    masses = np.concatenate([[float(world.mass)], joints])
    points = np.vstack([world.center_of_mass, world.platform_anchors])
    total = masses.sum()
    center = masses @ points / total
    inertia = np.array(world.inertia)
    for mass, point in zip(masses, points - center, strict=True):
        inertia = inertia + mass * (point @ point * np.eye(3) - np.outer(point, point))
    return Platform(float(total), center, 0.5 * (inertia + inertia.T))
