"""What clamped cables add to the platform's stiffness: their poles one by one, and what is left of them without.

A damped cable with elasticity e and inertia I (`damping`) has at its end the stiffness

    e K - I M - sum_j I^2 / (e w_j^2 - I) l_j l_j'  =  e (K + sum_j w_j^2 l_j l_j') - I (M - sum_j l_j l_j')
                                                       - sum_j w_j^4 / (w_j^2 / e - I / e^2) l_j l_j'

with the static stiffness K, the mass M of static shapes, and the natural frequencies w_j and mass couplings l_j of the
clamped modes. On the right, all that changes with frequency is e, I and one reciprocal a pole: matrix products do the
rest. Real and imaginary parts lie apart, (.., 2, f), so that all operations run over long vectors of real numbers.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.damping import DampingLaw
from cdpr_struct.dynamics.modal_expansion import ModalExpansion

UPPER = np.triu_indices(6)
"""Rows and columns of the 21 entries of an upper triangle."""


@dataclass(frozen=True, slots=True, eq=False)
class CableFactors:
    """A damping law at f frequencies (f,) [rad/s]: elasticity [-] and inertia [rad^2/s^2] of m cables, each (m, f)."""

    omega: np.ndarray
    elasticity: np.ndarray
    inertia: np.ndarray

    def __getitem__(self, part: slice | np.ndarray) -> "CableFactors":
        """The same at some of the frequencies."""
        return CableFactors(self.omega[part], self.elasticity[:, part], self.inertia[:, part])

    @classmethod
    def of(cls, law: DampingLaw, omega: np.ndarray, first_frequency: np.ndarray) -> "CableFactors":
        """omega (f,), first_frequency (m,) of the clamped cables [rad/s]."""
        each = np.tile(omega, (len(first_frequency), 1)).T  # frequencies lie in a row: long vectors
        return cls(omega, law.elasticity(each, first_frequency).T, law.inertia(each, first_frequency).T)


@dataclass(frozen=True, slots=True, eq=False)
class CablePoles:
    """Natural frequencies of m clamped cables, all together, and the platform that they hold.

    omega_squared   : (p,) [rad^2/s^2]
    cable           : (p,) number of the cable, from 0
    strength        : (p, 21) of the pole in the platform's matrix, upper triangle
    static, mass    : (m, 21) what is left of each cable without poles, in the platform's matrix [N/m, kg, ..]
    rigid, inertia  : (21,) stiffness without cables and mass of the platform [N/m, kg, ..]
    """

    omega_squared: np.ndarray
    cable: np.ndarray
    strength: np.ndarray
    static: np.ndarray
    mass: np.ndarray
    rigid: np.ndarray
    inertia: np.ndarray

    def weights(self, chosen: np.ndarray) -> np.ndarray:
        """(21, p + 2 m + 2) by which `terms` of the chosen p poles are summed to upper triangles."""
        squared, strength = self.omega_squared[chosen][:, None], self.strength[chosen]
        own = np.asarray(self.cable[chosen] == np.arange(len(self.static))[:, None], dtype=float)
        static, mass = self.static + own @ (squared * strength), self.mass - own @ strength
        platform = self.rigid, -self.inertia
        return np.ascontiguousarray(np.vstack([-(squared**2) * strength, static, -mass, *platform]).T)

    def terms(self, chosen: np.ndarray, factors: CableFactors) -> np.ndarray:
        """(p + 2 m + 2, 2, f) reciprocals of the chosen poles' gaps, elasticity and inertia of all cables, 1, omega^2.

        Exactly at a pole the value is that just below it.
        """
        p, m = len(chosen), len(self.static)
        terms = np.empty((p + 2 * m + 2, 2, len(factors.omega)))
        if p:
            self._reciprocals(chosen, factors, terms[:p])
        terms[p : p + m], terms[p + m : -2] = _parts(factors.elasticity), _parts(factors.inertia)
        terms[-2, 0], terms[-1, 0], terms[-2:, 1] = 1.0, factors.omega**2, 0.0
        return terms

    def _reciprocals(self, chosen: np.ndarray, factors: CableFactors, gap: np.ndarray) -> None:
        """Write 1 / (w^2 / e - I / e^2) of the chosen poles to `gap` (p, 2, f)."""
        cable, squared = self.cable[chosen], self.omega_squared[chosen][:, None]
        inverse = 1.0 / factors.elasticity
        np.take(_parts(np.conj(inverse)), cable, axis=0, out=gap, mode="clip")
        gap *= squared[..., None]
        gap -= _parts(np.conj(factors.inertia * inverse**2))[cable]
        size = gap[:, 0] ** 2
        size += gap[:, 1] ** 2
        if not size.all():
            gap[:, 0] = np.where(size == 0.0, np.finfo(float).eps * squared, gap[:, 0])
            size = (gap**2).sum(axis=1)
        gap /= size[:, None]


def cable_poles(expansion: ModalExpansion, arms: np.ndarray, rigid: np.ndarray, inertia: np.ndarray) -> CablePoles:
    """Those of m cables that hold a platform.

    arms           : (m, 3, 6) attachment matrices
    rigid, inertia : (6, 6) stiffness without cables and mass of the platform [N/m, kg, ..]
    """
    to_cable = np.swapaxes(expansion.frame, -1, -2) @ arms
    modal = expansion.coupling @ to_cable
    omega_squared = expansion.omega_squared.ravel()
    return CablePoles(
        omega_squared,
        np.repeat(np.arange(len(modal)), modal.shape[1]),
        (modal[..., UPPER[0]] * modal[..., UPPER[1]]).reshape(len(omega_squared), 21),
        (np.swapaxes(to_cable, 1, 2) @ expansion.static_stiffness @ to_cable)[:, *UPPER],
        (np.swapaxes(to_cable, 1, 2) @ expansion.end_mass @ to_cable)[:, *UPPER],
        rigid[UPPER],
        inertia[UPPER],
    )


def weighted(weights: np.ndarray, terms: np.ndarray) -> np.ndarray:
    """(21, 2, f) sums of terms (n, 2, f) with weights (21, n)."""
    return np.asarray((weights @ terms.reshape(len(terms), -1)).reshape(len(weights), *terms.shape[1:]))


def _parts(values: np.ndarray) -> np.ndarray:
    """Real and imaginary part (n, 2, f) of (n, f)."""
    parts = np.empty((len(values), 2, values.shape[1]))
    parts[:, 0], parts[:, 1] = values.real, values.imag
    return parts
