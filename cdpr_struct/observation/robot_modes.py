"""Modes of the robot in measured states, and how their frequencies change with anything they depend on."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableModel, expand_catenaries_at, polynomial_order
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.errors import CrowdedModesError, UnstableEquilibriumError
from cdpr_struct.observation.dependence import Dependence
from cdpr_struct.observation.expanded_modes import ExpandedModes, beyond_cables
from cdpr_struct.observation.mode_mixing import Mixing

BEYOND = 1.3  # times the highest frequency of the band: from there changes of tens of per cent bring modes into it
PLATFORM_SHARE = 0.02  # of the kinetic energy: modes beyond the band with less in the platform are left out
_SAME = 1e-6  # relative distance below which the split of modes is rounding or symmetry
_HIGHEST_ORDER = 160  # of polynomials where many robots are tried: some 75 modes of one cable in one plane


@dataclass(frozen=True, slots=True, eq=False)
class VibratingModes:
    """Up to M modes of the robot in each of F states, ascending; where `mask` is False there is none, all else is 0.

    log_hertz (F, M) : ln f [Hz];  share (F, M) : of the kinetic energy in the platform, parts that move in it included
    platform (F, M, 6) : motion of the platform in modes of unit modal mass, world axes
    dependence (F, n) : what they depend on, `Dependence.vector`;  gradient (F, n, M) : of ln f by it
    mass (F, 6, 6) : of the platform, world axes
    mixing : how their shapes change, of all states together or of each, None where a state has no modes
    """

    log_hertz: np.ndarray
    share: np.ndarray
    platform: np.ndarray
    mask: np.ndarray
    dependence: np.ndarray
    gradient: np.ndarray
    mass: np.ndarray
    assembly: Assembly
    mixing: tuple[Mixing | None, ...]

    def motion_rates(self, index: np.ndarray) -> np.ndarray:
        """(F, n, q, 6) change of `platform` of modes (F, q) by `dependence`; zero in a state that has no modes."""
        if len(self.mixing) == 1 and self.mixing[0] is not None:
            return self.mixing[0].rates(index)
        blank = np.zeros((1, self.dependence.shape[1], index.shape[1], 6))
        parts = [
            blank if one is None else one.rates(np.minimum(own, one.kept.shape[1] - 1)[None])
            for one, own in zip(self.mixing, index, strict=True)
        ]
        return np.concatenate(parts)


def modes_at(
    point: OperatingPoint, highest_omega: np.ndarray, assembly: Assembly = "consistent", model: CableModel = "exact"
) -> VibratingModes:
    """Modes in states (F,): all below highest_omega (F,) [rad/s], and beyond, up to `BEYOND` times that, those that
    move the platform.

    Modes within `_SAME` of each other share one gradient, that of their mean: how they split is left out.

    Raises
    ------
    UnstableEquilibriumError : a state is unstable.
    ValueError : the model is neither "exact" nor "static".
    """
    limit = BEYOND * np.asarray(highest_omega, dtype=float)
    found = ExpandedModes.at(point, float(limit.max()), assembly, model)
    shapes = found.shapes
    kept = (shapes.omega < np.asarray(highest_omega)[:, None]) | (shapes.platform_energy > PLATFORM_SHARE)
    within = model == "static" or shapes.omega < limit[:, None]
    return _collected(found, found.gradient(), kept & within, assembly)


def of_states_apart(modes: Sequence[VibratingModes | None]) -> VibratingModes:
    """Modes of several states from those of each alone; None for a state that has none.

    Raises
    ------
    UnstableEquilibriumError : no state has any.
    """
    known = [one for one in modes if one is not None]
    if not known:
        raise UnstableEquilibriumError(
            "the equilibrium is unstable in every state where robot frequencies were measured"
        )
    most, blank = max(one.mask.shape[1] for one in known), known[0]

    def stacked(name: str) -> np.ndarray:
        """Along states, padded along modes."""
        parts = [getattr(one or blank, name) * (one is not None or name == "mass") for one in modes]
        if name in ("dependence", "mass"):
            return np.concatenate(parts)
        axis = 2 if name == "gradient" else 1
        missing = [[(0, (most - part.shape[k]) * (k == axis)) for k in range(part.ndim)] for part in parts]
        return np.concatenate([np.pad(part, width) for part, width in zip(parts, missing, strict=True)])

    names = [field.name for field in fields(VibratingModes) if field.name not in ("assembly", "mixing")]
    mixing = tuple(None if one is None else one.mixing[0] for one in modes)
    return VibratingModes(**{name: stacked(name) for name in names}, assembly=blank.assembly, mixing=mixing)


def frequencies_at(
    point: OperatingPoint, highest_omega: float, assembly: Assembly = "consistent"
) -> tuple[np.ndarray, np.ndarray]:
    """ln f [Hz] and share of the kinetic energy as in `VibratingModes`, both (..., M), of the modes below highest_omega
    [rad/s] in states (...) of exact catenaries; to six digits, without their gradients. Beyond them f is infinite.

    Raises
    ------
    CrowdedModesError : a cable has more modes below highest_omega than polynomials of `_HIGHEST_ORDER` can tell apart.
    UnstableEquilibriumError : a state is unstable.
    """
    order = polynomial_order(point, highest_omega, rough=True)
    if order > _HIGHEST_ORDER:
        raise CrowdedModesError(f"a cable has some {order // 2} modes below {highest_omega / (2.0 * np.pi):.4g} Hz")
    expansion = expand_catenaries_at(point, order).reduced(highest_omega)
    below = int((expansion.omega_squared < highest_omega**2).sum(axis=(-2, -1)).max())
    shapes = ritz_modes(point, expansion, below + beyond_cables(point), assembly).above_zero
    kept = shapes.omega < highest_omega
    return np.where(kept, np.log(shapes.omega / (2.0 * np.pi)), np.inf), np.where(kept, shapes.platform_energy, 0.0)


def changes_of(modes: VibratingModes, points: OperatingPoint) -> np.ndarray:
    """(B, F, n) change of what modes depend on towards nearby states (B, F)."""
    return np.asarray(Dependence.of(points, modes.assembly).vector - modes.dependence)


def log_changes(modes: VibratingModes, change: np.ndarray) -> np.ndarray:
    """(B, F, M) changes of ln f by small changes (B, F, n) of what modes depend on."""
    return np.moveaxis(np.moveaxis(change, 0, 1) @ modes.gradient, 0, 1)


def _collected(found: ExpandedModes, gradient: np.ndarray, kept: np.ndarray, assembly: Assembly) -> VibratingModes:
    """Those to be kept, from `gradient` (F, n, k) of omega^2."""
    shapes = found.shapes
    gradient = _joined(gradient / (2.0 * shapes.omega**2)[..., None, :], shapes.omega)
    rank = np.argsort(~kept, axis=-1, kind="stable")[:, : int(kept.sum(axis=-1).max())]
    mask = np.take_along_axis(kept, rank, axis=-1)

    def chosen(values: np.ndarray, axis: int = -1) -> np.ndarray:
        shape = [1] * values.ndim
        shape[0], shape[axis] = rank.shape
        return np.where(mask.reshape(shape), np.take_along_axis(values, rank.reshape(shape), axis=axis), 0.0)

    log_hertz = np.log(shapes.omega / (2.0 * np.pi))
    mass = np.broadcast_to(shapes.platform_mass, (len(mask), 6, 6))
    return VibratingModes(
        chosen(log_hertz), chosen(shapes.platform_energy), chosen(shapes.platform, -2), mask, found.dependence.vector,
        chosen(gradient), mass, assembly, (Mixing(found, rank),),
    )  # fmt: skip


def _joined(gradient: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """Gradient (F, n, k) with the mean of each group of modes in place of theirs."""
    near = np.diff(omega, axis=-1) <= _SAME * omega[..., 1:]
    if not near.any():
        return gradient
    first = np.zeros((*omega.shape[:-1], 1), dtype=int)
    group = np.concatenate([first, np.cumsum(~near, axis=-1)], axis=-1)
    together = (group[..., :, None] == group[..., None, :]).astype(float)
    return np.asarray(gradient @ (together / together.sum(axis=-2, keepdims=True)))
