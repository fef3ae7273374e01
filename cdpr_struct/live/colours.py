"""Colours of the cables, red, green and blue from 0 to 255."""

import numpy as np

from cdpr_struct.live.view_state import Refusal, ViewState

LOW, HIGH = (86, 180, 233), (0, 68, 130)  # of the tensions within the limits
ABOVE, BELOW, SLACK, NONE = (213, 94, 0), (230, 159, 0), (150, 155, 160), (138, 143, 152)
MORE, LESS = (213, 94, 0), (0, 114, 178)  # measured above and below the prediction
PLATFORM = (70, 130, 190)
_FULL = 5.0  # sigmas


def state_colours(state: ViewState | Refusal, cables: int) -> np.ndarray:
    """(m, 3) by tension; other colours where a force limit is exceeded or the cable hangs slack."""
    if isinstance(state, Refusal):
        return np.tile(np.array(NONE), (cables, 1))
    low, high = float(state.tensions.min()), float(state.tensions.max())
    share = (state.tensions - low) / max(high - low, 1e-9 * max(high, 1.0))
    found = _between(np.array(LOW), np.array(HIGH), share)
    found[state.slack] = SLACK
    found[state.exceeded < 0] = BELOW
    found[state.exceeded > 0] = ABOVE
    return found


def residual_colours(in_sigmas: np.ndarray) -> np.ndarray:
    """(m, 3) grey where measured and predicted agree, full colour from five sigmas (m,) on; grey for nan."""
    size = np.nan_to_num(np.clip(in_sigmas / _FULL, -1.0, 1.0))
    colour = np.where(size[:, None] > 0.0, np.array(MORE), np.array(LESS))
    return _between(np.array(NONE), colour, np.abs(size))


def _between(first: np.ndarray, second: np.ndarray, share: np.ndarray) -> np.ndarray:
    return np.asarray(np.rint((1.0 - share[:, None]) * first + share[:, None] * second), dtype=int)
