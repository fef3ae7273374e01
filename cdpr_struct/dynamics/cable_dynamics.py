"""The cable models of the robot's dynamics behind one interface, chosen by name.

static : massless cables with the catenary's tangent stiffness (K_static of the thesis)
dsm    : the thesis's closed form for taut cables with a small sag (eqs 2.31-2.46)
exact  : the linearised elastic catenary itself, any sag and inclination
"""

from dataclasses import dataclass, fields, replace
from typing import Literal, Protocol, get_args

import numpy as np

from cdpr_struct.dynamics.catenary_expansion import CableExtras, FrameEnds, expand_catenaries
from cdpr_struct.dynamics.clamped_cable import clamped_count
from cdpr_struct.dynamics.frame_give import frame_give
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.taut_cable_expansion import expand_taut_cables
from cdpr_struct.dynamics.taut_cables import TautCables, closed_form_stiffness, taut_cables
from cdpr_struct.generated.cable_dsm import damped_omega_squared
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import VECTORS, CableStates

CableModel = Literal["static", "dsm", "exact"]
CABLE_MODELS: tuple[CableModel, ...] = get_args(CableModel)
_MAST_MODES = 4.0  # pairs of modes a half wave below the frequency, in the series of moving masts
_TAUT = 0.2  # w L / T below which tension and tangent vary so little that fewer polynomials have the same digits
_EXTRAS = ("bending_stiffness", "bending_fixity", "added_mass", "added_mass_place")
_FEWEST, _FEW, _MANY, _KINKED = (6.0, 10.0), (10.0, 14.0), (16.0, 22.0), (24.0, 32.0)  # beyond the half waves, at least


