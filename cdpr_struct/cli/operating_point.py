"""From the options of a command to the robot at rest at a pose."""

from typing import TYPE_CHECKING

from cdpr_struct.errors import UnholdablePoseError

if TYPE_CHECKING:
    from cdpr_struct.dynamics.operating_point import OperatingPoint
    from cdpr_struct.robot.pose import Pose
    from cdpr_struct.robot.robot import Robot


def rest_at(robot: "Robot", pose: "Pose", lower_bound: float = 0.0) -> "OperatingPoint":
    """The robot held at the pose by sagging cables of minimum-norm tension.

    Raises
    ------
    UnholdablePoseError : the cables cannot hold the pose, or only with a tension at zero or below.
    """
    from cdpr_struct.dynamics.operating_point import OperatingPoint
    from cdpr_struct.statics.inverse_kinematics import inverse

    solution = inverse(robot, pose.position, pose.rotation, model="sagging", lower_bound=lower_bound)
    lowest = int(solution.tensions.argmin())
    if not solution.tensions[lowest] > 0.0:
        raise UnholdablePoseError(
            f"cable {lowest + 1} would need a tension of {solution.tensions[lowest]:.4g} N to hold this pose",
            lowest + 1,
        )
    return OperatingPoint(robot, pose.position, pose.rotation, solution.cables)
