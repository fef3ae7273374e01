"""What is never exactly known about a robot, and which robots are as probable as the one entered."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from scipy.linalg import block_diag

from cdpr_struct.robot.changed_arrays import plus, times
from cdpr_struct.robot.parameters import CABLES, EXTENSIONS, PARAMETERS, SENSORS
from cdpr_struct.robot.robot_arrays import RobotArrays

_HALF = np.sqrt(0.5)  # of a relative tolerance's sigma is common to all cables, which come from one reel
UNKNOWN_SWIVEL = 100.0
"""deg, one sigma of a swivel encoder's zero of which nothing is known: as wide as a full turn spreads."""


@dataclass(frozen=True, slots=True)
class Tolerances:
    """One sigma of what is never exactly known about a robot; the defaults are those of a carefully built one.

    anchor_m             : each coordinate of each anchor, both ends [m]
    length_m             : zero of each cable's length [m]
    axial_stiffness, linear_density : relative, per cable, half of the variance common to all (one reel)
    platform_mass_kg, center_of_mass_m, platform_inertia (relative)
    load_cell_gain       : relative;  load_cell_bias_N [N]
    damping              : relative
    pulley_radius_m      : each pulley [m]
    swivel_deg           : zero of each encoder on a swivel axis [deg]; unknown unless given
    """

    anchor_m: float = 0.001
    length_m: float = 0.0005
    axial_stiffness: float = 0.03
    linear_density: float = 0.01
    platform_mass_kg: float = 0.1
    center_of_mass_m: float = 0.002
    platform_inertia: float = 0.03
    load_cell_gain: float = 0.005
    load_cell_bias_N: float = 0.5
    damping: float = 0.3
    pulley_radius_m: float = 0.0002
    swivel_deg: float = UNKNOWN_SWIVEL


def tolerance_unit(name: str) -> str:
    """Unit of a tolerance, which ends its name; "" of those that are shares of the value entered."""
    return next((ending for ending in ("m", "kg", "N", "deg") if name.endswith(f"_{ending}")), "")


@dataclass(frozen=True, slots=True)
class Varied:
    """A number of a robot, or one of each cable, that may be off.

    field : of `RobotArrays`;  tolerance : of `Tolerances`, "" of what only a diagnosis finds to be off
    unit : of a change; with a tolerance, "1" is that of the logarithm
    shape : axes, as in `Parameter`;  reel : cables share half of the variance
    """

    field: str
    tolerance: str
    unit: str
    shape: tuple[int | str, ...]
    reel: bool = False

    @property
    def relative(self) -> bool:
        """Whether changes are those of the logarithm."""
        return self.unit == "1" and self.tolerance != ""

    @property
    def of_cells(self) -> bool:
        """Whether it changes what load cells say, and no robot."""
        return self.field.startswith("cell_")

    def count(self, cables: int) -> int:
        """Numbers in it."""
        return math.prod(self.lengths(cables))

    def lengths(self, cables: int) -> tuple[int, ...]:
        """Of its axes."""
        return tuple(cables if isinstance(n, str) else n for n in self.shape)

    @classmethod
    def found(cls, field: str) -> "Varied":
        """A number that no tolerance is about, and that a diagnosis finds to be off."""
        rule = PARAMETERS[field]
        return cls(field, "", rule.unit, rule.shape)


VARIED = (
    Varied("frame_anchors", "anchor_m", "m", (CABLES, 3)),
    Varied("platform_anchors", "anchor_m", "m", (CABLES, 3)),
    Varied("length_offset", "length_m", "m", (CABLES,)),
    Varied("axial_stiffness", "axial_stiffness", "1", (CABLES,), reel=True),
    Varied("linear_density", "linear_density", "1", (CABLES,), reel=True),
    Varied("mass", "platform_mass_kg", "kg", ()),
    Varied("center_of_mass", "center_of_mass_m", "m", (3,)),
    Varied("inertia", "platform_inertia", "1", (3,)),
    Varied("cell_gain", "load_cell_gain", "1", (CABLES,)),
    Varied("cell_bias", "load_cell_bias_N", "N", (CABLES,)),
    Varied("pulley_radius", "pulley_radius_m", "m", (CABLES,)),
)
"""In the order in which changes stand behind each other; what else a diagnosis found stands behind them."""
FINDABLE = tuple(name for name in EXTENSIONS if name not in {*SENSORS, *(one.field for one in VARIED)})
"""Fields that only a diagnosis finds to be off; sensors' own left out."""


def places(cables: int, varied: Sequence[Varied] = VARIED) -> list[slice]:
    """Of each kind of number among the changes of a robot with so many cables."""
    ends = list(accumulate(one.count(cables) for one in varied))
    return [slice(end - one.count(cables), end) for one, end in zip(varied, ends, strict=True)]


def change_count(cables: int, varied: Sequence[Varied] = VARIED) -> int:
    """How many numbers may be off."""
    return places(cables, varied)[-1].stop


