"""Modes above zero of a model at rest, with shapes sampled where those of the FEM are."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.optimize import linear_sum_assignment

from cdpr_struct.crosscheck.neglected_effects import assembly_without, expansion_without
from cdpr_struct.dynamics.cable_dynamics import CableModel, polynomial_order
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import RitzModes, ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly, platform_static_stiffness, stability_at
from cdpr_struct.statics.guides import free_axes, free_block

SPARE_MODES = 24  # beyond those that are compared: partners may lie higher
_ALIKE = 0.1  # of a mode's energy must be a static mode's motion for the one to stand for the other
_ABOVE = 1.3  # over the highest frequency that is compared


@dataclass(frozen=True, slots=True, eq=False)
class ComparedModes:
    """Modes of a model above its `neutral` freedoms at zero.

    hertz : (k,);  shapes : (k, 6 + 3 m (stations - 1)), platform first;  kinds : where the kinetic energy sits
    """

    neutral: int
    hertz: np.ndarray
    certified: bool
    shapes: np.ndarray
    kinds: list[str]


def model_modes(
    point: OperatingPoint, model: CableModel, modes: int, assembly: Assembly, stations: int
) -> ComparedModes:
    """The first modes of the model, and some more."""
    neutral = int(stability_at(point, assembly).neutral)
    found = certified_modes(point, model, neutral + modes + SPARE_MODES, assembly)
    hertz, kinds = found.frequencies.hertz[neutral:], found.shapes.kinds()[neutral:]
    return ComparedModes(neutral, hertz, found.frequencies.certified, _sampled(found.shapes, stations)[neutral:], kinds)


def modes_without(
    point: OperatingPoint, off: frozenset[str], modes: int, highest_hertz: float, stations: int
) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (k,) [Hz] and shapes of the exact model without some `neglected_effects`, up to about a frequency."""
    highest = _ABOVE * 2.0 * np.pi * highest_hertz
    full = expansion_without(point, off, polynomial_order(point, highest))
    found = ritz_modes(point, full.reduced(highest), modes + SPARE_MODES, assembly_without(off)).above_zero
    return found.omega / (2.0 * np.pi), _sampled(found, stations)


def _sampled(modes: RitzModes, stations: int) -> np.ndarray:
    motion = modes.cable_motion(np.arange(1, stations) / stations)
    return np.concatenate([modes.platform, motion.reshape(len(motion), -1)], axis=1)


def static_partners(
    point: OperatingPoint, assembly: Assembly, platform_shapes: np.ndarray, mass: np.ndarray
) -> np.ndarray:
    """For each FEM mode the frequency of the static mode it stands for; at most six modes get one, the others nan.

    platform_shapes carry unit modal mass, so the overlap with a static shape is the share of the FEM mode's energy
    that is this platform motion.
    """
    free = free_axes(point.arrays)
    stiffness, own = (free_block(part, point.arrays) for part in (platform_static_stiffness(point, assembly), mass))
    squared, static_shapes = scipy.linalg.eigh(stiffness, own)
    overlap = (platform_shapes[:, free] @ own @ static_shapes) ** 2
    result = np.full(len(platform_shapes), np.nan)
    rows, columns = linear_sum_assignment(-overlap)
    for i, j in zip(rows, columns, strict=True):
        if squared[j] > 0.0 and overlap[i, j] > _ALIKE:
            result[i] = np.sqrt(squared[j]) / (2.0 * np.pi)
    return result
