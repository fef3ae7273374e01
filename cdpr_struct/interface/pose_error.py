"""How far the platform misses its pose when sag and stretch are not accounted for."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import read_grid, read_pose, read_robot, real
from cdpr_struct.interface.free_angles import FreeAngles, found_angles, read_free, told_in_map, where_judged
from cdpr_struct.interface.given import GridLike, Numbers, PoseLike, Progress, RobotLike
from cdpr_struct.interface.map import require_drawable
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.sweeping import swept
from cdpr_struct.interface.winches import require_locked_lengths
from cdpr_struct.reports import statics_pose_error
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.statics_map import map_table
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.sufficient_load import SufficientLoad, sufficient_load
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.hanging_poses import hanging
from cdpr_struct.workspace.pose_batches import PoseBatches
from cdpr_struct.workspace.pose_error_map import PoseErrorMap
from cdpr_struct.workspace.sweep import sweep
from cdpr_struct.workspace.work_list import Columns

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

QUANTITY = "pose-error"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PoseErrorResult(Result):
    """Static pose errors.

    robot : with its load;  errors : over the grid, None without one
    load : from which on the spring model is good, and the pose it was sought at; None if not asked for
    """

    robot: Robot
    errors: PoseErrorMap | None
    load: tuple[SufficientLoad, Pose] | None

    @property
    def title(self) -> str:
        """Whose errors."""
        return f"{self.robot.name}: static pose error"

    def text(self) -> str:
        """Means, and poses that do not count."""
        return "\n".join(self.sentences())

    def sentences(self) -> Sequence[str]:
        """The outcome."""
        return statics_pose_error.pose_error_sentences(self.errors, self.load)

    def columns(self) -> Mapping[str, Any]:
        """Columns of pose_error.csv; of sufficient_load.csv without a grid."""
        if self.errors is not None:
            return map_table(self.errors.grid, self.errors.columns).columns
        return {} if self.load is None else statics_pose_error.load_columns(self.load[0])

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """The error over the grid; over the load without a grid.

        Raises
        ------
        InputError : the grid is a single pose.
        """
        if self.errors is not None:
            require_drawable(self.errors.grid)
        return statics_pose_error.main_figure(self.errors, self.load, self.robot)

    def files(self) -> Files:
        """Tables, figures and page."""
        return statics_pose_error.pose_error_files(self.robot, self.errors, self.load)


@dataclass(frozen=True, slots=True, eq=False)
class PoseErrorQuestion:
    """What is asked: over which grid, and from which load on the spring model is good; one of both may be None.

    free : (3,) bool, which of rx, ry, rz hang freely at the references of the grid, or None
    """

    robot: Robot
    grid: Grid | None
    load: tuple[SufficientLoad, Pose] | None
    free: np.ndarray | None = None

    @property
    def batches(self) -> PoseBatches | None:
        """What is to be computed over the grid, if there is one."""
        if self.grid is None:
            return None
        batches = sweep(QUANTITY, self.robot, self.grid)
        if self.free is None:
            return batches
        return hanging(batches, QUANTITY, batches.evaluate, self.free.tolist())

    def answered(self, values: Columns | None) -> PoseErrorResult:
        """The result, with columns over the grid if there is one.

        Raises
        ------
        UnholdablePoseError : no pose of the grid counts.
        """
        machine, errors = self.robot, None
        told: dict[str, Any] = {"robot": machine.name, "mass_kg": machine.platform.mass}
        if self.grid is not None and values is not None:
            errors = PoseErrorMap(machine.name, machine.platform.mass, self.grid, values).require_some()
            told |= statics_pose_error.pose_error_json(errors, machine)
            if self.free is not None:
                free, angles = self.free.tolist(), found_angles(values)
                told = told_in_map(told, machine, free, angles, where_judged(QUANTITY), "pose_error.csv")
        if self.load is not None:
            told["sufficient_load"] = statics_pose_error.sufficient_load_json(*self.load)
        return PoseErrorResult(with_extensions(told, machine, "pose-error"), machine, errors, self.load)


@answered
def pose_error(
    robot: RobotLike,
    grid: GridLike | None = None,
    *,
    payload: float = 0.0,
    mass: float | None = None,
    wrench: Numbers | None = None,
    temperature: float | None = None,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    sufficient_load: float | None = None,
    pose: PoseLike | None = None,
    free: FreeAngles | None = None,
    executor: Executor | None = None,
    progress: Progress = silent,
) -> PoseErrorResult:
    """Compute the static pose error over a grid, split into what sag adds and what stretch adds.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    grid : Grid, or "X0:X1:NX,Y0:Y1:NY,Z[,RX,RY,RZ]" [m, deg], each of x, y, z a number or a range
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    sufficient_load : tolerance [mm]: find the mass from which on the spring model is good to it, at `pose`
    pose : with sufficient_load: Pose, or x, y, z[, rx, ry, rz] [m, deg]; default: the home pose
    free : angles of the references over the grid that the platform takes by hanging on ideal cables, some of rx, ry, rz
    executor : of `concurrent.futures` that shares the work; default: this process
    progress : called once a batch

    Raises
    ------
    InputError : an unusable argument.
    UnholdablePoseError : no pose of the grid has a pose error.
    """
    asked = pose_error_question(
        robot, grid, payload, mass, wrench, temperature, lower_bound, upper_bound, sufficient_load, pose, free
    )
    batches = asked.batches
    return asked.answered(None if batches is None else swept(batches, executor, progress))


@answered
def pose_error_question(
    robot: RobotLike,
    grid: GridLike | None,
    payload: float,
    mass: float | None,
    wrench: Numbers | None,
    temperature: float | None,
    lower_bound: float | None,
    upper_bound: float | None,
    tolerance: float | None,
    pose: PoseLike | None,
    free: FreeAngles | None = None,
) -> PoseErrorQuestion:
    """What the arguments of `pose_error` ask for; the load is searched, `tolerance` [mm] is its `sufficient_load`.

    Raises
    ------
    InputError : an unusable argument, or arguments that do not belong together.
    """
    if grid is None and tolerance is None:
        raise InputError("grid", "", "nothing", "give `grid`, `sufficient_load`, or both")
    if tolerance is not None:
        real(tolerance, "sufficient_load", "give a tolerance in mm above zero", 0.0, float("inf"))
    if pose is not None and tolerance is None:
        raise InputError("pose", "", pose, "a pose is for `sufficient_load`; errors over poses take `grid`")
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature)
    require_locked_lengths(machine, "a pose error is that of locked lengths")
    poses = None if grid is None else read_grid(grid)
    hung = None
    if free is not None:
        if poses is None:
            raise InputError("free", "", free, "free angles are for errors over a `grid`; leave it out")
        hung = read_free(free, machine, poses.angles)[0]
    if tolerance is None:
        return PoseErrorQuestion(machine, poses, None, hung)
    where = read_pose(pose, machine)
    found = sufficient_load(machine, where.position, where.rotation, 1e-3 * tolerance)
    return PoseErrorQuestion(machine, poses, (found, where), hung)
