"""Static stiffness of the robot: how far does the platform give way under a wrench, and what gives way?"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cdpr_struct.generated.platform import attachment
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_response import end_stiffness
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, load_wrench, moment_skew, tangent_stiffness
from cdpr_struct.statics.guides import behind_guides
from cdpr_struct.statics.neutral_freedoms import Stability, stability
from cdpr_struct.statics.stiffening import in_small_motion


@dataclass(frozen=True, slots=True, eq=False)
class RobotStiffness:
    """6 x 6 stiffness about the platform origin at locked cable lengths; leading axes (...) are the batch.

    Rows force [N] and moment [N m] (of the wrench that displaces), columns displacement [m] and rotation [rad].

    matrix   : (..., 6, 6) world axes, exactly -d(wrench of cables and weight)/d(pose), guides left out; symmetric at
               an equilibrium without applied moment
    axial    : (..., 6, 6) part of the compliance from axial cable elasticity, world axes
    sag      : (..., 6, 6) part from cable sag in the cable planes, eq. (2.28)
    rotation : (..., 3, 3) platform to world
    arrays   : the robot's
    """

    matrix: np.ndarray
    axial: np.ndarray
    sag: np.ndarray
    rotation: np.ndarray
    arrays: RobotArrays

    @property
    def compliance(self) -> np.ndarray:
        """(..., 6, 6) inverse of `matrix`, world axes [m/N, 1/N, 1/(N m)].

        Of a guided platform zero in the guided directions; with neutral freedoms that of the platform held in these.
        """
        return self.compliance_of(self.stability)

    def compliance_of(self, held: Stability) -> np.ndarray:
        """The same where the stability is known."""
        inverse = np.linalg.inv(behind_guides(self.matrix, self.arrays) + held.holding)
        twists = held.twists
        if twists.shape[-1]:  # what the holding stiffness itself gives way is no compliance of the robot
            stiff = np.swapaxes(twists, -1, -2) @ held.holding @ twists
            there = np.where((twists != 0.0).any(axis=-2), np.einsum("...ii->...i", stiff), np.inf)
            inverse = inverse - (twists / there[..., None, :]) @ np.swapaxes(twists, -1, -2)
        return np.asarray(inverse * self.arrays.free[..., :, None] * self.arrays.free[..., None, :])

    @property
    def stability(self) -> Stability:
        """How the platform is held."""
        return stability(self.arrays, self.rotation, self.symmetric)

    @property
    def geometric(self) -> np.ndarray:
        """(..., 6, 6) rest of the compliance: cables swinging out of their planes, levers that turn, pulleys."""
        return self.compliance - self.axial - self.sag

    @property
    def in_platform(self) -> np.ndarray:
        """(..., 6, 6) `matrix` in platform axes, eq. (3.10) with the rotation block-diagonal."""
        turn = np.zeros(self.matrix.shape)
        turn[..., :3, :3] = turn[..., 3:, 3:] = self.rotation
        return np.swapaxes(turn, -1, -2) @ self.matrix @ turn

    @property
    def symmetric(self) -> np.ndarray:
        """(..., 6, 6) symmetric part of `matrix`: second derivative of the potential energy along twists."""
        return 0.5 * (self.matrix + np.swapaxes(self.matrix, -1, -2))


def static_stiffness(
    robot: Robot | RobotArrays,
    position: npt.ArrayLike,
    rotation: npt.ArrayLike,
    cables: CableStates,
    mass: npt.ArrayLike | None = None,
) -> RobotStiffness:
    """Stiffness of the platform at poses whose cable states are known (from `inverse` or `forward`).

    Parameters
    ----------
    position, rotation : (..., 3) [m], (..., 3, 3) platform to world
    cables : CableStates (..., m) at these poses
    mass : (...) of the platform in place of the robot's [kg]

    Eq. (3.8) with the geometric terms that it leaves out.
    """
    entered = RobotArrays.of(robot, None if mass is None else np.asarray(mass, dtype=float))
    arrays, cables = in_small_motion(entered, cables)
    turn = np.asarray(rotation, dtype=float)
    arms = PlatformArms.at(arrays, np.asarray(position, dtype=float), turn)
    matrix = tangent_stiffness(arrays, cables, arms)
    moment = (cable_wrench(cables, arms) + load_wrench(arrays, arms))[..., 3:] - arrays.moment
    matrix[..., 3:, 3:] += moment_skew(moment)
    axial, sag = _compliance_parts(arrays, cables, arms, matrix)
    return RobotStiffness(matrix, axial, sag, np.broadcast_to(turn, (*matrix.shape[:-2], 3, 3)), arrays)


def _compliance_parts(
    arrays: RobotArrays, cables: CableStates, arms: PlatformArms, matrix: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Axial and sag part of the robot's compliance by the work that cable force changes do on each cable's parts."""
    force_change = end_stiffness(arrays, cables) @ attachment(*np.moveaxis(arms.arms, -1, 0))
    in_plane = np.zeros((*cables.length.shape, 2, 3))
    in_plane[..., 0, :] = cables.heading
    in_plane[..., 1, :] = cables.up
    planar = in_plane @ force_change
    compliance = np.linalg.pinv(behind_guides(matrix, arrays, held=0.0), hermitian=False)
    parts = []
    for part in cables.compliance_split():
        work = np.einsum("...mai,...mab,...mbj->...ij", planar, part, planar)
        parts.append(np.swapaxes(compliance, -1, -2) @ work @ compliance)
    return parts[0], parts[1]
