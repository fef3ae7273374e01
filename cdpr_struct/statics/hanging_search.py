"""The search for an orientation at which no moment is left about the free angles: Newton on many poses at once.

The tensions are those of least norm that balance the forces and the moments about the angles that are kept. Derivatives
are differences. If all three angles are free, the steps are turns about the world axes: angles have poses at which two
of their axes meet (ry = 90 deg), turns have none.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.batch_items import BatchItems
from cdpr_struct.statics.cable_models import CableModel
from cdpr_struct.statics.equilibrium import cable_wrench, platform_radius, rotation_from_vector
from cdpr_struct.statics.holding_tensions import HoldingProblem, allowed_unbalance
from cdpr_struct.statics.lost_cables import lost

WITHIN = 1e-8  # of load and tensions: what counts as balanced and within the bounds
BALANCED = 1e-11  # moment over arms times tensions
_ITERATIONS = 25
_DIFFERENCE = 1e-6  # [rad]
_LARGEST_TURN = 0.2  # of one step [rad]
_PARALLEL = 1e-9  # of axes of free angles that are taken for one


@dataclass(frozen=True, slots=True, eq=False)
class HangingProblem:
    """Positions (k, 3) [m], load (k, 6) [N, N m] beside the weight, bounds (k, m) [N]; free : (3,) bool."""

    arrays: RobotArrays
    model: CableModel
    position: np.ndarray
    wrench: np.ndarray
    bounds: tuple[np.ndarray, np.ndarray]
    free: np.ndarray

    def take(self, index: np.ndarray) -> "HangingProblem":
        low, high = self.bounds
        arrays = self.arrays.take(index)
        return HangingProblem(
            arrays, self.model, self.position[index], self.wrench[index], (low[index], high[index]), self.free
        )

    def at(self, angles: np.ndarray, tension: np.ndarray | None = None) -> "Hung":
        """Moments at angles (k, 3) [rad]; the search for the tensions begins at `tension` (k, m) [N]."""
        return self.hung(angles, rotation_from_angles(*np.moveaxis(angles, -1, 0)), tension)

    def turned(self, ends: "Hung", step: np.ndarray) -> "Hung":
        """Moments once the free angles have changed by steps (k, 3) [rad], or about the world axes if all are free."""
        return self.hung(*self.reoriented(ends, step), ends.tension)

    def reoriented(self, ends: "Hung", step: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Angles (k, 3) and rotations (k, 3, 3) after such steps."""
        if not self.free.all():
            angles = ends.angles + step
            return angles, rotation_from_angles(*np.moveaxis(angles, -1, 0))
        rotation = rotation_from_vector(step) @ ends.rotation
        return angles_from_rotation(rotation), rotation

    def hung(self, angles: np.ndarray, rotation: np.ndarray, tension: np.ndarray | None) -> "Hung":
        """Moments at angles (k, 3) [rad] and their rotations (k, 3, 3)."""
        holding = self.holding(angles, rotation)
        return self.measured(holding, angles, rotation, holding.solve(tension)[0])

    def holding(self, angles: np.ndarray, rotation: np.ndarray) -> HoldingProblem:
        """The search for tensions that balance all but the moments about the free angles."""
        problem = HoldingProblem.at(self.arrays, self.model, (self.position, rotation), self.wrench, self.bounds)
        return replace(problem, kept=_kept(self._axes(angles), self.free))

    def _axes(self, angles: np.ndarray) -> np.ndarray:
        """(k, 3, 3) rows: the axes about which steps of the free angles turn the platform."""
        return np.broadcast_to(np.eye(3), (*angles.shape, 3)) if self.free.all() else turning_axes(angles)

    def measured(
        self, problem: HoldingProblem, angles: np.ndarray, rotation: np.ndarray, tension: np.ndarray
    ) -> "Hung":
        """Moments that chord tensions (k, m) [N] leave; problem : of `holding` at these angles."""
        axes = self._axes(angles)
        states = self.model.hold(problem.arrays, problem.arms.points, tension).states
        left = cable_wrench(states, problem.arms) + problem.load
        pulls = np.linalg.norm(problem.load[:, :3], axis=1) + states.tension_at_platform.sum(axis=1)
        about = np.where(self.free, np.einsum("kij,kj->ki", axes, left[:, 3:]), 0.0)
        unbalanced = np.linalg.norm(problem.balanced(left / problem.unit), axis=1)
        carried = (unbalanced <= allowed_unbalance(self.arrays, WITHIN, pulls)) & ~lost(states).any(axis=1)
        moment = about / (platform_radius(self.arrays) * pulls)[:, None]
        return Hung(angles, rotation, tension, moment, carried, np.linalg.norm(left / problem.unit, axis=1) / pulls)


