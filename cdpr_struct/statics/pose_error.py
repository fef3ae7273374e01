"""Static pose error (3.2.2): how far does the platform miss its pose if cables are taken as ideal, and why?

The lengths come from the ideal inverse model; the pose they lead to, from the sagging and the spring model. Sagging
minus reference is the global error, spring minus reference the axial part, and the rest is what sag introduces.

Inextensible cables cannot be preloaded by their lengths. So if the robot's force limits ask for an internal force, the
lengths are shortened by the stretch that this force alone causes: the error is what load and sag add to a robot that
was preloaded at the reference pose. Without limits nothing is shortened.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.equilibrium import PlatformArms, weight_force
from cdpr_struct.statics.forward_kinematics import ForwardSolution, forward
from cdpr_struct.statics.masts import MastShapes
from cdpr_struct.statics.preload import Preload

CONTINUATION = (30.0, 4.0)  # times EA: stations between the ideal reference and the spring model
SAME_POSE = 1e-6  # [m], [rad]


@dataclass(frozen=True, slots=True, eq=False)
class PoseError:
    """Pose errors at a batch (...) of reference poses.

    reference_position, reference_rotation : (..., 3) [m], (..., 3, 3)
    held              : (...) bool, ideal cables hold the reference pose within the robot's force limits
    sagging, spring   : ForwardSolution (...) at the same cable lengths
    more_stable_pose  : (...) bool, the spring model has another equilibrium of lower energy near the sagging pose; the
                        one reported is that reached from the reference by softening the cables. Found by one descent
                        from the sagging pose: a probe, not a search
    """

    reference_position: np.ndarray
    reference_rotation: np.ndarray
    held: np.ndarray
    sagging: ForwardSolution
    spring: ForwardSolution
    more_stable_pose: np.ndarray

    @property
    def global_error(self) -> np.ndarray:
        """(..., 3) sagging minus reference position, world [m]."""
        return self.sagging.position - self.reference_position

    @property
    def axial_error(self) -> np.ndarray:
        """(..., 3) spring minus reference position, world [m]."""
        return self.spring.position - self.reference_position

    @property
    def sag_error(self) -> np.ndarray:
        """(..., 3) sagging minus spring position, world [m]."""
        return self.sagging.position - self.spring.position

    @property
    def global_rotation(self) -> np.ndarray:
        """(..., 3) angles rx, ry, rz of the sagging pose in reference platform axes [rad]."""
        return _turn(self.reference_rotation, self.sagging.rotation)

    @property
    def axial_rotation(self) -> np.ndarray:
        """(..., 3) angles rx, ry, rz of the spring pose in reference platform axes [rad]."""
        return _turn(self.reference_rotation, self.spring.rotation)

    @property
    def converged(self) -> np.ndarray:
        """(...) bool: both models found a stable pose."""
        return self.sagging.stable & self.spring.stable


def reference_lengths(
    robot: Robot | RobotArrays,
    position: npt.ArrayLike,
    rotation: npt.ArrayLike,
    external_wrench: npt.ArrayLike | None = None,
    mass: npt.ArrayLike | None = None,
) -> np.ndarray:
    """(..., m) cable lengths of the ideal inverse model: straight, inextensible, over the pulleys if there are any [m].

    They are what the controller commands: it knows nothing of encoder errors, compliance in line and masts. Only the
    preload that the robot's force limits ask for is wound in, against everything that gives way under it.

    position, rotation : (..., 3) [m], (..., 3, 3) platform to world
    external_wrench, mass : as for `pose_error`; they matter only with force limits
    """
    arrays = RobotArrays.of(robot, None if mass is None else np.asarray(mass, dtype=float))
    place, turn = np.asarray(position, dtype=float), np.asarray(rotation, dtype=float)
    points = PlatformArms.at(arrays, place, turn).points
    if not arrays.has_force_limits:
        return _straight_lengths(arrays, points)
    preload = Preload.of(arrays, place, turn, external_wrench)
    return _straight_lengths(arrays, points) - preload.taken_up(arrays, points)


def _straight_lengths(arrays: RobotArrays, points: np.ndarray) -> np.ndarray:
    return cable_model("ideal").hold(arrays, points, np.zeros(points.shape[:-1])).states.total_length


def pose_error(
    robot: Robot | RobotArrays,
    position: npt.ArrayLike,
    rotation: npt.ArrayLike,
    external_wrench: npt.ArrayLike | None = None,
    mass: npt.ArrayLike | None = None,
) -> PoseError:
    """Static pose error at reference poses, split into axial and sag part.

    Parameters
    ----------
    position, rotation : (..., 3) [m], (..., 3, 3) platform to world, the reference poses
    external_wrench : (..., 6) on the platform beside its weight, world axes [N, N m]
    mass : (...) of the platform in place of the robot's [kg]
    """
    arrays = RobotArrays.of(robot, None if mass is None else np.asarray(mass, dtype=float))
    place, turn = np.asarray(position, dtype=float), np.asarray(rotation, dtype=float)
    points, preload = PlatformArms.at(arrays, place, turn).points, Preload.of(arrays, place, turn, external_wrench)
    straight = _straight_lengths(arrays, points)

    def lengths_of(stiffened: RobotArrays) -> np.ndarray:
        return straight - preload.taken_up(stiffened, points)

    lengths = lengths_of(arrays)
    sagging = forward(arrays, lengths, place, turn, "sagging", external_wrench)
    spring = _softened(arrays, lengths_of, place, turn, external_wrench)
    other = forward(arrays, lengths, sagging.position, sagging.rotation, "spring", external_wrench)
    lower = potential_energy(arrays, other, external_wrench) < potential_energy(arrays, spring, external_wrench)
    distance = np.abs(other.position - spring.position).max(axis=-1)
    distance = np.maximum(distance, np.abs(other.rotation - spring.rotation).max(axis=(-1, -2)))
    shape = distance.shape
    return PoseError(
        np.broadcast_to(place, (*shape, 3)),
        np.broadcast_to(turn, (*shape, 3, 3)),
        np.broadcast_to(preload.held, shape),
        sagging,
        spring,
        (distance > SAME_POSE) & lower & other.stable,
    )


def potential_energy(
    robot: Robot | RobotArrays, solution: ForwardSolution, external_wrench: npt.ArrayLike | None = None
) -> np.ndarray:
    """(...) energy of straight elastic cables, weight and dead force at a solution of the spring model [J].

    Zero is the platform's centre of mass at height 0. A constant moment has no potential and is left out.
    """
    arrays = RobotArrays.of(robot)
    cables = solution.cables
    give = cables.total_length / cables.axial_stiffness + arrays.series_compliance
    strain = 0.5 * (cables.tension_at_platform**2 * give).sum(axis=-1)
    strain = strain + MastShapes.of(arrays).energy(cables.force_at_frame)
    away = solution.position - arrays.hose_center
    strain = strain + 0.5 * arrays.hose * (away**2).sum(axis=-1)
    center = PlatformArms.at(arrays, solution.position, solution.rotation).center + solution.position
    force = np.zeros(6) if external_wrench is None else np.asarray(external_wrench, dtype=float)
    work = np.einsum("...i,...i->...", force[..., :3] + arrays.constant_force, solution.position)
    energy: np.ndarray = strain - np.einsum("...i,...i->...", weight_force(arrays), center) - work
    return energy


def _softened(
    arrays: RobotArrays,
    lengths_of: Callable[[RobotArrays], np.ndarray],
    place: np.ndarray,
    turn: np.ndarray,
    wrench: npt.ArrayLike | None,
) -> ForwardSolution:
    """Spring equilibrium continuous with the reference pose: cables softened in stations from nearly ideal.

    lengths_of : lengths (..., m) that give cables of some stiffness their preload
    """
    for factor in CONTINUATION:
        stiff = arrays.stiffened(factor)
        station = forward(stiff, lengths_of(stiff), place, turn, "spring", wrench)
        place, turn = station.position, station.rotation
    return forward(arrays, lengths_of(arrays), place, turn, "spring", wrench)


def _turn(reference: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    return angles_from_rotation(np.swapaxes(reference, -1, -2) @ rotation)
