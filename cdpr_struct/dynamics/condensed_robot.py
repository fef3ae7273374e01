"""The robot on condensed cables: a small standard eigenproblem about a frequency shift, and what it proves.

With platform and leads as unknowns, D - d N has as many negative eigenvalues as the robot has frequencies below
sigma + d, but for terms of the order d^2. Its eigenvalues d_i are Rayleigh-Ritz values: sigma + d_i lies above the i-th
squared frequency. Since C^T A(lambda)^-1 C <= N / (lambda_c - lambda), lambda_c the eliminated block's lowest,

    D(sigma + d) >= D - f(d) N,   f(d) = d g / (g - d),   g = lambda_c - sigma,

and with f(d) = d_i solved for d every squared frequency below lambda_c is enclosed:

    sigma + d_i g / (g + d_i)  <=  lambda_i  <=  sigma + d_i.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cables_of_poses import HangingCables
from cdpr_struct.dynamics.condensed_cables import CondensedCables, Terms, quietly
from cdpr_struct.dynamics.frame_springs import beside_springs
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import attachment, geometric_stiffness, platform_mass_matrix
from cdpr_struct.statics.small_systems import cholesky, forward


@dataclass(frozen=True, slots=True, eq=False)
class Platform:
    """The platform of a batch of poses.

    motion : (3, 6, m, n) motion of the cable ends along their a, n and y per motion of the platform
    mass, held : (6, 6, n) mass; stiffness beside the cables' ends
    """

    motion: np.ndarray
    mass: np.ndarray
    held: np.ndarray

    @classmethod
    def of(cls, point: OperatingPoint, cables: HangingCables) -> "Platform":
        """At poses (n)."""
        n = cables.length.shape[1]
        arrays = point.arrays
        arms = arrays.platform_anchors @ np.swapaxes(point.rotation, -1, -2)
        arm = np.moveaxis(np.broadcast_to(arms, point.cables.heading.shape), -1, 0).swapaxes(1, 2)
        axes = cables.axes(point.cables.heading)
        motion = np.concatenate([axes, np.cross(arm[None], axes, axis=1)], axis=1)
        mass = np.moveaxis(np.broadcast_to(platform_mass_matrix(arrays, point.rotation), (n, 6, 6)), 0, -1)
        held = np.zeros((6, 6, n))
        held[3:, 3:] = np.moveaxis(np.broadcast_to(geometric_stiffness(point), (n, 3, 3)), 0, -1)
        held[range(3), range(3)] += arrays.hose
        rest = beside_springs(point)
        if rest is not None:
            ends = np.moveaxis(attachment(point), -3, -4)
            held += np.moveaxis(np.swapaxes(ends, -1, -2) @ np.moveaxis(rest, 0, 1) @ ends, 1, -1).sum(axis=0)
        return cls(motion, np.ascontiguousarray(mass), held)

    def take(self, index: np.ndarray) -> "Platform":
        """Some poses."""
        return Platform(self.motion[..., index], self.mass[..., index], self.held[..., index])

    def of_ends(self, parts: "list[tuple[tuple[int, ...], np.ndarray]]") -> np.ndarray:
        """(6, 6, n), lower triangle, from axes and blocks (e, e, m, n) of the ends in them."""
        total = np.zeros((6, 6, self.motion.shape[-1]))
        for axes, block in parts:
            for row, axis in zip(block, axes, strict=True):
                moved = self._moved(row, axes)
                for i in range(6):
                    total[i, : i + 1] += (self.motion[axis, i] * moved[: i + 1]).sum(axis=1)
        return total

    def of_leads(self, parts: "list[tuple[tuple[int, ...], np.ndarray]]") -> np.ndarray:
        """(6, 2 p, m, n) from axes of the ends and blocks (p, e, m, n) of leads and ends."""
        return np.stack([self._moved(row, axes) for axes, block in parts for row in block], axis=1)

    def _moved(self, row: np.ndarray, axes: tuple[int, ...]) -> np.ndarray:
        """(6, m, n) of pulls (e, m, n) along some axes."""
        found = row[0] * self.motion[axes[0]]
        for pull, axis in zip(row[1:], axes[1:], strict=True):
            found += pull * self.motion[axis]
        return np.asarray(found)


@dataclass(frozen=True, slots=True, eq=False)
class Pencil:
    """D - d N of platform and leads at n poses, in coordinates in which N is the unit matrix.

    matrix : (n, 6 + 2 p m, 6 + 2 p m), lower triangle; leads are ordered by (plane and lead, cable)
    lower  : (6, 6, n) Cholesky factor of the platform's N
    shift, lowest : (n,) sigma and lambda_c
    """

    matrix: np.ndarray
    lower: np.ndarray
    shift: np.ndarray
    lowest: np.ndarray

    @property
    def squared(self) -> np.ndarray:
        """(n, k) sigma + d_i, ascending: above the squared frequencies; nan where the cables have no such shift."""
        matrix, known = self._finite
        return np.where(known[:, None], self.shift[:, None] + np.linalg.eigvalsh(matrix), np.nan)

    @property
    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """d_i (n, k), ascending, and vectors (n, k, k), columns of unit modal mass; of no use beyond `lowest`."""
        d, vectors = np.linalg.eigh(self._finite[0])
        return d, vectors

    def shares(self, vectors: np.ndarray, momentum: np.ndarray) -> np.ndarray:
        """(n, k) squared products of momenta (n, 6) with the modes' platform motions."""
        seen = forward(self.lower, np.moveaxis(momentum, 0, -1))
        return np.asarray(np.einsum("in,nik->nk", seen, vectors[:, :6]) ** 2)

    @property
    def _finite(self) -> tuple[np.ndarray, np.ndarray]:
        known = np.isfinite(self.matrix[:, :6, :6]).all(axis=(1, 2)) & (self.shift < self.lowest)
        if known.all():
            return self.matrix, known
        return np.where(known[:, None, None], self.matrix, np.eye(self.matrix.shape[1])), known

    def enclosed(self, squared: np.ndarray) -> np.ndarray:
        """(n, ...) lower ends of the intervals whose upper ends are sigma + d_i; minus infinity where not proved."""
        shape = (-1,) + (1,) * (squared.ndim - 1)
        d, gap = squared - self.shift.reshape(shape), (self.lowest - self.shift).reshape(shape)
        proved = (gap > 0.0) & (gap + d > 0.0)
        return np.where(proved, squared - d * d / np.where(proved, gap + d, 1.0), -np.inf)


