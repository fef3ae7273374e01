"""What arguments may be: values of the package, plain numbers, or the text of an option."""

import os
from collections.abc import Callable, Iterable
from typing import TypeAlias

from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.trajectory import Trajectory
from cdpr_struct.workspace.grid import Grid

Numbers: TypeAlias = str | Iterable[float]
"""Numbers, or their text with commas between them."""
RobotLike: TypeAlias = Robot | str | os.PathLike[str]
"""A robot, a built-in name, or the path of a robot file."""
PoseLike: TypeAlias = Pose | str | Iterable[float]
"""A pose, or x, y, z[, rx, ry, rz] in m and deg."""
GridLike: TypeAlias = Grid | str
"""A grid, or X0:X1:NX,Y0:Y1:NY,Z[,RX,RY,RZ] in m and deg."""
TrajectoryLike: TypeAlias = Trajectory | str | os.PathLike[str]
"""A trajectory, a built-in name, a line, or the path of a CSV file."""
CampaignLike: TypeAlias = Campaign | str | os.PathLike[str]
"""A campaign, or the path of a campaign file."""
Progress: TypeAlias = Callable[[str], None]
"""Called with the name of each step as it begins."""
