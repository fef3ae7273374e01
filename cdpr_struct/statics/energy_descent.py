"""Newton descent of a platform's potential energy on positions and rotations, a flat batch at once."""

from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays

_SHORTEST_LIMIT, _LIMIT = 0.6, 0.06  # a step is at most 0.6 m or .06 of the reach, rotations as arcs
LARGEST_TURN = 0.5  # [rad]
_OVERSHOOT = 0.8  # a step is kept while the power at its end is above -0.8 of that at its start
_PUSH = 0.02  # [m] off a saddle, along its softest motion
_UNSTABLE = 1e-9  # of the largest eigenvalue: below minus that, the softest motion grows


@dataclass(frozen=True, slots=True, eq=False)
class Evaluation:
    """Wrench (n, 6) [N, N m], its tangent (n, 6, 6), symmetric but for an applied moment, and the tolerated residual
    (n,) [N]."""

    wrench: np.ndarray
    tangent: np.ndarray
    tolerance: np.ndarray


class Balance(Protocol):
    """A batch of platforms whose balance can be evaluated, and cut down to some of its items."""

    def take(self, index: np.ndarray) -> Self: ...

    def evaluate(self, position: np.ndarray, rotation: np.ndarray) -> Evaluation: ...

    def moved(
        self, position: np.ndarray, rotation: np.ndarray, motion: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]: ...


def longest_step(reach: float) -> float:
    """Longest step [m] of a robot whose cables are `reach` long [m]."""
    return max(_SHORTEST_LIMIT, _LIMIT * reach)


def arm_scale(arrays: RobotArrays) -> float:
    """Root mean square distance of the platform anchors from the platform origin, at least 1 mm [m]."""
    square = (arrays.platform_anchors**2).sum(axis=-1).mean()
    return float(max(np.sqrt(square), 1e-3))


