"""How the motion of the platform in a mode changes: to first order, other modes are mixed into it.

Of modes v_i of unit modal mass, with Z_ij = v_i^T (dK - omega_i^2 dM) v_j,

    dv_i = sum over j != i of v_j Z_ij / (omega_i^2 - omega_j^2) - v_i (v_i^T dM v_i) / 2

(Fox and Kapoor, Rates of change of eigenvalues and eigenvectors, AIAA Journal 6, 1968). Z_ij is half of the difference
of the gradients of (v_i + v_j) / sqrt 2 and (v_i - v_j) / sqrt 2. Modes beyond those that were computed are left out.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cdpr_struct.dynamics.ritz_modes import RitzModes
from cdpr_struct.observation.expanded_modes import ExpandedModes

_FIELDS = ("platform", "end", "mast", "modal", "internal")
_MOVES = 0.02  # of the kinetic energy in the platform: modes with less bring no motion of it
_STEP = 1e-3  # relative, of omega^2, by which its gradient tells the modal mass; but for frames that give way linear
_APART = 1e-9  # relative distance of omega^2 below which two modes are one: what they mix is a matter of their sum


@dataclass(frozen=True, slots=True, eq=False)
class Mixing:
    """Modes of states (F,) of which some were kept, by their numbers (F, M) among all."""

    found: ExpandedModes
    kept: np.ndarray

    def rates(self, index: np.ndarray) -> np.ndarray:
        """(F, n, q, 6) change of the platform's motion in kept modes (F, q) by `Dependence.vector` (n)."""
        shapes, own = self.found.shapes, np.take_along_axis(self.kept, index, axis=1)
        others = _moving(shapes)
        (states, q), j = own.shape, others.shape[1]
        one = _taken(shapes, np.repeat(own, j, axis=1))
        other = _taken(shapes, np.tile(others, (1, q)))
        summed, differing = (self.found.gradient(_mixed(one, other, sign)) for sign in (1.0, -1.0))
        apart = one.omega**2 - other.omega**2
        apart = np.where(np.abs(apart) > _APART * one.omega**2, apart, np.inf)
        share = (0.5 * (summed - differing) / apart[:, None]).reshape((states, -1, q, j))
        motion = np.take_along_axis(shapes.platform, others[..., None], axis=1)
        alone = _taken(shapes, own)
        change = np.einsum("fnqj,fjc->fnqc", share, motion, optimize=True)
        return np.asarray(change - 0.5 * self._modal_mass(alone)[..., None] * alone.platform[:, None])

    def _modal_mass(self, modes: RitzModes) -> np.ndarray:
        """(F, n, q) change of v^T M v."""
        faster, slower = (replace(modes, omega=modes.omega * np.sqrt(1.0 + sign * _STEP)) for sign in (1.0, -1.0))
        change = self.found.gradient(faster) - self.found.gradient(slower)
        return np.asarray(-change / (2.0 * _STEP * modes.omega**2)[:, None])


def _moving(shapes: RitzModes) -> np.ndarray:
    """(F, j) the modes that move the platform most, as many in each state as do clearly in any."""
    energy = shapes.platform_energy
    count = int((energy > _MOVES).sum(axis=1).max())
    return np.argsort(-energy, axis=1, kind="stable")[:, :count]


def _taken(shapes: RitzModes, index: np.ndarray) -> RitzModes:
    """Modes (F, k), others in each state."""
    fields: dict[str, Any] = {}
    for name in ("omega", *_FIELDS):
        values = getattr(shapes, name)
        fields[name] = np.take_along_axis(values, index.reshape((*index.shape, *(1,) * (values.ndim - 2))), axis=1)
    return replace(shapes, **fields)


def _mixed(one: RitzModes, other: RitzModes, sign: float) -> RitzModes:
    """Sums (sign 1) or differences (-1) of modes, of unit modal mass, at the first one's omega."""
    return replace(one, **{name: (getattr(one, name) + sign * getattr(other, name)) / np.sqrt(2.0) for name in _FIELDS})
