"""Is a platform that is balanced also held, and if not, which way would it go?"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.robot import MOTIONS
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import PlatformArms, platform_radius, tangent_stiffness
from cdpr_struct.statics.guides import free_axes
from cdpr_struct.statics.neutral_freedoms import stability


@dataclass(frozen=True, slots=True, eq=False)
class HeldStability:
    """At locked lengths.

    stable          : (...) bool: no motion of the platform is pushed on; it may be neutral
    least_stiffness : (...) of all motions, rotations as arcs at the anchors [N/m]
    motion          : (..., 6) the motion of least stiffness, the largest component 1 [m, arc in m]
    condition       : (...) largest stiffness over the least in size, neutral freedoms left out, rotations as arcs at
                      the platform's radius [-]
    """

    stable: np.ndarray
    least_stiffness: np.ndarray
    motion: np.ndarray
    condition: np.ndarray

    @property
    def direction(self) -> str:
        """The motion of least stiffness in words, for a single pose."""
        large = np.flatnonzero(np.abs(self.motion) > 0.5)
        return " and ".join(MOTIONS[i] for i in large)


def held_stability(
    arrays: RobotArrays, position: np.ndarray, rotation: np.ndarray, states: CableStates
) -> HeldStability:
    """Of platforms at positions (..., 3) and rotations (..., 3, 3), on cables (..., m)."""
    arms = PlatformArms.at(arrays, position, rotation)
    radius = np.maximum(np.sqrt((arms.arms**2).sum(axis=-1).mean(axis=-1)), 1e-3)[..., None]
    unit = np.concatenate([np.ones((*radius.shape[:-1], 3)), np.repeat(radius, 3, axis=-1)], axis=-1)
    tangent = tangent_stiffness(arrays, states, arms)
    free = free_axes(arrays)
    matrix = (tangent / unit[..., :, None] / unit[..., None, :])[..., free[:, None], free]
    values, vectors = np.linalg.eigh(0.5 * (matrix + np.swapaxes(matrix, -1, -2)))
    softest = np.zeros(unit.shape)
    softest[..., free] = vectors[..., 0]
    largest = np.take_along_axis(softest, np.abs(softest).argmax(axis=-1)[..., None], axis=-1)
    held = stability(arrays, rotation, tangent)
    return HeldStability(
        np.asarray(~held.unstable), values[..., 0], softest / largest, _condition(arrays, tangent, held.neutral)
    )


def _condition(arrays: RobotArrays, tangent: np.ndarray, neutral: np.ndarray) -> np.ndarray:
    """Of stiffnesses (..., 6, 6), the smallest `neutral` (...) in size left out; inf where nothing is stiff."""
    unit, free = np.repeat([1.0, platform_radius(arrays)], 3), free_axes(arrays)
    scaled = (tangent / unit / unit[:, None])[..., free[:, None], free]
    size = np.sort(np.abs(np.linalg.eigvalsh(0.5 * (scaled + np.swapaxes(scaled, -1, -2)))), axis=-1)
    first = np.minimum(neutral, size.shape[-1] - 1)[..., None]
    least = np.take_along_axis(size, first, axis=-1)[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(size[..., -1] > 0.0, size[..., -1] / least, np.inf)


def unstable_sentence(found: HeldStability) -> str | None:
    """What to say of a single pose that is balanced but not held; None if it is."""
    if found.stable:
        return None
    return (
        f"the pose is an unstable equilibrium: at locked lengths the platform leaves it, moving {found.direction} "
        f"(stiffness {found.least_stiffness:.3g} N/m, rotations as arcs at the anchors)."
    )