@dataclass(frozen=True, slots=True, eq=False)
class Hung(BatchItems):
    """angles (k, 3) [rad], rotations (k, 3, 3), chord tensions (k, m) [N], moments (k, 3) about the free angles over
    arms times tensions, whether the tensions balance all else (k,), and the wrench left over load and tensions (k,)."""

    angles: np.ndarray
    rotation: np.ndarray
    tension: np.ndarray
    moment: np.ndarray
    carried: np.ndarray
    left: np.ndarray

    @property
    def size(self) -> np.ndarray:
        """(k,) largest moment."""
        return np.asarray(np.abs(self.moment).max(axis=1))

    @property
    def found(self) -> np.ndarray:
        """(k,) bool: carried, with no moment left."""
        return np.asarray(self.carried & (self.size <= BALANCED))


def newton(problem: HangingProblem, ends: Hung) -> Hung:
    """Where Newton on the free angles ends; a step that does not reduce the moment is cut down."""
    items = np.flatnonzero(ends.size > BALANCED)
    step, share = np.zeros_like(ends.angles), np.ones(len(ends.angles))
    fresh = items
    for _ in range(_ITERATIONS):
        if not items.size:
            break
        if fresh.size:
            step[fresh] = _step(problem.take(fresh), ends.take(fresh))
        tried = problem.take(items).turned(ends.take(items), share[items, None] * step[items])
        better = tried.size < ends.size[items]
        ends.replaced(items[better], tried.take(better))
        share[items] = np.where(better, 1.0, 0.25 * share[items])
        going = (ends.size[items] > BALANCED) & (share[items] > 1e-3)
        items, fresh = items[going], items[going & better]
    return ends


def _step(problem: HangingProblem, ends: Hung) -> np.ndarray:
    """(k, 3) Newton step of the free angles [rad]."""
    free, k = np.flatnonzero(problem.free), len(ends.angles)
    every = np.tile(np.arange(k), len(free))
    shifts = np.repeat(_DIFFERENCE * np.eye(3)[free], k, axis=0)
    there = problem.take(every).turned(ends.take(every), shifts).moment
    rates = np.moveaxis((there.reshape((-1, k, 3)) - ends.moment) / _DIFFERENCE, 0, -1)[:, free]
    step = np.zeros_like(ends.angles)
    step[:, free] = -(np.linalg.pinv(rates, rcond=1e-8) @ ends.moment[:, free, None])[..., 0]
    return within_largest_turn(step)


def within_largest_turn(step: np.ndarray) -> np.ndarray:
    """Steps (k, 3) [rad], shortened where one of their turns is larger than a search may take."""
    return step * np.minimum(1.0, _LARGEST_TURN / np.maximum(np.abs(step).max(axis=1, keepdims=True), 1e-300))


def turning_axes(angles: np.ndarray) -> np.ndarray:
    """(..., 3, 3) rows: world axes about which rx, ry and rz (..., 3) [rad] turn the platform."""
    _, ry, rz = np.moveaxis(angles, -1, 0)
    zero, one = np.zeros_like(ry), np.ones_like(ry)
    first = np.stack([np.cos(rz) * np.cos(ry), np.sin(rz) * np.cos(ry), -np.sin(ry)], axis=-1)
    return np.stack(
        [first, np.stack([-np.sin(rz), np.cos(rz), zero], axis=-1), np.stack([zero, zero, one], -1)], axis=-2
    )


def _kept(axes: np.ndarray, free: np.ndarray) -> np.ndarray:
    """(k, 3, 3) projection on the moments that do no work when the free angles change."""
    rows = axes[:, free]
    return np.asarray(np.eye(3) - np.linalg.pinv(rows, rcond=_PARALLEL) @ rows)
