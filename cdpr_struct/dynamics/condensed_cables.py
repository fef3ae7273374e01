"""Cables condensed at a frequency shift to the motion of their ends and a few of their own lead functions.

A hanging cable moves along and across its chord's tension at mid-cable (a, n) and out of the plane (y). With tension T
and F its parts along a and n, the stiffness density of (D u')' + mu omega^2 u = 0 in these axes is

    D = G + E F F^T  in the plane,  G  across it,   G = T / (1 + T / EA),   E = (EA - G) / T^2.

Kept are the moving end and the first p functions across the chord in each plane; with all others eliminated exactly at
the squared frequency sigma (A, K and M the eliminated, kept and coupling blocks, M the unit matrix there),

    X = -A^-1 (K - sigma M),   C = M + X,   Y = A^-1 C,   Z = A^-1 Y,
    D(sigma + d) = D - d N - d^2 C^T Y - d^3 Y^T Y - d^4 Y^T Z - d^5 Z^T Z - ... .

The poles of this are the frequencies of the eliminated block, p + 1 times the string's, not those of the clamped cable.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.string_functions import StringFunctions
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.small_systems import backward, cholesky, eliminate, forward, substituted_back

HIGHEST_TERM = 5
quietly = np.errstate(all="ignore")  # numbers of poses at which a shift is out of reach are nonsense, and dropped
_SHARES = (1.0, 0.7, 0.5)  # of the ratio of the string's functions: the r that are tried for the bound below


@dataclass(frozen=True, slots=True, eq=False)
class HangingCables:
    """Cables of a batch of poses, all (m, n).

    along, middle  : horizontal and mid-cable vertical pull [N]
    length, weight, stiff, density : L [m], w [N/m], EA [N], mu [kg/m]
    """

    along: np.ndarray
    middle: np.ndarray
    length: np.ndarray
    weight: np.ndarray
    stiff: np.ndarray
    density: np.ndarray

    @classmethod
    def of(cls, cables: CableStates, density: np.ndarray) -> "HangingCables":
        """From states (n, m) and linear densities, broadcast against them."""
        shape = cables.length.shape

        def first(value: np.ndarray) -> np.ndarray:
            return np.ascontiguousarray(np.broadcast_to(value, shape).T)

        middle = cables.force_z - 0.5 * cables.weight * cables.length
        rest = (cables.length, cables.weight, cables.axial_stiffness, density)
        return cls(*(first(value) for value in (cables.force_x, middle, *rest)))

    def take(self, index: np.ndarray) -> "HangingCables":
        """Some poses."""
        return HangingCables(*(getattr(self, name)[:, index] for name in self.__slots__))

    @property
    def tension(self) -> np.ndarray:
        """(m, n) at mid-cable [N]."""
        return np.hypot(self.along, self.middle)

    @property
    def sag_ratio(self) -> np.ndarray:
        """(m, n) w L / T [-]."""
        return self.weight * self.length / self.tension

    @property
    def direction(self) -> tuple[np.ndarray, np.ndarray]:
        """Horizontal and vertical part (m, n) of the unit vector a."""
        return self.along / self.tension, self.middle / self.tension

    @property
    def per_squared(self) -> np.ndarray:
        """(m, n) mu L^2 / 4 [kg m]: from omega^2 to the functions' own scale [N]."""
        return 0.25 * self.density * self.length**2

    def densities(self, nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """D_aa, D_an, D_nn and D_yy (q, m, n) [N] at nodes (q,)."""
        ahead, across = self._pull(nodes)
        squared = ahead**2 + across**2
        tension = np.sqrt(squared)
        soft = tension / (1.0 + tension / self.stiff)
        excess = (self.stiff - soft) / squared
        return soft + excess * ahead**2, excess * ahead * across, soft + excess * across**2, soft

    def out_of_plane(self, nodes: np.ndarray) -> np.ndarray:
        """D_yy (q, m, n) [N] at nodes (q,)."""
        tension = np.hypot(*self._pull(nodes))
        return np.asarray(tension / (1.0 + tension / self.stiff))

    def _pull(self, nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        cos, sin = self.direction
        change = 0.5 * self.weight * self.length * nodes[:, None, None]
        return self.tension + sin * change, cos * change


@dataclass(frozen=True, slots=True, eq=False)
class Terms:
    """Coefficients of powers of d of the stiffness of kept motions: D, then those that it loses, N, C^T Y, ....

    Each (r, r, m, n), leads first, in N/m (times s^2, s^4, ...).
    """

    of_power: tuple[np.ndarray, ...]
    leads: int

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
    """Cables (m, n) condensed at shifts (n,): in the plane (leads, a, n) and out of it (leads, y).

    Leads have unit mass N and none in common with the end, at the shift.
    lowest : (n,) bound below the frequencies of the eliminated motions, omega^2
    """

    in_plane: Terms
    out_of_plane: Terms
    lowest: np.ndarray


@quietly
def condensed(
    cables: HangingCables, shift: np.ndarray, functions: StringFunctions, leads: int, highest: int = 1
) -> CondensedCables:
    """Cables at omega^2 = shift (n,), terms up to the power `highest` of d; of no meaning where shift >= `lowest`."""
    densities = cables.densities(functions.nodes)
    blocks = [(functions.pairs @ d.reshape(len(d), -1)).reshape((-1, *cables.length.shape)) for d in densities]
    own = shift * cables.per_squared
    planes = []
    for components in ((0, 1), (2,)):
        layout = _layout(components, functions, leads)
        matrix = _gathered(blocks, layout, functions)
        for i, j in zip(*np.nonzero(np.triu(layout.mass)), strict=True):
            matrix[i, j] -= layout.mass[i, j] * own
        planes.append(_terms(matrix, layout, cables, leads, highest))
    return CondensedCables(planes[0], planes[1], _lowest(cables, densities, functions, leads))


@dataclass(frozen=True, slots=True, eq=False)
class _Layout:
    """Freedoms of a plane: component (0 a, 1 n, 2 y) and function of each, the eliminated ones first; mass (d, d)."""

    component: np.ndarray
    function: np.ndarray
    eliminated: int
    mass: np.ndarray


def _layout(components: Sequence[int], functions: StringFunctions, leads: int) -> _Layout:
    inner, across = functions.count - 1, components[-1]
    dropped = [(c, f) for c in components for f in range(leads if c == across else 0, inner)]
    kept = [(across, f) for f in range(leads)] + [(c, inner) for c in components]
    component, function = np.array(dropped + kept).T
    same = component[:, None] == component[None, :]
    mass = np.where(same, functions.mass[function[:, None], function[None, :]], 0.0)
    return _Layout(component, function, len(dropped), mass)


def _gathered(blocks: list[np.ndarray], layout: _Layout, functions: StringFunctions) -> np.ndarray:
    """Stiffness (d, d, m, n), upper triangle."""
    d = len(layout.component)
    matrix = np.empty((d, d, *blocks[0].shape[1:]))
    for i in range(d):
        for component in set(layout.component[i:].tolist()):
            columns = i + np.flatnonzero(layout.component[i:] == component)
            sort = 3 if component == 2 else layout.component[i] + component
            matrix[i, columns] = blocks[sort][functions.pair[layout.function[i], layout.function[columns]]]
    return matrix


def _terms(matrix: np.ndarray, layout: _Layout, cables: HangingCables, leads: int, highest: int) -> Terms:
    """Condensation of the upper triangle `matrix` (d, d, m, n), which is used up."""
    c = layout.eliminated
    shares = eliminate(matrix, c)
    coupled = layout.mass[:c, c:, None, None]
    followed = substituted_back(shares, -matrix[:c, c:] / _pivots(matrix, c))
    carried = coupled + followed
    own = matrix[c:, c:].copy()
    for i in range(len(own)):
        own[i + 1 :, i] = own[i, i + 1 :]
    mass = layout.mass[c:, c:, None, None] + _product(coupled, followed) + _product(followed, carried)
    found = [own, mass]
    solved = carried
    for power in range(2, highest + 1, 2):
        before, solved = solved, _solved(shares, _pivots(matrix, c), solved)
        found.append(_product(before, solved))
        found += [_product(solved, solved)] if power < highest else []
    unit = 2.0 / cables.length
    scaled = [term * (unit * cables.per_squared**power) for power, term in enumerate(found)]
    return Terms(tuple(_unit_leads(scaled, leads)), leads)


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


def _lowest(
    cables: HangingCables, densities: tuple[np.ndarray, ...], functions: StringFunctions, leads: int
) -> np.ndarray:
    """(n,) omega^2 below which no eliminated motion has a frequency.

    For any r < D_aa / G, D >= diag(r G, b) along and across the chord with b = D_nn - D_an^2 / (D_aa - r G). Squared
    frequencies are then no less than r G (b) times those of the string's functions eliminated along it (across it).
    """
    aa, an, nn, soft = densities
    first, across = functions.string[0], functions.string[leads]
    most, least = 0.5 * (aa / soft).min(axis=0), soft.min(axis=0)
    bounds = []
    for ratio in (np.minimum(share * across / first, most) for share in _SHARES):
        own = across * (nn - an**2 / (aa - ratio * soft)).min(axis=0)
        bounds.append(np.minimum(own, np.minimum(ratio * first, across) * least))
    return np.asarray((np.max(bounds, axis=0) / cables.per_squared).min(axis=0))