class EnergyDescent:
    """State of the descent; fields are arrays over the flat batch (n).

    position, rotation, wrench : the last accepted pose and its wrench
    converged, iterations : (n,)

    scale : anchors' mean radius [m];  longest : of a step, rotations as arcs at that radius [m]
    """

    def __init__(
        self, balance: Balance, position: np.ndarray, rotation: np.ndarray, scale: float, longest: float
    ) -> None:
        self.balance, self.position, self.rotation, self.longest = balance, position, rotation, longest
        self.unit = np.array([1.0, 1.0, 1.0, scale, scale, scale])
        first = balance.evaluate(position, rotation)
        self.wrench, self.tangent = first.wrench, first.tangent
        self.converged = self._small(first)
        self.iterations = np.zeros(len(position), dtype=int)

    def run(self, limit: int, pushes: int = 0, spared: int = 0) -> None:
        """Step every item that is not balanced until it is, at most `limit` evaluations each.

        pushes : how often an item that is balanced but unstable is pushed along its softest motion, to descend again
        spared : so many items, the slowest, need not end
        """
        left, evaluated = np.full(len(self.converged), pushes), np.zeros(len(self.converged), dtype=int)
        items, step = np.flatnonzero(~self.converged), np.zeros(self.wrench.shape)
        step[items] = self._newton(items)
        pushed = self._push(np.flatnonzero(self.converged), step, left)
        items = np.sort(np.append(items, np.flatnonzero(pushed)))
        while len(items) > spared:
            part = self.balance.take(items)
            position, rotation = part.moved(self.position[items], self.rotation[items], step[items] / self.unit)
            there = part.evaluate(position, rotation)
            small = self._small(there) & ~pushed[items]
            accepted, shorter = self._judged(items, step[items], there, small | pushed[items])
            kept = items[accepted]
            self.position[kept], self.rotation[kept] = position[accepted], rotation[accepted]
            self.wrench[kept], self.tangent[kept] = there.wrench[accepted], there.tangent[accepted]
            self.converged[items] = small
            self.iterations[items] += ~pushed[items]
            evaluated[items] = np.where(pushed[items], 0, evaluated[items] + 1)
            step[items[~accepted]] *= shorter[~accepted, None]
            going = ~small & (evaluated[items] < limit)
            fresh = items[going & accepted]
            step[fresh] = self._newton(fresh)
            pushed = self._push(items[small], step, left)
            items = items[going | pushed[items]]

    def _judged(
        self, items: np.ndarray, step: np.ndarray, there: Evaluation, certain: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Which steps (k, 6) are kept, and to which share the others are cut."""
        before = np.einsum("ni,ni->n", self.wrench[items] / self.unit, step)
        after = np.einsum("ni,ni->n", there.wrench / self.unit, step)
        accepted = certain | (after >= -_OVERSHOOT * before) | (np.linalg.norm(step, axis=-1) < 1e-13)
        with np.errstate(over="ignore"):  # power that hardly falls: the longest step will do
            return accepted, np.clip(before / np.maximum(before - after, 1e-300), 0.1, 0.6)

    def _newton(self, items: np.ndarray) -> np.ndarray:
        scaled = self._scaled(self.tangent[items])
        return newton_step(scaled, self.wrench[items] / self.unit, self.unit[-1], self.longest)

    def _push(self, items: np.ndarray, step: np.ndarray, left: np.ndarray) -> np.ndarray:
        """(n,) bool: which of the balanced `items` are unstable and pushed; sets their steps and the pushes `left`."""
        pushed = np.zeros(len(left), dtype=bool)
        items = items[left[items] > 0]
        if items.size:
            values, vectors = np.linalg.eigh(symmetric(self._scaled(self.tangent[items])))
            off = values[:, 0] < -_UNSTABLE * np.abs(values[:, -1])
            step[items[off]] = _PUSH * vectors[off, :, 0]
            pushed[items[off]] = True
            left[items[off]] -= 1
        return pushed

    @property
    def stiffness(self) -> np.ndarray:
        """(n, 6) eigenvalues of the symmetric tangent, ascending, in scaled coordinates [N/m]."""
        return np.asarray(np.linalg.eigvalsh(symmetric(self._scaled(self.tangent))))

    def _small(self, there: Evaluation) -> np.ndarray:
        return np.linalg.norm(there.wrench / self.unit, axis=-1) <= there.tolerance

    def _scaled(self, tangent: np.ndarray) -> np.ndarray:
        return tangent / self.unit / self.unit[:, None]


def newton_step(tangent: np.ndarray, wrench: np.ndarray, scale: float, longest: float) -> np.ndarray:
    """Descent steps (n, 6) in scaled coordinates: Newton where the tangent is positive, else made positive."""
    force = np.linalg.norm(wrench, axis=-1)
    shift = 1e-14 * np.einsum("nii->n", np.abs(tangent)) + 1e-12 * force / longest + 1e-100
    step = np.linalg.solve(tangent + shift[:, None, None] * np.eye(6), wrench[..., None])[..., 0]
    power = np.einsum("ni,ni->n", step, wrench)
    size = np.linalg.norm(step, axis=-1)
    suspect = ~(power > 1e-6 * size * force) | (size > longest)
    if suspect.any():
        step[suspect] = _positive_step(tangent[suspect], wrench[suspect], longest)
    size = np.linalg.norm(step, axis=-1)
    turn = np.linalg.norm(step[:, 3:], axis=-1) / scale
    excess = np.maximum(np.maximum(size / longest, turn / LARGEST_TURN), 1.0)
    return step / excess[:, None]


def _positive_step(tangent: np.ndarray, wrench: np.ndarray, longest: float) -> np.ndarray:
    values, vectors = np.linalg.eigh(symmetric(tangent))
    force = np.linalg.norm(wrench, axis=-1, keepdims=True)
    floor = np.maximum(1e-9 * np.abs(values[:, -1:]), force / longest * 1e-3)
    values = np.maximum(np.abs(values), np.maximum(floor, 1e-300))
    return np.einsum("nij,nj->ni", vectors, np.einsum("nji,nj->ni", vectors, wrench) / values)


def symmetric(tangent: np.ndarray) -> np.ndarray:
    """The part (n, 6, 6) of a tangent that has an energy."""
    return np.asarray(0.5 * (tangent + np.swapaxes(tangent, -1, -2)))
