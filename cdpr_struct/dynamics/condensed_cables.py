"""Cables condensed at a frequency shift to the motion of their ends and a few of their own lead functions.

Kept are the moving end and the first p functions across the chord in each plane; with all others eliminated exactly at
the squared frequency sigma (A, K and M the eliminated, kept and coupling blocks, M the unit matrix there),

    X = -A^-1 (K - sigma M),   C = M + X,   Y = A^-1 C,   Z = A^-1 Y,
    D(sigma + d) = D - d N - d^2 C^T Y - d^3 Y^T Y - d^4 Y^T Z - d^5 Z^T Z - ... .

The poles of this are the frequencies of the eliminated block, p + 1 times the string's, not those of the clamped cable.
A frame end that gives way moves along its springs' directions; these motions are eliminated with the others.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_freedoms import CableFreedoms
from cdpr_struct.dynamics.cables_of_poses import HangingCables
from cdpr_struct.dynamics.eliminated_motions import lowest_eliminated
from cdpr_struct.dynamics.string_functions import StringFunctions
from cdpr_struct.statics.small_systems import backward, cholesky, eliminate, forward, substituted_back

HIGHEST_TERM = 5
quietly = np.errstate(all="ignore")  # numbers of poses at which a shift is out of reach are nonsense, and dropped


@dataclass(frozen=True, slots=True, eq=False)
class Terms:
    """Coefficients of powers of d of the stiffness of kept motions: D, then those that it loses, N, C^T Y, ....

    Each (r, r, m, n), leads first, in N/m (times s^2, s^4, ...).
    leads : how many
    axes  : of the end, 0 a, 1 n, 2 y
    """

    of_power: tuple[np.ndarray, ...]
    leads: int
    axes: tuple[int, ...]

    @property
    def leads_own(self) -> list[np.ndarray]:
        """Lead blocks (p, p, m, n)."""
        return [term[: self.leads, : self.leads] for term in self.of_power]

    @property
    def coupling(self) -> list[np.ndarray]:
        """Blocks (p, e, m, n) of leads and end."""
        return [term[: self.leads, self.leads :] for term in self.of_power]

    @property
    def end(self) -> list[np.ndarray]:
        """Blocks (e, e, m, n) of the end."""
        return [term[self.leads :, self.leads :] for term in self.of_power]


@dataclass(frozen=True, slots=True, eq=False)
class CondensedCables:
    """Cables (m, n) condensed at shifts (n,): a part for every group of axes that are coupled with each other.

    Leads have unit mass N and none in common with the end, at the shift; those along n come before those along y.
    of_cables : (m, n) bounds below the frequencies of the eliminated motions, omega^2
    """

    parts: tuple[Terms, ...]
    of_cables: np.ndarray

    @property
    def lowest(self) -> np.ndarray:
        """(n,) the lowest bound."""
        return np.asarray(self.of_cables.min(axis=0))


@quietly
def condensed(
    cables: HangingCables, shift: np.ndarray, functions: StringFunctions, leads: int, highest: int = 1
) -> CondensedCables:
    """Cables at omega^2 = shift (n,) or (m, n), terms up to the power `highest` of d; of no meaning where
    shift >= `lowest`.

    leads : p, along n and along y each
    """
    densities = cables.densities(functions.nodes)
    blocks = [(functions.pairs @ d.reshape(len(d), -1)).reshape((-1, *cables.length.shape)) for d in densities]
    parts = []
    for axes, springs in cables.groups:
        freedoms = CableFreedoms.of(axes, springs, functions, leads)
        shared = freedoms.shared_mass(cables.frame, functions)
        matrix = _less_mass(freedoms.stiffness(blocks, functions, cables), freedoms, shared, shift * cables.per_squared)
        parts.append(_terms(matrix, freedoms, shared, cables, highest))
    held = None if cables.frame is None else cables.frame.along_axes * (0.5 * cables.length)
    bound = lowest_eliminated(densities, functions, leads, held)
    return CondensedCables(tuple(parts), bound / cables.per_squared)


def _less_mass(matrix: np.ndarray, freedoms: CableFreedoms, shared: np.ndarray, own: np.ndarray) -> np.ndarray:
    """The upper triangle of a stiffness (d, d, m, n), less `own` (m, n) times the mass."""
    for i, j in zip(*np.nonzero(np.triu(freedoms.mass)), strict=True):
        matrix[i, j] -= freedoms.mass[i, j] * own
    ends = freedoms.eliminated + freedoms.leads
    for row, _ in freedoms.held:
        matrix[row, ends:] -= shared[row, freedoms.leads :] * own
    return matrix


def _terms(
    matrix: np.ndarray, freedoms: CableFreedoms, coupled: np.ndarray, cables: HangingCables, highest: int
) -> Terms:
    """Condensation of the upper triangle `matrix` (d, d, m, n), which is used up."""
    c = freedoms.eliminated
    shares = eliminate(matrix, c)
    followed = substituted_back(shares, -matrix[:c, c:] / _pivots(matrix, c))
    carried = coupled + followed
    own = matrix[c:, c:].copy()
    for i in range(len(own)):
        own[i + 1 :, i] = own[i, i + 1 :]
    mass = freedoms.mass[c:, c:, None, None] + _product(coupled, followed) + _product(followed, carried)
    found = [own, mass]
    solved = carried
    for power in range(2, highest + 1, 2):
        before, solved = solved, _solved(shares, _pivots(matrix, c), solved)
        found.append(_product(before, solved))
        found += [_product(solved, solved)] if power < highest else []
    unit = 2.0 / cables.length
    scaled = [term * (unit * cables.per_squared**power) for power, term in enumerate(found)]
    return Terms(tuple(_unit_leads(scaled, freedoms.leads)), freedoms.leads, freedoms.axes)


def _pivots(matrix: np.ndarray, c: int) -> np.ndarray:
    """(c, 1, m, n)."""
    return matrix[np.arange(c), np.arange(c)][:, None]


def _solved(shares: list[np.ndarray], pivots: np.ndarray, right: np.ndarray) -> np.ndarray:
    """A^-1 right (c, r, m, n)."""
    found = np.array(right)
    for k in range(len(found)):
        for i in range(k + 1, len(found)):
            found[i] -= shares[k][i - k - 1] * found[k]
    return substituted_back(shares, found / pivots)


def _product(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """left^T right (r, s, ...) of (c, r, ...) and (c, s, ...)."""
    return np.asarray(sum(a[:, None] * b[None] for a, b in zip(left, right, strict=True)))


def _unit_leads(terms: list[np.ndarray], p: int) -> list[np.ndarray]:
    """The same in leads of unit mass that share none with the end."""
    lower = cholesky(terms[1][:p, :p])
    shared = backward(lower, forward(lower, terms[1][:p, p:]))
    found = []
    for term in terms:
        new, lead = np.empty_like(term), term[:p, :p]
        passed = _product(np.swapaxes(lead, 0, 1), shared)
        coupling = term[:p, p:] - passed
        new[:p, :p] = forward(lower, np.swapaxes(forward(lower, lead), 0, 1))
        new[:p, p:] = forward(lower, coupling)
        new[p:, :p] = np.swapaxes(new[:p, p:], 0, 1)
        end = _product(term[:p, p:], shared)
        new[p:, p:] = term[p:, p:] - end - np.swapaxes(end, 0, 1) + _product(shared, passed)
        found.append(new)
    return found
