"""The robot at one pose on cables condensed at a frequency shift, as arrays of small matrices.

The equations are those of `condensed_cables`, two powers of d further. At few poses small matrices of LAPACK's are
faster than long vectors: every cable is one, its plane and what is across it together. Kept of it are its moving end
and the first p functions along n and along y,

    D(sigma + d) = D - d N - d^2 T_2 - ... - d^7 T_7 - ...,   T_k = C^T A^(1 - k) C.

With g the lowest eigenvalue of A, all from d^7 on lies between that term and g / (g - d) times it, for d < g. A bound
below g is one over the largest sum of a row of |A^-1|.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from cdpr_struct.dynamics.cables_of_poses import HangingCables
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly, attachment, beside_cables, platform_mass_matrix
from cdpr_struct.dynamics.string_functions import string_functions

HIGHEST_TERM = 7
_SORTS = {(0, 0): 0, (0, 1): 1, (1, 0): 1, (1, 1): 2, (2, 2): 3}  # of stiffness density, by components a, n, y


def knows(point: OperatingPoint) -> bool:
    """One pose of a robot whose cables run from fixed points, uniform and fully flexible, to a rigid body."""
    robot = point.arrays
    ends = robot.has_yielding_frame_ends or robot.has_masts
    more = robot.bending_stiffness.any() or robot.added_mass.any() or robot.has_moving_parts or robot.has_lumps
    turned = robot.is_tilted or robot.has_cable_drag
    return not (ends or more or robot.has_guides or turned or robot.batch_shape or point.position.ndim > 1)


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A pose that `knows` accepts, every cable taut.

    cables  : of shape (m, 1)
    motion  : (m, 3, 6) motion of the cable ends along their a, n and y per motion of the platform
    mass, held : (6, 6) of the platform; stiffness beside the cables' ends
    strings : (m,) squared first frequencies of uniform strings with the cables' tensions at mid-cable
    """

    cables: HangingCables
    motion: np.ndarray
    mass: np.ndarray
    held: np.ndarray
    strings: np.ndarray

    @classmethod
    def of(cls, point: OperatingPoint, assembly: Assembly) -> "Pose":
        """At a point without batch axes."""
        cables = HangingCables.of(point.cables.at(None), point.arrays.linear_density)
        cos, sin = (part[:, 0] for part in cables.direction)
        x, y = point.cables.heading[:, 0], point.cables.heading[:, 1]
        axes = np.zeros((len(x), 3, 3))
        axes[:, 0] = np.stack([cos * x, cos * y, sin], axis=-1)
        axes[:, 1] = np.stack([-sin * x, -sin * y, cos], axis=-1)
        axes[:, 2, 0], axes[:, 2, 1] = -y, x
        mass, held = platform_mass_matrix(point.arrays, point.rotation), beside_cables(point, assembly)
        strings = (0.5 * np.pi) ** 2 * (cables.tension / cables.per_squared)[:, 0]
        return cls(cables, axes @ attachment(point), mass, held, strings)


