"""Is anything wrong at all? Every law at once, each at its smallest detectable size.

How large a cause is when it occurs, its prior says; whether something is there should not depend on it. Here each
pattern of a cause is given the size at which it would be found if it alone were in question, in any direction that it
can show. The mean over directions, patterns, causes and laws outside is one likelihood ratio against the null, the most
powerful test for a law drawn so. Draws from the null, the noise as it was found, say how large it gets by chance.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy.special import gammaln, hyp0f1, ive, logsumexp

from cdpr_struct.hypotheses.alternatives import Offered, of_pattern
from cdpr_struct.hypotheses.detectable import noncentrality
from cdpr_struct.hypotheses.hypothesis import SCALES
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.inference.screening import Screen

SIGNIFICANT = 0.04
"""p-value below which something is said to be wrong: so many sound campaigns in a hundred are looked into in vain."""
_OUTSIDE = -2.0  # ln prior of the laws outside the library together, beside that of one cause
_SEED, _DRAWS = 20240229, 1000
_LARGE = 100.0  # argument beyond which a Bessel function is scaled


def p_of_null(menu: Sequence[Offered], null: Judged) -> float:
    """p-value of nothing being wrong: the likelihood ratio of any law beside that of draws."""
    screen = Screen.of(null.model, null.fit.noise, null.fit.soft)
    shelves = zip(*(cause.columns for cause in menu), strict=True)
    said = screen.screened([np.concatenate(parts, axis=-1) for parts in shelves])
    scores = np.column_stack([said.score, _drawn(said.gram)])
    logs, weights, start = [], [], 0
    for cause in menu:
        own = slice(start, start + cause.columns[0].shape[-1])
        start = own.stop
        log = _of_cause(cause, said.gram[own, own], scores[own])
        if log is not None:
            logs.append(log)
            weights.append(_OUTSIDE if cause.cause.name == UNKNOWN else 0.0)
    if not logs:
        return 1.0
    ratio = logsumexp(np.array(logs) + np.array(weights)[:, None], axis=0) - logsumexp(weights)
    p = (1.0 + float((ratio[1:] >= ratio[0]).sum())) / (_DRAWS + 1.0)
    return float(min(p, np.exp(-max(ratio[0], 0.0)))) if ratio[0] > ratio[1:].max() else p


def _drawn(gram: np.ndarray) -> np.ndarray:
    """(D, draws) scores of data in which nothing is wrong: N(0, gram)."""
    values, vectors = np.linalg.eigh(gram)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    return np.asarray(root @ np.random.default_rng(_SEED).standard_normal((len(gram), _DRAWS)))


def _of_cause(cause: Offered, gram: np.ndarray, scores: np.ndarray) -> np.ndarray | None:
    """(k,) of one cause over its patterns; None if it shows in none."""
    found = list(_of_patterns(cause, gram, scores))
    if not found:
        return None
    logs, weights = np.array([log for log, _ in found]), np.log([weight for _, weight in found])
    return np.asarray(logsumexp(logs + weights[:, None], axis=0) - logsumexp(weights))


def _of_patterns(cause: Offered, gram: np.ndarray, scores: np.ndarray) -> Iterator[tuple[np.ndarray, float]]:
    """(k,) of each pattern that shows, and its weight."""
    for pattern in cause.patterns:
        own_gram, own_scores = of_pattern(pattern, gram, scores)
        values, vectors = np.linalg.eigh(own_gram)
        shown = SCALES[-1] ** 2 * values > 1.0  # by a sigma, where it is as large as is considered
        if not shown.any():
            continue
        along = (vectors[:, shown].T @ own_scores) / np.sqrt(values[shown])[:, None]
        one_sided = len(pattern.prior) == 1 and bool(pattern.positive[0])
        if one_sided:
            along = along * np.sign(vectors[0, 0])
        yield _of_size(float(np.sqrt(noncentrality(len(along)))), along, one_sided), pattern.weight


def _of_size(size: float, along: np.ndarray, one_sided: bool) -> np.ndarray:
    """(k,) ln likelihood ratio of a change of known size and unknown direction, by its components along (d, k) [sigma].

    The mean of exp(size u'along - size^2 / 2) over all unit vectors u, a Bessel function of |along|.
    """
    if one_sided:
        return size * along[0] - 0.5 * size**2
    order, x = 0.5 * len(along) - 1.0, size * np.linalg.norm(along, axis=0)
    large, result = x > _LARGE, np.log(hyp0f1(order + 1.0, 0.25 * np.minimum(x, _LARGE) ** 2))
    if large.any():
        y = x[large]
        result[large] = gammaln(order + 1.0) - order * np.log(0.5 * y) + np.log(ive(order, y)) + y
    return np.asarray(result - 0.5 * size**2)
