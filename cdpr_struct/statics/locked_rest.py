"""Where does the platform rest at locked cable lengths, and how sure is it that this is the pose that was meant?

Without a start, the platform is led from its home pose to the asked lengths by continuous motion; then other stable
equilibria at these lengths are sought. Where an applied moment turns the platform away on this way, it is led to its
rest without the moment first, and the moment is then raised: what has no energy can turn a platform on and on.
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import numpy.typing as npt

from cdpr_struct.errors import ConvergenceError
from cdpr_struct.robot.pose import Pose, angle_between
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import CableModel, cable_model
from cdpr_struct.statics.continuation import Continuation, continued
from cdpr_struct.statics.equilibria import Equilibria, other_equilibria
from cdpr_struct.statics.forward_kinematics import ForwardSolution, forward, starting_position
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.pose_error import reference_lengths

UPSET = np.radians(60.0)  # a platform that turned further than this from its start may have rolled over
Way = Literal["continued", "descended"]


@dataclass(frozen=True, slots=True, eq=False)
class LockedRest:
    """A platform at rest at locked lengths.

    solution : ForwardSolution without batch axes
    start    : where the search began
    way      : "continued" from the start's own lengths, or "descended" from the start at the asked ones
    steps    : equilibria on the way that was continued
    jumps    : of them that no continuous motion led to; from there on the platform may be another way up
    others   : other stable equilibria that were found
    """

    solution: ForwardSolution
    start: Pose
    way: Way
    steps: int
    jumps: int
    others: Equilibria

    @property
    def turned(self) -> float:
        """Angle between the platform's orientations at the start and at rest [rad]."""
        return turned(self.start, self.solution)


def turned(start: Pose, solution: ForwardSolution) -> float:
    """Angle between the platform's orientations at the start and at rest [rad]."""
    return float(angle_between(start.rotation, solution.rotation))


def locked_rest(
    robot: Robot,
    lengths: npt.ArrayLike,
    start: Pose | None = None,
    model: str = "sagging",
    external_wrench: npt.ArrayLike | None = None,
) -> LockedRest:
    """Stable equilibrium at locked lengths, with what else is known about it.

    Parameters
    ----------
    lengths : (m,) unstrained, as the encoders say them [m]
    start : pose near which the equilibrium is sought; without it, the way continues from the home pose, or descends
        from below the frame anchors if the robot has none
    external_wrench : (6,) on the platform beside its weight [N, N m]

    Raises
    ------
    ConvergenceError : no equilibrium was found; under an applied moment, which share of it one was followed to.
    """
    arrays, chosen = RobotArrays.of(robot), cable_model(model)
    wrench = np.zeros(6) if external_wrench is None else np.asarray(external_wrench, dtype=float)
    asked = np.asarray(lengths, dtype=float)
    begin = start or robot.home or Pose(starting_position(arrays, arrays.paid_out(asked)), np.zeros(3))
    led, solution = _found(robot, arrays, asked, (start, begin), chosen, wrench)
    moment = np.concatenate([np.zeros(3), arrays.moment + wrench[3:]])
    if moment.any() and _astray(solution, begin, led):
        led, solution = _with_moment_raised(robot, arrays, asked, (start, begin), chosen, (wrench, moment))
    solution.require_converged()
    steps, jumps = (0, 0) if led is None else (int(led.steps[0]), int(led.jumps[0]))
    others = other_equilibria(arrays, asked, solution, chosen, wrench)
    return LockedRest(solution, begin, "descended" if led is None else "continued", steps, jumps, others)


def _found(
    robot: Robot,
    arrays: RobotArrays,
    asked: np.ndarray,
    starts: tuple[Pose | None, Pose],
    model: CableModel,
    wrench: np.ndarray,
) -> tuple[Continuation | None, ForwardSolution]:
    """The way from home, if no start was given, and where the platform rests from its end."""
    start, begin = starts
    led = _from_home(robot, arrays, asked, model, wrench) if start is None else None
    place, turn = (begin.position, begin.rotation) if led is None else (led.position[0], led.rotation[0])
    return led, forward(arrays, asked, place, turn, model, wrench)


def _astray(solution: ForwardSolution, begin: Pose, led: Continuation | None) -> bool:
    """Whether no stable rest was found, or one to which no continuous motion may lead."""
    jumped = led is not None and bool(led.jumps[0])
    return not bool(solution.stable) or jumped or turned(begin, solution) > UPSET


def _with_moment_raised(
    robot: Robot,
    arrays: RobotArrays,
    asked: np.ndarray,
    starts: tuple[Pose | None, Pose],
    model: CableModel,
    loads: tuple[np.ndarray, np.ndarray],
) -> tuple[Continuation | None, ForwardSolution]:
    """The same, the applied moment raised from nothing at the asked lengths.

    Raises
    ------
    ConvergenceError : the equilibrium ends before the moment is whole, and none is found beyond.
    """
    (wrench, moment), first = loads, model.approach()[0]
    before, free = _found(robot, arrays, asked, starts, first, wrench - moment)
    if not free.stable:
        return _found(robot, arrays, asked, starts, model, wrench)
    known = (asked, free.position, free.rotation)
    led = continued(arrays, known, asked[None], first, wrench, wrench - moment)
    solution = forward(arrays, asked, led.position[0], led.rotation[0], model, wrench)
    if not solution.converged:
        raise _turned_away(float(np.linalg.norm(moment)), float(led.followed[0]), solution)
    if before is None:
        return None, solution
    return replace(led, steps=led.steps + before.steps, jumps=led.jumps + before.jumps), solution


def _turned_away(moment: float, followed: float, solution: ForwardSolution) -> ConvergenceError:
    """Error about a moment [N m] of which only a share is held."""
    return ConvergenceError(
        f"forward kinematics under a moment of {moment:.4g} N m",
        float(np.linalg.norm(solution.residual_wrench)),
        int(solution.iterations),
        "Raised from nothing at these lengths, the moment turns the platform out of its stable equilibrium beyond "
        f"{followed * moment:.4g} N m. Lower the moment, or give --start near a rest.",
    )


def _from_home(
    robot: Robot, arrays: RobotArrays, asked: np.ndarray, model: CableModel, wrench: np.ndarray
) -> Continuation | None:
    """The way from the home pose; None where there is no stable equilibrium at home."""
    if robot.home is None:
        return None
    place, turn = robot.home.position, robot.home.rotation
    first = model.approach()[0]
    held = inverse(arrays, place, turn, first, wrench, allow_unheld=True)
    lengths = held.lengths if held.held.all() else reference_lengths(arrays, place, turn)
    home = forward(arrays, lengths, place, turn, first, wrench)
    if not home.stable.all():
        return None
    return continued(arrays, (lengths, home.position, home.rotation), asked[None], first, wrench)
