"""Which mode of one model is which mode of the other: by shape, not by order."""

import numpy as np
from scipy.optimize import linear_sum_assignment

_CLUSTER_GAP = 2e-3


def modal_assurance(first: np.ndarray, second: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """Modal assurance criterion (k, l) of shapes (k, n) and (l, n) under a symmetric mass matrix (n, n)."""
    cross = first @ mass @ second.T
    norm_first = np.einsum("ki,ij,kj->k", first, mass, first)
    norm_second = np.einsum("ki,ij,kj->k", second, mass, second)
    return cross**2 / np.outer(norm_first, norm_second)


def pair_modes(assurance: np.ndarray, first_hertz: np.ndarray, second_hertz: np.ndarray) -> np.ndarray:
    """For each mode of the first model the index of its partner in the second.

    Shapes inside a cluster of (nearly) equal frequencies are an arbitrary basis of the cluster's subspace, so what
    counts is the share of a shape that lies in the other model's cluster; inside a pair of clusters modes are paired
    in the order of frequency.

    Parameters
    ----------
    assurance : (k, l) from `modal_assurance`, k <= l
    first_hertz, second_hertz : (k,), (l,) ascending

    Returns
    -------
    (k,) indices into the second model.
    """
    shared = _sum_over_clusters(assurance, second_hertz, axis=1)
    shared = _sum_over_clusters(shared, first_hertz, axis=0, mean=True)
    distance = np.abs(np.log(first_hertz[:, None] / second_hertz[None, :]))
    rows, columns = linear_sum_assignment(-shared + 1e-3 * np.minimum(distance, 1.0))
    partner = np.empty(len(first_hertz), dtype=int)
    partner[rows] = columns
    return _sorted_in_clusters(partner, first_hertz, second_hertz)


def clusters(hertz: np.ndarray) -> np.ndarray:
    """Cluster number of each of the ascending frequencies: a new one starts after a relative gap of 0.2 %."""
    gaps = np.diff(hertz) > _CLUSTER_GAP * hertz[1:]
    return np.concatenate([[0], np.cumsum(gaps)])


def _sum_over_clusters(values: np.ndarray, hertz: np.ndarray, axis: int, mean: bool = False) -> np.ndarray:
    label = clusters(hertz)
    member = (label[:, None] == label[None, :]).astype(float)
    if mean:
        member /= member.sum(axis=1, keepdims=True)
    return member @ values if axis == 0 else values @ member


def _sorted_in_clusters(partner: np.ndarray, first_hertz: np.ndarray, second_hertz: np.ndarray) -> np.ndarray:
    key = clusters(first_hertz), clusters(second_hertz)[partner]
    result = partner.copy()
    for pair in set(zip(*key, strict=True)):
        members = np.flatnonzero((key[0] == pair[0]) & (key[1] == pair[1]))
        result[members] = np.sort(partner[members])
    return result
