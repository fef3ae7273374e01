"""A live view of a robot in a browser window."""

from typing import Any

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import read_pose, read_robot, whole
from cdpr_struct.interface.campaigns import read_campaign
from cdpr_struct.interface.given import CampaignLike, PoseLike, RobotLike
from cdpr_struct.live.controls import Controls
from cdpr_struct.live.window import Window, open_server
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.robot import Robot


@answered
def open_window(
    robot: RobotLike,
    pose: PoseLike | None = None,
    *,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    payload: float = 0.0,
    mass: float | None = None,
    campaign: CampaignLike | None = None,
    count: int = 12,
    port: int = 8080,
) -> tuple[Any, Window]:
    """The server of a window, and the window; its `run` answers the sliders until the program is interrupted.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    pose : at the start, x, y, z[, rx, ry, rz] [m, deg]; default: the home pose
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    payload : at the start, point load at the platform origin [kg];  mass : replaces the platform's [kg]
    campaign : measured states to step through;  count : how many modes;  port : where the window is served

    Raises
    ------
    InputError : an unusable argument, or viser is not installed.
    """
    whole(count, "count", 1, 100)
    whole(port, "port", 1, 65535)
    read_robot(robot, payload)
    machine = read_robot(robot, 0.0, mass, lower_bound, upper_bound)
    measured = None if campaign is None else _fitting(read_campaign(campaign, lower_bound, upper_bound), machine)
    start = Controls((), float(payload)).at(read_pose(pose, machine))
    server = open_server(port, machine.name)
    return server, Window(server, machine, start, measured, count)


def _fitting(campaign: Campaign, robot: Robot) -> Campaign:
    """The campaign, which must be of a robot with as many cables."""
    cables = len(campaign.robot.cables)
    if cables != len(robot.cables):
        raise InputError(
            "campaign", "robot", campaign.robot_name,
            f"it has {cables} cables and {robot.name} has {len(robot.cables)}: give a campaign of this robot",
        )  # fmt: skip
    return campaign
