"""Requirements files (TOML): limits on predictions, where they hold, and with which probability."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from cdpr_struct.errors import InputError, not_utf8
from cdpr_struct.interface.arguments import read_grid, read_pose
from cdpr_struct.robot.file_complaints import input_error
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.toml_text import toml_table

Quantity = Literal["frequency", "platform_frequency", "tension", "strain", "position_error", "rotation_error"]
UNITS: dict[str, str] = {
    "frequency": "Hz",
    "platform_frequency": "Hz",
    "tension": "N",
    "strain": "1",
    "position_error": "m",
    "rotation_error": "deg",
}
_MOST_POSES = 2000
_Limit = Annotated[float, Field(strict=True, ge=0.0, le=1e12)]
_Place = list[Annotated[float, Field(strict=True)]]


class RequirementTable(BaseModel):
    """One limit; `mode` of frequencies, counted from the lowest, `cable` of tension and strain (all if not given)."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    name: Annotated[str, Field(min_length=1)]
    quantity: Quantity
    at_least: _Limit | None = None
    at_most: _Limit | None = None
    mode: Annotated[int, Field(strict=True, ge=1, le=100)] = 1
    cable: Annotated[int, Field(strict=True, ge=1)] | None = None
    probability: Annotated[float, Field(strict=True, gt=0.5, lt=1.0)] = 0.95

    @model_validator(mode="after")
    def _one_limit(self) -> "RequirementTable":
        if (self.at_least is None) == (self.at_most is None):
            raise ValueError("give at_least or at_most, one of the two")
        return self

    @property
    def limit(self) -> float:
        """The one that is given."""
        return float(self.at_least if self.at_most is None else self.at_most)  # type: ignore[arg-type]

    @property
    def words(self) -> str:
        """The requirement in words."""
        side = "at least" if self.at_most is None else "at most"
        unit = "" if UNITS[self.quantity] == "1" else f" {UNITS[self.quantity]}"
        return f"{self._what} {side} {self.limit:g}{unit}, probability {self.probability:g}"

    @property
    def _what(self) -> str:
        if self.quantity == "frequency":
            return f"frequency of mode {self.mode}"
        if self.quantity == "platform_frequency":
            return f"frequency of platform mode {self.mode}"
        if self.quantity in ("tension", "strain"):
            return f"{self.quantity} of {'every cable' if self.cable is None else f'cable {self.cable}'}"
        return self.quantity.replace("_", " ")


class RequirementsTable(BaseModel):
    """A requirements file: poses or a grid, and limits."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    poses: list[_Place] | None = None
    grid: str | None = None
    requirement: Annotated[list[RequirementTable], Field(min_length=1)]


@dataclass(frozen=True, slots=True, eq=False)
class Requirements:
    """Limits, and the poses where they are to hold."""

    limits: tuple[RequirementTable, ...]
    poses: tuple[Pose, ...]


def read_requirements(path: str | os.PathLike[str], robot: Robot) -> Requirements:
    """Requirements of a file for a robot; without poses and grid they are for the home pose.

    Raises
    ------
    InputError : a file, field or value that cannot be used, and what would be right.
    """
    source = os.fspath(path)
    try:
        text = Path(path).read_text("utf-8-sig")
    except UnicodeDecodeError as error:
        raise not_utf8(source, error) from error
    except (OSError, ValueError) as error:
        raise InputError("REQUIREMENTS", "", source, "a requirements file (TOML) that can be read") from error
    try:
        table = RequirementsTable.model_validate(toml_table(text, source))
    except ValidationError as error:
        raise input_error(source, error, RequirementsTable) from error
    for number, one in enumerate(table.requirement, start=1):
        if one.cable is not None and one.cable > len(robot.cables):
            expected = f"a cable from 1 to {len(robot.cables)}"
            raise InputError(source, f"requirement[{number}].cable", one.cable, expected)
    return Requirements(tuple(table.requirement), _poses(table, robot, source))


def _poses(table: RequirementsTable, robot: Robot, source: str) -> tuple[Pose, ...]:
    if table.poses is not None and table.grid is not None:
        raise InputError(source, "grid", table.grid, "give poses or a grid, not both")
    if table.grid is not None:
        grid = read_grid(table.grid)
        if grid.size > _MOST_POSES:
            raise InputError(source, "grid", table.grid, f"at most {_MOST_POSES} poses")
        return tuple(Pose(position, grid.angles) for position in grid.positions)
    given = [None] if table.poses is None else table.poses
    return tuple(read_pose(values, robot, f"{source}: poses") for values in given)
