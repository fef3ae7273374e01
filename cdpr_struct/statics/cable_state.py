"""Static state of the cables of a robot, and how stiff each is."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.generated import catenary
from cdpr_struct.generated.cable_compliance import compliance, stiffness

STEEPEST = 1e-100  # cos(inclination) of a vertical cable: forces and their rates by the span stay finite
_UP = np.array([0.0, 0.0, 1.0])
VECTORS = ("offset", "heading", "up", "lump_place", "lump_weight")
"""Fields of `CableStates` with an axis of their own."""


@dataclass(frozen=True, slots=True, eq=False)
class CableStates:
    """Static state of m cables at each of a batch of poses; leading axes (...) are the batch.

    offset          : (..., m, 3) platform anchor minus the point where the free cable starts (the frame anchor, or
                      where it leaves its pulley), world [m]
    heading         : (..., m, 3) horizontal unit vector from frame end to platform end, world, across `up`
    length          : (..., m) unstrained length of the free cable [m]
    wrapped_length  : (..., m) unstrained length on the pulley [m]
    let_out         : (..., m) unstrained length that elements in line behind the frame end let out by stretching [m]
    force_x, force_z : (..., m) pull on the cable at its platform end, along `heading` and up [N]
    axial_stiffness : (..., m) EA [N]
    weight          : (..., m) w [N/m]; 0 for a straight, weightless cable
    status          : (..., m) `CableStatus` values
    up              : (..., m, 3) unit vector against gravity, world; along z if not given
    incremental_ratio : (..., m) EA over the secant that the tension has strained it by; 1 if not given
    lump_place, lump_weight : (..., m, k) of masses, unstrained from the platform end on [m], [N]; none if not given
    """

    offset: np.ndarray
    heading: np.ndarray
    length: np.ndarray
    wrapped_length: np.ndarray
    force_x: np.ndarray
    force_z: np.ndarray
    axial_stiffness: np.ndarray
    weight: np.ndarray
    status: np.ndarray
    let_out: np.ndarray
    up: np.ndarray = None  # type: ignore[assignment]
    lump_place: np.ndarray = None  # type: ignore[assignment]
    lump_weight: np.ndarray = None  # type: ignore[assignment]
    incremental_ratio: np.ndarray = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        if self.lump_place is None:
            none = np.broadcast_to(np.zeros(1), (*np.shape(self.length), 1))
            object.__setattr__(self, "lump_place", none)
            object.__setattr__(self, "lump_weight", none)
        if self.incremental_ratio is None:
            object.__setattr__(self, "incremental_ratio", np.ones(np.shape(self.length)))
        if self.up is None:
            object.__setattr__(self, "up", np.broadcast_to(_UP, self.heading.shape))

    def at(self, index: int | np.ndarray | None) -> "CableStates":
        """The states at an index of the batch: a number, an array of numbers, or None for one more axis."""
        return CableStates(*(getattr(self, name)[index] for name in CableStates.__slots__))

    @property
    def has_lumps(self) -> bool:
        """Whether point masses hang on any of them."""
        return bool(self.lump_weight.any())

    @property
    def whole_weight(self) -> np.ndarray:
        """(..., m) of the free cable and the point masses on it [N]."""
        own = self.weight * self.length
        return own + self.lump_weight.sum(axis=-1) if self.has_lumps else own

    @property
    def force_on_platform(self) -> np.ndarray:
        """(..., m, 3) force the cable exerts on the platform, world [N]."""
        return -self.force_x[..., None] * self.heading - self.force_z[..., None] * self.up

    @property
    def force_at_frame(self) -> np.ndarray:
        """(..., m, 3) tension vector at the frame end, pointing from frame to platform, world [N]."""
        return self.force_x[..., None] * self.heading + (self.force_z - self.whole_weight)[..., None] * self.up

    @property
    def total_length(self) -> np.ndarray:
        """(..., m) unstrained length that the winch has paid out beyond the frame anchor [m]."""
        return self.length + self.wrapped_length - self.let_out

    @property
    def paid_out(self) -> np.ndarray:
        """(..., m) `total_length` of the cable that was put at rest [m], where this is one in small motion."""
        return self.total_length * (1.0 - (self.incremental_ratio - 1.0) * self.tension / self.axial_stiffness)

    @property
    def tension_at_platform(self) -> np.ndarray:
        """(..., m) [N]."""
        return np.hypot(self.force_x, self.force_z)

    @property
    def tension_at_frame(self) -> np.ndarray:
        """(..., m) [N]."""
        return np.hypot(self.force_x, self.force_z - self.whole_weight)

    @property
    def slack(self) -> np.ndarray:
        """(..., m) bool: the cable does not pull at all (straight models only; a sagging cable always does)."""
        return (self.weight == 0.0) & (self.tension_at_platform <= 1e-100 * self.axial_stiffness)

    @property
    def span(self) -> np.ndarray:
        """(..., m) horizontal distance of the ends [m]."""
        return span_and_rise(self.offset, self.up)[0]

    @property
    def rise(self) -> np.ndarray:
        """(..., m) height of the platform end above the frame end [m]."""
        return span_and_rise(self.offset, self.up)[1]

    @property
    def chord(self) -> np.ndarray:
        """(..., m) distance of the ends, eq. (2.13) [m]."""
        return np.linalg.norm(self.offset, axis=-1)

    @property
    def inclination(self) -> np.ndarray:
        """(..., m) angle of the chord above the horizontal [rad], > 0 if the platform end is the higher one."""
        return np.arctan2(self.rise, self.span)

    @property
    def tension(self) -> np.ndarray:
        """(..., m) tau, tension where the cable is parallel to its chord, eq. (2.17) [N]."""
        if self.has_lumps:
            return np.asarray(self.force_x * self.chord / np.maximum(self.span, STEEPEST * self.chord))
        return np.where(self.slack, 0.0, catenary.chord_tension(*self._pulling))

    @property
    def sag(self) -> np.ndarray:
        """(..., m) largest distance from the chord, eq. (2.22) [m]; nan for a slack straight cable."""
        if self.has_lumps:
            return self._sag_of_segments()
        return np.where(self.slack, np.nan, catenary.sag(*self._pulling))

    @property
    def elongation(self) -> np.ndarray:
        """(..., m) strained minus unstrained length, eq. (2.16) [m]."""
        if self.has_lumps:
            return np.asarray(catenary.elongation(*self.segments).sum(axis=-1))
        return np.where(self.slack, 0.0, catenary.elongation(*self._pulling))

    def compliance_split(self) -> tuple[np.ndarray, np.ndarray]:
        """Axial and sag part (2.28) of the compliance in the cable plane (heading, up): two (..., m, 2, 2) [m/N]."""
        if self.has_lumps:
            c_axial, c_xx, c_xz, c_zz = (part.sum(axis=-1) for part in compliance(*self.segments))
        else:
            c_axial, c_xx, c_xz, c_zz = compliance(*self._pulling)
        sag = np.stack([c_xx, c_xz, c_xz, c_zz], axis=-1).reshape((*c_xx.shape, 2, 2))
        return c_axial[..., None, None] * np.eye(2), sag

    @property
    def segments(self) -> tuple[np.ndarray, ...]:
        """Arguments of the generated functions for the segments between point masses, (..., m, k + 1)."""
        return segments(self._pulling, self.lump_place, self.lump_weight)

    def profile(self, fractions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Along heading and up (..., m, p) [m] from the frame end, at fractions (p,) or (..., m, p) of the unstrained
        lengths."""
        arc = fractions * self.length[..., None]
        if not self.has_lumps:
            along, rise = catenary.profile(arc, *(value[..., None] for value in self._pulling))
            return along, rise
        parts = self.segments
        starts = self.length[..., None] - np.cumsum(parts[2], axis=-1)
        local = np.clip(arc[..., None, :] - starts[..., None], 0.0, parts[2][..., None])
        along, rise = catenary.profile(local, *(part[..., None] for part in parts))
        return along.sum(axis=-2), rise.sum(axis=-2)

    def _sag_of_segments(self) -> np.ndarray:
        """(..., m) [m]: at a point mass, or where a segment is parallel to the chord."""
        _, vertical, own, _, weight = parts = self.segments
        span = np.maximum(self.span, STEEPEST * self.chord)
        parallel = (self.force_x * self.rise / span)[..., None]
        down = np.clip((vertical - parallel) / np.maximum(weight, 1e-300), 0.0, own)
        arc = self.length[..., None] - np.cumsum(parts[2], axis=-1) + own - down
        along, rise = self.profile(arc / self.length[..., None])
        away = np.abs(along * self.rise[..., None] - rise * self.span[..., None]) / self.chord[..., None]
        return np.asarray(away.max(axis=-1))

    @property
    def _pulling(self) -> tuple[np.ndarray, ...]:
        """Arguments of the generated functions, with a unit pull where the cable is slack."""
        force_z = np.where(self.slack, 1.0, self.force_z)
        return self.force_x, force_z, self.length, self.axial_stiffness, self.weight


