"""How much better than the null does a cause predict the residuals?

Linear and Gaussian: with whitened residuals z and a cause's whitened signatures G = L^-1 J S^1/2, the logarithm of the
Bayes factor against the null is (b' M^-1 b - ln|M|) / 2 with M = 1 + G'G, b = G'z. Sizes are known to an order of
magnitude only, so the prior's scale is marginalised over three values; so is the pattern of occurrence.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr, logsumexp

from cdpr_struct.diagnosis.causes.cause import SCALES, Cause, Pattern
from cdpr_struct.diagnosis.null_model import NullModel
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import Setting, residuals
from cdpr_struct.diagnosis.world import World
from cdpr_struct.side_by_side import side_by_side

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

    def signature(cause: Cause) -> np.ndarray:
        prior = np.array([p.prior for p in cause.basic(setting)])
        moved = residuals(setting, cause.apply(world, _STEP * np.diag(prior)), readings, small=True)
        return null.white((moved - base).T / (_STEP * prior))

    signatures = side_by_side(signature, causes, ())
    return [Candidate(cause, own, cause.patterns(setting)) for cause, own in zip(causes, signatures, strict=True)]


def choice(candidate: Candidate, pattern: Pattern, scale: float) -> Choice:
    """One pattern of a cause at one scale."""
    signature = scale * (candidate.signature @ pattern.basis) * pattern.prior
    return Choice(candidate, pattern, scale, signature, float(np.log(pattern.weight / len(SCALES))))


def choices(candidate: Candidate) -> list[Choice]:
    """Every pattern at every scale."""
    return [choice(candidate, pattern, scale) for pattern in candidate.patterns for scale in SCALES]


def log_bayes_factor(signature: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Of G (n, d) against the null, for whitened residuals z (n,) or (n, k)."""
    return scaled_log_bayes_factors(signature.T @ signature, signature.T @ z, (1.0,))[0]


def scaled_log_bayes_factors(gram: np.ndarray, b: np.ndarray, scales: Sequence[float]) -> np.ndarray:
    """ln B (s, ...) of signatures s G for several scales s, from G'G (d, d) and G'z (d, ...)."""
    values, vectors = np.linalg.eigh(gram)
    values = np.maximum(values, 0.0).reshape((-1, *(1,) * (b.ndim - 1)))
    square = (vectors.T @ b) ** 2
    logs = [0.5 * (s**2 * square / (1.0 + s**2 * values) - np.log1p(s**2 * values)).sum(axis=0) for s in scales]
    return np.array(logs)


def _bounded(gram: np.ndarray, b: np.ndarray, scales: Sequence[float]) -> np.ndarray:
    """Correction of ln B (s, ...) for one size that cannot be negative: the posterior's part above zero, doubled.

    A residual that a cause of size theta leaves is theta times its signature, so what explains z has the sign of -b.
    """
    s = np.array(scales).reshape((-1, *(1,) * (b.ndim - 1)))
    result: np.ndarray = log_ndtr(-s * b[0] / np.sqrt(1.0 + s**2 * gram[0, 0])) + np.log(2.0)
    return result


def log_factors_of_pattern(pattern: Pattern, gram: np.ndarray, b: np.ndarray, scales: Sequence[float]) -> np.ndarray:
    """ln B (s, ...) of a pattern at several scales, from G'G (d, d) and G'z (d, ...); a single size keeps its sign."""
    logs = scaled_log_bayes_factors(gram, b, scales)
    if pattern.one_sided:
        logs = logs + _bounded(gram, b, scales)
    return logs


def gains_of(candidate: Candidate, z: np.ndarray, signature: np.ndarray | None = None) -> np.ndarray:
    """ln B + ln weight (patterns, scales, ...) of a cause for residuals z (n,) or (n, k)."""
    own = candidate.signature if signature is None else signature
    gram, b = own.T @ own, own.T @ z
    rows = []
    for pattern in candidate.patterns:
        basis = pattern.basis * pattern.prior
        small, part = basis.T @ gram @ basis, basis.T @ b
        rows.append(log_factors_of_pattern(pattern, small, part, SCALES) + np.log(pattern.weight / len(SCALES)))
    return np.array(rows)


@dataclass(frozen=True, slots=True, eq=False)
class Screened:
    """Log evidence gain of a cause (over patterns and scales) on top of others, and its best pattern and scale.

    spread : by how much the gain exceeds that of the best pattern and scale alone
    """

    candidate: Candidate
    gain: float
    best: Choice
    spread: float


def screen(found: list[Candidate], z: np.ndarray, others: np.ndarray | None = None) -> list[Screened]:
    """Gain of each cause on top of `others`, (n, d) signatures already taken, best first."""
    free = Freed(others) if others is not None else None
    left = z if free is None else free.of(z)
    rows = []
    for candidate in found:
        signature = candidate.signature if free is None else free.of(candidate.signature)
        logs = gains_of(candidate, left, signature)
        i, j = np.unravel_index(int(logs.argmax()), logs.shape)
        whole = float(logsumexp(logs))
        best = choice(candidate, candidate.patterns[i], SCALES[j])
        rows.append(Screened(candidate, whole, best, whole - float(logs[i, j])))
    return sorted(rows, key=lambda row: -row.gain)


class Freed:
    """Whitening (1 + O O')^-1/2 by causes of unknown size with signatures O (n, d), on top of the null's."""

    def __init__(self, others: np.ndarray) -> None:
        self._left, values, _ = np.linalg.svd(others, full_matrices=False)
        self._shrink = 1.0 - 1.0 / np.sqrt(1.0 + values**2)

    def of(self, value: np.ndarray) -> np.ndarray:
        """The whitened value (n,) or (n, k)."""
        part = self._left.T @ value
        result: np.ndarray = value - self._left @ (part.T * self._shrink).T
        return result


def largest_gains(found: list[Candidate], draws: np.ndarray) -> np.ndarray:
    """(k,) largest gain of any cause for each of k whitened residual vectors (n, k)."""
    rows = [logsumexp(gains_of(candidate, draws), axis=(0, 1)) for candidate in found]
    result: np.ndarray = np.max(rows, axis=0)
    return result
