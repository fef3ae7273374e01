"""Stiffness of the platform on its cables, static and dynamic (thesis section 3.3)."""

from dataclasses import replace
from typing import Literal

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableDynamics
from cdpr_struct.dynamics.internal_mass import internal_reaction
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.generated import platform as generated
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.equilibrium import weight_force
from cdpr_struct.statics.guides import behind_guides
from cdpr_struct.statics.masts import Inertia, behind_masts
from cdpr_struct.statics.neutral_freedoms import Stability, stability

Assembly = Literal["consistent", "thesis"]


def platform_mass_matrix(robot: Robot | RobotArrays, rotation: np.ndarray) -> np.ndarray:
    """Mass matrix (..., 6, 6) of the platform about its origin, world axes [kg, kg m, kg m^2]; zero where guided."""
    body = RobotArrays.of(robot)
    center = np.einsum("...ij,...j->...i", rotation, body.center_of_mass)
    inertia = rotation @ body.inertia @ np.swapaxes(rotation, -1, -2)
    matrix = generated.mass_matrix(
        body.mass,
        *(center[..., i] for i in range(3)),
        *(inertia[..., i, i] for i in range(3)),
        *(inertia[..., i, j] for i, j in ((0, 1), (0, 2), (1, 2))),
    )
    return behind_guides(matrix, body, held=0.0)


def inertia_of_platform(point: OperatingPoint, omega_squared: np.ndarray) -> np.ndarray:
    """(..., 6, 6) what the platform's inertia takes from its stiffness, omega^2 M, with the parts that move in it.

    omega_squared : (...) [rad^2/s^2]
    """
    squared = np.asarray(omega_squared)
    rigid = squared[..., None, None] * platform_mass_matrix(point.arrays, point.rotation)
    if not point.arrays.has_moving_parts:
        return np.asarray(rigid)
    return np.asarray(rigid + internal_reaction(point.arrays, point.rotation, squared))


def assemble(
    point: OperatingPoint,
    cable_stiffness: np.ndarray,
    assembly: Assembly = "consistent",
    mast_inertia: Inertia | None = None,
) -> np.ndarray:
    """Platform stiffness from the stiffness of each cable's end.

    Parameters
    ----------
    cable_stiffness : (..., m, 3, 3) [N/m], world axes
    assembly : "thesis" is eq. (3.8); "consistent" adds what it leaves out, the work of the static cable forces and
        of the weight on the second-order motion of the rotating lever arms. Masts and a hose belong to both
    mast_inertia : of the cables, if they vibrate and masts give way

    Returns
    -------
    (..., 6, 6), world axes, rotations about the platform origin [N/m, N, N m].
    """
    cables = behind_masts(cable_stiffness, attachment(point), point.arrays, mast_inertia)
    return cables + beside_cables(point, assembly)


def beside_cables(point: OperatingPoint, assembly: Assembly = "consistent") -> np.ndarray:
    """(..., 6, 6) stiffness of the platform that its cables' ends have no part in; `assemble` says what that is."""
    hose = point.arrays.hose
    if assembly == "thesis":
        held = np.zeros((*hose.shape, 6, 6))
    else:
        turned = geometric_stiffness(point)
        held = np.zeros((*np.broadcast_shapes(hose.shape, turned.shape[:-2]), 6, 6))
        held[..., 3:, 3:] = turned
    held[..., range(3), range(3)] += hose[..., None]
    return behind_guides(held, point.arrays)


def geometric_stiffness(point: OperatingPoint) -> np.ndarray:
    """(..., 3, 3) second-order rotational stiffness of the cable forces and of the weight [N m]."""
    arms = _arms(point)
    force = point.cables.force_on_platform
    cables = generated.geometric_stiffness(*(force[..., i] for i in range(3)), *(arms[..., i] for i in range(3))).sum(
        axis=-3
    )
    center = np.einsum("...ij,...j->...i", point.rotation, point.arrays.center_of_mass)
    weight = np.moveaxis(weight_force(point.arrays), -1, 0)
    return cables + generated.geometric_stiffness(*weight, *(center[..., i] for i in range(3)))


def platform_static_stiffness(point: OperatingPoint, assembly: Assembly = "consistent") -> np.ndarray:
    """(..., 6, 6) stiffness with massless cable dynamics (K_static of the thesis, eqs 2.29 and 3.8)."""
    return assemble(point, point.end_stiffness, assembly)


def stability_at(point: OperatingPoint, assembly: Assembly = "consistent") -> Stability:
    """How the platform is held at rest, and in which directions it is not.

    Unstable, too, is a platform with a slack cable where there is no gravity: it has no shape to vibrate about.
    """
    stiffness = platform_static_stiffness(point, assembly)
    held = stability(point.arrays, point.rotation, stiffness, weightless=assembly == "thesis")
    if not point.arrays.is_weightless:
        return held
    return replace(held, unstable=held.unstable | point.cables.slack.any(axis=-1))


def platform_dynamic_stiffness(
    point: OperatingPoint, cables: CableDynamics, omega_squared: np.ndarray, assembly: Assembly = "consistent"
) -> np.ndarray:
    """(..., 6, 6) stiffness K_E(omega) of eq. (3.8).

    omega_squared : broadcasts against (..., m) [rad^2/s^2]; complex for damped cables, see `damped`
    """
    inertia = cables.mast_stiffness(omega_squared) if point.arrays.has_masts else None
    return assemble(point, cables.stiffness(omega_squared), assembly, inertia)


def _arms(point: OperatingPoint) -> np.ndarray:
    return np.asarray(point.arrays.platform_anchors @ np.swapaxes(point.rotation, -1, -2))


def attachment(point: OperatingPoint) -> np.ndarray:
    """Attachment matrices A_i (..., m, 3, 6), eq. (3.9) corrected: motion of anchor i is A_i times platform motion.

    Columns of guided directions are zero: there the platform does not move.
    """
    arms = _arms(point)
    motion = generated.attachment(*(arms[..., i] for i in range(3)))
    return motion * point.arrays.free[..., None, None, :] if point.arrays.has_guides else motion
