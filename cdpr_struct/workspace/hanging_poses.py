"""A quantity over the workspace where angles of the platform are left free: each pose at its own orientation."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.free_orientation import ANGLES, FreeOrientation, free_orientation, names_of
from cdpr_struct.statics.hanging_solution import hung_solution
from cdpr_struct.statics.shared_winches import resting_orientation
from cdpr_struct.workspace.margins import stable_where_held
from cdpr_struct.workspace.pose_batches import PoseBatches
from cdpr_struct.workspace.quantities import pose_errors
from cdpr_struct.workspace.work_list import Columns


def hanging(batches: PoseBatches, quantity: str, compute: Callable[..., Columns], free: Sequence[bool]) -> PoseBatches:
    """Batches of a quantity, given by its name and its function, with some of rx, ry, rz (3 booleans) left free."""
    rx, ry, rz = free
    name = f"{batches.name} free {','.join(names_of(free))}"
    if quantity.startswith("pose-error"):
        return replace(batches, name=name, evaluate=ReferencesHangingFreely((rx, ry, rz)))
    return replace(batches, name=name, evaluate=HangingFreely(compute, (rx, ry, rz)))


@dataclass(frozen=True, slots=True)
class HangingFreely:
    """What computes a batch of a quantity at the orientations at which the platform hangs freely.

    compute : (robot, positions, rotations, their solutions) -> columns;  free : of rx, ry, rz

    Columns `rx_deg`, `ry_deg`, `rz_deg` say the orientations, nan where none is found; there nothing is held. `stable`
    says whether the platform stays there at locked lengths.
    """

    compute: Callable[..., Columns]
    free: tuple[bool, bool, bool]

    def __call__(self, robot: Robot, position: np.ndarray, rotation: np.ndarray) -> Columns:
        began = angles_from_rotation(np.asarray(rotation))
        hung = resting_orientation(robot, position, began, self.free)
        solution = hung_solution(robot, hung)
        columns = self.compute(robot, position, hung.rotation, solution)
        if "stable" not in columns:
            columns = {**columns, "stable": stable_where_held(robot, position, hung.rotation, solution)}
        return columns | _angles(hung)


@dataclass(frozen=True, slots=True)
class ReferencesHangingFreely:
    """What computes pose errors from references at which the platform hangs on straight, inextensible cables.

    free : of rx, ry, rz

    Columns `rx_deg`, `ry_deg`, `rz_deg` are the references' angles, nan where none are found; there nothing is held.
    """

    free: tuple[bool, bool, bool]

    def __call__(self, robot: Robot, position: np.ndarray, rotation: np.ndarray) -> Columns:
        began = angles_from_rotation(np.asarray(rotation))
        hung = free_orientation(robot, position, began, self.free, model="ideal")
        columns = pose_errors(robot, position, hung.rotation)
        return {**columns, "held": columns["held"] & hung.found} | _angles(hung)


def _angles(hung: FreeOrientation) -> Columns:
    degrees = np.where(hung.found[:, None], np.degrees(hung.angles), np.nan)
    return {f"{name}_deg": degrees[:, i] for i, name in enumerate(ANGLES)}
