"""Forward kinematics (3.2.1b): which pose does the platform take at locked cable lengths?

Six unknowns a pose. The potential energy of platform, cables and load is minimised by Newton steps with the exact
tangent, so what is found is a stable equilibrium. The energy itself is never formed: its change along a step d is
judged by the power of the wrench W at both ends, -(W_old + W_new) d / 2, which keeps full precision near the end.
"""

from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from cdpr_struct.errors import ConvergenceError
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import CableModel, cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.energy_descent import EnergyDescent, arm_scale, longest_step
from cdpr_struct.statics.equilibrium import PlatformArms, tangent_stiffness
from cdpr_struct.statics.locked_balance import LockedBalance
from cdpr_struct.statics.lost_cables import lost
from cdpr_struct.statics.neutral_freedoms import stability, turned_least
from cdpr_struct.statics.stiffening import settled_stiffness
from cdpr_struct.statics.tension_winches import pulls_as_held

MAX_ITERATIONS = 500  # stiff cables, far from rest: of 10 000 random robots, eleven take more than 200, none 360
_PUSHES = 3  # off saddles, of a pose


class ForwardStatus(IntEnum):
    """What the solver found for one pose."""

    CONVERGED = 0
    NOT_STABLE = 1  # balanced, but a small motion grows
    NOT_CONVERGED = 2
    NEUTRAL = 3  # balanced, and free to move in some direction: a platform that spins about one cable, say


@dataclass(frozen=True, slots=True, eq=False)
class ForwardSolution:
    """Poses at locked lengths; leading axes (...) are the batch.

    position, rotation : (..., 3) [m], (..., 3, 3) platform to world
    cables             : CableStates (..., m)
    residual_wrench    : (..., 6) what is left unbalanced [N, N m]
    least_stiffness    : (...) smallest eigenvalue of the tangent, rotations as arcs at the anchors' mean radius [N/m]
    iterations, status : (...); `ForwardStatus` values
    """

    position: np.ndarray
    rotation: np.ndarray
    cables: CableStates
    residual_wrench: np.ndarray
    least_stiffness: np.ndarray
    iterations: np.ndarray
    status: np.ndarray

    @property
    def converged(self) -> np.ndarray:
        """(...) bool: the wrench is balanced (stable or not)."""
        return self.status != ForwardStatus.NOT_CONVERGED

    @property
    def stable(self) -> np.ndarray:
        """(...) bool: balanced, and no small motion grows; neutral freedoms are allowed."""
        return (self.status == ForwardStatus.CONVERGED) | (self.status == ForwardStatus.NEUTRAL)

    @property
    def tensions(self) -> np.ndarray:
        """(..., m) at the platform [N]."""
        return self.cables.tension_at_platform

    def require_converged(self) -> "ForwardSolution":
        """Self, or ConvergenceError with the worst residual."""
        if not self.converged.all():
            left = np.linalg.norm(self.residual_wrench[~self.converged], axis=-1)
            what = f"forward kinematics at {left.size} of {self.status.size} poses"
            hint = "Start nearer to the expected pose, or check that the lengths (and winch_tension) fit the robot."
            raise ConvergenceError(what, float(left.max()), int(self.iterations.max()), hint)
        return self


def forward(
    robot: Robot | RobotArrays,
    lengths: npt.ArrayLike,
    position: npt.ArrayLike | None = None,
    rotation: npt.ArrayLike | None = None,
    model: str | CableModel = "sagging",
    external_wrench: npt.ArrayLike | None = None,
    mass: npt.ArrayLike | None = None,
    spared: int = 0,
) -> ForwardSolution:
    """Stable pose of the platform at locked unstrained cable lengths, or held tensions where winches hold these.

    All batch axes (...) broadcast: lengths, starting poses, loads, masses, and the fields of a `RobotArrays`.

    Parameters
    ----------
    lengths : (..., m) unstrained, from the frame anchors on, as the encoders say them [m]; any positive number where
        the winch holds the tension
    position, rotation : (..., 3) [m], (..., 3, 3), where to start; default below the frame anchors, not rotated
    model : "sagging", "spring" or "ideal"
    external_wrench : (..., 6) on the platform about its origin, world axes, beside its weight [N, N m]
    mass : (...) of the platform in place of the robot's [kg]
    spared : so many items of the batch, the slowest, are not awaited and stay unconverged

    Returns
    -------
    ForwardSolution. The equilibrium in whose basin the start lies, if there are several.

    Raises
    ------
    ValueError : a length that is not positive, or shapes that do not fit.
    """
    arrays = RobotArrays.of(robot, None if mass is None else np.asarray(mass, dtype=float))
    reading = np.asarray(lengths, dtype=float)
    length = arrays.paid_out(reading) if reading.shape[-1:] == (arrays.cable_count,) else reading[..., :0]
    if not length.size or not (length > 0.0).all():
        raise ValueError(f"lengths must be (..., {arrays.cable_count}) and > 0, got {reading.tolist()!s:.200}")
    wrench = np.zeros(6) if external_wrench is None else np.asarray(external_wrench, dtype=float)
    start = starting_position(arrays, length) if position is None else np.asarray(position, dtype=float)
    turn = np.eye(3) if rotation is None else np.asarray(rotation, dtype=float)
    cores = (length.shape[:-1], wrench.shape[:-1], start.shape[:-1], turn.shape[:-2], arrays.batch_shape)
    shape = np.broadcast_shapes(*cores)
    place, turns = _flat(start, shape, 1), _flat(turn, shape, 2)
    balance = LockedBalance(
        arrays.flattened(shape), _flat(length, shape, 1), _flat(wrench, shape, 1), cable_model(model)
    )
    begun, entered, sizes = turns.copy(), balance.arrays, (arm_scale(arrays), longest_step(_reach(balance, place)))
    *first, last = balance.model.approach()
    stiffens = balance.arrays.stiffens
    for station in (*first, last):
        balance = replace(balance, arrays=station.seen(entered), model=station)
        descent = EnergyDescent(balance, place, turns, *sizes)
        descent.run(MAX_ITERATIONS, *((_PUSHES, spared) if station is last and not stiffens else ()))
        place, turns = descent.position, descent.rotation
    if stiffens:
        balance, descent, settled = _stiffening(balance, descent, sizes)
        descent.run(MAX_ITERATIONS, _PUSHES)
        descent.converged &= settled
    return _solution(descent, balance, shape, begun)


