"""Everything that the vibration of a robot at rest depends on, as one vector of smooth numbers.

Per cable: tension vector at the frame end, weight, EA, unstrained length, density, stiffening by bending, EI, mass at
mid-cable, compliance of the frame end, lever arm. Of each shape of the masts its
compliance. Of the platform: mass matrix and the stiffness of weight, lever arms and hose; of each freedom of a part
that moves in it the coupling (`internal_coupling`) and omega.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.frame_give import frame_give
from cdpr_struct.dynamics.internal_mass import internal_coupling, internal_omega
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly, geometric_stiffness, platform_mass_matrix
from cdpr_struct.dynamics.stiff_cable import shortening, slenderness
from cdpr_struct.robot.added_masses import nearest_place
from cdpr_struct.statics.masts import MastShapes

PULL, WEIGHT, EA, LENGTH, DENSITY, TIGHTENED, BENDING, PLACE, ADDED, GIVE, ARM = (
    slice(0, 3), 3, 4, 5, 6, 7, 8, 9, slice(10, 14), slice(14, 23), slice(23, 26),
)  # fmt: skip
CABLE_COLUMNS = 26
"""Columns of one cable in the vector."""


@dataclass(frozen=True, slots=True, eq=False)
class Dependence:
    """What the vibration of robots (...) depends on.

    cables : (..., m, CABLE_COLUMNS), in the order of the constants above
    masts  : (..., q) compliances of `MastShapes` [m/N]
    mass, stiffness : (..., 6, 6) of the platform without cables, world axes
    internal : (..., 7 PARTS) coupling (6) [kg^(1/2), kg^(1/2) m] and omega [rad/s] of each freedom of a moving part
    """

    cables: np.ndarray
    masts: np.ndarray
    mass: np.ndarray
    stiffness: np.ndarray
    internal: np.ndarray

    @classmethod
    def of(cls, point: OperatingPoint, assembly: Assembly) -> "Dependence":
        arrays = point.arrays
        held = arrays.hose[..., None, None] * np.eye(3)
        turned = geometric_stiffness(point) if assembly == "consistent" else np.zeros((3, 3))
        stiffness = np.zeros((*np.broadcast_shapes(held.shape, turned.shape)[:-2], 6, 6))
        stiffness[..., :3, :3], stiffness[..., 3:, 3:] = held, turned
        mass = platform_mass_matrix(arrays, point.rotation)
        coupling = np.swapaxes(internal_coupling(arrays, point.rotation), -1, -2)
        internal = _joined(coupling, internal_omega(arrays)[..., None])
        internal = internal.reshape((*internal.shape[:-2], -1))
        masts = MastShapes.of(arrays)
        return cls(cable_dependence(point), masts.compliance, mass, stiffness, internal)

    @property
    def vector(self) -> np.ndarray:
        """(..., n) all of it."""
        parts = [(self.cables, 2), (self.masts, 1), (self.mass, 2), (self.stiffness, 2), (self.internal, 1)]
        lead = np.broadcast_shapes(*(part.shape[: part.ndim - axes] for part, axes in parts))
        flat = [np.broadcast_to(p, lead + p.shape[p.ndim - axes :]).reshape((*lead, -1)) for p, axes in parts]
        return np.concatenate(flat, axis=-1)


def cable_dependence(point: OperatingPoint) -> np.ndarray:
    """(..., m, CABLE_COLUMNS) of the cables."""
    arrays, cables = point.arrays, point.cables
    bends, tightened = arrays.bending_stiffness, np.ones(1)
    if bends.any():
        slender = slenderness(bends, cables.tension, cables.chord)
        tightened = (1.0 + shortening(slender, arrays.bending_fixity)) ** 2
    singles = (
        cables.weight * cables.length, cables.axial_stiffness, cables.length, arrays.linear_density, tightened, bends,
        arrays.added_mass_place,
    )  # fmt: skip
    added = arrays.added_mass[..., None] * nearest_place(arrays)
    arms = arrays.platform_anchors @ np.swapaxes(point.rotation, -1, -2)
    return _joined(
        cables.force_at_frame, *(value[..., None] for value in singles), added, frame_compliance(point), arms
    )


def _joined(*parts: np.ndarray) -> np.ndarray:
    """Arrays (..., n) behind each other along their last axis; the others broadcast."""
    shape = np.broadcast_shapes(*(part.shape[:-1] for part in parts))
    return np.concatenate([np.broadcast_to(p, (*shape, p.shape[-1])) for p in parts], axis=-1)


def frame_compliance(point: OperatingPoint) -> np.ndarray:
    """(..., m, 9) by which frame ends give way, rows and columns of the world's axes [m/N]; zero for fixed points."""
    give = frame_give(point)
    if give is None:
        return np.zeros((*point.cables.length.shape, 9))
    matrix = (give.directions * give.compliance[..., None, :]) @ np.swapaxes(give.directions, -1, -2)
    return np.asarray(matrix.reshape((*matrix.shape[:-2], 9)))
