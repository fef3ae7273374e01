"""Following the platform from lengths and loads at which its pose is known to others.

Lengths and wrench change in a straight line from the known ones to the asked ones, in steps that adapt, and each
equilibrium is the next one's start. A step counts if the platform moved as its rates of motion at both ends say; else
it is tried in halves. Where even the smallest step fails, the equilibrium has ended (the platform rolls over, say), and
the jump is counted; where no other one is found there, the way ends.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import CableModel
from cdpr_struct.statics.energy_descent import arm_scale
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.locked_balance import LockedBalance
from cdpr_struct.statics.neutral_freedoms import stability

_SMALLEST = 2.0**-9  # step of a way of length 1
_AGREEMENT = 0.1  # largest difference between a step and what the rates at its ends say, of the step
_TURN = 0.35  # largest rotation in a step [rad]
_NOTHING = 1e-9  # [m]; shorter steps agree with anything
_DIFFERENCE = 1e-6  # of the way: for rates of motion


@dataclass(frozen=True, slots=True, eq=False)
class Continuation:
    """Where n platforms are led.

    position, rotation : (n, 3) [m], (n, 3, 3)
    steps : (n,) equilibria that led there
    jumps : (n,) of them that no continuous motion led to
    followed : (n,) share of the way before the first jump
    """

    position: np.ndarray
    rotation: np.ndarray
    steps: np.ndarray
    jumps: np.ndarray
    followed: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class _Way:
    """From readings (m,) of the encoders and a wrench (6,) on, by readings (n, m) and a wrench (6,)."""

    arrays: RobotArrays
    model: CableModel
    begin: np.ndarray
    change: np.ndarray
    wrench: np.ndarray
    added: np.ndarray

    def lengths(self, items: np.ndarray, share: np.ndarray) -> np.ndarray:
        """(k, m) readings at shares (k,) of the way."""
        found: np.ndarray = self.begin + share[:, None] * self.change[items]
        return found

    def loads(self, share: np.ndarray) -> np.ndarray:
        """(k, 6) wrenches at shares (k,) of the way [N, N m]."""
        return np.asarray(self.wrench + share[:, None] * self.added)

    def rates(self, items: np.ndarray, share: np.ndarray, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """(k, 6) motion of the platforms per share of the way, rotations as arcs [m]."""
        seen = self.model.seen(self.arrays)
        here, *there = (
            LockedBalance(seen, self.arrays.paid_out(self.lengths(items, at)), self.loads(at), self.model)
            for at in (share, share + _DIFFERENCE, share - _DIFFERENCE)
        )
        more, less = (balance.evaluate(position, rotation).wrench for balance in there)
        push = (more - less) / (2.0 * _DIFFERENCE)
        tangent = here.evaluate(position, rotation).tangent
        tangent = tangent + stability(seen, rotation, tangent).holding  # neutral freedoms stay where they are
        return np.linalg.solve(tangent, push[..., None])[..., 0] * _units(self.arrays)


def continued(
    arrays: RobotArrays,
    known: tuple[np.ndarray, np.ndarray, np.ndarray],
    lengths: np.ndarray,
    model: CableModel,
    wrench: np.ndarray,
    known_wrench: np.ndarray | None = None,
) -> Continuation:
    """Equilibria at lengths (n, m) that continuous motion from known ones leads to.

    Parameters
    ----------
    arrays : of one robot, without batch axes
    known : readings (m,) [m], position (3,) [m] and rotation (3, 3) of an equilibrium there
    lengths : (n, m) as the encoders say them [m]
    wrench : (6,) on the platform beside its weight [N, N m]
    known_wrench : (6,) that at the known lengths; None: the same
    """
    begin, position, rotation = known
    count = len(lengths)
    load = wrench if known_wrench is None else known_wrench
    way = _Way(arrays, model, begin, lengths - begin, load, wrench - load)
    place, turn = np.tile(position, (count, 1)), np.tile(rotation, (count, 1, 1))
    share, step = np.zeros(count), np.ones(count)
    steps, jumps, followed = np.zeros(count, dtype=int), np.zeros(count, dtype=int), np.ones(count)
    rate = way.rates(np.arange(count), share, place, turn)
    while (items := np.flatnonzero(share < 1.0)).size:
        end = np.minimum(share[items] + step[items], 1.0)
        size = end - share[items]
        found = forward(arrays, way.lengths(items, end), place[items], turn[items], model, way.loads(end))
        there = way.rates(items, end, found.position, found.rotation)
        turned = Rotation.from_matrix(found.rotation @ np.swapaxes(turn[items], -1, -2)).as_rotvec()
        moved = np.concatenate([found.position - place[items], turned], axis=-1) * _units(arrays)
        miss = np.linalg.norm(moved - 0.5 * size[:, None] * (rate[items] + there), axis=-1)
        smooth = found.stable & (miss <= _AGREEMENT * np.linalg.norm(moved, axis=-1) + _NOTHING)
        smooth &= np.linalg.norm(turned, axis=-1) <= _TURN
        taken = smooth | (size <= _SMALLEST)
        first = items[taken & ~smooth & (jumps[items] == 0)]
        followed[first] = share[first]
        there_is = taken & found.converged
        new = items[there_is]
        place[new], turn[new], rate[new] = found.position[there_is], found.rotation[there_is], there[there_is]
        share[items[taken]] = np.where(found.converged, end, 1.0)[taken]
        steps[new] += 1
        jumps[items[taken & ~smooth]] += 1
        step[items] = np.where(smooth, 2.0 * size, np.where(taken, size, 0.5 * size))
    return Continuation(place, turn, steps, jumps, followed)


def _units(arrays: RobotArrays) -> np.ndarray:
    """(6,) metres per unit of motion: rotations as arcs at the anchors' mean radius."""
    return np.repeat([1.0, arm_scale(arrays)], 3)
