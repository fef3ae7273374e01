"""Which neglected effect makes an error, and which further limit would keep it away.

An effect is responsible for an error if the error falls below half when the effect is switched off in the reference.
The limit is then read off the samples: for each dimensionless group the threshold below which none of these errors
lies, and of all groups the one that costs least of the volume that was rightly admitted.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.crosscheck.limits_errors import Samples
from cdpr_struct.crosscheck.limits_groups import CableGroups
from cdpr_struct.crosscheck.limits_reference import EFFECTS
from cdpr_struct.crosscheck.limits_sweep import Measured
from cdpr_struct.crosscheck.validity_limits import crossover_distance

CAUSES = (*EFFECTS, "higher_order_sag", "several")
_HALF = 0.5


@dataclass(frozen=True, slots=True)
class Candidate:
    """A possible limit `parameter` < threshold and the share of the rightly admitted volume that it would cost."""

    parameter: str
    threshold: float
    cost: float


@dataclass(frozen=True, slots=True, eq=False)
class MissingLimit:
    """A limit that the print lacks.

    cause        : one of `CAUSES`;  samples : how many errors above the tolerance it explains
    limit        : the cheapest candidate;  others : the next ones
    cable, sample: the worst of these errors, as indices;  error : its size
    without      : its size with each single effect switched off, and with all
    """

    quantity: str
    cause: str
    samples: int
    limit: Candidate
    others: tuple[Candidate, ...]
    cable: int
    sample: int
    error: float
    without: dict[str, float]


def static_groups(groups: CableGroups) -> dict[str, np.ndarray]:
    """Every group of the cables at rest: name -> (n,) [-], large where the closed form may fail."""
    return {
        "epsilon": groups.epsilon,
        "along_weight": groups.along,
        "weight": groups.weight,
        "strain": groups.strain,
        "lambda2": groups.lambda_squared,
        "inverse_lambda2": 1.0 / groups.lambda_squared,
        "alpha_deg": groups.inclination_deg,
        "crossover_closeness": 1.0 / np.maximum(crossover_distance(groups.lambda_squared), 1e-12),
    }


def sample_groups(groups: CableGroups, samples: Samples) -> dict[str, np.ndarray]:
    """Every group of the problem at each sample: name -> (n, k) [-]."""
    shape = samples.error.shape
    found = {name: np.broadcast_to(value[:, None], shape) for name, value in static_groups(groups).items()}
    found["frequency"] = samples.frequency
    found["axial_phase"] = samples.frequency * np.sqrt(groups.strain)[:, None]
    if np.isfinite(samples.mass_ratio).all():
        found["cable_to_end_mass"] = np.broadcast_to(1.0 / samples.mass_ratio, shape)
    return found


def causes_of(samples: Samples, without: dict[str, np.ndarray], bad: np.ndarray) -> np.ndarray:
    """Index into `CAUSES` of each bad sample, -1 elsewhere.

    without : errors (n, k) with one effect switched off, by name, and under "all" with all of them off
    """
    error = samples.error
    single = np.stack([np.where(np.isfinite(without[e]), without[e], np.inf) for e in EFFECTS])
    cause = np.where(single.min(axis=0) < _HALF * error, single.argmin(axis=0), CAUSES.index("several"))
    cause = np.where(without["all"] > _HALF * error, CAUSES.index("higher_order_sag"), cause)
    return np.where(bad, cause, -1)


def missing_limits(
    groups: CableGroups, volume: np.ndarray, measured: Measured, switched: dict[str, Measured], tolerance: float
) -> list[MissingLimit]:
    """Further limits for cables that the print admits, quantity by quantity, the most frequent cause first.

    switched : the same cables measured with an effect switched off, by effect, and under "all"
    """
    found = []
    for quantity, samples in measured.items():
        values = sample_groups(groups, samples)
        without = {name: other[quantity].error for name, other in switched.items()}
        bad = samples.error > tolerance
        cause = causes_of(samples, without, bad)
        left = bad.copy()
        for number in np.argsort([-(cause == c).sum() for c in range(len(CAUSES))], kind="stable"):
            mask = left & (cause == number)
            if not mask.any():
                continue
            limits = candidates(values, mask, ~bad, volume)
            found.append(_missing(quantity, int(number), samples, mask, limits, without))
            left &= values[limits[0].parameter] < limits[0].threshold
    return found


def candidates(values: dict[str, np.ndarray], bad: np.ndarray, good: np.ndarray, volume: np.ndarray) -> list[Candidate]:
    """For each group the limit that excludes all bad samples, the cheapest first.

    values : name -> (n, k);  bad, good : (n, k) bool;  volume : (n,)
    """
    weight = np.broadcast_to(volume[:, None], good.shape) * good
    total = float(weight.sum())
    found = []
    for name, value in values.items():
        threshold = rounded_down(float(value[bad].min()))
        lost = float(weight[value >= threshold].sum())
        found.append(Candidate(name, threshold, lost / total if total > 0.0 else 0.0))
    return sorted(found, key=lambda c: c.cost)


def rounded_down(value: float) -> float:
    """To two significant digits, never above the value."""
    if value <= 0.0:
        return 0.0
    unit = 10.0 ** (np.floor(np.log10(value)) - 1.0)
    rounded = float(f"{np.floor(value / unit) * unit:.12g}")
    return rounded if rounded <= value else float(f"{rounded - unit:.12g}")


def _missing(
    quantity: str,
    cause: int,
    samples: Samples,
    mask: np.ndarray,
    limits: list[Candidate],
    without: dict[str, np.ndarray],
) -> MissingLimit:
    worst = np.unravel_index(np.where(mask, samples.error, -np.inf).argmax(), mask.shape)
    cable, sample = int(worst[0]), int(worst[1])
    return MissingLimit(
        quantity=quantity,
        cause=CAUSES[cause],
        samples=int(mask.sum()),
        limit=limits[0],
        others=tuple(limits[1:4]),
        cable=cable,
        sample=sample,
        error=float(samples.error[cable, sample]),
        without={name: float(error[cable, sample]) for name, error in without.items()},
    )
