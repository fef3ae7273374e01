"""Bands of a quantity over the workspace: what may be asked, and what the result says."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.bands.mapped_bands import BANDED, POSE_ERRORS, BandedQuantity
from cdpr_struct.errors import InputError
from cdpr_struct.interface.arguments import LARGEST, real
from cdpr_struct.interface.bands import AskedBand, band_head, spread_of
from cdpr_struct.interface.winches import require_locked_lengths
from cdpr_struct.reports.map_bands_told import map_band_checks, map_bands_told
from cdpr_struct.reports.trust import Trust
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.quantities import quantity_of
from cdpr_struct.workspace.work_list import Columns


def require_no_band(band: float | None, samples: int | None, limit: float | None) -> None:
    """Refuse what only quantities with bands take.

    Raises
    ------
    InputError : one of them is given.
    """
    for name, given in (("band", band), ("samples", samples), ("limit", limit)):
        if given is not None:
            raise InputError(name, "", given, f"a workspace has none; it belongs to a `quantity` like {BANDED[0]}")


def banded_quantity(
    robot: Robot, name: str, asked: AskedBand | None, limit: float | None, alone: bool, free: bool
) -> BandedQuantity:
    """What computes a quantity with a band.

    limit : given, or None;  alone : neither wrenches nor an anchor zone were given;  free : some angles hang freely

    Raises
    ------
    InputError : a limit without a band, or a quantity, or a way to ask for it, that has none.
    """
    if asked is None:
        raise InputError("limit", "", limit, "it belongs to `band`; give that, too, or leave it out")
    require_locked_lengths(robot, "a band is that of locked lengths")
    if name not in BANDED:
        raise InputError("quantity", "", name, f"with `band` one of: {', '.join(BANDED)}")
    if not alone:
        raise InputError("wrenches", "", "given", "with `band` the margin is that of the robot's load; leave it out")
    if free and name in POSE_ERRORS:
        raise InputError(
            "free", "", "given", "with `band` pose errors are those of the grid's orientation; leave it out"
        )
    below = None if limit is None else real(limit, "limit", f"give a number in {quantity_of(name).unit}", -LARGEST)
    return BandedQuantity(name, spread_of(robot), asked.level, below, asked.samples)


def told_with_bands(
    told: Mapping[str, Any], robot: Robot, grid: Grid, values: Columns, banded: BandedQuantity
) -> dict[str, Any]:
    """The result of a map with the key `bands`, and with what is to be doubted of them."""
    asked = AskedBand(banded.level, banded.samples)
    found = map_bands_told(banded.quantity, grid, values, banded.samples, banded.limit)
    checks = Trust((*told["trust"].checks, *map_band_checks(values)))
    return {**told, "bands": band_head(asked, robot) | found, "trust": checks}
