"""Which cables' states were searched and not found?"""

from dataclasses import replace

import numpy as np

from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.catenary import CableStatus


def lost(states: CableStates) -> np.ndarray:
    """(..., m) bool: the search for the cable's state ended before it had converged."""
    return np.asarray(states.status == CableStatus.NOT_CONVERGED)


def counted_lost(states: CableStates, missed: np.ndarray) -> CableStates:
    """The same states; cables (..., m) that `missed` what they were to have count as lost."""
    return (
        replace(states, status=np.where(missed, CableStatus.NOT_CONVERGED, states.status)) if missed.any() else states
    )
