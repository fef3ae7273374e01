"""The linearised elastic catenary in the axes of its chord, with switches for what the closed form leaves out.

    (D u')' + omega^2 M u = 0,   D = EA t t^T + T / (1 + e) (1 - t t^T),   M = eta t t^T + (1 - t t^T)

in units of chord, chord tension and density, over the unstrained coordinate, by Galerkin's method with integrated
Legendre polynomials. With every effect on this is the product's exact model; the switches say what an effect is worth:

    along_weight    off: the weight along the chord is taken away, the tension varies with the sag only
    axial_inertia   off: eta = 0, the cable stretches without delay
    static_strain   off: e = 0, the cable at rest is inextensible
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import legendre

from cdpr_struct.crosscheck.limits_groups import CableGroups
from cdpr_struct.statics.catenary_length import length_at_chord_tension

_INEXTENSIBLE = 1e12
LOADED_MODES = 30  # that a mass at the end is coupled to; the first six frequencies are then good to 1e-5
ORDER = 24  # of the polynomials: the first eight modes of any cable in the audit to nine digits


@dataclass(frozen=True, slots=True)
class Effects:
    """What the reference contains beyond the closed form; all on: the elastic catenary itself."""

    along_weight: bool = True
    axial_inertia: bool = True
    static_strain: bool = True


EFFECTS = ("along_weight", "axial_inertia", "static_strain")


@dataclass(frozen=True, slots=True, eq=False)
class Plane:
    """Clamped modes and end shapes of n cables in one plane with c components, for each of e moving ends.

    omega_squared (n, p) ascending, modal mass one; modes (n, p, s, c) at the stations; static (n, e, c, c)
    stiffness of the end; coupling (n, e, p, c); end_mass (n, e, c, c). Axes: along the chord towards the moving
    end, and across it, up.
    """

    omega_squared: np.ndarray
    modes: np.ndarray
    static: np.ndarray
    coupling: np.ndarray
    end_mass: np.ndarray

    @property
    def frequencies(self) -> np.ndarray:
        """(n, p) Omega of the clamped cable."""
        return np.sqrt(self.omega_squared)

    def stiffness(self, frequency: np.ndarray) -> np.ndarray:
        """(n, e, f, c, c) dynamic stiffness of the moving end at Omega (n, f)."""
        squared = np.asarray(frequency)[:, None, :] ** 2
        gain = squared[..., None] ** 2 / (self.omega_squared[:, None, None, :] - squared[..., None])
        modal = np.einsum("nefp,nepa,nepb->nefab", np.broadcast_to(gain, (*self.coupling.shape[:2], *gain.shape[2:])),
                          self.coupling, self.coupling, optimize=True)  # fmt: skip
        return self.static[:, :, None] - squared[..., None, None] * self.end_mass[:, :, None] - modal

    def loaded_frequencies(self, mass_ratio: np.ndarray, count: int) -> np.ndarray:
        """(n, e, r, count) lowest Omega with a point mass of mass_ratio (r,) cable masses at the moving end."""
        size, slow = self.static.shape[-1], slice(0, LOADED_MODES)
        omega_squared, coupled = self.omega_squared[:, slow], self.coupling[:, :, slow]
        inverse = np.linalg.inv(np.linalg.cholesky(self.static))[:, :, None]
        n, ends, p, _ = coupled.shape
        carried = self.end_mass[:, :, None] + mass_ratio[:, None, None] * np.eye(size)
        matrix = np.zeros((n, ends, len(mass_ratio), size + p, size + p))
        matrix[..., :size, :size] = inverse @ carried @ np.swapaxes(inverse, -1, -2)
        weighted = coupled / np.sqrt(omega_squared)[:, None, :, None]
        side = np.swapaxes(inverse @ np.swapaxes(weighted, -1, -2)[:, :, None], -1, -2)
        matrix[..., size:, :size] = side
        matrix[..., :size, size:] = np.swapaxes(side, -1, -2)
        index = np.arange(size, size + p)
        matrix[..., index, index] = 1.0 / omega_squared[:, None, None, :]
        periods = np.linalg.eigvalsh(matrix)[..., ::-1][..., :count]
        return 1.0 / np.sqrt(periods)


@dataclass(frozen=True, slots=True, eq=False)
class CablePlanes:
    """Both planes of n cables; moving ends: 0 the upper one, 1 the lower one."""

    in_plane: Plane
    across: Plane


def reference_planes(groups: CableGroups, stations: np.ndarray, effects: Effects | None = None) -> CablePlanes:
    """The catenary about its true profile.

    Parameters
    ----------
    stations : (s,) fractions of the cable, where mode shapes are wanted
    """
    effects = effects or Effects()
    if not effects.along_weight:
        groups = replace(groups, along=np.zeros(len(groups)))
    rest = _AtRest.of(groups, effects)
    nodes, weights = legendre.leggauss(2 * ORDER + 16)
    tangent, tension, stretch = rest.line(0.5 * (nodes + 1.0))
    outer = tangent[..., :, None] * tangent[..., None, :]
    across = tension / stretch
    normal = np.eye(2) - outer
    stiffness = rest.axial_stiffness[:, None, None, None] * outer + across[..., None, None] * normal
    inertia = (1.0 if effects.axial_inertia else 0.0) * outer + normal
    unit = np.ones((len(groups), len(nodes), 1, 1))
    common = (nodes, weights, stations, rest.length)
    return CablePlanes(
        in_plane=_galerkin(stiffness, inertia, *common),
        across=_galerkin(across[..., None, None], unit, *common),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _AtRest:
    """Unstrained length (n,); in chord axes force at the upper end (n, 2) and weight per unstrained length (n, 2)."""

    length: np.ndarray
    force: np.ndarray
    weight: np.ndarray
    axial_stiffness: np.ndarray
    strains: bool

    @classmethod
    def of(cls, groups: CableGroups, effects: Effects) -> "_AtRest":
        stiff = 1.0 / groups.strain
        angle = np.arctan2(groups.along, groups.epsilon)
        cos, sin = np.cos(angle), np.sin(angle)
        at_rest = stiff if effects.static_strain else np.full(len(groups), _INEXTENSIBLE)
        held = length_at_chord_tension(cos, sin, np.ones(len(groups)), at_rest, groups.weight)
        force = np.stack([cos * held.force_x + sin * held.force_z, cos * held.force_z - sin * held.force_x], axis=-1)
        return cls(
            held.length, force, np.stack([-groups.along, -groups.epsilon], axis=-1), stiff, effects.static_strain
        )

    def line(self, fraction: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Tangent (n, q, 2), tension (n, q) and stretch 1 + e (n, q) at fractions (q,) of the unstrained length."""
        hanging = (1.0 - fraction)[None, :, None] * (self.length[:, None] * self.weight)[:, None, :]
        force = self.force[:, None, :] + hanging
        tension = np.linalg.norm(force, axis=-1)
        strain = tension / self.axial_stiffness[:, None] if self.strains else np.zeros_like(tension)
        return force / tension[..., None], tension, 1.0 + strain


