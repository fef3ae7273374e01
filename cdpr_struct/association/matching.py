"""Which peak is which mode, with probabilities: the answer that every rule of matching gives."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class Matching:
    """Probable assignment of the peaks of L lists.

    pair (L, J, M) : probability that the peak is the mode's
    log_likelihood (L,) : of each list, summed over all assignments [nats]
    """

    pair: np.ndarray
    log_likelihood: np.ndarray