class CableDynamics(Protocol):
    """How the cables of a robot at rest answer a harmonic motion of their platform ends."""

    @property
    def first_frequency(self) -> np.ndarray:
        """(m,) lowest natural frequency of each clamped cable [rad/s], to which damping ratios refer."""

    def stiffness(self, omega_squared: np.ndarray) -> np.ndarray:
        """(..., m, 3, 3) world [N/m]; omega_squared broadcasts against (..., m), complex where damped."""

    def mast_stiffness(self, omega_squared: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What the cables' inertia adds if their masts move too, as in `ModalExpansion.mast_stiffness`."""

    def clamped_count(self, omega: np.ndarray) -> np.ndarray:
        """(..., m) natural frequencies of each clamped cable below omega [rad/s]; omega broadcasts against it."""

    def expansion(self, omega: float) -> ModalExpansion:
        """Static shapes and clamped modes that resolve the cables' motion up to omega [rad/s]."""


def cable_dynamics(
    point: OperatingPoint, model: CableModel, highest_omega: float = 0.0, rough: bool = False
) -> CableDynamics:
    """The named cable model at one operating point.

    highest_omega : [rad/s] up to which "exact" is to be accurate to about ten digits (0: its first dozen modes)
    rough : seven digits do, at a fraction of the work
    """
    if model == "static":
        return StaticCables(point)
    if model == "dsm":
        return ClosedFormCables(taut_cables(point), point.arrays)
    return CatenaryCables(expand_catenaries_at(point, polynomial_order(point, highest_omega, rough)))


def polynomial_order(point: OperatingPoint, highest_omega: float, rough: bool = False) -> int:
    """Order of the polynomials with which "exact" is as accurate as `cable_dynamics` says."""
    half_waves = highest_omega / _first_frequency(point).min()
    kinks = point.arrays.bending_stiffness.any() or point.arrays.added_mass.any()  # at clamped ends, at the mass
    taut = not kinks and (point.cables.whole_weight < _TAUT * point.cables.tension).all()
    fine = _KINKED if kinks else _FEW if taut else _MANY
    spare, least = (_FEWEST if taut else _FEW) if rough else fine
    return int(np.clip(2.0 * half_waves + spare, least, 400.0))


def expand_catenaries_at(point: OperatingPoint, order: int) -> ModalExpansion:
    """Modal expansion (..., m) of the exact catenaries at a batch (...) of poses, pulleys included."""
    cables, robot = point.cables, point.arrays
    shape = cables.length.shape
    stiffness = point.end_stiffness.reshape(-1, 3, 3)
    density = np.broadcast_to(robot.linear_density, shape).reshape(-1)
    k = robot.lump_mass.shape[-1:]
    bodies = {name: np.broadcast_to(getattr(robot, name), shape).reshape(-1) for name in _EXTRAS}
    extras = CableExtras(**bodies, lump_mass=np.broadcast_to(robot.lump_mass, shape + k).reshape((-1, *k)))
    flat = flattened(cables)
    found = expand_catenaries(flat, density, order, stiffness, frame_ends(point), extras).reshaped(shape)
    return with_mast_mass(found, robot)


def with_mast_mass(expansion: ModalExpansion, robot: RobotArrays) -> ModalExpansion:
    """Cables that carry what moves with their exits on their masts: it moves as they do when moved as a whole."""
    if not robot.mast_mass.any():
        return expansion
    return replace(expansion, rigid_mass=expansion.rigid_mass + _heads(robot))


def _heads(robot: RobotArrays) -> np.ndarray:
    """(..., m, 3, 3) mass of what moves with the cables' exits on their masts [kg]."""
    return np.asarray(robot.mast_mass[..., None, None] * np.eye(3))


def flattened(cables: CableStates) -> CableStates:
    """The same cables with the batch of poses and m in one axis."""
    shape = cables.length.shape

    def flat(value: np.ndarray, own: int) -> np.ndarray:
        core = value.shape[value.ndim - own :]
        return np.broadcast_to(value, shape + core).reshape((-1, *core))

    return CableStates(**{f.name: flat(getattr(cables, f.name), int(f.name in VECTORS)) for f in fields(cables)})


def damped(cables: CableDynamics, damping_ratio: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """omega_c^2 (..., m) of viscously damped cables at omega (..., 1) [rad/s].

    omega_c^2 = omega^2 - 2 i xi omega_1 omega, xi referred to the cable's first natural frequency omega_1.
    """
    return damped_omega_squared(omega, damping_ratio, cables.first_frequency)


def _first_frequency(point: OperatingPoint) -> np.ndarray:
    cables = point.cables
    return np.pi / cables.chord * np.sqrt(cables.tension / point.arrays.linear_density)


def frame_ends(point: OperatingPoint) -> FrameEnds | None:
    """The frame ends of all cables as springs; None where all are fixed points."""
    give = frame_give(point)
    if give is None:
        return None
    q = give.compliance.shape[-1]
    return FrameEnds(give.directions.reshape(-1, 3, q), give.stiffness.reshape(-1, q))


@dataclass(frozen=True, slots=True, eq=False)
class StaticCables:
    """Massless cables."""

    point: OperatingPoint

    @property
    def first_frequency(self) -> np.ndarray:
        """Infinite: nothing can vibrate."""
        return np.full(self.point.arrays.cable_count, np.inf)

    def stiffness(self, omega_squared: np.ndarray) -> np.ndarray:
        static = self._ends
        return np.broadcast_to(static, (*np.shape(omega_squared)[:-1], *static.shape))

    def mast_stiffness(self, omega_squared: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        none = np.zeros((*np.shape(omega_squared)[:-1], *self._ends.shape))
        return none, none - np.asarray(omega_squared)[..., None, None] * _heads(self.point.arrays)

    def clamped_count(self, omega: np.ndarray) -> np.ndarray:
        return np.zeros((*np.shape(omega)[:-1], self.point.arrays.cable_count), dtype=int)

    def expansion(self, omega: float) -> ModalExpansion:
        ends = self._ends
        cables = ends.shape[:-2]

        def shapes(stations: np.ndarray, derivative: int = 0) -> tuple[np.ndarray, np.ndarray]:
            share = (stations, np.ones_like(stations), np.zeros_like(stations))[derivative]
            straight = np.broadcast_to(share[:, None, None] * np.eye(3), (*cables, len(stations), 3, 3))
            return straight, np.zeros((*cables, 0, len(stations), 3))

        world = np.broadcast_to(np.eye(3), ends.shape)
        none, modes = np.zeros(ends.shape), np.zeros((*cables, 0, 3))
        found = ModalExpansion(world, ends, none, np.zeros((*cables, 0)), modes, none, none, modes, shapes)
        return with_mast_mass(found, self.point.arrays)

    @property
    def _ends(self) -> np.ndarray:
        return self.point.end_stiffness


@dataclass(frozen=True, slots=True, eq=False)
class ClosedFormCables:
    """The thesis's DSM; masts are those of a robot."""

    cables: TautCables
    robot: RobotArrays

    @property
    def first_frequency(self) -> np.ndarray:
        return np.pi * self.cables.frequency_scale

    def stiffness(self, omega_squared: np.ndarray) -> np.ndarray:
        return closed_form_stiffness(self.cables, omega_squared)

    def mast_stiffness(self, omega_squared: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """From the modal series, which converges with the fourth power of the number of modes."""
        highest = float(np.sqrt(np.abs(omega_squared).max()))
        half_waves = _MAST_MODES * (1.0 + highest / self.first_frequency.min())
        full = expand_taut_cables(self.cables.flattened(), int(np.ceil(half_waves)))
        return with_mast_mass(full.reshaped(self.cables.chord.shape), self.robot).mast_stiffness(omega_squared)

    def clamped_count(self, omega: np.ndarray) -> np.ndarray:
        return clamped_count(self.cables, omega)

    def expansion(self, omega: float) -> ModalExpansion:
        half_waves = omega / self.first_frequency.min()
        full = expand_taut_cables(self.cables.flattened(), int(np.ceil(0.5 * half_waves)) + 6)
        found = full.ascending().reduced(omega).reshaped(self.cables.chord.shape)
        return with_mast_mass(found, self.robot)


@dataclass(frozen=True, slots=True, eq=False)
class CatenaryCables:
    """The linearised elastic catenary."""

    full: ModalExpansion

    @property
    def first_frequency(self) -> np.ndarray:
        return np.sqrt(self.full.omega_squared[..., 0])

    def stiffness(self, omega_squared: np.ndarray) -> np.ndarray:
        return self.full.stiffness(omega_squared)

    def mast_stiffness(self, omega_squared: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self.full.mast_stiffness(omega_squared)

    def clamped_count(self, omega: np.ndarray) -> np.ndarray:
        return (self.full.omega_squared < np.asarray(omega)[..., None] ** 2).sum(axis=-1)

    def expansion(self, omega: float) -> ModalExpansion:
        return self.full.reduced(omega)
