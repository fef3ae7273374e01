"""The robot that arrays without batch axes mean: plain values where these can say it, extensions for the rest."""

from dataclasses import replace

import numpy as np

from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.parameters import EXTENSIONS, PARAMETERS
from cdpr_struct.robot.platform import Platform, is_inertia
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays


def robot_from_arrays(entered: Robot, arrays: RobotArrays, causes: tuple[str, ...] = ()) -> Robot:
    """The entered robot with the values of arrays, which have no batch axes, or axes of length one.

    Name, home, damping, thermal expansion, force limits and winches stay as entered. Values that no robot can have
    become the nearest that one can: nothing below the bounds of `parameters`, and no inertia of which a principal
    moment exceeds the sum of the others.

    causes : names of the diagnosed causes that the changes stand for
    """
    value = {name: _single(arrays, name) for name in PARAMETERS}
    cables = tuple(
        replace(cable, axial_stiffness=float(ea), linear_density=float(rho))
        for cable, ea, rho in zip(entered.cables, value["axial_stiffness"], value["linear_density"], strict=True)
    )
    pulleys = tuple(
        Pulley(float(radius), axis) if radius > 0.0 else None
        for radius, axis in zip(value["pulley_radius"], value["pulley_axis"], strict=True)
    )
    return replace(
        entered, cables=cables, pulleys=pulleys, gravity=float(value["gravity"]),
        platform=Platform(float(value["mass"]), value["center_of_mass"], bodily(value["inertia"])),
        platform_anchors=value["platform_anchors"], frame_anchors=value["frame_anchors"],
        extensions=Extensions.of(len(cables), {name: value[name] for name in EXTENSIONS}, causes),
    )  # fmt: skip


def bodily(inertia: np.ndarray) -> np.ndarray:
    """The nearest inertia (3, 3) that a rigid body can have: no principal moment above the sum of the others."""
    symmetric = 0.5 * (inertia + inertia.T)
    moments, axes = np.linalg.eigh(symmetric)
    if is_inertia(moments):
        return np.asarray(symmetric)
    moments[2] = min(moments[2], moments[:2].sum())
    return np.asarray((axes * moments) @ axes.T)


def _single(arrays: RobotArrays, name: str) -> np.ndarray:
    """A field without its batch axes of length one, within its bounds."""
    rule, field = PARAMETERS[name], np.asarray(getattr(arrays, name), dtype=float)
    core = field.shape[field.ndim - rule.axes :]
    if field.size != np.prod(core, dtype=int):
        raise ValueError(f"RobotArrays.{name} describes more than one robot: it has the shape {field.shape}")
    value = np.clip(field.reshape(core), rule.least, rule.most)
    entries = rule.entries(arrays.cable_count)
    return np.broadcast_to(value, (entries,)) if entries and value.size == 1 and rule.axes == 1 else value
