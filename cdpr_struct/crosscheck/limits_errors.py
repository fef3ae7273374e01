"""How far the closed form is from the catenary, per quantity and frequency."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.crosscheck.limits_closed_form import closed_form_planes, closed_form_stiffness
from cdpr_struct.crosscheck.limits_groups import CableGroups
from cdpr_struct.crosscheck.limits_reference import CablePlanes, Effects, reference_planes

IN_PLANE_MODES = 6
ACROSS_MODES = 3
MASS_RATIOS = (1.0, 3.0, 10.0, 30.0, 100.0)
BANDS, PER_BAND = 6, 5
_SIZES = np.array([0.0003, 0.001, 0.002, 0.003, 0.004, 0.006, 0.008, 0.01, 0.013, 0.017, 0.023, 0.03, 0.04, 0.06, 0.1])
_SHIFTS = np.concatenate([-_SIZES[::-1], [0.0], _SIZES])
QUANTITIES = ("in_plane_frequency", "across_frequency", "mode_shape", "end_stiffness", "end_mass_frequency")


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """Errors (n, k) of one quantity at n cables and k samples each, and where along the frequency axis they are.

    error     : relative error, or 1 - MAC for mode shapes [-]
    frequency : (n, k) Omega of the reference
    mass_ratio : (k,) end mass over cable mass, nan where there is none
    end : (k,) 0 the upper end moves, 1 the lower, -1 none
    label : (k,) what the sample is
    """

    quantity: str
    error: np.ndarray
    frequency: np.ndarray
    mass_ratio: np.ndarray
    end: np.ndarray
    label: tuple[str, ...]


def measure(groups: CableGroups, effects: Effects | None = None) -> dict[str, Samples]:
    """Errors of the closed form against the catenary, or against it without some effects."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    stations = 0.5 * (nodes + 1.0)
    reference, model = reference_planes(groups, stations, effects), closed_form_planes(groups, stations)
    found = (
        _clamped("in_plane_frequency", reference.in_plane.frequencies, model.in_plane.frequencies, IN_PLANE_MODES),
        _clamped("across_frequency", reference.across.frequencies, model.across.frequencies, ACROSS_MODES),
        _shapes(reference, model, weights),
        _stiffness(groups, reference, model),
        _loaded(reference, model),
    )
    return {samples.quantity: samples for samples in found}


def _clamped(quantity: str, reference: np.ndarray, model: np.ndarray, count: int) -> Samples:
    labels = tuple(f"mode {k + 1}" for k in range(count))
    error = np.abs(model[:, :count] / reference[:, :count] - 1.0)
    return Samples(quantity, error, reference[:, :count], np.full(count, np.nan), np.full(count, -1), labels)


def _shapes(reference: CablePlanes, model: CablePlanes, weights: np.ndarray) -> Samples:
    """1 - MAC of the motion across the chord; each reference mode against its best partner."""
    ours = reference.in_plane.modes[:, :IN_PLANE_MODES, :, 1]
    theirs = model.in_plane.modes[:, : IN_PLANE_MODES + 3, :, 1]
    cross = np.einsum("nps,nqs,s->npq", ours, theirs, weights, optimize=True) ** 2
    norms = [np.einsum("nps,s->np", shape**2, weights) for shape in (ours, theirs)]
    assurance = (cross / (norms[0][:, :, None] * norms[1][:, None, :])).max(axis=-1)
    labels = tuple(f"mode {k + 1}" for k in range(IN_PLANE_MODES))
    none = np.full(IN_PLANE_MODES, np.nan)
    frequency = reference.in_plane.frequencies[:, :IN_PLANE_MODES]
    return Samples("mode_shape", 1.0 - assurance, frequency, none, np.full(IN_PLANE_MODES, -1), labels)


def _stiffness(groups: CableGroups, reference: CablePlanes, model: CablePlanes) -> Samples:
    """Smallest eta such that model and reference agree after changing frequency and stiffness by eta each.

    Stiffness is scaled by the static one, so that eta is a change of energy, and taken over the larger of dynamic and
    static stiffness. The frequency may give way too, or a pole off by next to nothing would be an infinite error. The
    band up to the sixth mode is cut into six, and the median of each counts: a narrow resonance that the closed form
    lacks is seen in mode shapes and in the frequencies of an end mass.
    """
    count = BANDS * PER_BAND
    highest = model.in_plane.frequencies[:, IN_PLANE_MODES - 1 : IN_PLANE_MODES]
    frequency = highest * (np.arange(count) + 0.5) / count
    scale = 1.0 / np.sqrt(np.diagonal(model.in_plane.static[:, 0], axis1=1, axis2=2))
    scaling = (scale[:, :, None] * scale[:, None, :])[:, None, None]
    true = reference.in_plane.stiffness(frequency) * scaling
    side = reference.across.stiffness(frequency)[..., 0, 0]
    size, side_size = np.maximum(_largest(true), 1.0), np.maximum(np.abs(side), 1.0)
    best = np.full((2, *side.shape), np.inf)
    for shift in _SHIFTS:
        in_plane, across = closed_form_stiffness(groups, frequency * (1.0 + shift))
        error = np.stack(
            [_largest(in_plane[:, None] * scaling - true) / size, np.abs(across[:, None] - side) / side_size]
        )
        best = np.minimum(best, np.maximum(error, abs(shift)))
    error = np.median(best.max(axis=0).reshape(len(groups), 2, BANDS, PER_BAND), axis=-1)
    middle = frequency.reshape(len(groups), BANDS, PER_BAND)[..., PER_BAND // 2]
    return Samples(
        "end_stiffness",
        error.reshape(len(groups), -1),
        np.tile(middle, (1, 2)),
        np.full(2 * BANDS, np.nan),
        np.repeat([0, 1], BANDS),
        tuple(f"{end} end, band {k + 1} of {BANDS}" for end in ("upper", "lower") for k in range(BANDS)),
    )


def _largest(matrix: np.ndarray) -> np.ndarray:
    """Largest eigenvalue in size of symmetric matrices (..., 2, 2)."""
    a, b, d = matrix[..., 0, 0], matrix[..., 0, 1], matrix[..., 1, 1]
    return 0.5 * np.abs(a + d) + np.hypot(0.5 * (a - d), b)


def _loaded(reference: CablePlanes, model: CablePlanes) -> Samples:
    """Frequencies of a point mass at the moving end, held in place by a constant force."""
    ratios = np.array(MASS_RATIOS)
    errors, frequencies, names = [], [], []
    for name, count in (("in_plane", IN_PLANE_MODES), ("across", ACROSS_MODES)):
        true = getattr(reference, name).loaded_frequencies(ratios, count)
        errors.append(np.abs(getattr(model, name).loaded_frequencies(ratios, count) / true - 1.0))
        frequencies.append(true)
        names += [f"{name.replace('_', '-')} mode {k + 1}" for k in range(count)]
    error, frequency = np.concatenate(errors, axis=-1), np.concatenate(frequencies, axis=-1)
    _, ends, count, modes = error.shape
    return Samples(
        "end_mass_frequency",
        error.reshape(len(error), -1),
        frequency.reshape(len(error), -1),
        np.tile(np.repeat(ratios, modes), ends),
        np.repeat([0, 1], count * modes),
        tuple(f"{end} end, {mode}" for end in ("upper", "lower") for _ in ratios for mode in names),
    )
