"""How cables move in a mode: displacement and its slope at Gauss points along each cable."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import flattened
from cdpr_struct.dynamics.catenary_coordinate import CatenaryCoordinate
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.added_masses import PLACES, asked_places

_SPARE = (
    8  # Gauss points beyond the order of the polynomials: products of slopes with tension and density come out whole
)


@dataclass(frozen=True, slots=True, eq=False)
class Stations:
    """Gauss points (..., m, s): fractions of the unstrained cable from the frame, and weights that add up to one."""

    share: np.ndarray
    weight: np.ndarray

    @classmethod
    def on(cls, point: OperatingPoint, order: int) -> "Stations":
        """Points that integrate polynomials of an order in the catenary's own coordinate, however sharply it bends."""
        shape = point.cables.length.shape
        nodes, weights = np.polynomial.legendre.leggauss(order + _SPARE)
        flat = flattened(point.cables)
        arc, rate = CatenaryCoordinate.of(flat).arc(nodes)
        length = flat.length[:, None]
        share, weight = arc / length, weights * rate / length
        return cls(share.reshape((*shape, -1)), weight.reshape((*shape, -1)))


@dataclass(frozen=True, slots=True, eq=False)
class CableFields:
    """k modes of m cables at s stations, world axes; leading axes (...) are the batch.

    motion    : (..., m, k, s, 3) displacement, of the mast too
    slope     : (..., m, k, s, 3) its derivative by the fraction of the cable
    curvature : (..., m, k, s, 3) its second derivative; no stations where it is not asked for
    loaded    : (..., m, k, 2, p, 3) displacement and slope where the cable may carry an added mass (`asked_places`)
    """

    stations: Stations
    motion: np.ndarray
    slope: np.ndarray
    curvature: np.ndarray
    loaded: np.ndarray

    @property
    def at_rest(self) -> "CableFields":
        """The same shapes without inertia."""
        return replace(self, motion=np.zeros_like(self.motion), loaded=np.zeros_like(self.loaded))


def fields_of_expansion(
    point: OperatingPoint,
    order: int,
    expansion: ModalExpansion,
    end: np.ndarray,
    modal: np.ndarray,
    mast: np.ndarray,
    bent: bool = False,
) -> CableFields:
    """Fields of modes with coordinates end, mast (..., k, m, 3) and modal (..., k, m, p) of an exact expansion.

    bent : with curvatures, also where cables do not resist bending: to know what they would do
    """
    stations = Stations.on(point, order)
    flat = stations.share.reshape((-1, stations.share.shape[-1]))
    ends, own = np.swapaxes(end, -3, -2), np.swapaxes(modal, -3, -2)
    whole, masts = expansion.frame[..., None, None, :, :], np.swapaxes(mast, -3, -2)[..., None, :]

    def of(places: np.ndarray, derivative: int) -> np.ndarray:
        static, modes = expansion.shapes(places, derivative)
        held = np.einsum("...msab,...mkb->...mksa", static, ends, optimize=True)
        swing = own @ modes.reshape((*modes.shape[:-2], -1))
        moved = held + swing.reshape((*swing.shape[:-1], -1, 3)) + (0.0 if derivative else masts)
        return np.asarray((whole @ moved[..., None])[..., 0])

    curved = of(flat if bent or point.arrays.bending_stiffness.any() else flat[:, :0], 2)
    places = asked_places(point.arrays)
    there = 1.0 - np.broadcast_to(places, point.cables.length.shape + places.shape[-1:]).reshape(-1, places.shape[-1])
    loaded = np.stack([of(there, 0), of(there, 1)], axis=-3)
    return CableFields(stations, of(flat, 0), of(flat, 1), curved, loaded)


def massless_fields(point: OperatingPoint, order: int, force: np.ndarray) -> CableFields:
    """Fields of massless cables whose ends give way by `force` (..., k, m, 3) [N], world: it is the same all along."""
    stations = Stations.on(point, order)
    cables = point.cables
    weight = (cables.weight * cables.length)[..., None] * stations.share
    vector = cables.force_at_frame[..., None, :] + weight[..., None] * np.array([0.0, 0.0, 1.0])
    tension = np.maximum(np.linalg.norm(vector, axis=-1), np.finfo(float).tiny)
    tangent = (vector / tension[..., None])[..., None, :, :]
    pull = np.swapaxes(force, -3, -2)[..., None, :]
    along = (tangent * pull).sum(axis=-1, keepdims=True)
    stiff = cables.axial_stiffness[..., None]
    across = (1.0 / tension + 1.0 / stiff)[..., None, :, None]
    length = cables.length[..., None, None, None]
    slope = length * (along * tangent / stiff[..., None, :, None] + across * (pull - along * tangent))
    nothing = slope[..., :0, :]
    return CableFields(stations, np.zeros_like(slope), slope, nothing, np.zeros((*slope.shape[:-2], 2, len(PLACES), 3)))