def segments(cable: tuple[np.ndarray, ...], place: np.ndarray, point_weight: np.ndarray) -> tuple[np.ndarray, ...]:
    """Arguments (..., k + 1) of the generated functions for each segment between point masses, that at the platform
    first: pulls at its platform end, length, EA, w.

    cable : those (...) of the whole cable;  place, point_weight : (..., k) from its platform end on, ascending [m],
        [N]. A mass beyond the frame end sits on it
    """
    force_x, force_z, length, axial_stiffness, weight = (value[..., None] for value in np.broadcast_arrays(*cable))
    none, place = np.zeros(length.shape), np.minimum(place, length)
    ends = np.concatenate([none, place, length], axis=-1)
    above = np.cumsum(np.concatenate([none, point_weight], axis=-1), axis=-1)
    vertical = force_z - weight * ends[..., :-1] - above
    rest = (np.broadcast_to(value, vertical.shape) for value in (axial_stiffness, weight))
    return np.broadcast_to(force_x, vertical.shape), vertical, np.diff(ends, axis=-1), *rest


def cable_stiffness(states: CableStates) -> np.ndarray:
    """Static stiffness of each free cable for a motion of its platform end, the frame end held.

    Returns
    -------
    (..., m, 3, 3) symmetric, world [N/m]: eq. (2.29) in the cable plane, and force_x / span across it (for an exactly
    vertical taut cable both horizontal directions are alike). Zero for a slack straight cable and across a fold.
    """
    k_xx, k_xz, k_zz = stiffness(*states._pulling) if not states.has_lumps else _stiffness_in_series(states)
    span = states.span
    vertical = span <= 1e-140 * states.length
    across = np.where(vertical, k_xx, states.force_x / np.where(vertical, 1.0, span))
    h = states.heading
    matrix = np.empty((*span.shape, 3, 3))
    if (states.up[..., 2] != 1.0).any():
        matrix = _turned_stiffness(states, (k_xx, k_xz, k_zz, across))
    else:
        for i in range(2):
            for j in range(2):
                along = h[..., i] * h[..., j]
                matrix[..., i, j] = k_xx * along + across * (float(i == j) - along)
            matrix[..., i, 2] = matrix[..., 2, i] = k_xz * h[..., i]
        matrix[..., 2, 2] = k_zz
    if (states.weight == 0.0).any():
        matrix[states.slack] = 0.0
    return matrix