def _galerkin(
    stiffness: np.ndarray,
    inertia: np.ndarray,
    nodes: np.ndarray,
    weights: np.ndarray,
    stations: np.ndarray,
    length: np.ndarray,
) -> Plane:
    """Clamped modes and end shapes from densities (n, q, c, c) over the unstrained length."""
    n, size = len(length), stiffness.shape[-1]
    values, slopes = _basis(nodes, ORDER)
    k = _assembled(slopes, stiffness * (weights[:, None, None] * (2.0 / length)[:, None, None, None]))
    m = _assembled(values, inertia * (weights[:, None, None] * (0.5 * length)[:, None, None, None]))
    inner, upper = slice(None, -2 * size), slice(-size, None)
    inverse = np.linalg.inv(np.linalg.cholesky(k[:, inner, inner]))
    turned = np.swapaxes(inverse, 1, 2)
    periods, modes = _slow_modes_first(inverse, m[:, inner, inner])
    half = inverse @ k[:, inner, upper]
    static = k[:, upper, upper] - np.swapaxes(half, 1, 2) @ half
    mirror = np.diag([-1.0, 1.0]) if size == 2 else np.eye(size)
    ends = _end_shapes(-turned @ half, mirror)
    carried = m[:, None] @ ends
    at_stations = _basis(2.0 * stations - 1.0, ORDER)[0][: ORDER - 1]
    return Plane(
        omega_squared=1.0 / periods,
        modes=np.einsum("is,nicp->npsc", at_stations, modes.reshape(n, ORDER - 1, size, -1), optimize=True),
        static=np.stack([static, mirror @ static @ mirror], axis=1),
        coupling=np.swapaxes(modes, 1, 2)[:, None] @ carried[:, :, inner],
        end_mass=np.swapaxes(ends, -1, -2) @ carried,
    )


def _slow_modes_first(inverse: np.ndarray, mass: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """1 / omega^2 (n, p) descending and modes (n, i, p) of unit modal mass; `inverse` of the stiffness's root."""
    turned = np.swapaxes(inverse, 1, 2)
    periods, vectors = np.linalg.eigh(inverse @ mass @ turned)
    periods, vectors = periods[:, ::-1], vectors[:, :, ::-1]
    periods = np.maximum(periods, np.finfo(float).eps * periods[:, :1])
    return periods, turned @ vectors / np.sqrt(periods)[:, None, :]


def _end_shapes(bubbles: np.ndarray, mirror: np.ndarray) -> np.ndarray:
    """Static shapes (n, 2, functions, c) of the upper and the lower end, the latter in the mirrored axes.

    bubbles : (n, i, c) of the upper end's shape; both shapes add up to a rigid displacement
    """
    n, count, size = bubbles.shape
    upper = np.zeros((n, count + 2 * size, size))
    upper[:, :count] = bubbles
    upper[:, count + size :] = np.eye(size)
    lower = -upper
    lower[:, count : count + size] += np.eye(size)
    lower[:, count + size :] += np.eye(size)
    return np.stack([upper, lower @ mirror], axis=1)


def _basis(xi: np.ndarray, order: int) -> tuple[np.ndarray, np.ndarray]:
    """Values and slopes (order + 1, q): bubbles, zero at both ends, then the ramps of the lower and the upper end."""
    polynomials = legendre.legvander(xi, order).T
    k = np.arange(2, order + 1)[:, None]
    bubbles = (polynomials[2:] - polynomials[:-2]) / np.sqrt(2.0 * (2 * k - 1))
    slopes = np.sqrt((2 * k - 1) / 2.0) * polynomials[1:-1]
    half = np.full_like(xi, 0.5)
    return np.vstack([bubbles, half * (1.0 - xi), half * (1.0 + xi)]), np.vstack([slopes, -half, half])


def _assembled(functions: np.ndarray, density: np.ndarray) -> np.ndarray:
    """(n, i c, j c) integrals of products of functions (i, q) under a density (n, q, c, c) that holds the weights."""
    count, (n, _, size, _) = len(functions), density.shape
    products = (functions[:, None, :] * functions[None, :, :]).reshape(count * count, -1)
    summed = products @ density.reshape(*density.shape[:2], size * size)
    blocks = summed.reshape(n, count, count, size, size)
    return np.ascontiguousarray(np.moveaxis(blocks, 3, 2)).reshape(n, count * size, count * size)
