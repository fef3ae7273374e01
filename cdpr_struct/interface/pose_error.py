"""How far the platform misses its pose when sag and stretch are not accounted for."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import read_grid, read_pose, read_robot, real
from cdpr_struct.interface.banded_pose_error import banded_pose_error, require_one_pose, single_pose
from cdpr_struct.interface.bands import AskedBand, read_band
from cdpr_struct.interface.free_angles import FreeAngles, found_angles, read_free, told_in_map, where_judged
from cdpr_struct.interface.given import GridLike, Numbers, PoseLike, Progress, RobotLike
from cdpr_struct.interface.map import require_drawable
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.sweeping import swept
from cdpr_struct.interface.winches import require_locked_lengths
from cdpr_struct.reports import statics_pose_error
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.pose_error_bands_told import pose_error_bands_text
from cdpr_struct.reports.text import paragraphs
from cdpr_struct.reports.trust import Trust
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
        """Means, and poses that do not count; bands if there are any."""
        more = pose_error_bands_text(self.answer["bands"]) if "bands" in self.answer else []
        return paragraphs("\n".join(self.sentences()), *more)

    def sentences(self) -> Sequence[str]:
        """The outcome."""
        return statics_pose_error.pose_error_sentences(self.errors, self.load)

    def columns(self) -> Mapping[str, Any]:
        """Columns of pose_error.csv; of sufficient_load.csv without a grid."""
        if self.errors is not None:
            return statics_pose_error.error_table(self.errors, self.answer.get("bands")).columns
        return {} if self.load is None else statics_pose_error.load_columns(self.load[0])

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """The error over the grid; over the load without a grid; at a single pose its bands.

        Raises
        ------
        InputError : the grid is a single pose, and no bands were asked for.
        """
        if "bands" in self.answer:
            from cdpr_struct.reports.figures import pose_error_bands

            bands = self.answer["bands"]
            return lambda figure: pose_error_bands.draw_bands(figure, bands), pose_error_bands.SIZE
        if self.errors is not None:
            require_drawable(self.errors.grid)
        return statics_pose_error.main_figure(self.errors, self.load, self.robot)

    def files(self) -> Files:
        """Tables, figures and page."""
        return statics_pose_error.pose_error_files(self.robot, self.errors, self.load, self.answer.get("bands"))


@dataclass(frozen=True, slots=True, eq=False)
class PoseErrorQuestion:
    """What is asked: over which grid, and from which load on the spring model is good; one of both may be None.

    free : (3,) bool, which of rx, ry, rz hang freely at the references of the grid, or None
    band : of the errors at the one pose of the grid, or None
    """

    robot: Robot
    grid: Grid | None
    load: tuple[SufficientLoad, Pose] | None
    free: np.ndarray | None = None
    band: AskedBand | None = None

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
            if self.band is not None:
                bands, checks = banded_pose_error(machine, self.grid, values, self.band)
                told |= {"bands": bands, "trust": Trust((*told["trust"].checks, *checks))}
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
    band: float | None = None,
    samples: int | None = None,
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
    pose : with sufficient_load or band: Pose, or x, y, z[, rx, ry, rz] [m, deg]; default: the home pose
    free : angles of the references over the grid that the platform takes by hanging on ideal cables, some of rx, ry, rz
    band : level of bands about the error at one pose [%], like 90: within the robot's tolerances, lengths as commanded
    samples : with band, so many robots drawn within the tolerances check it
    executor : of `concurrent.futures` that shares the work; default: this process
    progress : called once a batch

    Raises
    ------
    InputError : an unusable argument.
    UnholdablePoseError : no pose of the grid has a pose error.
    """
    asked = pose_error_question(
        robot, grid, payload, mass, wrench, temperature, lower_bound, upper_bound, sufficient_load, pose, free,
        band, samples,
    )  # fmt: skip
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
    band: float | None = None,
    samples: int | None = None,
) -> PoseErrorQuestion:
    """What the arguments of `pose_error` ask for; the load is searched, `tolerance` [mm] is its `sufficient_load`.

    Raises
    ------
    InputError : an unusable argument, or arguments that do not belong together.
    """
    asked = read_band(band, samples)
    if grid is None and tolerance is None and asked is None:
        raise InputError("grid", "", "nothing", "give `grid`, `sufficient_load`, or both")
    if tolerance is not None:
        real(tolerance, "sufficient_load", "give a tolerance in mm above zero", 0.0, float("inf"))
    if pose is not None and tolerance is None and (asked is None or grid is not None):
        raise InputError("pose", "", pose, "a pose is for `sufficient_load` or `band`; errors over poses take `grid`")
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature)
    require_locked_lengths(machine, "a pose error is that of locked lengths")
    poses = _references(machine, grid, pose, asked)
    hung = None
    if free is not None:
        if poses is None:
            raise InputError("free", "", free, "free angles are for errors over a `grid`; leave it out")
        hung = read_free(free, machine, poses.angles)[0]
    if tolerance is None:
        return PoseErrorQuestion(machine, poses, None, hung, asked)
    where = read_pose(pose, machine)
    found = sufficient_load(machine, where.position, where.rotation, 1e-3 * tolerance)
    return PoseErrorQuestion(machine, poses, (found, where), hung, asked)


def _references(robot: Robot, grid: GridLike | None, pose: PoseLike | None, asked: AskedBand | None) -> Grid | None:
    """The poses whose errors are asked for; with a band one, and without a grid that of `pose`."""
    if grid is None:
        return None if asked is None else single_pose(read_pose(pose, robot))
    poses = read_grid(grid)
    if asked is not None:
        require_one_pose(poses)
    return poses
