"""The cables against the printed validity limits of the closed form, at one or many poses."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.crosscheck.limits_poses import PoseAudit, audit_batches, audit_of, audit_rest
from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import read_grid, read_robot, require_one
from cdpr_struct.interface.free_angles import FreeAngles, read_free, told_in_map
from cdpr_struct.interface.given import GridLike, Numbers, PoseLike, Progress, RobotLike, TrajectoryLike
from cdpr_struct.interface.operating_point import rest
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.sweeping import swept
from cdpr_struct.interface.trajectory import read_trajectory
from cdpr_struct.interface.winches import require_given_free, require_locked_lengths
from cdpr_struct.reports.audit_result import audit_checks, audit_columns, audit_json, audit_text, sentences
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.trust import Trust
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.pose_batches import PoseBatches
from cdpr_struct.workspace.work_list import Columns

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

_INSTANTS = 301  # of a trajectory that has none of its own


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class AuditResult(Result):
    """Cable parameters against their printed limits.

    audit : value, limit and broken by parameter, (k, m) each;  grid, time : what its k poses are ordered by, or None
    """

    audit: PoseAudit
    grid: Grid | None = None
    time: np.ndarray | None = None

    @property
    def valid(self) -> bool:
        """Whether no limit is broken at any pose."""
        return bool(self.answer["valid"])

    @property
    def title(self) -> str:
        """Whose cables."""
        return f"{self.audit.robot.name}: validity limits"

    def text(self) -> str:
        """Verdict, with the cables of a single pose or the counts over many."""
        return audit_text(self.audit)

    def sentences(self) -> Sequence[str]:
        """The verdict."""
        return sentences(self.audit)

    def columns(self) -> Mapping[str, Any]:
        """Columns of audit.csv."""
        return audit_columns(self.audit, self.time)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """The limits of one pose, over the grid, or along the way.

        Raises
        ------
        UnholdablePoseError : no pose is held.
        """
        from cdpr_struct.reports.audit_page import audit_figure

        return audit_figure(self.audit, self.grid, self.time)

    def files(self) -> Files:
        """Table, figure and page."""
        from cdpr_struct.reports.audit_page import audit_files

        return audit_files(self.audit, self.grid, self.time)


@answered
def audit(
    robot: RobotLike,
    pose: PoseLike | None = None,
    *,
    lengths: Numbers | None = None,
    start: PoseLike | None = None,
    grid: GridLike | None = None,
    trajectory: TrajectoryLike | None = None,
    payload: float = 0.0,
    mass: float | None = None,
    wrench: Numbers | None = None,
    temperature: float | None = None,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    executor: Executor | None = None,
    progress: Progress = silent,
    free: FreeAngles | None = None,
) -> AuditResult:
    """Check each cable at each pose against the printed validity limits of the closed form; `valid`: none is broken.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    pose : Pose, or x, y, z[, rx, ry, rz] [m, deg]; default: the home pose
    lengths : locked unstrained lengths [m], in place of pose;  start : with lengths, the pose where to look
    grid : Grid, or "X0:X1:NX,Y0:Y1:NY,Z[,RX,RY,RZ]" [m, deg], in place of pose
    trajectory : Trajectory, "helix", "line:..", or path of a CSV file, in place of pose
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    executor : of `concurrent.futures` that shares the work over many poses; default: this process
    progress : called once a batch of poses
    free : angles that hang freely, some of rx, ry, rz; they are found from those given

    Raises
    ------
    InputError : an unusable argument, or several places.
    CdprError : the robot cannot be at rest at the one pose.
    """
    asked = audit_question(
        robot,
        pose,
        lengths,
        start,
        grid,
        trajectory,
        payload,
        mass,
        wrench,
        temperature,
        lower_bound,
        upper_bound,
        free,
    )
    if isinstance(asked, AuditResult):
        return asked
    return asked.answered(swept(asked.batches, executor, progress))


@dataclass(frozen=True, slots=True, eq=False)
class AuditQuestion:
    """Poses of an audit, over a grid or along a trajectory with its times; notes: what was assumed of it.

    free : (3,) bool, which of rx, ry, rz hang freely, or None
    """

    robot: Robot
    batches: PoseBatches
    grid: Grid | None
    time: np.ndarray | None
    notes: list[str]
    free: np.ndarray | None = None

    def answered(self, columns: Columns) -> AuditResult:
        """The result, with the columns of all poses."""
        found = audit_of(self.batches, columns)
        told: dict[str, Any] = audit_json(found, self.time) | {
            "warnings": self.notes,
            "trust": Trust(tuple(audit_checks(found))),
        }
        if self.free is not None:
            angles = np.degrees(angles_from_rotation(found.rotation[found.held]))
            told = told_in_map(told, self.robot, self.free.tolist(), angles, table="audit.csv")
        return AuditResult(with_extensions(told, self.robot, "audit"), found, self.grid, self.time)


@answered
def audit_question(
    robot: RobotLike,
    pose: PoseLike | None,
    lengths: Numbers | None,
    start: PoseLike | None,
    grid: GridLike | None,
    trajectory: TrajectoryLike | None,
    payload: float,
    mass: float | None,
    wrench: Numbers | None,
    temperature: float | None,
    lower_bound: float | None,
    upper_bound: float | None,
    free: FreeAngles | None = None,
) -> AuditQuestion | AuditResult:
    """What the arguments of `audit` ask for: the poses of many, the result of a single one.

    Raises
    ------
    InputError : an unusable argument, or several places.
    CdprError : the robot cannot be at rest at the one pose.
    """
    require_one({"pose": pose, "lengths": lengths, "grid": grid, "trajectory": trajectory})
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature, winches=True)
    require_locked_lengths(machine, "the printed limits are those of cables of locked lengths")
    if grid is not None or trajectory is not None:
        if start is not None:
            raise InputError("start", "", start, "it belongs to `lengths`; leave it out")
        require_given_free(machine, free, "an audit of many poses")
        return _of_many(machine, grid, trajectory, free)
    state = rest(machine, pose, lengths, start, free)
    found = audit_rest(state.point)
    return AuditResult(with_extensions(audit_json(found) | state.told(), machine, "audit"), found)


def _of_many(
    machine: Robot, grid: GridLike | None, trajectory: TrajectoryLike | None, free: FreeAngles | None
) -> AuditQuestion:
    def asked(position: np.ndarray, rotation: np.ndarray, angles: np.ndarray) -> tuple[PoseBatches, np.ndarray | None]:
        hung = None if free is None else read_free(free, machine, angles)[0]
        return audit_batches(machine, position, rotation, None if hung is None else hung.tolist()), hung

    if grid is not None:
        poses = read_grid(grid)
        batches, hung = asked(poses.positions, poses.rotation, poses.angles)
        return AuditQuestion(machine, batches, poses, None, [], hung)
    given = "helix" if trajectory is None else trajectory
    own = isinstance(given, str) and (given == "helix" or given.startswith("line:"))
    path, notes = read_trajectory(given, _INSTANTS if own else None)
    batches, hung = asked(path.position, path.rotation, angles_from_rotation(path.rotation))
    return AuditQuestion(machine, batches, None, path.time, notes, hung)
