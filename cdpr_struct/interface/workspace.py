"""Where do all requirements hold? The workspace of `map`."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.interface.free_angles import found_angles, told_in_map
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.wrenches import Wrenches
from cdpr_struct.reports import statics_map, workspace_region
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.robot.fingerprint import fingerprint
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.hanging_poses import HangingFreely
from cdpr_struct.workspace.pose_batches import Evaluate, PoseBatches
from cdpr_struct.workspace.region import Region
from cdpr_struct.workspace.requirements import FEASIBLE, ManyQuantities, Requirement, failing
from cdpr_struct.workspace.work_list import Columns

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

WORKSPACE = "workspace"
_BATCH = 512
_MOST_POSES = 4_000_000


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class WorkspaceResult(Result):
    """Where a robot meets all requirements.

    robot : with its load;  grid : of poses;  values : columns of n numbers over it, z runs fastest
    requirements : in their order;  fails : (n, 2 + r) bool, not held, not stable, each requirement
    region : the poses that meet all, on the finest grid, with volume and error
    """

    robot: Robot
    grid: Grid
    values: Columns
    requirements: tuple[Requirement, ...]
    fails: np.ndarray
    region: Region

    @property
    def title(self) -> str:
        """Whose workspace."""
        return f"{self.robot.name}: workspace"

    def text(self) -> str:
        """Volume, and what rejects poses."""
        return "\n".join(self.sentences())

    def sentences(self) -> Sequence[str]:
        """Volume with its error, then one sentence for each reason of rejection."""
        return workspace_region.sentences(self.answer)

    def columns(self) -> Mapping[str, Any]:
        """Columns of map.csv."""
        told = workspace_region.table_columns(self.requirements, self.fails)
        return statics_map.map_table(self.grid, {**self.values, **told}).columns

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """The workspace in slices, and what rejects the other poses."""
        return workspace_region.figure(self.robot, self.grid, self.requirements, self.fails, self.region)

    def files(self) -> Files:
        """Table, figure and page."""
        plates = workspace_region.plates(self.robot, self.grid, self.requirements, self.fails, self.region)
        return workspace_region.files(self.robot, self.grid, self.columns(), plates, self.answer)


@dataclass(frozen=True, slots=True, eq=False)
class WorkspaceQuestion:
    """What is required over which grid; refine : halvings of the grid where the workspace ends."""

    robot: Robot
    grid: Grid
    requirements: tuple[Requirement, ...]
    compute: ManyQuantities
    refine: int
    chunk: int | None
    free: tuple[bool, bool, bool] | None
    ran: list[PoseBatches] = field(default_factory=list)

    def answered_by(self, run: Callable[[PoseBatches], Columns]) -> WorkspaceResult:
        """The result; `run` gives the columns of batches of poses, first of the grid, then of each halving."""
        values = run(self._batches(self.grid.positions))
        fails = failing(self.requirements, values)
        region = Region(self.grid, np.asarray(~fails.any(axis=1)))
        for _ in range(self.refine):
            grid, known, asked = region.next_grid()
            if grid.size > _MOST_POSES:
                raise InputError("refine", "", self.refine, f"the halved grid has {grid.size} poses: refine less")
            holds = known.copy()
            if asked.any():
                found = run(self._batches(grid.positions[asked]))
                holds[asked] = ~failing(self.requirements, found).any(axis=1)
            region = Region(grid, holds, region)
        told = workspace_region.result(self.robot, self.grid, self.requirements, (values, fails), region)
        told["wrenches"] = [list(wrench) for wrench in self.compute.wrenches]
        told["anchor_zone_m"] = self.compute.zone
        told["resumed_chunks"] = 0
        if self.free is not None:
            told = told_in_map(told, self.robot, self.free, found_angles(values))
        answer = with_extensions(told, self.robot, "inverse")
        return WorkspaceResult(answer, self.robot, self.grid, values, self.requirements, fails, region)

    def _batches(self, positions: np.ndarray) -> PoseBatches:
        compute: Any = self.compute if self.free is None else HangingFreely(self.compute, self.free)
        parts = [part for body in self.robot.bodies for part in (body.size, body.center, body.rotation)]
        kinds = "".join(f"{body.shape} {body.fixed_to}" for body in self.robot.bodies)
        name = fingerprint(f"{WORKSPACE} {self.compute} {self.free} {kinds}", *parts)
        batches = PoseBatches(name, compute, self.robot, positions, self.grid.rotation, self.chunk or _BATCH)
        self.ran.append(batches)
        return batches


def read_requirements(given: str | Iterable[str] | None, wrenches: Wrenches | None) -> tuple[Requirement, ...]:
    """Requirements of their texts; a set of wrenches is required to be held, too.

    Raises
    ------
    InputError : a text that is none.
    """
    texts = [given] if isinstance(given, str) else list(given or ())
    found = []
    for text in texts:
        try:
            found.append(Requirement.read(text))
        except ValueError as error:
            raise InputError("require", "", text, str(error)) from None
    if wrenches is not None and FEASIBLE not in [one.quantity for one in found]:
        found.insert(0, Requirement(FEASIBLE, True, 1.0))
    return tuple(dict.fromkeys(found))


def single(compute: Evaluate, batches: PoseBatches) -> PoseBatches:
    """Batches of one quantity with a set of wrenches, a zone or a band of its own."""
    return replace(batches, name=f"{batches.name} {compute}", evaluate=compute)


def require_entered(robot: Robot, quantities: tuple[str, ...]) -> None:
    """Refuse a distance to bodies or a margin to force limits of a robot that has none.

    Raises
    ------
    InputError : a quantity asks for what the robot file does not have.
    """
    if "body-distance" in quantities and not robot.bodies:
        raise InputError(robot.name, "bodies", "none", "enter `[[bodies]]` in the robot file to ask for body-distance")
    if "force-margin" in quantities and not (robot.force_max < np.inf).all():
        hint = "force-margin needs a finite upper bound, here or as force_max in the robot file"
        raise InputError("upper_bound", "", "nothing", hint)
