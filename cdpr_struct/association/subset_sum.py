"""Exact sum over the partial matchings of a small block of peaks and modes.

Every peak takes at most one mode and every mode at most one peak; a matching weighs the product of the odds of its
pairs. The longer side is passed item by item. `used[i][S]` sums the matchings of the items before i whose partners on
the shorter side are just the subset S, `free[i][S]` those of the items from i on whose partners lie outside S. Cost:
number of pairs times 2^(shorter side).
"""

import numpy as np


def subset_matching(odds: np.ndarray) -> tuple[np.ndarray, float]:
    """Probability (a, b) of each pair, and ln of the sum over all partial matchings, for odds (a, b) >= 0."""
    if odds.shape[0] < odds.shape[1]:
        pair, log_sum = subset_matching(odds.T)
        return pair.T, log_sum
    used, log_used = _used(odds)
    free, log_free = _free(odds)
    log_sum = float(np.log(free[0][0]) + log_free[0])
    pair = np.zeros(odds.shape)
    for item, row in enumerate(odds):
        scale = np.exp(log_used[item] + log_free[item + 1] - log_sum)
        for bit in np.flatnonzero(row).tolist():
            without, within = _halves(used[item], bit)[:, 0], _halves(free[item + 1], bit)[:, 1]
            pair[item, bit] = row[bit] * scale * (without * within).sum()
    return pair, log_sum


def _halves(table: np.ndarray, bit: int) -> np.ndarray:
    """View (., 2, .) of a table over subsets: 0 without, 1 with the bit."""
    return table.reshape(-1, 2, 1 << bit)


def _used(odds: np.ndarray) -> tuple[list[np.ndarray], list[float]]:
    """Tables `used` of largest entry one, and ln of their scales, before each item and after the last."""
    table = np.zeros(1 << odds.shape[1])
    table[0] = 1.0
    tables, scales = [table], [0.0]
    for row in odds:
        grown = table.copy()
        for bit in np.flatnonzero(row).tolist():
            _halves(grown, bit)[:, 1] += row[bit] * _halves(table, bit)[:, 0]
        table = grown / grown.max()
        tables.append(table)
        scales.append(scales[-1] + float(np.log(grown.max())))
    return tables, scales


def _free(odds: np.ndarray) -> tuple[list[np.ndarray], list[float]]:
    """Tables `free` of largest entry one, and ln of their scales, before each item and after the last."""
    table = np.ones(1 << odds.shape[1])
    tables, scales = [table], [0.0]
    for row in odds[::-1]:
        grown = table.copy()
        for bit in np.flatnonzero(row).tolist():
            _halves(grown, bit)[:, 0] += row[bit] * _halves(table, bit)[:, 1]
        table = grown / grown.max()
        tables.append(table)
        scales.append(scales[-1] + float(np.log(grown.max())))
    return tables[::-1], scales[::-1]
