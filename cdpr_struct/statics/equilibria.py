"""Which stable equilibria does a platform have at locked cable lengths?

Descents begin at poses that cover all orientations; what they end at is told apart by place and orientation. The search
is a sample: an equilibrium with a small basin can escape it. Cables may cross each other and the platform.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import CableModel
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.energy_descent import arm_scale
from cdpr_struct.statics.forward_kinematics import (
    ForwardSolution,
    ForwardStatus,
    forward,
    starting_position,
)
from cdpr_struct.statics.potential_energy import potential_energy
from cdpr_struct.statics.slack_cables import hangs_slack

STARTS = 128
_SPARED = 16  # of the starts, the slowest: they find nothing more at 200 poses of four robots, little of random ones
_SAME = 1e-3  # of the anchors' mean radius: equilibria nearer to each other are one
_ALIKE = 1e-6  # of the largest tension: tensions nearer to each other are the same
_SPIRAL = 1.533751168755204288  # root of x^4 = x + 4


@dataclass(frozen=True, slots=True, eq=False)
class Equilibria:
    """Stable equilibria at the same locked lengths, the lowest energy first.

    position, rotation : (k, 3) [m], (k, 3, 3)
    energy : (k,) potential energy above that of the pose they were sought beside [J]
    least_stiffness : (k,) [N/m], rotations as arcs
    cables : CableStates (k, m)
    starts : descents that the search took
    """

    position: np.ndarray
    rotation: np.ndarray
    energy: np.ndarray
    least_stiffness: np.ndarray
    cables: CableStates
    starts: int

    @property
    def count(self) -> int:
        """k."""
        return len(self.energy)

    @property
    def slack(self) -> np.ndarray:
        """(k,) number of cables that hang slack."""
        return hangs_slack(self.cables).sum(axis=-1)


def other_equilibria(
    arrays: RobotArrays, lengths: np.ndarray, answer: ForwardSolution, model: CableModel, wrench: np.ndarray
) -> Equilibria:
    """Stable equilibria other than a known one.

    Parameters
    ----------
    arrays : of one robot, without batch axes
    lengths : (m,) as the encoders say them [m]
    answer : the known one, without batch axes
    wrench : (6,) on the platform beside its weight [N, N m]
    """
    place = np.tile(answer.position, (STARTS, 1))
    place[1::4] = starting_position(arrays, arrays.paid_out(lengths))
    place, turn = _as_guided(arrays, answer, place, _orientations(STARTS))
    found = forward(arrays, lengths, place, turn, model, wrench, spared=_SPARED)
    good = np.flatnonzero(found.stable)
    first = _told_apart(found, good, answer, arm_scale(arrays))
    states = found.cables.at(first)
    energy = potential_energy(model.seen(arrays), found.position[first], found.rotation[first], states, wrench)
    own = potential_energy(model.seen(arrays), answer.position, answer.rotation, answer.cables, wrench)
    order = np.argsort(energy)
    kept = first[order]
    return Equilibria(
        found.position[kept],
        found.rotation[kept],
        energy[order] - own,
        found.least_stiffness[kept],
        found.cables.at(kept),
        STARTS,
    )


def _as_guided(
    arrays: RobotArrays, answer: ForwardSolution, place: np.ndarray, turn: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Starts (n, 3), (n, 3, 3) with what a guide holds as in the answer; turns about guided axes are left out."""
    if not arrays.has_guides:
        return place, turn
    free = arrays.free
    vectors = Rotation.from_matrix(turn).as_rotvec() * free[3:]
    turned = Rotation.from_rotvec(vectors).as_matrix() @ answer.rotation
    return np.where(free[:3] > 0.0, place, answer.position), turned


def _told_apart(found: ForwardSolution, good: np.ndarray, answer: ForwardSolution, radius: float) -> np.ndarray:
    """Items of `good` that are neither the answer nor an earlier one."""
    place = np.concatenate([answer.position[None], found.position[good]])
    turn = np.concatenate([answer.rotation[None], found.rotation[good]])
    apart = np.linalg.norm(place[:, None] - place, axis=-1) + radius * np.linalg.norm(
        turn[:, None] - turn, axis=(-2, -1)
    )
    near = (apart <= _SAME * radius) | _turned_alike(found, good, answer)
    return np.asarray(good[~np.tril(near, -1).any(axis=1)[1:]])


def _turned_alike(found: ForwardSolution, good: np.ndarray, answer: ForwardSolution) -> np.ndarray:
    """(1 + g, 1 + g) bool: with a neutral freedom, poses of equal tensions, which that motion connects."""
    free = np.append(answer.status, found.status[good]) == ForwardStatus.NEUTRAL
    pulls = np.concatenate([answer.tensions[None], found.tensions[good]])
    alike = np.abs(pulls[:, None] - pulls).max(axis=-1) <= _ALIKE * pulls.max()
    return np.asarray(alike & free[:, None] & free)


def _orientations(count: int) -> np.ndarray:
    """(count, 3, 3) rotations spread evenly: the super-Fibonacci spiral of quaternions (Alexa 2022)."""
    step = np.arange(count) + 0.5
    inner, outer = np.sqrt(step / count), np.sqrt(1.0 - step / count)
    first, second = 2.0 * np.pi * step / np.sqrt(2.0), 2.0 * np.pi * step / _SPIRAL
    parts = inner * np.sin(first), inner * np.cos(first), outer * np.sin(second), outer * np.cos(second)
    return np.asarray(Rotation.from_quat(np.stack(parts, axis=-1)).as_matrix())
