"""Any quantity over the workspace."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

from cdpr_struct.bands.mapped_bands import POSES_AT_ONCE, BandedQuantity
from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import read_grid, read_robot, whole
from cdpr_struct.interface.banded_map import banded_quantity, require_no_band, told_with_bands
from cdpr_struct.interface.bands import read_band
from cdpr_struct.interface.free_angles import FreeAngles, found_angles, told_in_map, where_judged
from cdpr_struct.interface.given import GridLike, Numbers, Progress, RobotLike
from cdpr_struct.interface.map_options import ONCE, OWN_LENGTHS, More, Three, free_axes, own_compute, workspace_question
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.sweeping import swept
from cdpr_struct.interface.winches import require_given_free, require_locked_lengths, require_own_winches
from cdpr_struct.interface.workspace import (
    WORKSPACE,
    WorkspaceQuestion,
    WorkspaceResult,
    require_entered,
    single,
)
from cdpr_struct.interface.wrenches import WrenchesLike
from cdpr_struct.reports import statics_map
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.hanging_poses import hanging
from cdpr_struct.workspace.margins import ZONE
from cdpr_struct.workspace.pose_batches import Evaluate, PoseBatches
from cdpr_struct.workspace.quantities import evaluate, quantity_of
from cdpr_struct.workspace.sweep import sweep
from cdpr_struct.workspace.work_list import Columns

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

Within: TypeAlias = tuple[float | None, int | None, float | None]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class MapResult(Result):
    """A quantity over a grid of poses.

    robot : with its load;  quantity : its name;  grid : of poses;  values : columns of n numbers, z runs fastest, those
        of bands among them
    """

    robot: Robot
    quantity: str
    grid: Grid
    values: Columns

    @property
    def title(self) -> str:
        """Whose quantity."""
        return f"{self.robot.name}: {quantity_of(self.quantity).label}"

    def text(self) -> str:
        """Smallest, largest and mean value, and the poses that do not count; what bands say."""
        return statics_map.map_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """The same without notes."""
        return statics_map.map_sentences(self.answer)

    def columns(self) -> Mapping[str, Any]:
        """Columns of map.csv."""
        return statics_map.map_table(self.grid, self.values).columns

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """A curve, a heat map or slices.

        Raises
        ------
        InputError : a single pose has no map.
        """
        require_drawable(self.grid)
        return statics_map.map_figure(self.robot, self.quantity, self.grid, self.values)

    def files(self) -> Files:
        """Table, figure and page."""
        return statics_map.map_files(self.robot, self.quantity, self.grid, self.values, self.answer)


@answered
def map(
    robot: RobotLike,
    grid: GridLike | None = None,
    quantity: str | None = None,
    *,
    payload: float = 0.0,
    mass: float | None = None,
    wrench: Numbers | None = None,
    temperature: float | None = None,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    chunk: int | None = None,
    executor: Executor | None = None,
    progress: Progress = silent,
    free: FreeAngles | None = None,
    require: str | Iterable[str] | None = None,
    wrenches: WrenchesLike | None = None,
    refine: int = ONCE,
    anchor_zone: float = ZONE,
    band: float | None = None,
    samples: int | None = None,
    limit: float | None = None,
) -> MapResult | WorkspaceResult:
    """Map a quantity over a grid of poses, or the workspace: where all requirements hold.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    grid : Grid, or "X0:X1:NX,Y0:Y1:NY,Z[,RX,RY,RZ]" [m, deg], each of x, y, z a number or a range
    quantity : like "first-frequency", "tension-max", "stiffness-min"; the complaint about an unknown one lists all;
        "workspace" answers with a `WorkspaceResult`
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    chunk : poses a batch; default: what suits the quantity
    executor : of `concurrent.futures` that shares the work, like a ProcessPoolExecutor; default: this process
    progress : called once a batch
    free : angles that hang freely at each pose, some of rx, ry, rz; they are found from those of the grid
    require : of a workspace, like ["slack-margin>=50", "cable-distance>=0.02"]: any quantity with >= or <=
    wrenches : to be held beside the load: a CSV file, "fx=-100:100,mz=-5:5" (all corners), or rows of six numbers
    refine : how often the grid of a workspace is halved where the workspace ends
    anchor_zone : of cable, next to an anchor that is shared or sits on a body, left out of distances [m]
    band : level of a band about the value at every pose [%], like 90: within the robot's tolerances, winches locked
    samples : with band, so many robots drawn within the tolerances check it at every pose
    limit : with band, in the quantity's unit: with which probability does it fall below?

    Raises
    ------
    InputError : an unusable argument.
    """
    asked = map_question(
        robot, grid, quantity, payload, mass, wrench, temperature, lower_bound, upper_bound, chunk, free,
        (require, wrenches, refine, anchor_zone), (band, samples, limit),
    )  # fmt: skip
    return asked.answered_by(lambda batches: swept(batches, executor, progress))


@dataclass(frozen=True, slots=True, eq=False)
class MapQuestion:
    """Which quantity is asked for, over which grid.

    chunk : poses a batch, None for what suits the quantity;  free : which of rx, ry, rz hang freely, or None
    compute : the quantity under a set of wrenches, with an anchor zone of its own, or with a band, or None
    """

    robot: Robot
    grid: Grid
    quantity: str
    chunk: int | None
    free: Three | None = None
    compute: Evaluate | None = None

    @property
    def batches(self) -> PoseBatches:
        """What is to be computed."""
        batches = sweep(self.quantity, self.robot, self.grid, self.chunk)
        if self.compute is not None:
            batches = single(self.compute, batches)
        if self.free is None:
            return batches
        compute = partial(evaluate, self.quantity) if self.compute is None else self.compute
        return hanging(batches, self.quantity, compute, self.free)

    @property
    def ran(self) -> list[PoseBatches]:
        """What was computed."""
        return [self.batches]

    def answered_by(self, run: Callable[[PoseBatches], Columns]) -> MapResult:
        """The result; `run` gives the columns of batches of poses."""
        values = quantity_of(self.quantity, self.free).finished(self.robot, self.grid, run(self.batches))
        told = statics_map.map_json(self.robot, self.quantity, self.grid, values) | {"resumed_chunks": 0}
        if self.free is not None:
            told = told_in_map(told, self.robot, self.free, found_angles(values), where_judged(self.quantity))
        if isinstance(self.compute, BandedQuantity):
            told = told_with_bands(told, self.robot, self.grid, values, self.compute)
        answer = with_extensions(told, self.robot, *_kin(self.quantity))
        return MapResult(answer, self.robot, self.quantity, self.grid, values)


@answered
def map_question(
    robot: RobotLike,
    grid: GridLike | None,
    quantity: str | None,
    payload: float,
    mass: float | None,
    wrench: Numbers | None,
    temperature: float | None,
    lower_bound: float | None,
    upper_bound: float | None,
    chunk: int | None,
    free: FreeAngles | None = None,
    more: More = (None, None, ONCE, ZONE),
    within: Within = (None, None, None),
) -> MapQuestion | WorkspaceQuestion:
    """What the arguments of `map` ask for.

    more : require, wrenches, refine and anchor_zone;  within : band, samples and limit

    Raises
    ------
    InputError : an unusable argument, or more poses than a followed mode can be kept of.
    """
    if grid is None:
        raise InputError("grid", "", "nothing", "give X0:X1:NX,Y0:Y1:NY,Z, like -3:3:13,-3:3:13,0.5")
    if chunk is not None:
        whole(chunk, "chunk", 1, 100_000)
    machine, poses = (
        read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature, winches=True),
        read_grid(grid),
    )
    require_given_free(machine, free, "a map of its poses")
    name = "nothing" if quantity is None else quantity
    if name.startswith("pose-error"):
        require_locked_lengths(machine, "a pose error is that of locked lengths")
        require_own_winches(machine, OWN_LENGTHS)
    if more[1] is not None:
        require_own_winches(machine, "further wrenches are held by a winch of each cable")
    band = read_band(*within[:2])
    if name == WORKSPACE or more[0] is not None:
        require_no_band(*within)
        return workspace_question(machine, poses, name, chunk, free, more)
    try:
        what = quantity_of(name)
    except KeyError as error:
        raise InputError("quantity", "", name, f"{error.args[0]}; or {WORKSPACE}") from None
    if what.most_poses is not None and poses.size > (most := what.most_poses(machine)):
        right = f"at most {most} poses for {name}, which keeps the mode shapes of all poses in memory"
        raise InputError("grid", "", f"{poses.size} poses", right)
    require_entered(machine, (name,))
    compute: Evaluate | None = own_compute(name, what.evaluate, more)
    if band is not None or within[2] is not None:
        compute = banded_quantity(machine, name, band, within[2], compute is None, free is not None)
        chunk = POSES_AT_ONCE if chunk is None else chunk
    return MapQuestion(machine, poses, name, chunk, free_axes(free, machine, poses), compute)


def require_drawable(grid: Grid) -> None:
    """Refuse to draw over a grid without an axis.

    Raises
    ------
    InputError : it has a single pose.
    """
    if not grid.free:
        raise InputError("grid", "", "a single pose", "give a range for x, y or z to draw over")


def _kin(quantity: str) -> tuple[str, str]:
    """The command, and its cable model, that know the extensions which this quantity knows."""
    if quantity.startswith("pose-error"):
        return "pose-error", ""
    if quantity.startswith(("first-", "mode-")) or quantity == "frequencies":
        return "map", ""
    if quantity == "platform-frequency":
        return "map", "static"
    return ("stiffness" if quantity.startswith("stiffness-") else "inverse"), ""
