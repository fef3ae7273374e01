"""How much better than the null does a cause predict the residuals?

Linear and Gaussian: with whitened residuals z and a cause's whitened signatures G = L^-1 J S^1/2, the logarithm of the
Bayes factor against the null is (b' M^-1 b - ln|M|) / 2 with M = 1 + G'G, b = G'z. Sizes are known to an order of
magnitude only, so the prior's scale is marginalised over three values; so is the pattern of occurrence.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr, logsumexp

from cdpr_struct.diagnosis.causes.cause import SCALES, Cause, Pattern
from cdpr_struct.diagnosis.null_model import NullModel
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import Setting, residuals
from cdpr_struct.diagnosis.world import World

_STEP = 0.05  # of the prior's sigma


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A cause with its whitened signature (n, d0) per basic parameter, and its patterns."""

    cause: Cause
    signature: np.ndarray
    patterns: list[Pattern]

    @property
    def name(self) -> str:
        return self.cause.name


@dataclass(frozen=True, slots=True, eq=False)
class Choice:
    """A pattern and scale of a cause: G (n, d) whitened signatures in prior sigmas, ln of its prior weight."""

    candidate: Candidate
    pattern: Pattern
    scale: float
    signature: np.ndarray
    log_weight: float

    @property
    def prior(self) -> np.ndarray:
        """(d,) sigma of theta."""
        return self.scale * self.pattern.prior


def candidates(
    setting: Setting, world: World, readings: Readings, null: NullModel, causes: list[Cause]
) -> list[Candidate]:
    """Causes with their whitened signatures at a world."""
    base = residuals(setting, world, readings, small=True)
    found = []
    for cause in causes:
        prior = np.array([p.prior for p in cause.basic(setting)])
        moved = residuals(setting, cause.apply(world, _STEP * np.diag(prior)), readings, small=True)
        found.append(Candidate(cause, null.white((moved - base).T / (_STEP * prior)), cause.patterns(setting)))
    return found


def choices(candidate: Candidate) -> list[Choice]:
    """Every pattern at every scale."""
    found = []
    for pattern in candidate.patterns:
        signature = (candidate.signature @ pattern.basis) * pattern.prior
        for scale in SCALES:
            weight = np.log(pattern.weight / len(SCALES))
            found.append(Choice(candidate, pattern, scale, scale * signature, weight))
    return found


def log_bayes_factor(signature: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Of G (n, d) against the null, for whitened residuals z (n,) or (n, k)."""
    matrix = np.eye(signature.shape[1]) + signature.T @ signature
    b = signature.T @ z
    _, log_det = np.linalg.slogdet(matrix)
    result: np.ndarray = 0.5 * ((b * np.linalg.solve(matrix, b)).sum(axis=0) - log_det)
    return result


def bounded(choice: Choice, z: np.ndarray) -> np.ndarray:
    """Correction of ln B for a single size that cannot be negative: the part of the posterior above zero, doubled."""
    if choice.signature.shape[1] != 1 or not choice.pattern.parameters[0].positive:
        return np.zeros(z.shape[1:])
    column = choice.signature[:, 0]
    precision = 1.0 + column @ column
    result: np.ndarray = log_ndtr(column @ z / np.sqrt(precision)) + np.log(2.0)
    return result


@dataclass(frozen=True, slots=True, eq=False)
class Screened:
    """Log evidence gain of a cause (over patterns and scales) on top of others, and its best pattern and scale."""

    candidate: Candidate
    gain: float
    best: Choice


def screen(found: list[Candidate], z: np.ndarray, others: np.ndarray | None = None) -> list[Screened]:
    """Gain of each cause together with `others` (n, d) signatures against the null, best first."""
    rows = []
    for candidate in found:
        options = choices(candidate)
        logs = [
            float(log_bayes_factor(c.signature if others is None else np.hstack([others, c.signature]), z))
            + c.log_weight
            + (float(bounded(c, z)) if others is None else 0.0)
            for c in options
        ]
        rows.append(Screened(candidate, float(logsumexp(logs)), options[int(np.argmax(logs))]))
    return sorted(rows, key=lambda row: -row.gain)


def largest_gains(found: list[Candidate], draws: np.ndarray) -> np.ndarray:
    """(k,) largest gain of any cause for each of k whitened residual vectors (n, k)."""
    best = np.full(draws.shape[1], -np.inf)
    for candidate in found:
        options = choices(candidate)
        logs = np.array([log_bayes_factor(c.signature, draws) + c.log_weight + bounded(c, draws) for c in options])
        best = np.maximum(best, logsumexp(logs, axis=0))
    return best
