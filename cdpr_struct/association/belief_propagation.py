"""Sum over partial matchings by belief propagation, for lists of any size at once.

Modes are taken two by two, close neighbours together, since plain propagation errs where two modes meet two peaks: by
up to ln 2 in the sum. The node of a pair of modes sums its own matchings exactly, with x1 and x2 the odds of its modes
with each peak times the probability that the peak is free:

    Z = 1 + sum_j x1_j + sum_j x2_j + sum_(i != j) x1_i x2_j

The result is the Bethe approximation of this graph: exact without cycles, and stationary in the messages. Only pairs of
peak and mode that matter are kept, as a list of edges.
"""

from dataclasses import dataclass

import numpy as np

MAX_ROUNDS = 300
TOLERANCE = 1e-7
"""Change of a pair's probability in a round [-]: the sum is stationary at the fixed point, so its error is far less."""
NEGLIGIBLE = 1e-8
"""Odds [-] below which a pair is left out: a thousand of them change the log likelihood by less than 1e-5 nats."""


def neighbours(ln_frequency: np.ndarray, visible: np.ndarray) -> np.ndarray:
    """Visible modes two by two, the closest first: (L, M) slots, of which 2 n and 2 n + 1 belong together."""
    slots = np.empty(ln_frequency.shape, int)
    for row, values in enumerate(ln_frequency):
        order = np.lexsort((values, ~visible[row]))
        place = np.arange(len(order))
        partner = place.copy()
        for gap in np.argsort(np.diff(values[order[: visible[row].sum()]]), kind="stable"):
            if partner[gap] == gap and partner[gap + 1] == gap + 1:
                partner[gap], partner[gap + 1] = gap + 1, gap
        first = np.minimum(partner, place)
        slots[row, order] = 2 * first + (first < place)
    return slots


@dataclass(frozen=True, slots=True, eq=False)
class _Edges:
    """Edges (E,) between peaks and pairs of modes.

    peak, node, which (E,) : peak and pair of modes, counted through all lists, and the list
    odds (2, E) : of both modes of the pair
    shape : (L, J, M)
    """

    peak: np.ndarray
    node: np.ndarray
    which: np.ndarray
    odds: np.ndarray
    shape: tuple[int, int, int]

    def at_peak(self, value: np.ndarray) -> np.ndarray:
        return np.bincount(self.peak, value, self.shape[0] * self.shape[1])

    def at_node(self, value: np.ndarray) -> np.ndarray:
        return np.bincount(self.node, value, self.shape[0] * self.shape[2])


def bethe_matching(odds: np.ndarray, slots: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Probability (L, J, M) of each pair, and ln (L,) of the sum over partial matchings.

    odds (L, J, M) : of peak and mode being a pair against neither being in one, >= 0
    slots (L, M) : which modes are taken together; see `neighbours`
    """
    lists, peaks, modes = odds.shape
    slotted = np.zeros((lists, peaks, 2 * modes))
    place = np.broadcast_to(slots[:, None, :], odds.shape)
    np.put_along_axis(slotted, place, odds, axis=2)
    slotted = slotted.reshape(lists, peaks, modes, 2)
    kept = (slotted > NEGLIGIBLE).any(axis=3)
    which, peak, node = np.nonzero(kept)
    edges = _Edges(peak + peaks * which, node + modes * which, which, slotted[kept].T, odds.shape)
    probability, log_sum = _propagated(edges)
    slotted[:] = 0.0
    slotted[kept] = probability.T
    return np.take_along_axis(slotted.reshape(lists, peaks, 2 * modes), place, axis=2), log_sum


def _propagated(edges: _Edges) -> tuple[np.ndarray, np.ndarray]:
    """Probability (2, E) of each edge, and the Bethe sum (L,), at the fixed point."""
    lists, peaks, modes = edges.shape
    to_peak = edges.odds.copy()  # odds of each mode of the node taking the peak, the other peaks summed out
    probability = np.zeros(edges.odds.shape)
    for _ in range(MAX_ROUNDS):
        into = to_peak.sum(axis=0)
        free = 1.0 / (1.0 + np.maximum(edges.at_peak(into)[edges.peak] - into, 0.0))
        x = edges.odds * free
        ways, without = _node_sums(edges, x)
        to_peak = edges.odds * without
        both = to_peak * free
        before, probability = probability, both / (1.0 + both.sum(axis=0))
        if np.abs(probability - before).max(initial=0.0) < TOLERANCE:
            break
    at_peak = np.log1p(edges.at_peak(to_peak.sum(axis=0))).reshape(lists, peaks).sum(axis=1)
    at_node = np.log(ways).reshape(lists, modes).sum(axis=1)
    return probability, at_peak + at_node - np.bincount(edges.which, np.log1p(both.sum(axis=0)), lists)


def _node_sums(edges: _Edges, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sum Z of each node; for each edge and mode (2, E), the sum without peak and mode over that without the peak."""
    first, second, same = (edges.at_node(value) for value in (x[0], x[1], x[0] * x[1]))
    ways = 1.0 + first + second + np.maximum(first * second - same, 0.0)
    one = np.maximum(first[edges.node] - x[0], 0.0)
    two = np.maximum(second[edges.node] - x[1], 0.0)
    cross = np.maximum(one * two - np.maximum(same[edges.node] - x[0] * x[1], 0.0), 0.0)
    return ways, np.stack([1.0 + two, 1.0 + one]) / (1.0 + one + two + cross)
