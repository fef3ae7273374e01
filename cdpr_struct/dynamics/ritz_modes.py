"""The robot's modes as an ordinary eigenproblem: platform motion, the clamped cables' modal coordinates, and motions of
parts inside the platform."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.dynamics.internal_mass import PARTS, internal_coupling, internal_squared, part_masses, present
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    Assembly,
    assemble,
    attachment,
    platform_mass_matrix,
    stability_at,
)
from cdpr_struct.errors import UnstableEquilibriumError
from cdpr_struct.statics.masts import MastShapes


@dataclass(frozen=True, slots=True, eq=False)
class RitzModes:
    """The first k undamped modes of unit modal mass that an expansion of the cables spans, at a batch (...) of poses.

    omega         : (..., k) ascending [rad/s], upper bounds of the model's; zero for neutral freedoms
    platform      : (..., k, 6) motion of the platform origin and rotation, world axes
    end           : (..., k, m, 3) motion of the cables' platform ends against their masts, local axes of `expansion`
    mast          : (..., k, m, 3) motion of the cables' masts, local axes; zero where masts stand still
    modal         : (..., k, m, p) coordinates of the clamped cables' modes
    internal      : (..., k, PARTS) motions of parts against the platform, times the root of their mass; zero without
    platform_mass : (..., 6, 6) world axes;  internal_coupling : (..., 6, PARTS) see `internal_mass`
    to_cable      : (..., m, 3, 6) platform motion to `end`
    """

    omega: np.ndarray
    platform: np.ndarray
    end: np.ndarray
    mast: np.ndarray
    modal: np.ndarray
    internal: np.ndarray
    platform_mass: np.ndarray
    internal_coupling: np.ndarray
    to_cable: np.ndarray
    expansion: ModalExpansion

    @property
    def above_zero(self) -> "RitzModes":
        """Without neutral freedoms; of a batch, without as many first modes as any of it has of these."""
        first = int((self.omega == 0.0).sum(axis=-1).max(initial=0))
        return self.modes(slice(first, None)) if first else self

    def modes(self, index: slice | np.ndarray) -> "RitzModes":
        """Some modes, or all of them in another order."""
        own = {name: getattr(self, name)[..., index, :] for name in ("platform", "internal")}
        own["omega"] = self.omega[..., index]
        own |= {name: getattr(self, name)[..., index, :, :] for name in ("end", "mast", "modal")}
        return replace(self, **own)

    @property
    def platform_energy(self) -> np.ndarray:
        """(..., k) share of the kinetic energy in the platform, parts that move in it included [-]."""
        moved, mass = self.platform, self.platform_mass
        rigid = np.einsum("...ki,...ij,...kj->...k", moved, mass, moved, optimize=True)
        carried = moved @ self.internal_coupling
        return np.asarray(rigid + ((2.0 * carried + self.internal) * self.internal).sum(axis=-1))

    @property
    def cable_energy(self) -> np.ndarray:
        """(..., k, m) shares of the kinetic energy [-]."""
        return self.expansion.kinetic_energy(self.end, self.modal, self.mast)

    def kinds(self) -> list[str]:
        """At one pose, per mode "platform", "cable i", "cables" or "mixed", by where the kinetic energy sits."""
        return [kind_of_mode(p, c) for p, c in zip(self.platform_energy, self.cable_energy, strict=True)]

    def cable_motion(self, stations: np.ndarray) -> np.ndarray:
        """(..., k, m, s, 3) motion at fractions (s,) of each cable from the frame, world axes."""
        return self.expansion.motion(stations, self.end, self.modal, self.mast)


def ritz_modes(
    point: OperatingPoint, expansion: ModalExpansion, count: int, assembly: Assembly = "consistent"
) -> RitzModes:
    """First `count` modes (or as many as the expansion has).

    Solved for 1 / omega^2 in coordinates in which the stiffness is the unit matrix: the fastest modes lie many decades
    above the slowest, and so rounding falls on the fast ones.

    Raises
    ------
    UnstableEquilibriumError : the platform's stiffness at rest is not positive.
    """
    ends, masts = _with_masts(point)
    to_cable, to_mast = (np.swapaxes(expansion.frame, -1, -2) @ motion for motion in (ends, masts))
    platform_mass = platform_mass_matrix(point.arrays, point.rotation)
    turn, stretch, neutral = _unit_stiffness(point, expansion, ends, assembly)
    n = ends.shape[-1]
    mass = _mass(expansion, to_cable, to_mast, platform_mass)
    mass[..., :n, :] = np.swapaxes(turn, -1, -2) @ mass[..., :n, :]
    mass[..., :, :n] = mass[..., :, :n] @ turn
    mass[..., n:, :] *= stretch[..., :, None]
    mass[..., :, n:] *= stretch[..., None, :]
    coupling, slow = _internal(point, mass.shape[:-2])
    if slow.size:
        mass = _with_internal(mass, turn, coupling[..., present(point.arrays)], slow)
    count = min(count, mass.shape[-1] - int(point.arrays.guided.sum(axis=-1).max()))
    omega, vectors = _modes(mass, count) if neutral is None else _beside_neutral(mass, neutral, count)
    moved = np.swapaxes(turn @ vectors[..., :n, :], -1, -2)
    inner = n + stretch.shape[-1]
    modal = np.swapaxes(stretch[..., None] * vectors[..., n:inner, :], -1, -2)
    internal = np.zeros((*omega.shape, PARTS))
    internal[..., present(point.arrays)] = np.swapaxes(slow[..., None] * vectors[..., inner:, :], -1, -2)
    modal = modal.reshape((*omega.shape, *expansion.omega_squared.shape[-2:]))
    end, mast = (np.einsum("...mai,...ki->...kma", motion, moved) for motion in (to_cable, to_mast))
    return RitzModes(
        omega, moved[..., :6], end, mast, modal, internal, platform_mass, coupling, to_cable[..., :6], expansion
    )


def _modes(mass: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """omega (..., k) and coordinates (..., n, k) at unit modal mass, of first modes where the stiffness is one."""
    periods, vectors = np.linalg.eigh(mass)
    periods = np.maximum(periods[..., : -count - 1 : -1], np.finfo(float).tiny)
    omega = 1.0 / np.sqrt(periods)
    return omega, vectors[..., : -count - 1 : -1] * omega[..., None, :]


def _beside_neutral(mass: np.ndarray, neutral: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The same with neutral freedoms (..., j, q) among the first coordinates, at omega zero.

    Without them the mass matrix is M - M n n' M, n of unit modal mass: its modes, made orthogonal to n,
    are the robot's.
    Where some of a batch have fewer, the columns left over are zero; they sort last.
    """
    there = (neutral != 0.0).any(axis=-2)
    moved = np.zeros((*mass.shape[:-1], neutral.shape[-1]))
    moved[..., : neutral.shape[-2], :] = neutral
    own = np.swapaxes(moved, -1, -2) @ mass @ moved
    own[..., range(own.shape[-1]), range(own.shape[-1])] += np.where(there, 0.0, 1.0)
    moved = moved @ np.swapaxes(np.linalg.inv(np.linalg.cholesky(own)), -1, -2)
    carried = mass @ moved
    omega, vectors = _modes(mass - carried @ np.swapaxes(carried, -1, -2), count)
    vectors = vectors - moved @ (np.swapaxes(carried, -1, -2) @ vectors)
    omega = np.concatenate([np.where(there, 0.0, np.inf), omega], axis=-1)
    order = np.argsort(omega, axis=-1, kind="stable")[..., :count]
    both = np.concatenate([moved, vectors], axis=-1)
    return np.take_along_axis(omega, order, axis=-1), np.take_along_axis(both, order[..., None, :], axis=-1)


