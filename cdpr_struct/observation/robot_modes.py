"""Modes of the robot in measured states, and how their frequencies change with anything they depend on."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableModel, StaticCables, expand_catenaries_at, polynomial_order
from cdpr_struct.dynamics.internal_mass import internal_omega, present
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import RitzModes, ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.errors import CrowdedModesError, UnstableEquilibriumError
from cdpr_struct.observation.cable_fields import fields_of_expansion, massless_fields
from cdpr_struct.observation.dependence import BENDING, TIGHTENED, Dependence
from cdpr_struct.observation.mode_gradient import CableGradient, cable_gradient, whole_gradient
from cdpr_struct.statics.masts import MastShapes

BEYOND = 1.3  # times the highest frequency of the band: from there changes of tens of per cent bring modes into it
PLATFORM_SHARE = 0.02  # of the kinetic energy: modes beyond the band with less in the platform are left out
_SAME = 1e-6  # relative distance below which the split of modes is rounding or symmetry
_HIGHEST_ORDER = 160  # of polynomials where many robots are tried: some 75 modes of one cable in one plane
_STATIC_ORDER = 16  # of Gauss points along massless cables


@dataclass(frozen=True, slots=True, eq=False)
class VibratingModes:
    """Up to M modes of the robot in each of F states, ascending; where `mask` is False there is none, all else is 0.

    log_hertz (F, M) : ln f [Hz];  share (F, M) : of the kinetic energy in the platform, parts that move in it included
    platform (F, M, 6) : motion of the platform in modes of unit modal mass, world axes
    dependence (F, n) : what they depend on, `Dependence.vector`;  gradient (F, n, M) : of ln f by it
    """

    log_hertz: np.ndarray
    share: np.ndarray
    platform: np.ndarray
    mask: np.ndarray
    dependence: np.ndarray
    gradient: np.ndarray
    assembly: Assembly


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
    now = Dependence.of(point, assembly)
    if model == "static":
        inner = len(present(point.arrays))
        shapes = ritz_modes(point, StaticCables(point).expansion(0.0), 6 + inner, assembly).above_zero
        own = _massless_gradient(point, shapes, now.cables)
        limit = np.full_like(limit, np.inf)
    elif model == "exact":
        shapes, own = _catenary_modes(point, float(limit.max()), assembly, now.cables)
    else:
        raise ValueError(f"model must be 'exact' or 'static', got {model!r}")
    gradient = whole_gradient(own, MastShapes.of(point.arrays), shapes, internal_omega(point.arrays))
    kept = (shapes.omega < np.asarray(highest_omega)[:, None]) | (shapes.platform_energy > PLATFORM_SHARE)
    return _collected(shapes, now, gradient, kept & (shapes.omega < limit[:, None]), assembly)


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
        parts = [getattr(one or blank, name) * (one is not None) for one in modes]
        if name == "dependence":
            return np.concatenate(parts)
        axis = 2 if name == "gradient" else 1
        missing = [[(0, (most - part.shape[k]) * (k == axis)) for k in range(part.ndim)] for part in parts]
        return np.concatenate([np.pad(part, width) for part, width in zip(parts, missing, strict=True)])

    arrays = {field.name: stacked(field.name) for field in fields(VibratingModes) if field.name != "assembly"}
    return VibratingModes(**arrays, assembly=blank.assembly)


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
    shapes = ritz_modes(point, expansion, below + _beyond_cables(point), assembly).above_zero
    kept = shapes.omega < highest_omega
    return np.where(kept, np.log(shapes.omega / (2.0 * np.pi)), np.inf), np.where(kept, shapes.platform_energy, 0.0)


def rates(modes: VibratingModes, points: OperatingPoint, steps: np.ndarray) -> np.ndarray:
    """d ln f / d(step) (B, F, M) towards nearby states.

    points : (B, F) operating points after steps (B,), small enough for their cables to change linearly
    """
    change = Dependence.of(points, modes.assembly).vector - modes.dependence
    change = change / np.asarray(steps, dtype=float)[:, None, None]
    return np.moveaxis(np.moveaxis(change, 0, 1) @ modes.gradient, 0, 1)


def _catenary_modes(
    point: OperatingPoint, highest: float, assembly: Assembly, cables: np.ndarray
) -> tuple[RitzModes, CableGradient]:
    """Modes below `highest` [rad/s] and their gradient by the cables (F, m, CABLE_COLUMNS)."""
    smooth = not (point.arrays.bending_stiffness.any() or point.arrays.added_mass.any())
    order = polynomial_order(point, highest, rough=smooth)
    expansion = expand_catenaries_at(point, order)
    if not point.arrays.has_masts:  # the reduction keeps how cables answer the platform, not how they answer masts
        expansion = expansion.reduced(highest)
    below = (expansion.omega_squared < highest**2).sum(axis=(-2, -1)).max()
    shapes = ritz_modes(point, expansion, int(below) + _beyond_cables(point), assembly).above_zero
    shapes = _first(shapes, max(1, int((shapes.omega < highest).sum(axis=-1).max())))
    turn, squared = shapes.platform[..., 3:], shapes.omega**2
    fields = fields_of_expansion(point, order, expansion, shapes.end, shapes.modal, shapes.mast)
    own = cable_gradient(cables, fields, squared, turn)
    if not point.arrays.bending_stiffness.any():
        return shapes, own
    static = fields_of_expansion(point, order, expansion, shapes.end, 0.0 * shapes.modal, shapes.mast).at_rest
    bent = cable_gradient(cables, static, 0.0 * squared, turn)
    return shapes, own.plus(bent, -1.0).plus(_massless_gradient(point, shapes, cables))  # K(0) knows no bending


def _beyond_cables(point: OperatingPoint) -> int:
    """By how many the robot's modes below a frequency exceed those of its clamped cables at most: Wittrick's count."""
    arrays = point.arrays
    return 6 + 3 * arrays.cable_count * int(arrays.has_masts) + len(present(arrays))


def _massless_gradient(point: OperatingPoint, shapes: RitzModes, cables: np.ndarray) -> CableGradient:
    """Of the energy in cables without mass that do not resist bending, at the ends' motion of these modes."""
    frame, local = shapes.expansion.frame, shapes.expansion.static_stiffness
    force = ((frame @ local)[..., None, :, :, :] @ shapes.end[..., None])[..., 0]
    flexible = cables.copy()
    flexible[..., [TIGHTENED, BENDING]] = 1.0, 0.0
    fields = massless_fields(point, _STATIC_ORDER, force)
    found = cable_gradient(flexible, fields, 0.0 * shapes.omega, shapes.platform[..., 3:])
    found.columns[..., [TIGHTENED, BENDING]] = 0.0
    return found