@dataclass(frozen=True, slots=True, eq=False)
class CondensedPose:
    """Cables condensed at omega^2 = shift.

    terms : (8, m, 2 p + 3, 2 p + 3) D, N, T_2, ..., T_7 [N/m times s^2, s^4, ...] of the leads in the plane, the end's
        a and n, the leads across it and the end's y
    reach : g or less, by how much a squared frequency of eliminated motions is above the shift [rad^2/s^2]
    """

    pose: Pose
    shift: float
    terms: np.ndarray
    reach: float

    @property
    def leads(self) -> int:
        """p."""
        return (self.terms.shape[-1] - 3) // 2

    @property
    def motions(self) -> int:
        """k = 6 + 2 p m, kept of the whole robot."""
        return 6 + 2 * self.leads * self.terms.shape[1]

    def pencil(self) -> tuple[np.ndarray, np.ndarray]:
        """D and N (k, k) of the robot: the platform's motion first, then leads cable by cable."""
        m, p, motion = self.terms.shape[1], self.leads, self.pose.motion
        lead, end = self._lead, self._end
        pulled = self.terms[:2][..., end] @ motion
        matrix = np.zeros((2, self.motions, self.motions))
        matrix[:, :6, :6] = (np.swapaxes(motion, 1, 2) @ pulled[:, :, end]).sum(axis=1)
        matrix[0, :6, :6] += self.pose.held - self.shift * self.pose.mass
        matrix[1, :6, :6] += self.pose.mass
        coupling = pulled[:, :, lead].reshape(2, -1, 6)
        matrix[:, 6:, :6], matrix[:, :6, 6:] = coupling, np.swapaxes(coupling, 1, 2)
        own = self.terms[:2][:, :, lead[:, None], lead]
        for i in range(m):
            place = slice(6 + 2 * p * i, 6 + 2 * p * (i + 1))
            matrix[:, place, place] = own[:, i]
        return matrix[0], matrix[1]

    def between(self, modes: np.ndarray) -> np.ndarray:
        """(6, s, s) of T_2, ..., T_7 between motions (k, s)."""
        m, _, r = self.terms.shape[1:]
        kept = np.empty((m, r, modes.shape[1]))
        kept[:, self._lead] = modes[6:].reshape(m, -1, modes.shape[1])
        kept[:, self._end] = self.pose.motion @ modes[:6]
        return kept.reshape(m * r, -1).T @ (self.terms[2:] @ kept).reshape(HIGHEST_TERM - 1, m * r, -1)

    @property
    def _lead(self) -> np.ndarray:
        p = self.leads
        return np.r_[:p, p + 2 : 2 * p + 2]

    @property
    def _end(self) -> np.ndarray:
        return np.array([self.leads, self.leads + 1, -1])

    def encloses(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """(n,) bool: fewer squared frequencies than its number, from 1 on, lie below `low` (n,), no fewer below `high`.

        Below `low` the series' rest counts in full, below `high` it is left out.
        """
        n, gap = np.arange(len(low)), self.reach - (low - self.shift)
        sure = (gap > 0.0) & (high - self.shift < self.reach)
        last = np.concatenate([self.reach / np.where(sure, gap, 1.0), np.ones(len(high))])
        few, many = np.split(self._negative(np.concatenate([low, high]), last), 2)
        return sure & (few <= n) & (many > n)

    def _negative(self, squared: np.ndarray, last: np.ndarray) -> np.ndarray:
        """(n,) negative eigenvalues at `squared` (n,) of the series with its last term times `last` (n,)."""
        d, n = squared - self.shift, len(squared)
        powers = -(d ** np.arange(HIGHEST_TERM + 1)[:, None])
        powers[0] = 1.0
        powers[-1] *= last
        m, p = self.terms.shape[1], self.leads
        ends, negative = np.zeros((n, m, 3, 3)), np.zeros(n, dtype=int)
        for part, own in ((slice(p + 2), slice(2)), (slice(p + 2, None), slice(2, 3))):
            below, end = _without_leads(self.terms[:, :, part, part], powers, p)
            negative += below
            ends[:, :, own, own] = end.transpose(3, 2, 0, 1)
        motion = self.pose.motion
        stiffness = motion.reshape(-1, 6).T @ (ends @ motion).reshape(n, -1, 6)
        stiffness += self.pose.held - squared[:, None, None] * self.pose.mass
        return np.asarray(negative + (np.linalg.eigvalsh(stiffness) < 0.0).sum(axis=-1))


def _without_leads(terms: np.ndarray, powers: np.ndarray, leads: int) -> tuple[np.ndarray, np.ndarray]:
    """Negative pivots (n,) of the leads of terms (8, m, r, r) times powers (8, n), and what is left without them, the
    end's block (e, e, m, n)."""
    m, r = terms.shape[1:3]
    matrix = (np.moveaxis(terms, (0, 1), (3, 2)).reshape(r * r * m, -1) @ powers).reshape(r, r, m, -1)
    for k in range(leads):
        row = matrix[k, k + 1 :]
        matrix[k + 1 :, k + 1 :] -= (row / matrix[k, k])[:, None] * row
    first = np.arange(leads)
    return (matrix[first, first] < 0.0).sum(axis=(0, 1)), matrix[leads:, leads:]


@dataclass(frozen=True, slots=True, eq=False)
class _Layout:
    """Freedoms of a cable, the eliminated ones first.

    gather, there : (d, d) where in the table of blocks their stiffness is, and 1 or 0 for whether it is
    mass : (d, d)
    """

    gather: np.ndarray
    there: np.ndarray
    eliminated: int
    mass: np.ndarray


@cache
def _layout(order: int, leads: int) -> _Layout:
    functions = string_functions(order)
    inner = functions.bubbles
    dropped = [(c, f) for c in range(3) for f in range(leads if c else 0, inner)]
    plane, across = ([(c, f) for f in range(leads)] for c in (1, 2))
    kept = [*plane, (0, inner), (1, inner), *across, (2, inner)]
    component, function = np.array(dropped + kept).T
    sort = np.array([[_SORTS.get((i, j), -1) for j in component] for i in component])
    pair = functions.pair[function[:, None], function]
    same = component[:, None] == component
    mass = np.where(same, functions.mass[function[:, None], function], 0.0)
    return _Layout(4 * pair + np.maximum(sort, 0), np.where(sort < 0, 0.0, 1.0), len(dropped), mass)


def condensed_pose(pose: Pose, shift: float, order: int, leads: int) -> CondensedPose | None:
    """The pose with polynomials up to degree `order` and p = `leads`; None where the shift is not below every squared
    frequency of the eliminated motions."""
    layout, functions = _layout(order, leads), string_functions(order)
    density = np.concatenate(pose.cables.densities(functions.nodes), axis=-1) / pose.cables.per_squared
    blocks = functions.pairs @ density.reshape(len(density), -1)
    m = density.shape[1]
    table = np.moveaxis(blocks.reshape(-1, m, 4), 1, 0).reshape(m, -1)
    matrix = table[:, layout.gather] * layout.there - shift * layout.mass
    c = layout.eliminated
    cross, coupled = matrix[:, :c, c:], layout.mass[:c, c:]
    try:
        np.linalg.cholesky(matrix[:, :c, :c])
    except np.linalg.LinAlgError:
        return None
    inverse = np.linalg.inv(matrix[:, :c, :c])
    followed = -inverse @ cross
    chain = [coupled + followed]
    for _ in range(HIGHEST_TERM // 2):
        chain.append(inverse @ chain[-1])
    turned = [np.swapaxes(part, 1, 2) for part in chain]
    own = matrix[:, c:, c:] + np.swapaxes(cross, 1, 2) @ followed
    mass = layout.mass[c:, c:] + coupled.T @ followed + np.swapaxes(followed, 1, 2) @ chain[0]
    more = [turned[(k - 1) // 2] @ chain[k // 2] for k in range(2, HIGHEST_TERM + 1)]
    scale = 0.5 * pose.cables.density * pose.cables.length
    reach = 1.0 / np.abs(inverse).sum(axis=-1).max()
    return CondensedPose(pose, shift, np.stack([own, mass, *more]) * scale[..., None], float(reach))
