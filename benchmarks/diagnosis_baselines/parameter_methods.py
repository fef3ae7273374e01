"""Textbook selections among single parameters: largest drop of chi^2, ridge, LASSO, orthogonal matching pursuit.

Each takes the material and returns the causes that it names, none if nothing is significant.
"""

from __future__ import annotations

import warnings

import numpy as np
from scipy.stats import chi2

from benchmarks.diagnosis_baselines.material import Material, single_parameters

FALSE_ALARMS = 0.04  # as in the diagnosis
DRAWS = 1000
SEED = 4
_RIDGE = 1.0  # prior variance over penalty: parameters are in prior sigmas, residuals in standard deviations


def noise_draws(count: int) -> np.ndarray:
    """(count, draws) residuals of campaigns in which nothing is wrong."""
    return np.random.default_rng(SEED).standard_normal((count, DRAWS))


def largest_drop(material: Material) -> tuple[str, ...]:
    """The cause of the parameter that, fitted alone, takes most from chi^2; threshold from draws of noise."""
    columns = single_parameters(material.visible)
    unit = columns.signature / np.linalg.norm(columns.signature, axis=0)
    return _largest((unit.T @ material.z) ** 2, (unit.T @ noise_draws(len(material.z))) ** 2, columns.cause)


def ridge(material: Material) -> tuple[str, ...]:
    """The cause of the parameter farthest from zero, in its own sigmas, when all are fitted together.

    The penalty is the prior; threshold from draws of noise.
    """
    columns = single_parameters(material.visible)
    gram = columns.signature.T @ columns.signature
    estimator = np.linalg.solve(gram + _RIDGE * np.eye(len(gram)), columns.signature.T)
    score = estimator / np.linalg.norm(estimator, axis=1, keepdims=True)
    return _largest((score @ material.z) ** 2, (score @ noise_draws(len(material.z))) ** 2, columns.cause)


def _largest(seen: np.ndarray, drawn: np.ndarray, cause: np.ndarray) -> tuple[str, ...]:
    """The cause of the largest of (p,) scores, if it beats those of noise (p, draws)."""
    if seen.max() <= np.quantile(drawn.max(axis=0), 1.0 - FALSE_ALARMS):
        return ()
    return (str(cause[seen.argmax()]),)


def lasso(material: Material) -> tuple[str, ...]:
    """LASSO along its path to the smallest BIC (noise known); the cause that explains most of what it fits."""
    from sklearn.linear_model import LassoLarsIC

    columns = single_parameters(material.visible)
    unit = columns.signature / np.linalg.norm(columns.signature, axis=0)
    model = LassoLarsIC(criterion="bic", fit_intercept=False, noise_variance=1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # columns that are nearly alike are dropped on the way, each with a warning
        size = model.fit(unit, material.z).coef_
    shares = {str(c): float(np.linalg.norm(unit @ np.where(columns.cause == c, size, 0.0))) for c in set(columns.cause)}
    best = max(sorted(shares), key=lambda name: shares[name])
    return (best,) if shares[best] > 0.0 else ()


def matching_pursuit(material: Material) -> tuple[str, ...]:
    """Orthogonal matching pursuit until chi^2 is that of noise; every cause of which it took a parameter."""
    from sklearn.linear_model import OrthogonalMatchingPursuit

    z = material.z
    enough = float(chi2.isf(FALSE_ALARMS, len(z)))
    if z @ z <= enough:
        return ()
    columns = single_parameters(material.visible)
    unit = columns.signature / np.linalg.norm(columns.signature, axis=0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # it stops where columns become dependent
        size = OrthogonalMatchingPursuit(tol=enough, fit_intercept=False).fit(unit, z).coef_
    taken = np.argsort(-np.abs(size))[: np.count_nonzero(size)]
    return tuple(dict.fromkeys(str(columns.cause[j]) for j in taken))
