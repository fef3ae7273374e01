"""Geometry of a swivelling pulley: where does the cable leave it, and how much cable lies on it?

The swivel axis a passes through the frame anchor B; the cable passes B travelling along +a, bends over the wheel of
radius R by the wrap angle phi and leaves at E in the direction t (unit). The wheel turns about its axis until the
cable lies in its plane, so t alone fixes everything: with e the unit normal part of t to a,

    t = sin(phi) e + cos(phi) a,      E = B + R (1 - cos(phi)) e + R sin(phi) a,      wrapped length R phi (strained).

R = 0 is a fixed point, E = B. A cable that would turn by more than 180 degrees, to a point behind the wheel and nearer
to the swivel axis than 2 R, is not covered, nor is one that ends within the wheel; to a point on the axis the wheel
might face any way. Weight of the wrapped piece and friction are left out, so the cable tension on the wheel is that at
E.
"""

from dataclasses import dataclass

import numpy as np

_SMALL = 1e-12
_ON_AXIS = 1e-9  # sine of the angle to the swivel axis below which a wheel has no plane


@dataclass(frozen=True, slots=True, eq=False)
class PulleyExit:
    """Where the cables leave their pulleys; leading axes (...) are free.

    point      : (..., 3) E minus B, world [m]
    wrap_angle : (...) phi [rad]
    """

    point: np.ndarray
    wrap_angle: np.ndarray


def pulley_exit(direction: np.ndarray, axis: np.ndarray, radius: np.ndarray) -> PulleyExit:
    """Exit of a cable that leaves in `direction`.

    direction, axis : (..., 3) unit, world
    radius : (...) R [m]
    """
    cos, sin, radial = _in_plane(direction, axis)
    point = radius[..., None] * ((1.0 - cos)[..., None] * radial + sin[..., None] * axis)
    return PulleyExit(point, np.arctan2(sin, cos))


def exit_rates(direction: np.ndarray, axis: np.ndarray, radius: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives with respect to the exit direction: of E (..., 3, 3) [m], and of R phi (..., 3) [m]."""
    cos, sin, radial = _in_plane(direction, axis)
    sin = np.maximum(sin, _SMALL)
    normal = np.eye(3) - axis[..., :, None] * axis[..., None, :] - radial[..., :, None] * radial[..., None, :]
    rate = ((1.0 - cos) / sin)[..., None, None] * normal  # turning the wheel plane moves E sideways
    rate -= radial[..., :, None] * axis[..., None, :]
    rate -= (cos / sin)[..., None, None] * axis[..., :, None] * axis[..., None, :]
    return radius[..., None, None] * rate, -(radius / sin)[..., None] * axis


def turned_back(direction: np.ndarray, axis: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """(...) bool: cables that leave in `direction` (..., 3) come straight back along the axis of their wheel, which
    might face any way."""
    cos, sin, _ = _in_plane(direction, axis)
    return np.asarray((radius > 0.0) & (cos < 0.0) & (sin <= _ON_AXIS))


def behind_wheel(offset: np.ndarray, axis: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """(...) bool: straight cables to points `offset` (..., 3) from B [m] would turn by more than 180 degrees, or end
    within the wheel."""
    along, distance, _ = _in_plane(offset, axis)
    behind = (radius > 0.0) & (along < 0.0) & (distance < 2.0 * radius)
    return np.asarray(behind | within_wheel(offset, axis, radius))


def within_wheel(offset: np.ndarray, axis: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """(...) bool: points `offset` (..., 3) from B [m] that lie within a wheel turned towards them."""
    along, distance, _ = _in_plane(offset, axis)
    return np.asarray(np.hypot(distance - radius, along) < radius)


def straight_exit(offset: np.ndarray, axis: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Exit direction (..., 3) of a straight cable from the pulley to a point; `offset` (..., 3) is point minus B [m].

    A point inside the wheel gets the direction of the nearest tangent.
    """
    along = np.einsum("...i,...i->...", offset, axis)
    across = offset - along[..., None] * axis
    distance = np.linalg.norm(across, axis=-1)
    radial = across / np.maximum(distance, 1e-300)[..., None]
    free = np.sqrt(np.maximum((distance - radius) ** 2 + along**2 - radius**2, 0.0))
    angle = np.arctan2(distance - radius, along) + np.arctan2(radius, free)
    return np.sin(angle)[..., None] * radial + np.cos(angle)[..., None] * axis


def _in_plane(direction: np.ndarray, axis: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """cos(phi), sin(phi) and e, of unit directions; of others, times their length."""
    cos = np.einsum("...i,...i->...", direction, axis)
    across = direction - cos[..., None] * axis
    sin = np.linalg.norm(across, axis=-1)
    return cos, sin, across / np.maximum(sin, 1e-300)[..., None]