def _first(shapes: RitzModes, count: int) -> RitzModes:
    some = slice(0, count)
    modes = {f: getattr(shapes, f) for f in ("platform", "end", "mast", "modal", "internal")}
    lead = shapes.omega.ndim - 1
    cut = {name: value[(slice(None),) * lead + (some,)] for name, value in modes.items()}
    return replace(shapes, omega=shapes.omega[..., some], **cut)


def _collected(
    shapes: RitzModes, now: Dependence, gradient: np.ndarray, kept: np.ndarray, assembly: Assembly
) -> VibratingModes:
    """Those to be kept, from `gradient` (F, n, k) of omega^2."""
    gradient = _joined(gradient / (2.0 * shapes.omega**2)[..., None, :], shapes.omega)
    rank = np.argsort(~kept, axis=-1, kind="stable")[:, : int(kept.sum(axis=-1).max())]
    mask = np.take_along_axis(kept, rank, axis=-1)

    def chosen(values: np.ndarray, axis: int = -1) -> np.ndarray:
        shape = [1] * values.ndim
        shape[0], shape[axis] = rank.shape
        return np.where(mask.reshape(shape), np.take_along_axis(values, rank.reshape(shape), axis=axis), 0.0)

    log_hertz = np.log(shapes.omega / (2.0 * np.pi))
    return VibratingModes(
        chosen(log_hertz), chosen(shapes.platform_energy), chosen(shapes.platform, -2), mask, now.vector,
        chosen(gradient), assembly,
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
