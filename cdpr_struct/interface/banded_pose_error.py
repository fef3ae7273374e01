"""Bands of the pose error at one pose."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.bands.likeliest_robot import about_the_means, required
from cdpr_struct.bands.locked_response import locked_response
from cdpr_struct.bands.pose_error_bands import ErringRobot
from cdpr_struct.errors import InputError
from cdpr_struct.interface.bands import AskedBand, band_head, spread_of
from cdpr_struct.interface.free_angles import found_angles
from cdpr_struct.reports.bands_told import slack_check
from cdpr_struct.reports.pose_error_bands_told import pose_error_bands_told
from cdpr_struct.reports.trust import Check
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.pose_error import pose_error
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.work_list import Columns


def require_one_pose(grid: Grid) -> None:
    """Refuse bands over many poses.

    Raises
    ------
    InputError : the grid has more than one.
    """
    if grid.size > 1:
        right = "one pose for `band`; over many poses `map` has bands of the quantities pose-error, pose-error-sag, ..."
        raise InputError("grid", "", f"{grid.size} poses", right)


def single_pose(pose: Pose) -> Grid:
    """The grid of one pose."""
    x, y, z = pose.position[:, None]
    return Grid(x, y, z, pose.angles)


def banded_pose_error(
    robot: Robot, grid: Grid, values: Columns, asked: AskedBand
) -> tuple[Mapping[str, Any], list[Check]]:
    """Key `bands` of the pose error at the one pose of a grid, and what is to be doubted.

    values : columns there, at which the pose is held and stable
    """
    angles = np.radians(found_angles(values)[0]) if "rx_deg" in values else grid.angles
    reference = Pose(grid.positions[0], angles)
    erring = ErringRobot.of(robot, pose_error(robot, reference.position, reference.rotation))
    known = spread_of(robot)
    errors, drawn = erring.drawn(known, asked.samples) if asked.samples else (None, None)
    likeliest, spread = required(ErringRobot.likeliest([erring], known))[0], about_the_means(known)
    response = locked_response(likeliest.sagging, spread=spread)
    found = likeliest.bands(response, spread, asked.level)
    tension = likeliest.sagging.cables.tension_at_platform
    checks = slack_check(tension, spread.sigma(response.tension), drawn)
    told = pose_error_bands_told(erring.numbers().all, found, errors, drawn, asked.level)
    return band_head(asked, robot) | told, checks
