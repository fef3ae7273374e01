"""Parts of the diagnosis: the cause with the largest linear evidence, with and without tolerances in the null.

No refit, no handling errors, no second cause, no class, no law outside the library.
"""

from __future__ import annotations

import numpy as np

from benchmarks.diagnosis_baselines.material import Material
from benchmarks.diagnosis_baselines.parameter_methods import FALSE_ALARMS, noise_draws
from cdpr_struct.diagnosis.evidence import Candidate, largest_gains, screen


def linear_evidence(material: Material) -> tuple[str, ...]:
    """The cause with the largest evidence, tolerances counted; threshold from draws of noise."""
    return _most_evident(material.candidates, material.z)


def noise_evidence(material: Material) -> tuple[str, ...]:
    """The same, whitened by sensor noise alone: as if the robot were exactly as drawn."""
    return _most_evident(material.noise_candidates, material.noise_z)


def _most_evident(found: list[Candidate], z: np.ndarray) -> tuple[str, ...]:
    best = screen(found, z)[0]
    limit = np.quantile(largest_gains(found, noise_draws(len(z))), 1.0 - FALSE_ALARMS)
    return (best.candidate.name,) if best.gain > limit else ()
