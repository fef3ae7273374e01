"""The robot object that a world means."""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.world import EXTENSIONS, World
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.parameters import PARAMETERS
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.robot import Robot


def robot_of(robot: Robot, world: World) -> Robot:
    """The robot with the world's anchors, masses, stiffness and density, and no extensions.

    Joints become part of the platform. The diagnosis puts the extensions into cable states and stiffness itself.
    """
    cables = tuple(
        replace(cable, axial_stiffness=float(ea), linear_density=float(rho))
        for ea, rho, cable in zip(world.axial_stiffness, world.linear_density, robot.cables, strict=True)
    )
    pulleys = tuple(
        Pulley(float(radius), np.array(axis)) if radius > 0.0 else None
        for radius, axis in zip(world.pulley_radius, world.pulley_axis, strict=True)
    )
    return replace(
        robot.without_extensions(), cables=cables, pulleys=pulleys, platform=platform_of(world),
        frame_anchors=world.frame_anchors, platform_anchors=world.platform_anchors,
    )  # fmt: skip


def extensions_of(world: World, hose_center: np.ndarray, reference_tension: float) -> Extensions:
    """What plain values of a robot cannot say.

    hose_center (3,) [m] and reference_tension [N] : what the world's hose and nonlinearity refer to
    """
    given = {name: np.maximum(getattr(world, name), PARAMETERS[name].least) for name in EXTENSIONS}
    return Extensions.of(world.cables, {**given, "hose_center": hose_center, "reference_tension": reference_tension})


def platform_of(world: World) -> Platform:
    """Platform and joints as one rigid body."""
    joints = np.maximum(world.joint_mass, -0.2 * float(world.mass) / world.cables)
    body = Platform(float(world.mass), world.center_of_mass, 0.5 * (world.inertia + world.inertia.T))
    return body.with_masses_at(joints, world.platform_anchors)
