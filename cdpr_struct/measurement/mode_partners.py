"""Which mode of a model is each identified one? By frequency, shape, and size in an FRF or visibility."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from cdpr_struct.measurement.modal_estimate import Modes
from cdpr_struct.measurement.mode_size import log_sizes

SIZE_SPREAD = 0.5
"""Of ln of a mode's size; a peak that much smaller than a mode is another."""
_NO_PARTNER = 16.0  # cost; a frequency 40 % off with the right shape
_SPREAD = 0.1  # of ln f
_EXACT = 0.003  # of ln f: the model may well be right
_TOO_LARGE, _TOO_SMALL = 2.0, 6.0  # largest cost of a size that is not the mode's; several modes may be fitted as one


def paired(
    modes: Modes, weight: np.ndarray, hertz: np.ndarray, shapes: np.ndarray, hidden: np.ndarray | None = None
) -> np.ndarray:
    """(k,) the model's mode for each of k identified ones, one each; -1 where none is near.

    weight (c,) : makes channels comparable;  hertz (l,), shapes (l, c) : of the model, with that weight
    hidden (l,) : share of the energy that a sensor does not see; None of an FRF, which has a size instead
    """
    far = (np.log(modes.hertz)[:, None] - np.log(hertz)[None]) / _SPREAD
    cost = far**2 + 0.5 * np.log1p((far * _SPREAD / _EXACT) ** 2) + 12.0 * _unlike(modes.shape * weight, shapes)
    if hidden is None:
        size = log_sizes(modes, shapes) / SIZE_SPREAD
        cost = cost + np.minimum(size**2, np.where(size > 0.0, _TOO_LARGE, _TOO_SMALL))
    else:
        cost = cost + 3.0 * hidden[None]
    alone = np.full((len(modes), len(modes)), _NO_PARTNER)
    rows, columns = linear_sum_assignment(np.concatenate([cost, alone], axis=1))
    found = np.full(len(modes), -1)
    found[rows] = np.where(columns < len(hertz), columns, -1)
    return found


def _unlike(measured: np.ndarray, model: np.ndarray) -> np.ndarray:
    """(k, l) 1 - modal assurance criterion of shapes (k, c) and (l, c)."""
    top = np.abs(measured.conj() @ model.T) ** 2
    bottom = (np.abs(measured) ** 2).sum(axis=1)[:, None] * (np.abs(model) ** 2).sum(axis=1)
    return np.asarray(1.0 - np.divide(top, bottom, out=np.zeros_like(top), where=bottom > 0.0))
