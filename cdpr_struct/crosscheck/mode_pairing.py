"""Which mode of one model is which mode of the other: by shape, not by order."""

import numpy as np
from scipy.optimize import linear_sum_assignment

CLUSTER_GAP = 5e-3
"""Relative distance of neighbouring frequencies up to which their modes may mix."""
_NEARNESS, _FAR = 0.1, 0.02


def modal_assurance(first: np.ndarray, second: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """Modal assurance criterion (k, l) of shapes (k, n) and (l, n) under a symmetric mass matrix (n, n)."""
    cross = first @ mass @ second.T
    norm_first = np.einsum("ki,ij,kj->k", first, mass, first)
    norm_second = np.einsum("ki,ij,kj->k", second, mass, second)
    return cross**2 / np.outer(norm_first, norm_second)


def pair_modes(assurance: np.ndarray, first_hertz: np.ndarray, second_hertz: np.ndarray) -> np.ndarray:
    """For each mode of the first model the index of its partner in the second.

    One-to-one, largest total assurance; among equally like shapes (the arbitrary bases of a double frequency) the
    nearer frequency.

    Parameters
    ----------
    assurance : (k, l) from `modal_assurance`, k <= l
    first_hertz, second_hertz : (k,), (l,)

    Returns
    -------
    (k,) indices into the second model.
    """
    distance = np.abs(np.log(first_hertz[:, None] / second_hertz[None, :]))
    rows, columns = linear_sum_assignment(-assurance + _NEARNESS * np.minimum(distance / _FAR, 1.0))
    partner = np.empty(len(first_hertz), dtype=int)
    partner[rows] = columns
    return partner


def shared_subspace(assurance: np.ndarray, second_hertz: np.ndarray, partner: np.ndarray) -> np.ndarray:
    """(k,) share of each shape that lies in the span of its partner's cluster of nearly equal frequencies [-].

    Shapes inside a cluster turn into each other under the smallest change of the model, so one shape against one
    shape says little there.
    """
    label = _clusters(second_hertz)
    member = label[partner][:, None] == label[None, :]
    return np.minimum((assurance * member).sum(axis=1), 1.0)


def _clusters(hertz: np.ndarray) -> np.ndarray:
    """Cluster number of each of the ascending frequencies: a new one starts after a relative gap of 0.5 %."""
    gaps = np.diff(hertz) > CLUSTER_GAP * hertz[1:]
    return np.concatenate([[0], np.cumsum(gaps)])
