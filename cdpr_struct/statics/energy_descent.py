"""Newton descent of a platform's potential energy on positions and rotations, a flat batch at once."""

from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays

_SHORTEST_LIMIT, _LIMIT = 0.6, 0.06  # a step is at most 0.6 m or .06 of the reach, rotations as arcs
LARGEST_TURN = 0.5  # [rad]
_OVERSHOOT = 0.8  # a step is kept while the power at its end is above -0.8 of that at its start
_PUSH = 0.02  # [m] off a saddle, along its softest motion


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

    def run(self, limit: int) -> None:
        """Step every item that is not balanced until it is, at most `limit` evaluations each."""
        items = np.flatnonzero(~self.converged)
        step = newton_step(
            self._scaled(self.tangent[items]), self.wrench[items] / self.unit, self.unit[-1], self.longest
        )
        for _ in range(limit):
            if not items.size:
                return
            part = self.balance.take(items)
            position, rotation = part.moved(self.position[items], self.rotation[items], step / self.unit)
            there = part.evaluate(position, rotation)
            self.iterations[items] += 1
            small = self._small(there)
            before = np.einsum("ni,ni->n", self.wrench[items] / self.unit, step)
            after = np.einsum("ni,ni->n", there.wrench / self.unit, step)
            accepted = small | (after >= -_OVERSHOOT * before)
            accepted |= np.linalg.norm(step, axis=-1) < 1e-13
            kept = items[accepted]
            self.position[kept], self.rotation[kept] = position[accepted], rotation[accepted]
            self.wrench[kept], self.tangent[kept] = there.wrench[accepted], there.tangent[accepted]
            self.converged[kept] = small[accepted]
            with np.errstate(over="ignore"):  # power that hardly falls: the longest step will do
                shorter = np.clip(before / np.maximum(before - after, 1e-300), 0.1, 0.6)
            step = np.where(accepted[:, None], step, shorter[:, None] * step)
            going = ~self.converged[items]
            items, step, fresh = items[going], step[going], accepted[going]
            scaled = self._scaled(self.tangent[items[fresh]])
            step[fresh] = newton_step(scaled, self.wrench[items[fresh]] / self.unit, self.unit[-1], self.longest)

    def leave_saddles(self, limit: int, attempts: int = 3) -> np.ndarray:
        """Push balanced but unstable items along their softest motion and descend again.

        Returns the eigenvalues of the symmetric tangent (n, 6), ascending, in scaled coordinates [N/m].
        """
        values = np.linalg.eigvalsh(symmetric(self._scaled(self.tangent)))
        for _ in range(attempts):
            items = np.flatnonzero(self.converged & (values[:, 0] < -1e-9 * np.abs(values[:, -1])))
            if not items.size:
                break
            softest = np.linalg.eigh(symmetric(self._scaled(self.tangent[items])))[1][:, :, 0]
            part, push = self.balance.take(items), _PUSH * softest / self.unit
            position, rotation = part.moved(self.position[items], self.rotation[items], push)
            there = part.evaluate(position, rotation)
            self.position[items], self.rotation[items] = position, rotation
            self.wrench[items], self.tangent[items] = there.wrench, there.tangent
            self.converged[items] = False
            self.run(limit)
            values[items] = np.linalg.eigvalsh(symmetric(self._scaled(self.tangent[items])))
        return values

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
