"""Is anything wrong at all? Every law at once, each at its smallest detectable size.

How large a cause is when it occurs, its prior says; whether something is there should not depend on it. Here each
pattern of a cause is given the size at which it would be found if it alone were in question, in any direction that it
can show. The mean over directions, patterns, causes and channels is one likelihood ratio against the null, the most
powerful test for a law drawn so. Draws from the null say how large it gets by chance.
"""

from collections.abc import Iterator

import numpy as np
from scipy.special import gammaln, hyp0f1, ive, logsumexp
from scipy.stats import chi2

from cdpr_struct.diagnosis.causes.cause import SCALES, Pattern
from cdpr_struct.diagnosis.detectable import noncentrality
from cdpr_struct.diagnosis.evidence import Candidate
from cdpr_struct.diagnosis.null_model import NullModel
from cdpr_struct.side_by_side import side_by_side

OUTSIDE = -2.0  # ln prior of a law outside the library, beside that of a cause
SEED = 20240229
DRAWS = 1000
_SHOWN = 1.0  # sigmas by which a large occurrence must show in a direction
_LARGE = 100.0  # argument beyond which a Bessel function is scaled
LAW_SHARE, NOISE_SHARE, STRAY_SHARE = 0.92, 0.05, 0.03  # of the false alarms: laws, chi^2, stray peaks


def p_of_null(
    library: list[Candidate], outside: list[Candidate], null: NullModel, p_strays: float, large: float = -np.inf
) -> float:
    """p-value of the null: likelihood ratio of any law beside that of draws, its chi^2, stray peaks.

    large : log evidence of the best large change of a cause, which small ones do not show
    """
    draws = np.random.default_rng(SEED).standard_normal((len(null.r), DRAWS))
    logs = log_ratio(library, outside, np.column_stack([null.white(null.r), draws]))
    ratio, chance = float(np.logaddexp(logs[0], large - np.log(max(len(library), 1)))), logs[1:]
    p_laws = (1.0 + float((chance >= ratio).sum())) / (DRAWS + 1.0)
    if ratio > chance.max():
        p_laws = min(p_laws, float(np.exp(-ratio)))  # no likelihood ratio is above e^x more often than e^-x
    return min(1.0, p_laws / LAW_SHARE, p_of_noise(null) / NOISE_SHARE, p_strays / STRAY_SHARE)


def log_ratio(library: list[Candidate], outside: list[Candidate], z: np.ndarray) -> np.ndarray:
    """(k,) logarithm of the likelihood ratio of any law against the null, for whitened residuals z (n, k)."""
    found = side_by_side(lambda law: _of_law(law, z), [*library, *outside], ())
    weighted = [0.0] * len(library) + [OUTSIDE] * len(outside)
    shown = [(log, weight) for log, weight in zip(found, weighted, strict=True) if log is not None]
    return _mean([log for log, _ in shown], [weight for _, weight in shown]) if shown else np.zeros(z.shape[1])


def _mean(logs: list[np.ndarray], weights: list[float]) -> np.ndarray:
    """Logarithm (k,) of a weighted mean, from logarithms of values (k,) and weights."""
    result: np.ndarray = logsumexp(np.array(logs) + np.array(weights)[:, None], axis=0) - logsumexp(weights)
    return result


def _of_law(candidate: Candidate, z: np.ndarray) -> np.ndarray | None:
    """(k,) of one cause or channel over its patterns; None if it shows in none."""
    gram, b = candidate.signature.T @ candidate.signature, candidate.signature.T @ z
    found = list(_of_patterns(candidate.patterns, gram, b))
    return _mean([log for _, log in found], [float(np.log(pattern.weight)) for pattern, _ in found]) if found else None


def _of_patterns(patterns: list[Pattern], gram: np.ndarray, b: np.ndarray) -> Iterator[tuple[Pattern, np.ndarray]]:
    """(k,) of each pattern that shows, from G'G (d0, d0) and G'z (d0, k) of the basic parameters."""
    for pattern in patterns:
        basis = pattern.basis * pattern.prior
        values, vectors = np.linalg.eigh(basis.T @ gram @ basis)
        shown = max(SCALES) ** 2 * values > _SHOWN**2
        if not shown.any():
            continue
        along = (vectors[:, shown].T @ (basis.T @ b)) / np.sqrt(values[shown])[:, None]
        yield pattern, _of_size(float(np.sqrt(noncentrality(len(along)))), along, pattern.one_sided)


def _of_size(size: float, along: np.ndarray, one_sided: bool) -> np.ndarray:
    """(k,) ln likelihood ratio of a change of known size and unknown direction, by its components along (d, k) [sigma].

    The mean of exp(size u'along - size^2 / 2) over all unit vectors u, a Bessel function of |along|. What explains a
    residual has the sign of minus its component: a one-sided number has that direction only.
    """
    if one_sided:
        return -size * along[0] - 0.5 * size**2
    order, x = 0.5 * len(along) - 1.0, size * np.linalg.norm(along, axis=0)
    large, result = x > _LARGE, np.log(hyp0f1(order + 1.0, 0.25 * np.minimum(x, _LARGE) ** 2))
    if large.any():
        y = x[large]
        result[large] = gammaln(order + 1.0) - order * np.log(0.5 * y) + np.log(ive(order, y)) + y
    return np.asarray(result - 0.5 * size**2)


def p_of_noise(null: NullModel, rows: np.ndarray | None = None) -> float:
    """Probability of a chi^2 at least as large as that of the null's residuals, or of some of their rows."""
    z = null.white(null.r) if rows is None else null.white_among(rows, null.r)
    return float(chi2.sf(float(z @ z), len(z)))
