"""What modes that were not told apart do to an identified one's pole.

A fit of one pole to a mode and a weaker or stronger neighbour beside it takes part of the neighbour for its own, and
nothing in the residuals need show it. The model says which modes lie near and how large they are; those that were
identified themselves are in the fit and do no harm.
"""

import numpy as np

from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.mode_size import log_sizes
from cdpr_struct.measurement.signal_states import model_shapes

_WINDOW = np.sqrt(12.0) / (2.0 * np.pi)  # times 1 / duration: spread of the frequencies that a record holds as one
_OTHER = 0.25  # of ln of a mode's size beside the other modes': beyond it, it is several modes, or another one
ALONE, SEVERAL = "", "its size is not that of one mode: several were fitted as one"


def pole_doubt(item: Identified, duration: float) -> np.ndarray:
    """(k,) one sigma of each mode's pole by neighbours that were not identified [Hz]; zero without a partner.

    duration : of the record or window [s], infinite for an FRF

    A neighbour of q times the size, D away, moves a pole by q D / (1 + q + (D / w)^2), w the half-width: all of it is
    taken in where it is nearer than that, a share w^2 / D where it is farther. Phases are any, so squares add up.
    """
    doubt = np.zeros(len(item.modes))
    if item.state is None:
        return doubt
    size = _sizes(item)
    free = np.setdiff1d(np.arange(len(size)), item.partner)
    width = np.hypot(item.modes.damping * item.modes.hertz, _WINDOW / duration)
    for i in np.flatnonzero(item.partner >= 0):
        own = int(item.partner[i])
        apart = np.abs(item.state.hertz[free] - item.state.hertz[own])
        share = size[free] / max(float(size[own]), 1e-300)
        moved = share * apart / (1.0 + share + (apart / width[i]) ** 2)
        doubt[i] = np.sqrt((moved**2).sum())
    return doubt


def crowded(item: Identified) -> list[str]:
    """(k,) why an FRF's mode is no single one of the model, by its size beside those of the others; "" if it is."""
    if item.state is None or item.record.kind != "frf" or not item.used.any():
        return [ALONE] * len(item.modes)
    off = log_sizes(item.modes, model_shapes(item.state, item.record))
    own = off[np.arange(len(item.modes)), item.partner]
    known = item.used & (item.partner >= 0)
    middle = float(np.median(own[known])) if known.any() else 0.0
    return [SEVERAL if abs(o - middle) > _OTHER else ALONE for o in own]


def _sizes(item: Identified) -> np.ndarray:
    """(l,) of the model's modes as a record of this kind shows them; how they were excited is not known of a decay."""
    assert item.state is not None
    size = np.linalg.norm(model_shapes(item.state, item.record), axis=1)
    return size if item.record.kind == "frf" else size**2
