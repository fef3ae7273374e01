"""Cables that are stretched more than ropes can bear."""

import numpy as np

from cdpr_struct.robot.plausibility import BREAKING_STRAIN
from cdpr_struct.statics.cable_state import CableStates


def strains(cables: CableStates) -> np.ndarray:
    """(..., m) elongation over unstrained length, as a whole; 0 of cables without an end to it."""
    return np.nan_to_num(cables.elongation / cables.total_length)


def strain_sentence(cables: CableStates) -> str | None:
    """A sentence on the cable that is stretched most, where ropes break; None if none is."""
    strain = strains(cables)
    if not strain.max() > BREAKING_STRAIN:
        return None
    return torn_sentence(f"Cable {int(strain.argmax()) + 1} is stretched", float(strain.max()))


def torn_sentence(stretched: str, strain: float) -> str:
    """What a strain beyond `BREAKING_STRAIN` means; `stretched` says which cable, and where."""
    return (
        f"{stretched} by {100.0 * strain:.3g} %: it would break long before, steel near 2 %, high-modulus fibres near "
        "3.5 %. Check its axial_stiffness (EA in N, not kN) and the load."
    )
