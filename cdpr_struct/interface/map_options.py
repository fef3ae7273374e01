"""Which free angles, wrenches, zones and requirements does a map take?"""

from collections.abc import Callable, Iterable
from typing import TypeAlias

from cdpr_struct.errors import InputError
from cdpr_struct.interface.arguments import SMALLEST, real, whole
from cdpr_struct.interface.free_angles import FreeAngles, read_free
from cdpr_struct.interface.winches import require_locked_lengths, require_own_winches
from cdpr_struct.interface.workspace import WORKSPACE, WorkspaceQuestion, read_requirements, require_entered
from cdpr_struct.interface.wrenches import WrenchesLike, read_wrenches
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.margins import NO_WRENCH, ZONE, distances, margins
from cdpr_struct.workspace.requirements import ManyQuantities
from cdpr_struct.workspace.work_list import Columns

OWN_LENGTHS = "a pose error is that of lengths which each cable has of its own"
ONCE = 1
"""Halving of the grid where a workspace ends, if nothing else is asked."""
Three: TypeAlias = tuple[bool, bool, bool]
More: TypeAlias = tuple[str | Iterable[str] | None, WrenchesLike | None, int, float]


def free_axes(free: FreeAngles | None, robot: Robot, grid: Grid) -> Three | None:
    """Which of rx, ry, rz hang freely, None if nothing was asked for."""
    if free is None:
        return None
    rx, ry, rz = read_free(free, robot, grid.angles)[0].tolist()
    return rx, ry, rz


def own_compute(name: str, evaluates: Callable[..., Columns], more: More) -> ManyQuantities | None:
    """What computes a quantity with a set of wrenches or an anchor zone, where they are given."""
    _, wrenches, refine, zone = more
    if refine != ONCE:
        raise InputError("refine", "", refine, f"only `quantity` {WORKSPACE} has an end to refine; leave it out")
    if wrenches is not None and evaluates is not margins:
        raise InputError("wrenches", "", name, "a quantity that asks for wrenches: slack-margin, force-margin, ...")
    if zone != ZONE and evaluates is not distances:
        raise InputError("anchor_zone", "", name, "only for cable-distance, body-distance and workspace")
    if wrenches is None and zone == ZONE:
        return None
    return ManyQuantities((name,), NO_WRENCH if wrenches is None else read_wrenches(wrenches), _zone(zone))


def workspace_question(
    robot: Robot, grid: Grid, name: str, chunk: int | None, free: FreeAngles | None, more: More
) -> WorkspaceQuestion:
    """Where all requirements hold.

    Raises
    ------
    InputError : an unusable requirement, or a grid without an extent.
    """
    require, wrenches, refine, zone = more
    if name != WORKSPACE:
        raise InputError("require", "", name, f"requirements belong to `quantity` {WORKSPACE}")
    if not grid.free:
        raise InputError("grid", "", "a single pose", "give a range for x, y or z: a workspace has an extent")
    asked = None if wrenches is None else read_wrenches(wrenches)
    required = read_requirements(require, asked)
    names = tuple(dict.fromkeys(one.quantity for one in required))
    require_entered(robot, names)
    errors = any(one.startswith("pose-error") for one in names)
    if errors:
        require_locked_lengths(robot, "a pose error is that of locked lengths")
        require_own_winches(robot, OWN_LENGTHS)
    if free is not None and errors:
        raise InputError("free", "", free, "pose errors are computed at the orientation of the grid; leave it out")
    compute = ManyQuantities(names, NO_WRENCH if asked is None else asked, _zone(zone))
    times = whole(refine, "refine", 0, 6)
    return WorkspaceQuestion(robot, grid, required, compute, times, chunk, free_axes(free, robot, grid))


def _zone(given: float) -> float:
    return real(given, "anchor_zone", "give a length in m, zero or more", -SMALLEST)
