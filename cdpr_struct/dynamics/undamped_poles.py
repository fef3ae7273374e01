"""Eigenfrequencies at which nothing bounds a response."""

import numpy as np

from cdpr_struct.dynamics.modal_basis import ModalBasis
from cdpr_struct.dynamics.ports import Port
from cdpr_struct.dynamics.ritz_modes import RitzModes

# Eigenfrequencies are enclosed to 1e-9, and the stiffness of a sweep is accurate to as much. A peak of this damping
# ratio is a hundred times wider than that; the height of a narrower one could not be told to 1 %.
UNDAMPED_RATIO = 1e-7
_TOGETHER = 1e-8  # relative distance of modes that cannot be told apart: their residues are added
_UNSEEN = 1e-9  # of the largest residue that the modes allow: rounding of shapes that symmetry makes zero


def undamped_poles(
    modes: RitzModes, hertz: np.ndarray, undamped: np.ndarray, excite: Port, respond: tuple[Port, ...]
) -> list[np.ndarray]:
    """Per responding port the undamped eigenfrequencies (p,) [Hz] at which it answers the force.

    hertz : (k,) certified frequencies of the modes;  undamped : (k,) bool
    """
    basis = ModalBasis(modes, np.zeros((0, 0)))
    own = np.flatnonzero(undamped)
    _, first, group = np.unique(_groups(hertz[own]), return_index=True, return_inverse=True)
    force = basis.shape_at(excite)
    found = []
    for port in respond:
        motion = basis.shape_at(port)
        residue = np.bincount(group, (force * motion)[own], len(first))
        seen = np.abs(residue) > _UNSEEN * np.linalg.norm(force) * np.linalg.norm(motion)
        found.append(hertz[own][first[seen]])
    return found


def _groups(hertz: np.ndarray) -> np.ndarray:
    return np.cumsum(np.diff(hertz, prepend=-np.inf) > _TOGETHER * hertz)
