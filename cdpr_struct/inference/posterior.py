"""From evidence to probability: hypotheses, their alternatives, and the names in them."""

from collections.abc import Collection, Sequence

import numpy as np
from scipy.special import logsumexp


def summed(log_evidence: np.ndarray, log_weight: np.ndarray | float | None = None) -> np.ndarray:
    """Log evidence of a hypothesis with alternatives (prior sizes, patterns, places), along the last axis.

    Parameters
    ----------
    log_evidence : (..., a); -inf for an alternative that is ruled out.
    log_weight : (a,) log prior weights, normalised here; equal without it.
    """
    log_evidence = np.asarray(log_evidence, dtype=float)
    weight = np.broadcast_to(0.0 if log_weight is None else log_weight, log_evidence.shape)
    return logsumexp(log_evidence + weight, axis=-1) - logsumexp(weight, axis=-1)


def probabilities(log_evidence: np.ndarray, log_prior: np.ndarray) -> np.ndarray:
    """Posterior probabilities (..., h) of rival hypotheses; priors need not be normalised.

    Raises
    ------
    ValueError : every hypothesis has evidence or prior zero, or one is nan.
    """
    total = np.asarray(log_evidence, dtype=float) + log_prior
    if np.isnan(total).any() or not (total.max(axis=-1) > -np.inf).all():
        raise ValueError("log evidence plus log prior must be finite for one hypothesis at least, and never nan")
    return np.exp(total - logsumexp(total, axis=-1, keepdims=True))


def inclusion(members: Sequence[Collection[str]], probability: np.ndarray) -> dict[str, float]:
    """Marginal probability of each name: summed over the hypotheses that contain it, most probable first."""
    if len(members) != len(probability):
        raise ValueError(f"{len(members)} hypotheses, but {len(probability)} probabilities")
    names = sorted({name for names in members for name in names})
    found = {
        name: float(sum(p for names, p in zip(members, probability, strict=True) if name in names)) for name in names
    }
    return dict(sorted(found.items(), key=lambda item: -item[1]))