def _stiffening(
    balance: LockedBalance, descent: EnergyDescent, sizes: tuple[float, float]
) -> tuple[LockedBalance, EnergyDescent, np.ndarray]:
    """Descents with the stiffness that the cables have at their tension, until it stays, and where (...) it did."""

    def tension() -> np.ndarray:
        return balance.states(descent.position, descent.rotation).tension_at_platform

    def again(arrays: RobotArrays) -> np.ndarray:
        nonlocal balance, descent
        balance = replace(balance, arrays=arrays)
        descent = EnergyDescent(balance, descent.position, descent.rotation, *sizes)
        descent.run(MAX_ITERATIONS)
        return tension()

    settled = settled_stiffness(balance.arrays, tension(), again)
    return balance, descent, settled


def _reach(balance: LockedBalance, place: np.ndarray) -> float:
    """Mean length of the cables, or half their mean distance at the start (k, 3) if that is larger [m]."""
    apart = np.linalg.norm(balance.arrays.frame_anchors - place[:, None], axis=-1)
    return max(float(balance.length.mean()), 0.5 * float(apart.mean()))


def starting_position(arrays: RobotArrays, length: np.ndarray) -> np.ndarray:
    """(..., 3) a point under the middle of the frame anchors, as deep as the lengths allow on average; the middle
    itself where there is no gravity [m]."""
    middle = arrays.frame_anchors.mean(axis=-2)
    reach = np.linalg.norm(arrays.frame_anchors - middle[..., None, :], axis=-1)
    depth = np.sqrt(np.maximum(length**2 - reach**2, 0.0)).mean(axis=-1)
    start = np.array(np.broadcast_to(middle, (*np.broadcast_shapes(depth.shape, middle.shape[:-1]), 3)))
    return np.asarray(start + np.where(arrays.gravity > 0.0, depth, 0.0)[..., None] * arrays.down)


def _flat(value: np.ndarray, shape: tuple[int, ...], core_axes: int) -> np.ndarray:
    core = value.shape[value.ndim - core_axes :]
    return np.array(np.broadcast_to(value, shape + core)).reshape((-1, *core))


def _solution(
    descent: EnergyDescent,
    balance: LockedBalance,
    shape: tuple[int, ...],
    begun: np.ndarray,
) -> ForwardSolution:
    """The state of a descent; `begun`: rotations (n, 3, 3) at its start, which neutral freedoms keep."""
    states = balance.states(descent.position, descent.rotation)
    cables = CableStates(
        *(getattr(states, name).reshape(shape + getattr(states, name).shape[1:]) for name in states.__slots__)
    )
    arms = PlatformArms.at(balance.arrays, descent.position, descent.rotation)
    held = stability(balance.arrays, descent.rotation, tangent_stiffness(balance.arrays, states, arms))
    position, rotation = turned_least(held, descent.position, descent.rotation, begun)
    status = np.where(held.neutral > 0, ForwardStatus.NEUTRAL, ForwardStatus.CONVERGED)
    status[held.unstable] = ForwardStatus.NOT_STABLE
    open_ = ~descent.converged | ~pulls_as_held(balance.arrays, states) | lost(states).any(axis=1)
    status[open_] = ForwardStatus.NOT_CONVERGED
    return ForwardSolution(
        position=position.reshape((*shape, 3)),
        rotation=rotation.reshape((*shape, 3, 3)),
        cables=cables,
        residual_wrench=descent.wrench.reshape((*shape, 6)),
        least_stiffness=descent.stiffness[:, 0].reshape(shape),
        iterations=descent.iterations.reshape(shape),
        status=status.reshape(shape),
    )
