"""A quantity over the workspace where angles of the platform are left free: each pose at its own orientation."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.free_orientation import ANGLES, free_orientation
from cdpr_struct.statics.inverse_kinematics import hung_solution
from cdpr_struct.workspace.quantities import evaluate
from cdpr_struct.workspace.work_list import Columns


@dataclass(frozen=True, slots=True)
class HangingFreely:
    """What computes a batch of a quantity at the orientations at which the platform hangs freely; free : of rx, ry, rz.

    Columns `rx_deg`, `ry_deg`, `rz_deg` say the orientations, nan where none is found; there nothing is held.
    """

    quantity: str
    free: tuple[bool, bool, bool]

    def __call__(self, robot: Robot, position: np.ndarray, rotation: np.ndarray) -> Columns:
        began = angles_from_rotation(np.asarray(rotation))
        hung = free_orientation(robot, position, began, self.free)
        columns = evaluate(self.quantity, robot, position, hung.rotation, hung_solution(robot, hung))
        degrees = np.where(hung.found[:, None], np.degrees(hung.angles), np.nan)
        return {**columns, **{f"{name}_deg": degrees[:, i] for i, name in enumerate(ANGLES)}}
