"""Balance of the platform: the wrench of cables, weight and load, and its tangent."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.generated.platform import attachment, geometric_stiffness
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_response import end_stiffness
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.masts import behind_masts


@dataclass(frozen=True, slots=True, eq=False)
class PlatformArms:
    """Lever arms in world axes at a batch of poses.

    points : (..., m, 3) platform anchors in the world, eq. (3.1) [m]
    arms   : (..., m, 3) R A_i [m]
    center : (..., 3) R c, to the centre of mass [m]
    """

    points: np.ndarray
    arms: np.ndarray
    center: np.ndarray

    @property
    def position(self) -> np.ndarray:
        """(..., 3) of the platform origin [m]."""
        return self.points[..., 0, :] - self.arms[..., 0, :]

    @classmethod
    def at(cls, arrays: RobotArrays, position: np.ndarray, rotation: np.ndarray) -> "PlatformArms":
        """Arms at `position` (..., 3) [m] and `rotation` (..., 3, 3), platform to world."""
        arms = arrays.platform_anchors @ np.swapaxes(rotation, -1, -2)
        center = (rotation @ arrays.center_of_mass[..., None])[..., 0]
        return cls(position[..., None, :] + arms, arms, center)


def weight_wrench(arrays: RobotArrays, arms: PlatformArms) -> np.ndarray:
    """(..., 6) wrench of the platform's weight about its origin, world axes [N, N m]; the weight may be tilted."""
    force = weight_force(arrays)
    center, force = np.broadcast_arrays(arms.center, force)
    return np.concatenate([force, np.cross(center, force)], axis=-1)


def weight_force(arrays: RobotArrays) -> np.ndarray:
    """(..., 3) of the platform, world [N]."""
    size = arrays.mass * arrays.gravity
    tilted = np.concatenate([arrays.tilt, np.zeros((*arrays.tilt.shape[:-1], 1))], axis=-1)
    return np.asarray(size[..., None] * (arrays.down + tilted))


def load_wrench(arrays: RobotArrays, arms: PlatformArms) -> np.ndarray:
    """(..., 6) wrench of weight, constant force and moment, and hose about the platform origin, world axes [N, N m]."""
    wrench = weight_wrench(arrays, arms)
    force = arrays.constant_force
    if not (arrays.hose.any() or force.any() or arrays.moment.any()):
        return wrench
    pull = force + arrays.hose[..., None] * (arrays.hose_center - arms.position)
    return wrench + np.concatenate(np.broadcast_arrays(pull, arrays.moment), axis=-1)


def cable_wrench(states: CableStates, arms: PlatformArms) -> np.ndarray:
    """(..., 6) wrench of all cables on the platform about its origin, eqs. (3.5)-(3.6) [N, N m]."""
    force = states.force_on_platform
    return np.concatenate([force.sum(axis=-2), np.cross(arms.arms, force).sum(axis=-2)], axis=-1)


def tangent_stiffness(arrays: RobotArrays, states: CableStates, arms: PlatformArms) -> np.ndarray:
    """Symmetric tangent of the platform at a pose, cable lengths locked.

    Returns
    -------
    (..., 6, 6) world axes, rows force [N] and moment [N m] about the platform origin, columns displacement [m] and
    rotation [rad]. Eq. (3.8) with the pulley-aware cable stiffness, plus the geometric terms that (3.8) leaves out:
    cable force and weight on their rotating lever arms; masts and a hose too. It is the second derivative of the
    potential energy along constant twists; `moment_skew` turns it into the derivative of the wrench.
    """
    map_ = attachment(*np.moveaxis(arms.arms, -1, 0))
    stiff = end_stiffness(arrays, states)
    if arrays.has_masts:
        tangent = behind_masts(stiff, map_, arrays)
    else:
        moved = stiff @ map_
        rows = 3 * arrays.cable_count
        stacked, carried = map_.reshape((*map_.shape[:-3], rows, 6)), moved.reshape((*moved.shape[:-3], rows, 6))
        tangent = np.swapaxes(stacked, -1, -2) @ carried
    weight, center = np.moveaxis(weight_force(arrays), -1, 0), np.moveaxis(arms.center, -1, 0)
    turned = cable_geometric_stiffness(states, arms) + geometric_stiffness(*weight, *center)
    held = arrays.hose[..., None, None] * np.eye(3)
    lead = np.broadcast_shapes(*(part.shape[:-2] for part in (tangent, turned, held)))
    whole = np.array(np.broadcast_to(tangent, (*lead, 6, 6)))  # a load may have batch axes that no cable has
    whole[..., 3:, 3:] += turned
    whole[..., :3, :3] += held
    return whole


def cable_geometric_stiffness(states: CableStates, arms: PlatformArms) -> np.ndarray:
    """(..., 3, 3) symmetric rotational stiffness of the cable forces on their lever arms, all cables [N m/rad]."""
    force, arm = np.moveaxis(states.force_on_platform, -1, 0), np.moveaxis(arms.arms, -1, 0)
    return geometric_stiffness(*force, *arm).sum(axis=-3)


def moment_skew(moment: np.ndarray) -> np.ndarray:
    """Half the cross-product matrix (..., 3, 3) of the moment (..., 3) of forces on their arms: cables and weight.

    tangent_stiffness plus this in its lower right block is exactly -d(wrench)/d(pose), also away from equilibrium
    and under an applied moment, where that derivative is not symmetric. The applied moment itself is not counted in
    `moment`: its axes stay those of the world, so it adds nothing to the derivative. Left out, the symmetric tangent is
    that of a semitangential moment of the same size (Ziegler 1968, Argyris 1979), which has a potential.
    """
    return 0.5 * cross_product_matrix(moment)


def cross_product_matrix(vector: np.ndarray) -> np.ndarray:
    """(..., 3, 3) [v]x of vectors (..., 3), such that [v]x w = v x w."""
    found = np.zeros((*vector.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[..., i, j] = -vector[..., k]
        found[..., j, i] = vector[..., k]
    return found


def platform_radius(arrays: RobotArrays) -> float:
    """r [m], one number for all of a batch: the largest of the anchors' mean radius, the radius of gyration and the
    distance of the centre of mass."""
    anchors = np.sqrt((arrays.platform_anchors**2).sum(axis=-1).mean())
    gyration = np.sqrt((np.trace(arrays.inertia, axis1=-2, axis2=-1) / arrays.mass).max() / 2.0)
    center = np.linalg.norm(arrays.center_of_mass, axis=-1).max()
    return float(max(anchors, gyration, center, 1e-3))


def rotation_from_vector(vector: np.ndarray) -> np.ndarray:
    """Rotation matrices (..., 3, 3) of rotation vectors (..., 3) [rad]."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    x, y, z = np.moveaxis(vector, -1, 0)
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape((*vector.shape, 3))
    sine = np.sinc(angle / np.pi)
    versine = 0.5 * np.sinc(0.5 * angle / np.pi) ** 2
    return np.eye(3) + sine * cross + versine * cross @ cross
