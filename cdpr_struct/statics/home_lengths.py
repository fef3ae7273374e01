"""How long are the cables that share a winch when it is at home?"""

from dataclasses import replace

from cdpr_struct.errors import CdprError
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.inverse_kinematics import inverse

_DECIMALS = 10  # of lengths [m]: the rest is rounding of the search


def with_home_lengths(robot: Robot) -> Robot:
    """The robot with a home length for each cable on a shared winch: those that hold the home pose, unless entered.

    Raises
    ------
    CdprError : no home pose, or one that the cables do not hold.
    """
    missing = [cable.winch for cable in robot.cables if cable.winch and not cable.home_length]
    if not missing:
        return robot
    if robot.home is None:
        raise CdprError(f"winch {missing[0]}: give home_pose, or home_length for each of its cables")
    try:
        lengths = inverse(robot, robot.home.position, robot.home.rotation).lengths
    except CdprError as error:
        hint = f"The cables of winch {missing[0]} are to be as long as the home pose needs: give each its home_length."
        raise CdprError(f"home pose: {error} {hint}") from error
    cables = (
        replace(cable, home_length=round(float(length), _DECIMALS)) if cable.winch and not cable.home_length else cable
        for cable, length in zip(robot.cables, lengths, strict=True)
    )
    return replace(robot, cables=tuple(cables))