def _internal(point: OperatingPoint, lead: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Coupling (..., 6, PARTS) of moving parts, and 1 / omega_k (..., q) of those that any robot of a batch has.

    Where others have none, 1 / omega_k is zero: a mode of infinite frequency.
    """
    robot = point.arrays
    coupling = np.broadcast_to(internal_coupling(robot, point.rotation), (*lead, 6, PARTS))
    squared = internal_squared(robot)
    there = (part_masses(robot) > 0.0) & (squared > 0.0)
    slow = np.where(there, 1.0, 0.0) / np.sqrt(np.where(there, squared, 1.0))
    return coupling, slow[..., present(robot)]


def _with_internal(mass: np.ndarray, turn: np.ndarray, coupling: np.ndarray, slow: np.ndarray) -> np.ndarray:
    """The mass matrix with a row and a column for each moving part, in coordinates of unit stiffness."""
    n, count = turn.shape[-1], mass.shape[-1]
    whole = count + slow.shape[-1]
    wide = np.zeros((*mass.shape[:-2], whole, whole))
    wide[..., :count, :count] = mass
    columns = np.swapaxes(turn[..., :6, :], -1, -2) @ coupling * slow[..., None, :]
    wide[..., :n, count:], wide[..., count:, :n] = columns, np.swapaxes(columns, -1, -2)
    wide[..., range(count, whole), range(count, whole)] = slow**2
    return wide


def _with_masts(point: OperatingPoint) -> tuple[np.ndarray, np.ndarray]:
    """Motion (..., m, 3, n) of the cable ends against their masts, and of these, per motion of platform and masts.

    That of a mast counts in units of the root of its compliance: its own stiffness is one, even if it is rigid.
    """
    ends = attachment(point)
    if not point.arrays.has_masts:
        return ends, np.zeros_like(ends)
    scaled = MastShapes.soft(point.arrays).scaled
    own = np.broadcast_to(scaled, (*ends.shape[:-1], scaled.shape[-1]))
    return np.concatenate([ends, -own], axis=-1), np.concatenate([np.zeros_like(ends), own], axis=-1)


def _unit_stiffness(
    point: OperatingPoint, expansion: ModalExpansion, ends: np.ndarray, assembly: Assembly
) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Coordinates of unit stiffness: motion of platform and masts (..., n, n) and modal coordinates (..., m p).

    Neutral freedoms are given a stiffness; their motions in these coordinates (..., n, q) come last, None without any.
    """
    held = stability_at(point, assembly)
    cables = expansion.frame @ expansion.static_stiffness @ np.swapaxes(expansion.frame, -1, -2)
    n = ends.shape[-1]
    stiffness = assemble(point, np.zeros_like(cables) if n > 6 else cables, assembly)
    if n > 6:
        body, stiffness = stiffness, np.einsum("...mai,...mab,...mbj->...ij", ends, cables, ends, optimize=True)
        stiffness[..., :6, :6] += body
        stiffness[..., range(6, n), range(6, n)] += 1.0
    own = _with_masts_of(stiffness, held.twists)
    stiffness[..., :6, :6] += held.holding
    try:
        if held.unstable.any():
            raise np.linalg.LinAlgError
        lower = np.linalg.cholesky(stiffness)
    except np.linalg.LinAlgError as error:
        reason = "the equilibrium is unstable: the platform's stiffness has a negative eigenvalue"
        raise UnstableEquilibriumError(reason) from error
    squared = expansion.omega_squared
    turn, stretch = np.swapaxes(np.linalg.inv(lower), -1, -2), 1.0 / np.sqrt(squared.reshape((*squared.shape[:-2], -1)))
    return turn, stretch, np.swapaxes(lower, -1, -2) @ own if own.shape[-1] else None


def _with_masts_of(stiffness: np.ndarray, twists: np.ndarray) -> np.ndarray:
    """(..., n, q) motions of platform and masts where the platform moves by twists (..., 6, q) and masts follow."""
    masts = -np.linalg.solve(stiffness[..., 6:, 6:], stiffness[..., 6:, :6] @ twists)
    return np.concatenate([np.broadcast_to(twists, (*masts.shape[:-2], *twists.shape[-2:])), masts], axis=-2)


def _mass(
    expansion: ModalExpansion, to_cable: np.ndarray, to_mast: np.ndarray, platform_mass: np.ndarray
) -> np.ndarray:
    batch, modal_count = expansion.omega_squared.shape[:-2], np.prod(expansion.omega_squared.shape[-2:], dtype=int)
    n = to_cable.shape[-1]
    mass = np.zeros((*batch, n + modal_count, n + modal_count))
    mass[..., np.arange(n, n + modal_count), np.arange(n, n + modal_count)] = 1.0
    mass[..., :n, :n] = np.einsum("...mai,...mab,...mbj->...ij", to_cable, expansion.end_mass, to_cable, optimize=True)
    mass[..., :6, :6] += platform_mass
    modal = expansion.coupling @ to_cable
    if n > 6:
        with_ends = np.swapaxes(to_cable, -1, -2) @ expansion.rigid_end @ to_mast
        own = np.swapaxes(to_mast, -1, -2) @ expansion.rigid_mass @ to_mast
        mass[..., :n, :n] += (with_ends + np.swapaxes(with_ends, -1, -2) + own).sum(axis=-3)
        modal = modal + expansion.rigid_modes @ to_mast
    mass[..., n:, :n] = modal.reshape((*batch, modal_count, n))
    mass[..., :n, n:] = np.swapaxes(mass[..., n:, :n], -1, -2)
    return mass


def kind_of_mode(platform: float, cables: np.ndarray) -> str:
    """ "platform" or "cable i" if it holds half of the kinetic energy, else "cables" (nine tenths) or "mixed"."""
    if platform >= 0.5:
        return "platform"
    if cables.max() >= 0.5:
        return f"cable {int(cables.argmax()) + 1}"
    return "cables" if platform < 0.1 else "mixed"