def _stiffness_in_series(states: CableStates) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """k_xx, k_xz, k_zz (..., m) [N/m] of cables whose segments' compliances add up."""
    inverse = np.linalg.inv(sum(states.compliance_split()))
    return inverse[..., 0, 0], inverse[..., 0, 1], inverse[..., 1, 1]


def _turned_stiffness(states: CableStates, parts: tuple[np.ndarray, ...]) -> np.ndarray:
    """(..., m, 3, 3) from its parts along heading, across and up, where up is not z."""
    frame = cable_frame(states)
    local = np.zeros(frame.shape)
    local[..., 0, 0], local[..., 0, 2], local[..., 2, 2], local[..., 1, 1] = parts
    local[..., 2, 0] = parts[1]
    return np.asarray(frame @ local @ np.swapaxes(frame, -1, -2))


def cable_frame(states: CableStates) -> np.ndarray:
    """(..., m, 3, 3) unit vectors along heading, across and up of each cable, as columns, world."""
    return np.stack([states.heading, np.cross(states.up, states.heading), states.up], axis=-1)


def span_and_rise(offset: np.ndarray, up: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Horizontal and vertical distance (...) [m] of offsets (..., 3), up (..., 3) a unit vector."""
    if (up[..., 2] == 1.0).all():
        return np.hypot(offset[..., 0], offset[..., 1]), offset[..., 2]
    rise = (offset * up).sum(axis=-1)
    return np.linalg.norm(offset - rise[..., None] * up, axis=-1), rise


def heading_and_span(offset: np.ndarray, up: np.ndarray = _UP) -> tuple[np.ndarray, np.ndarray]:
    """Horizontal unit vector (..., 3) of offsets (..., 3), world x for a vertical one, and their span (...) [m].

    up : (..., 3) unit vector against gravity; where it is not z, some horizontal direction for a vertical offset
    """
    span, rise = span_and_rise(offset, up)
    safe = np.where(span > 0.0, span, 1.0)
    heading = np.zeros_like(offset)
    if (up[..., 2] == 1.0).all():
        heading[..., 0] = np.where(span > 0.0, offset[..., 0] / safe, 1.0)
        heading[..., 1] = offset[..., 1] / safe
        return heading, span
    level = np.broadcast_to(np.eye(3)[int(np.abs(up).reshape(-1, 3).max(axis=0).argmin())], offset.shape)
    level = level - (level * up).sum(axis=-1, keepdims=True) * up
    level = level / np.linalg.norm(level, axis=-1, keepdims=True)
    across = (offset - rise[..., None] * up) / safe[..., None]
    return np.where(span[..., None] > 0.0, across, level), span
