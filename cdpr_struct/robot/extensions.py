"""What a real robot has beyond anchors, cables and platform: compliance in line, masts, loads, encoders, sensors."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from cdpr_struct.robot.arrays import frozen_array

MAST = 0.2  # frame anchors nearer to each other in plan than this share of the frame's width sit on one mast


@dataclass(frozen=True, slots=True)
class Key:
    """A field of `Extensions`: entries ("cables": one per cable), neutral value, bounds, unit and meaning."""

    shape: int | str
    neutral: float
    unit: str
    meaning: str
    least: float = -np.inf
    above: float = -np.inf
    most: float = np.inf

    def entries(self, cables: int) -> int:
        """Numbers in the field; 0 for a single number."""
        return cables if isinstance(self.shape, str) else self.shape

    @property
    def range(self) -> str:
        """What values may be, as the end of a sentence; "" if all may."""
        lowest = f", above {self.above:g}" if np.isfinite(self.above) else ""
        lowest = lowest or (f", not below {self.least:g}" if np.isfinite(self.least) else "")
        return lowest + (f", not above {self.most:g}" if np.isfinite(self.most) else "")


KEYS: dict[str, Key] = {
    "series_compliance": Key("cables", 0.0, "m/N", "spring in line with the cable, at its frame end", 0.0, most=0.1),
    "frame_compliance": Key("cables", 0.0, "m/N", "of the mast, alike in all directions; one a mast", 0.0, most=0.1),
    "hose": Key(0, 0.0, "N/m", "stiffness that holds the platform origin to hose_center", 0.0),
    "hose_center": Key(3, 0.0, "m", "where the hose is relaxed, world frame"),
    "force": Key(3, 0.0, "N", "constant force on the platform origin, world frame"),
    "tilt": Key(2, 0.0, "rad", "of the platform's weight: m g (tilt_x, tilt_y, -1)"),
    "nonlinearity": Key(0, 0.0, "1", "k in EA (1 + k (T / T0 - 1)), T the tension at the platform"),
    "reference_tension": Key(0, 1.0, "N", "T0 of nonlinearity", above=0.0),
    "length_offset": Key("cables", 0.0, "m", "length paid out = encoder length * length_scale + length_offset"),
    "length_scale": Key("cables", 1.0, "1", "see length_offset", above=0.0),
    "bending_stiffness": Key("cables", 0.0, "N m^2", "EI of the cable, both ends clamped", 0.0),
    "added_mass": Key("cables", 0.0, "kg", "at mid-cable, for vibration only", 0.0),
    "cell_gain": Key("cables", 1.0, "1", "load cell reading = cell_gain * tension + cell_bias", above=0.0),
    "cell_bias": Key("cables", 0.0, "N", "see cell_gain"),
    "friction": Key("cables", 0.0, "1", "load cell = tension * exp(friction * last direction * turn at the exit)"),
    "tracker": Key(6, 0.0, "m, rad", "true pose = tracker's pose, turned and shifted by this"),
    "creep": Key(0, 0.0, "1", "share of the elastic strain per decade of time after 1 min"),
    "slip": Key("cables", 0.0, "m/h", "of the winch"),
    "accelerometer_gain": Key(6, 1.0, "1", "accelerometer reading = gain * acceleration, x to rz", above=0.0),
    "sensor_mass": Key(0, 0.0, "kg", "on the platform origin while vibration is measured, not when tensions are", 0.0),
}  # fmt: skip
SENSORS = ("cell_gain", "cell_bias", "friction", "tracker", "creep", "slip", "accelerometer_gain", "sensor_mass")
"""Act only where readings are compared: they describe sensors, or need the time of a reading."""
AUXILIARY = {"hose_center": "hose", "reference_tension": "nonlinearity"}
"""Mean something only with the other key."""


@dataclass(frozen=True, slots=True, eq=False)
class Extensions:
    """Extensions of a robot with m cables, SI; `KEYS` says what each field means and what its neutral value is.

    Per-cable fields are (m,), force and hose_center (3,), tilt (2,), tracker and accelerometer_gain (6,), the others
    single numbers.
    causes : names of the diagnosed causes that they stand for
    """

    series_compliance: np.ndarray
    frame_compliance: np.ndarray
    hose: float
    hose_center: np.ndarray
    force: np.ndarray
    tilt: np.ndarray
    nonlinearity: float
    reference_tension: float
    length_offset: np.ndarray
    length_scale: np.ndarray
    bending_stiffness: np.ndarray
    added_mass: np.ndarray
    cell_gain: np.ndarray
    cell_bias: np.ndarray
    friction: np.ndarray
    tracker: np.ndarray
    creep: float
    slip: np.ndarray
    accelerometer_gain: np.ndarray
    sensor_mass: float
    causes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        m = len(np.atleast_1d(self.series_compliance))
        for name, key in KEYS.items():
            shape = (key.entries(m),) if key.entries(m) else ()
            value = frozen_array(getattr(self, name), shape, f"Extensions.{name}")
            if (value < key.least).any() or (value <= key.above).any() or (value > key.most).any():
                raise ValueError(f"Extensions.{name} must be in {key.unit}{key.range}, got {value.tolist()}")
            object.__setattr__(self, name, value if shape else float(value))

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
        for name in set(given or {}) - set(KEYS):
            raise ValueError(f"no extension is called {name!r}; known: {', '.join(KEYS)}")
        for name, key in KEYS.items():
            value = np.asarray((given or {}).get(name, key.neutral), dtype=float)
            count = key.entries(cables)
            values[name] = np.full(count, float(value)) if count and value.ndim == 0 else value
        return cls(**values, causes=causes)

    @property
    def active(self) -> tuple[str, ...]:
        """Names of the fields that are not neutral (`AUXILIARY` ones left out)."""
        return tuple(n for n, key in KEYS.items() if n not in AUXILIARY and np.any(getattr(self, n) != key.neutral))

    @property
    def entered(self) -> dict[str, list[float] | float]:
        """The active fields, and what belongs to them, as plain numbers: what a robot file holds."""
        names = [n for n in KEYS if n in self.active or AUXILIARY.get(n) in self.active]
        return {n: np.asarray(getattr(self, n)).tolist() for n in names}

    def without(self, *names: str) -> "Extensions":
        """The same with the named fields neutral."""
        kept = {f.name: getattr(self, f.name) for f in fields(self) if f.name in KEYS and f.name not in names}
        return Extensions.of(len(self.series_compliance), kept, self.causes)


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


def divided_mast(frame_anchors: np.ndarray, frame_compliance: np.ndarray) -> tuple[int, ...]:
    """Cables, from 0, of the first mast whose compliance (m,) is not one number; empty if there is none."""
    for together in masts_of(frame_anchors) > 0.0:
        if np.ptp(frame_compliance[together]) > 0.0:
            return tuple(np.flatnonzero(together).tolist())
    return ()
