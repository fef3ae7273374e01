"""Which chord tensions balance the platform at fixed poses with the least norm? A sequence of quadratic programs."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import CableModel, HeldCables
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, load_wrench
from cdpr_struct.statics.minimum_norm import QuadraticPrograms, solve_programs

MAX_ITERATIONS = 60
_STALLED = 8  # iterations without the unbalanced wrench shrinking by a tenth end the search,
_STALLED_NEAR = 20  # and so many where less than
_NEAR = 1e-5  # of the load is unbalanced
_TAUT = 0.8  # w chord / (2 tau) of a start well on the taut side of the tension minimum
_REACH = 1e4  # largest tension over load that a search starts from
_RISING = 0.05  # least growth of the platform tension with the chord tension at which its bounds are linearised
_OF_WEIGHT = 1e-3  # of the platform: most that counts as balanced


@dataclass(frozen=True, slots=True, eq=False)
class HoldingProblem:
    """A flat batch (k) of poses to be held.

    load      : (k, 6) weight and external wrench about the platform origin [N, N m]
    low, high : (k, m) bounds on the tensions at the platform [N]
    unit      : (k, 6) 1 for forces, the anchors' mean radius [m] for moments; inf where a guide takes them
    careful   : solve every program to the end, also where the structure matrix loses rank
    kept      : (k, 3, 3) which moments are balanced: products of its rows with the moment; None for all
    """

    arrays: RobotArrays
    model: CableModel
    arms: PlatformArms
    load: np.ndarray
    low: np.ndarray
    high: np.ndarray
    unit: np.ndarray
    careful: bool = False
    kept: np.ndarray | None = None

    @classmethod
    def at(
        cls,
        arrays: RobotArrays,
        model: CableModel,
        pose: tuple[np.ndarray, np.ndarray],
        external_wrench: np.ndarray,
        bounds: tuple[np.ndarray, np.ndarray],
    ) -> "HoldingProblem":
        """Problem at positions (k, 3) and rotations (k, 3, 3)."""
        arms = PlatformArms.at(arrays, *pose)
        radius = np.sqrt((arms.arms**2).sum(axis=-1).mean(axis=-1))
        unit = np.ones((len(radius), 6))
        unit[:, 3:] = np.maximum(radius, 1e-3)[:, None]
        unit[np.broadcast_to(arrays.guided > 0.0, unit.shape)] = np.inf
        return cls(arrays, model, arms, load_wrench(arrays, arms) + external_wrench, *bounds, unit)

    def take(self, index: np.ndarray) -> "HoldingProblem":
        """Some items."""
        arms = PlatformArms(self.arms.points[index], self.arms.arms[index], self.arms.center[index])
        rest = (self.load[index], self.low[index], self.high[index], self.unit[index])
        kept = None if self.kept is None else self.kept[index]
        return HoldingProblem(self.arrays.take(index), self.model, arms, *rest, self.careful, kept)

    def solve(self, start: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Chord tensions (k, m) [N], iterations (k,), and whether the last step was negligible (k,)."""
        tension = self.straight_tensions(self.high) if start is None else start
        best = tension.copy()
        count = len(tension)
        iterations, settled = np.zeros(count, dtype=int), np.zeros(count, dtype=bool)
        least, since = np.full(count, np.inf), np.zeros(count, dtype=int)
        items, dual = np.arange(count), np.zeros((count, 6))
        for _ in range(MAX_ITERATIONS):
            step, unbalanced, dual[items] = self.take(items)._step(tension[items], dual[items])
            small = np.abs(step).max(axis=1) <= 1e-11 * tension[items].max(axis=1)
            begun_balanced = (iterations[items] == 0) & (unbalanced <= 1e-9 * self._size(items))
            better = (unbalanced <= 0.9 * least[items]) & ~begun_balanced  # outside the bounds: the way in unbalances
            best[items[better]] = tension[items[better]]
            least[items] = np.where(better, unbalanced, least[items])
            since[items] = np.where(better | (unbalanced <= 1e-9 * self._size(items)), 0, since[items] + 1)
            settled[items] = small
            tension[items] += step
            iterations[items] += 1
            patience = np.where(unbalanced <= _NEAR * self._size(items), _STALLED_NEAR, _STALLED)
            items = items[~small & (since[items] < patience)]
            if not items.size:
                break
        balanced = least <= 1e-6 * self._size(np.arange(count))
        return np.where(balanced[:, None], tension, best), iterations, settled

    def straight_tensions(self, high: np.ndarray) -> np.ndarray:
        """(k, m) least-norm tensions [N] of straight cables within the bounds, as far as they balance the load."""
        chord = np.linalg.norm(self._chords, axis=-1)
        weight = self.arrays.cable_load(self._chords)[0] * chord + self.arrays.lump_weight.sum(axis=-1)
        shallow = np.where(self._least() > 0.0, 0.5 * weight / _TAUT, 0.0)
        low = np.maximum(self.low, shallow)
        ones = np.ones_like(low)
        reach = _REACH * np.maximum(np.linalg.norm(self.load / self.unit, axis=1, keepdims=True), low)
        top = np.maximum(np.minimum(high, reach), 2.0 * low)
        tension, _ = self._program(ones, 0.0 * ones, self.straight_matrix(), self.load, low, top)
        return np.maximum(tension, 1e-9 * np.linalg.norm(self.load, axis=1, keepdims=True))

    def linearised(self, tension: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Scaled wrench (k, 6) at chord tensions (k, m) [N], and its derivative by them (k, 6, m)."""
        held = self.model.hold(self.arrays, self.arms.points, tension)
        matrix = np.swapaxes(self._wrench_rates(held.force_rate), -1, -2) / self.unit[..., None]
        return matrix, (cable_wrench(held.states, self.arms) + self.load) / self.unit

    def straight_cables_balance(self) -> np.ndarray:
        """(k,) bool: the tensions of straight cables that a search begins from balance the load."""
        tension = self.straight_tensions(self.high)
        wrench = ((self.straight_matrix() * tension[..., None]).sum(axis=1) + self.load) / self.unit
        return np.asarray(np.linalg.norm(wrench, axis=1) <= 1e-6 * np.linalg.norm(self.load / self.unit, axis=1))

    def unbounded_tensions(self) -> tuple[np.ndarray, np.ndarray]:
        """Tensions (k, m) [N] of straight cables that could also push, and the wrench (k, 6) that even these leave."""
        matrix = np.swapaxes(self.straight_matrix(), -1, -2) / self.unit[..., None]
        tension = -(np.linalg.pinv(matrix, rcond=1e-10) @ (self.load / self.unit)[..., None])
        left = (np.swapaxes(self.straight_matrix(), -1, -2) @ tension)[..., 0] + self.load
        return tension[..., 0], np.where(np.isfinite(self.unit), left, 0.0)

    def _size(self, items: np.ndarray) -> np.ndarray:
        size: np.ndarray = np.linalg.norm(self.load[items] / self.unit[items], axis=1)
        return size + self.low[items].sum(axis=1) if self.arrays.is_weightless else size

    def _least(self) -> np.ndarray:
        return self.model.least_chord_tension(self.arrays, self.arms.points)

    @property
    def _chords(self) -> np.ndarray:
        """(k, m, 3) from the frame anchors to the platform anchors, world [m]."""
        return self.arms.points - self.arrays.frame_anchors

    @property
    def up(self) -> np.ndarray:
        """(k, m, 3) unit vector against weight and drag of each cable, world."""
        return self.arrays.cable_load(self._chords)[1]

    def straight_matrix(self) -> np.ndarray:
        """(k, m, 6) wrench per newton of straight cables, world [-, m]."""
        offset = -self._chords
        return self._wrench_rates(offset / np.linalg.norm(offset, axis=-1)[..., None])

    def _wrench_rates(self, force_rate: np.ndarray) -> np.ndarray:
        """(k, m, 6) of forces (k, m, 3) at the platform anchors."""
        return np.concatenate([force_rate, np.cross(self.arms.arms, force_rate)], axis=-1)

    def _step(self, tension: np.ndarray, dual: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Change (k, m) of the chord tensions by the program around them, imbalance (k,), and multipliers (k, 6)."""
        held = self.model.hold(self.arrays, self.arms.points, tension)
        force, rate = held.states.force_on_platform, held.force_rate
        growth = np.einsum("kmi,kmi->km", force, rate)
        matrix = self._wrench_rates(rate)
        wrench = cable_wrench(held.states, self.arms) + self.load
        low, high = self._step_bounds(held, growth, tension)
        curvature = self._curvature(held, dual)
        step, multipliers = self._program(curvature, growth, matrix, wrench, low, high)
        return step, np.linalg.norm(self.balanced(wrench / self.unit), axis=1), multipliers

    def _curvature(self, held: HeldCables, dual: np.ndarray) -> np.ndarray:
        """(k, m) second derivative of cost minus multipliers times balance, kept positive."""
        lever = self.arms.arms
        scaled = (dual / self.unit)[:, None, :]
        up = self.up
        along_up = (scaled[..., :3] * up + scaled[..., 3:] * np.cross(lever, up)).sum(axis=-1)
        first = np.einsum("kmi,kmi->km", held.force_rate, held.force_rate)
        return np.maximum(
            first + ((held.states.force_on_platform * up).sum(axis=-1) - along_up) * held.bend, 0.1 * first
        )

    def _step_bounds(self, held: HeldCables, growth: np.ndarray, tension: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        pull = held.states.tension_at_platform
        slope = growth / np.maximum(pull, 1e-300)
        rising = slope > _RISING
        safe = np.where(rising, slope, 1.0)
        least = self._least()
        low = np.maximum(np.where(rising, (self.low - pull) / safe, -np.inf), least - tension)
        low = np.where(least > 0.0, np.maximum(low, -0.5 * tension), low)
        high = np.where(rising, (self.high - pull) / safe, 2.0 * tension)
        far = 4.0 * tension + np.linalg.norm(self.load / self.unit, axis=1, keepdims=True)
        high = np.maximum(np.minimum(high, far), low)
        return np.minimum(low, high), high

    def _program(
        self,
        curvature: np.ndarray,
        gradient: np.ndarray,
        matrix: np.ndarray,
        wrench: np.ndarray,
        low: np.ndarray,
        high: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray]:
        scaled = self.balanced(np.swapaxes(matrix, -1, -2) / self.unit[..., None])
        programs = QuadraticPrograms(curvature, gradient, scaled, self.balanced(-wrench / self.unit), low, high)
        step, dual = solve_programs(programs, self.careful)
        if self.kept is not None:
            dual[:, 3:] = np.einsum("kij,ki->kj", self.kept, dual[:, 3:])
        return step, dual

    def balanced(self, scaled: np.ndarray) -> np.ndarray:
        """Scaled wrenches (k, 6) or (k, 6, m) without the moments that need no balance."""
        if self.kept is None:
            return scaled
        rows = scaled if scaled.ndim == 3 else scaled[..., None]
        return np.concatenate([rows[:, :3], self.kept @ rows[:, 3:]], axis=1).reshape(scaled.shape)


def allowed_unbalance(arrays: RobotArrays, share: float, pulls: np.ndarray) -> np.ndarray:
    """(...) wrench [N] that may be left where load and tensions, together `pulls` (...) [N], balance but for a share.

    Never more than a thousandth of the platform's weight: tensions beyond all measure would else balance anything.
    """
    weight = arrays.mass * arrays.gravity
    return np.asarray(np.where(weight > 0.0, np.minimum(share * pulls, _OF_WEIGHT * weight), share * pulls))


def force_bounds(lower: npt.ArrayLike, upper: npt.ArrayLike, m: int) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of the tensions of m cables, each (..., m) [N].

    Raises
    ------
    ValueError : bounds that are negative or crossed, or of another number of cables.
    """
    low, high = np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
    if not ((low >= 0.0).all() and np.isfinite(low).all()):
        raise ValueError(f"lower_bound must be finite and >= 0 N, got {low.min()!r}")
    pair = []
    for name, bound in (("lower_bound", low), ("upper_bound", high)):
        if bound.ndim and bound.shape[-1] not in (1, m):
            raise ValueError(f"{name} must have one entry per cable ({m}), got shape {bound.shape}")
        pair.append(np.broadcast_to(bound, (*bound.shape[:-1], m)))
    if not (low < high).all():
        raise ValueError(f"upper_bound must be above lower_bound, got {high.min()!r} N and {low.max()!r} N")
    return pair[0], pair[1]
