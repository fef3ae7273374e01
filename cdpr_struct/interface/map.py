"""Any quantity over the workspace."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import read_grid, read_robot, whole
from cdpr_struct.interface.free_angles import FreeAngles, names_of, read_free
from cdpr_struct.interface.given import GridLike, Numbers, Progress, RobotLike
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.sweeping import swept
from cdpr_struct.interface.winches import require_locked_lengths
from cdpr_struct.reports import statics_map
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.hanging_poses import HangingFreely
from cdpr_struct.workspace.pose_batches import PoseBatches
from cdpr_struct.workspace.quantities import quantity_of
from cdpr_struct.workspace.sweep import sweep
from cdpr_struct.workspace.work_list import Columns

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class MapResult(Result):
    """A quantity over a grid of poses.

    robot : with its load;  quantity : its name;  grid : of poses;  values : columns of n numbers, z runs fastest
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
        """Smallest, largest and mean value, and the poses that do not count."""
        return statics_map.map_sentence(self.answer)

    def sentences(self) -> Sequence[str]:
        """As `text`."""
        return [self.text()]

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
) -> MapResult:
    """Map a quantity over a grid of poses.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    grid : Grid, or "X0:X1:NX,Y0:Y1:NY,Z[,RX,RY,RZ]" [m, deg], each of x, y, z a number or a range
    quantity : like "first-frequency", "tension-max", "stiffness-min"; the complaint about an unknown one lists all
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    chunk : poses a batch; default: what suits the quantity
    executor : of `concurrent.futures` that shares the work, like a ProcessPoolExecutor; default: this process
    progress : called once a batch
    free : angles that hang freely at each pose, some of rx, ry, rz; they are found from those of the grid

    Raises
    ------
    InputError : an unusable argument.
    """
    asked = map_question(
        robot, grid, quantity, payload, mass, wrench, temperature, lower_bound, upper_bound, chunk, free
    )
    return asked.answered(swept(asked.batches, executor, progress))


@dataclass(frozen=True, slots=True, eq=False)
class MapQuestion:
    """Which quantity is asked for, over which grid.

    chunk : poses a batch, None for what suits the quantity;  free : (3,) bool, which of rx, ry, rz hang freely, or None
    """

    robot: Robot
    grid: Grid
    quantity: str
    chunk: int | None
    free: np.ndarray | None = None

    @property
    def batches(self) -> PoseBatches:
        """What is to be computed."""
        batches = sweep(self.quantity, self.robot, self.grid, self.chunk)
        if self.free is None:
            return batches
        rx, ry, rz = self.free.tolist()
        name = f"{batches.name} free {','.join(names_of(self.free))}"
        return replace(batches, name=name, evaluate=HangingFreely(self.quantity, (rx, ry, rz)))

    def answered(self, columns: Columns, resumed: int = 0) -> MapResult:
        """The result of columns that were computed; `resumed` chunks came from an earlier, interrupted run."""
        values = quantity_of(self.quantity).finished(self.robot, self.grid, columns)
        told = statics_map.map_json(self.robot, self.quantity, self.grid, values) | {"resumed_chunks": resumed}
        if self.free is not None:
            told["free"] = {"angles": names_of(self.free)}
            angles = "rx_deg, ry_deg and rz_deg of map.csv are the angles found."
            said = f"{', '.join(names_of(self.free))} were left free: {angles}"
            told["warnings"] = [said, *told["warnings"]]
        answer = with_extensions(told, self.robot, _kin(self.quantity))
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
) -> MapQuestion:
    """What the arguments of `map` ask for.

    Raises
    ------
    InputError : an unusable argument, or more poses than a followed mode can be kept of.
    """
    if grid is None:
        raise InputError("grid", "", "nothing", "give X0:X1:NX,Y0:Y1:NY,Z, like -3:3:13,-3:3:13,0.5")
    if chunk is not None:
        whole(chunk, "chunk", 1, 100_000)
    machine, poses = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature), read_grid(grid)
    name = "nothing" if quantity is None else quantity
    if name.startswith("pose-error"):
        require_locked_lengths(machine, "a pose error is that of locked lengths")
    if free is not None:
        require_locked_lengths(machine, "free angles are found for cables of locked lengths")
    try:
        what = quantity_of(name)
    except KeyError as error:
        raise InputError("quantity", "", name, error.args[0]) from None
    if what.most_poses is not None and poses.size > (most := what.most_poses(machine)):
        right = f"at most {most} poses for {name}, which keeps the mode shapes of all poses in memory"
        raise InputError("grid", "", f"{poses.size} poses", right)
    if free is None:
        return MapQuestion(machine, poses, name, chunk)
    if name.startswith(("mode-", "pose-error")):
        raise InputError("free", "", free, f"{name} is computed at the orientation of the grid; leave it out")
    return MapQuestion(machine, poses, name, chunk, read_free(free, len(machine.cables))[0])


def require_drawable(grid: Grid) -> None:
    """Refuse to draw over a grid without an axis.

    Raises
    ------
    InputError : it has a single pose.
    """
    if not grid.free:
        raise InputError("grid", "", "a single pose", "give a range for x, y or z to draw over")


def _kin(quantity: str) -> str:
    """The command that knows the extensions which this quantity knows."""
    if quantity.startswith("pose-error"):
        return "pose-error"
    return "map" if quantity.startswith(("first-", "mode-")) or quantity == "frequencies" else "inverse"