def changed(arrays: RobotArrays, change: np.ndarray, varied: Sequence[Varied] = VARIED) -> RobotArrays:
    """The robot with changes (..., p), in the units of `varied`, which begins with `VARIED`; (...) are batch axes of
    its fields."""
    m, lead = arrays.cable_count, change.shape[:-1]
    part = {one.field: change[..., place] for one, place in zip(varied, places(m, varied), strict=True)}
    stretch = np.exp(0.5 * part["inertia"])
    moved = plus(
        arrays,
        frame_anchors=part["frame_anchors"].reshape((*lead, m, 3)),
        platform_anchors=part["platform_anchors"].reshape((*lead, m, 3)),
        length_offset=part["length_offset"],
        mass=part["mass"][..., 0],
        center_of_mass=part["center_of_mass"],
        cell_bias=part["cell_bias"],
        pulley_radius=np.where(arrays.pulley_radius > 0.0, part["pulley_radius"], 0.0),
        **{one.field: part[one.field].reshape((*lead, *one.lengths(m))) for one in varied[len(VARIED) :]},
    )
    relative = {name: np.exp(part[name]) for name in ("axial_stiffness", "linear_density", "cell_gain")}
    return times(moved, **relative, inertia=stretch[..., :, None] * stretch[..., None, :])


def change_between(entered: RobotArrays, arrays: RobotArrays, varied: Sequence[Varied] = VARIED) -> np.ndarray:
    """Changes (n, p) that make one robot of another, its fields with axes (n or 1, 1) before their own.

    What differs from state to state is no change of a robot.
    """
    m = entered.cable_count
    parts = [_change_of(one, entered, arrays) for one in varied]
    count = max(len(part) for part in parts)
    whole = [np.broadcast_to(part, (count, one.count(m))) for one, part in zip(varied, parts, strict=True)]
    return np.concatenate(whole, axis=-1)


def _change_of(one: Varied, entered: RobotArrays, arrays: RobotArrays) -> np.ndarray:
    """(n, c) of one kind of number."""
    before, after = np.asarray(getattr(entered, one.field)), np.asarray(getattr(arrays, one.field))
    axes = 2 if one.field == "inertia" else len(one.shape)
    lead = after.shape[: after.ndim - axes]
    if len(lead) > 1 and lead[-1] > 1:
        return np.zeros((1, one.count(entered.cable_count)))
    core = after.shape[after.ndim - axes :]
    after = after.reshape((-1, *core))
    if one.field == "inertia":
        before, after = (np.diagonal(value, axis1=-2, axis2=-1) for value in (before, after))
    change = np.log(after / before) if one.relative else after - before
    return np.asarray(change.reshape((len(change), -1)))


def tolerance_count(cables: int, wheels: bool = False) -> int:
    """How many independent standard normal numbers describe how far a robot with so many cables is off.

    wheels : with the zeros of encoders on the swivel axes of its pulleys, which change no robot, behind all others
    """
    return change_count(cables) + sum(one.reel for one in VARIED) + (cables if wheels else 0)


def tolerance_factor(tolerances: Tolerances, cables: int) -> np.ndarray:
    """(p, t) changes of the robot per sigma of each independent number: the covariance is its product with itself.

    Behind the numbers of each cable of one reel stands the number common to all.
    """
    blocks = []
    for one in VARIED:
        own = getattr(tolerances, one.tolerance) * np.eye(one.count(cables))
        blocks.append(_HALF * np.hstack([own, own.sum(axis=1, keepdims=True)]) if one.reel else own)
    return np.asarray(block_diag(*blocks))


@dataclass(frozen=True, slots=True, eq=False)
class Spread:
    """Which robots are probable: changes of a robot's numbers are normal.

    root : (p, t) changes per sigma of independent numbers, so that the covariance is root root'
    mean : (p,) what a diagnosis found beside its causes; zero of a robot that nobody measured
    found : what is off beside `VARIED`, behind it among the p numbers
    scatter : sigma of ln f of every natural frequency by itself, besides
    """

    root: np.ndarray
    mean: np.ndarray
    found: tuple[Varied, ...] = ()
    scatter: float = 0.0

    @classmethod
    def within(cls, tolerances: Tolerances, cables: int) -> "Spread":
        """Of a robot that is known to within its tolerances."""
        root = tolerance_factor(tolerances, cables)
        return cls(root, np.zeros(len(root)))

    @property
    def varied(self) -> tuple[Varied, ...]:
        """Kinds of the p numbers."""
        return (*VARIED, *self.found)

    def sigma(self, rates: np.ndarray) -> np.ndarray:
        """(k,) of numbers with rates (p, k)."""
        return np.linalg.norm(rates.T @ self.root, axis=1)

    def scattered(self, logarithm: np.ndarray, seed: int) -> np.ndarray:
        """(n, k) ln f of drawn robots with what each is off by itself, ascending again."""
        if not self.scatter:
            return logarithm
        own = np.random.default_rng(seed).standard_normal(logarithm.shape)
        return np.sort(logarithm + self.scatter * own, axis=1)

    def drawn(self, normal: np.ndarray) -> np.ndarray:
        """(n, p) changes from standard normal numbers (n, t)."""
        return np.asarray(self.mean + normal @ self.root.T)


def tolerated(arrays: RobotArrays, tolerances: Tolerances, u: np.ndarray) -> RobotArrays:
    """The robot whose independent numbers are u (..., t) sigmas off; (...) are batch axes of its fields."""
    own, zeros = np.split(u, [tolerance_count(arrays.cable_count)], axis=-1)
    found = changed(arrays, own @ tolerance_factor(tolerances, arrays.cable_count).T)
    return plus(found, swivel_zero=np.radians(tolerances.swivel_deg) * zeros) if zeros.size else found
