"""What a real robot has beyond anchors, cables and platform: compliance in line, masts, loads, encoders, sensors."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from cdpr_struct.robot.arrays import frozen_array
from cdpr_struct.robot.parameters import AUXILIARY, EXTENSIONS

MAST = 0.2  # frame anchors nearer to each other in plan than this share of the frame's width sit on one mast
_RANK = 1e-12  # of the largest flexibility: exits at one height move as one
_ROUNDING = 1e-15  # a vector whose length is one but for this is left as it is: files are read as they were written


@dataclass(frozen=True, slots=True, eq=False)
class Extensions:
    """Extensions of a robot with m cables, SI; `EXTENSIONS` says what each field means and what its neutral value is.

    Per-cable fields are (m,), force, moment, wind, hose_center, swinging_place and internal_direction (3,; the last is
    normalised at birth), tilt (2,), tracker and accelerometer_gain (6,), the others single numbers.
    causes : names of the diagnosed causes that they stand for
    """

    series_compliance: np.ndarray
    frame_compliance: np.ndarray
    mast_bending: np.ndarray
    mast_mass: np.ndarray
    mast_foot: float
    hose: float
    hose_center: np.ndarray
    force: np.ndarray
    moment: np.ndarray
    drag_area: float
    drag_width: np.ndarray
    wind: np.ndarray
    air_density: float
    tilt: np.ndarray
    nonlinearity: float
    stiffening_exponent: float
    incremental_ratio: float
    reference_tension: float
    length_offset: np.ndarray
    length_scale: np.ndarray
    temperature_change: float
    bending_stiffness: np.ndarray
    bending_fixity: np.ndarray
    added_mass: np.ndarray
    added_mass_place: np.ndarray
    cell_gain: np.ndarray
    cell_bias: np.ndarray
    friction: np.ndarray
    bearing_friction: np.ndarray
    pulley_drag: np.ndarray
    backlash: np.ndarray
    tracker: np.ndarray
    creep: float
    slip: np.ndarray
    encoder_delay: np.ndarray
    swivel_zero: np.ndarray
    cell_delay: np.ndarray
    clock_drift: float
    clock_start: float
    accelerometer_gain: np.ndarray
    sensor_mass: float
    internal_mass: float
    internal_frequency: float
    internal_direction: np.ndarray
    swinging_mass: float
    swinging_frequency: float
    swinging_place: np.ndarray
    causes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        m = len(np.atleast_1d(self.series_compliance))
        for name, key in EXTENSIONS.items():
            shape = (key.entries(m),) if key.entries(m) else ()
            value = frozen_array(getattr(self, name), shape, f"Extensions.{name}")
            if (value < key.least).any() or (value <= key.above).any() or (value > key.most).any():
                raise ValueError(f"Extensions.{name} must be in {key.unit}{key.range}, got {value.tolist()}")
            object.__setattr__(self, name, value if shape else float(value))
        length = float(np.linalg.norm(self.internal_direction))
        if length == 0.0:
            raise ValueError("Extensions.internal_direction must not be the zero vector")
        if abs(length - 1.0) > _ROUNDING:
            unit = frozen_array(self.internal_direction / length, (3,), "Extensions.internal_direction")
            object.__setattr__(self, "internal_direction", unit)

    @classmethod
    def of(
        cls, cables: int, given: Mapping[str, npt.ArrayLike] | None = None, causes: tuple[str, ...] = ()
    ) -> "Extensions":
        """Extensions from the fields that are not neutral; one number stands for all entries of a field.

        Raises
        ------
        ValueError : unknown field, wrong number of entries, or a value out of range.
        """
        values: dict[str, Any] = {}
        for name in set(given or {}) - set(EXTENSIONS):
            raise ValueError(f"no extension is called {name!r}; known: {', '.join(EXTENSIONS)}")
        for name, key in EXTENSIONS.items():
            value = np.asarray((given or {}).get(name, key.neutral), dtype=float)
            count = key.entries(cables)
            values[name] = np.full(count, float(value)) if count and value.ndim == 0 else value
        return cls(**values, causes=causes)

    @property
    def active(self) -> tuple[str, ...]:
        """Names of the fields that are not neutral (`AUXILIARY` ones left out)."""
        return tuple(
            n for n, key in EXTENSIONS.items() if n not in AUXILIARY and np.any(getattr(self, n) != key.neutral)
        )

    @property
    def wrench(self) -> np.ndarray:
        """(6,) constant force, drag of wind included, and moment on the platform about its origin, world [N, N m]."""
        pushed = drag(self.wind, np.asarray(self.drag_area), np.asarray(self.air_density))
        return np.concatenate([self.force + pushed, self.moment])

    @property
    def entered(self) -> dict[str, list[float] | float]:
        """The active fields, and what belongs to them, as plain numbers: what a robot file holds."""
        names = [n for n in EXTENSIONS if n in self.active or set(AUXILIARY.get(n, ())) & set(self.active)]
        return {n: np.asarray(getattr(self, n)).tolist() for n in names}

    def with_changes(self, **changes: npt.ArrayLike) -> "Extensions":
        """The same with other values of the named fields."""
        kept = {f.name: getattr(self, f.name) for f in fields(self) if f.name in EXTENSIONS}
        return Extensions.of(len(self.series_compliance), kept | changes, self.causes)

    def without(self, *names: str) -> "Extensions":
        """The same with the named fields neutral."""
        kept = {f.name: getattr(self, f.name) for f in fields(self) if f.name in EXTENSIONS and f.name not in names}
        return Extensions.of(len(self.series_compliance), kept, self.causes)


def drag(wind: np.ndarray, area: np.ndarray, density: np.ndarray) -> np.ndarray:
    """Force (..., 3) [N] of wind (..., 3) [m/s] on a drag area (...) [m^2] in air of a density (...) [kg/m^3].

    rho/2 C A |v| v, the same from all sides.
    """
    size = 0.5 * np.asarray(density) * np.asarray(area) * np.linalg.norm(wind, axis=-1)
    return np.asarray(size[..., None] * wind)


def drag_across(wind: np.ndarray, chord: np.ndarray, width: np.ndarray, density: np.ndarray) -> np.ndarray:
    """Force per length (..., 3) [N/m] of wind (..., 3) [m/s] on cables along chords (..., 3), of a drag width (...) [m]
    in air of a density (...) [kg/m^3].

    rho/2 c d |v_n| v_n, v_n the part of the wind across the chord (cross-flow principle, Hoerner 1965, ch. 3): along a
    cable the air does not pull.
    """
    along = chord / np.linalg.norm(chord, axis=-1, keepdims=True)
    return drag(wind - (wind * along).sum(axis=-1, keepdims=True) * along, width, density)


def masts_of(frame_anchors: np.ndarray) -> np.ndarray:
    """(m, m) 1 where two cables share a mast, their frame anchors (m, 3) being close to each other in plan.

    Neighbours of neighbours are neighbours.
    """
    plan = frame_anchors[:, :2]
    distance = np.linalg.norm(plan[:, None] - plan[None], axis=-1)
    shared = distance <= MAST * max(float(distance.max()), 1e-9)
    for _ in range(len(shared)):
        shared = shared | (shared.astype(int) @ shared.astype(int) > 0)
    return np.asarray(shared, dtype=float)


def uprights_of(frame_anchors: np.ndarray, foot: float) -> np.ndarray:
    """(m, m) U, so that a unit compliance of each mast at its highest exit moves the exits by U U^T F under pulls F.

    A mast is an upright of constant bending stiffness EI, clamped at the height `foot` [m]: a force at height a moves
    height b by l^2 (3 h - l) / (6 EI), l and h the lower and the higher of the two above the foot (Euler-Bernoulli). An
    exit at the foot or below does not move. Columns belong to one mast each; those that are not needed are zero.
    """
    masts, height = masts_of(frame_anchors), np.maximum(frame_anchors[:, 2] - foot, 0.0)
    low, high = np.minimum.outer(height, height), np.maximum.outer(height, height)
    top = (masts * height).max(axis=1)
    share = np.where(top > 0.0, top, 1.0) ** 3
    flexibility = masts * low**2 * (3.0 * high - low) / (2.0 * share)
    result, column = np.zeros_like(masts), 0
    for first in np.unique(masts.argmax(axis=1)):
        own = np.flatnonzero(masts[first])
        values, vectors = np.linalg.eigh(flexibility[np.ix_(own, own)])
        kept = values > _RANK * values.max(initial=0.0)
        count = int(kept.sum())
        result[own, column : column + count] = vectors[:, kept] * np.sqrt(values[kept])
        column += count
    return result


def divided_mast(frame_anchors: np.ndarray, frame_compliance: np.ndarray) -> tuple[int, ...]:
    """Cables, from 0, of the first mast whose compliance (m,) is not one number; empty if there is none."""
    for together in masts_of(frame_anchors) > 0.0:
        if np.ptp(frame_compliance[together]) > 0.0:
            return tuple(np.flatnonzero(together).tolist())
    return ()
