"""With which periods along the cable could errors of its length repeat?"""

import numpy as np

_SHORTEST_PERIOD = 0.15  # m, a small drum's turn
_PICKED = 3  # periods that are judged as laws
_PER_TURN = 4  # steps of the grid for each period more within the range of lengths: a wave is off by an eighth at most


def likeliest_periods(lengths: np.ndarray, error: np.ndarray) -> tuple[np.ndarray, int]:
    """The periods [m] that errors (S, m) [m] show most as waves along lengths (S, m) [m], and how many were tried.

    Each cable has a wave with an amplitude and a phase of its own, beside a line along its length.
    """
    longest = 0.5 * max(float(np.ptp(lengths, axis=0).max()), 2.0 * _SHORTEST_PERIOD)
    count = 2 + round(2.0 * _PER_TURN * (longest / _SHORTEST_PERIOD - 1.0))
    rates = np.linspace(1.0 / longest, 1.0 / _SHORTEST_PERIOD, count)
    angle = 2.0 * np.pi * rates[:, None, None] * lengths.T  # (period, cable, state)
    line = np.broadcast_to(lengths.T - lengths.mean(axis=0)[:, None], angle.shape)
    basis = np.stack([np.ones_like(angle), line, np.cos(angle), np.sin(angle)], axis=-1)
    orthogonal = np.linalg.qr(basis)[0][..., 2:]
    power = np.einsum("pmsk,sm->pmk", orthogonal, error) ** 2
    best = np.argsort(-power.sum(axis=(1, 2)), kind="stable")[:_PICKED]
    return 1.0 / rates[best], count