@quietly
def pencil(platform: Platform, cables: CondensedCables, shift: np.ndarray) -> Pencil:
    """The robot's pencil at omega^2 = shift (n,)."""
    parts = cables.parts
    mass = platform.mass + platform.of_ends([(part.axes, part.end[1]) for part in parts])
    ends = platform.of_ends([(part.axes, part.end[0]) for part in parts])
    stiffness = _mirrored(ends + platform.held - shift * platform.mass)
    lower = cholesky(mass)
    own = forward(lower, np.swapaxes(forward(lower, stiffness), 0, 1))
    leads = platform.of_leads([(part.axes, part.coupling[0]) for part in parts])
    coupling = forward(lower, leads)
    return Pencil(_dense(own, coupling, parts), lower, shift, cables.lowest)


def _mirrored(lower: np.ndarray) -> np.ndarray:
    """(i, j, n) symmetric, from its lower triangle."""
    whole = lower.copy()
    for i in range(len(whole)):
        whole[:i, i] = whole[i, :i]
    return whole


def _dense(own: np.ndarray, coupling: np.ndarray, parts: tuple[Terms, ...]) -> np.ndarray:
    """(n, k, k), lower triangle."""
    _, two, m, n = coupling.shape
    k = 6 + two * m
    matrix = np.zeros((k, k, n))
    matrix[:6, :6] = own
    matrix[6:, :6] = np.swapaxes(coupling.reshape(6, two * m, n), 0, 1)
    cable, start = np.arange(m), 6
    for part in parts:
        block = part.leads_own[0]
        for i in range(part.leads):
            for j in range(i + 1):
                matrix[start + i * m + cable, start + j * m + cable] = block[i, j]
        start += part.leads * m
    return np.ascontiguousarray(np.moveaxis(matrix, -1, 0))
