"""Robot files (TOML): read, check with messages that name the field, write."""

import tomllib
from importlib import resources
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, PositiveFloat, ValidationError

from cdpr_struct.errors import InputError
from cdpr_struct.robot.cable import Cable, Pulley
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot

Vector = Annotated[list[FiniteFloat], Field(min_length=3, max_length=3)]
Matrix = Annotated[list[Vector], Field(min_length=3, max_length=3)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=False, allow_inf_nan=False)


class PlatformTable(_Table):
    mass: PositiveFloat
    center_of_mass: Vector = [0.0, 0.0, 0.0]
    inertia: Matrix


class CableTable(_Table):
    axial_stiffness: PositiveFloat | None = None
    linear_density: PositiveFloat | None = None
    damping_ratio: Annotated[float, Field(ge=0.0, lt=1.0)] | None = None


class PulleyTable(_Table):
    radius: PositiveFloat
    axis: Vector = [0.0, 0.0, 1.0]


class CablesEntry(CableTable):
    platform_anchor: Vector
    frame_anchor: Vector
    pulley: PulleyTable | None = None


class RobotTable(_Table):
    name: str
    description: str = ""
    gravity: PositiveFloat = 9.81
    home_pose: Annotated[list[FiniteFloat], Field(min_length=3, max_length=6)] | None = None
    platform: PlatformTable
    cable: CableTable = CableTable()
    cables: Annotated[list[CablesEntry], Field(min_length=1)]
    extensions: dict[str, Any] = {}


def builtin_names() -> list[str]:
    """Names of the robots that come with the package, sorted."""
    files = resources.files("cdpr_struct.robot.builtin").iterdir()
    return sorted(Path(f.name).stem for f in files if f.name.endswith(".toml"))


def load_robot(name_or_path: str | Path) -> Robot:
    """Robot from a built-in name or a path to a robot file.

    Raises
    ------
    InputError : no such robot, not TOML, or a field that is missing, unknown or out of range.
    """
    text, source = _read(str(name_or_path))
    try:
        table = RobotTable.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise InputError(source, "", str(error), "a TOML file") from error
    except ValidationError as error:
        raise input_error(source, error) from error
    return _build(table, source)


def input_error(source: str, error: ValidationError) -> InputError:
    """The first complaint of pydantic as one sentence with file, field, value and what would be right."""
    first = error.errors()[0]
    field = "".join(f"[{p + 1}]" if isinstance(p, int) else f".{p}" for p in first["loc"]).lstrip(".")
    value = "nothing" if first["type"] == "missing" else first["input"]
    expected = {"extra_forbidden": "no such key is known here", "missing": "this key is required"}
    return InputError(source, field, value, expected.get(first["type"], first["msg"].lower()))


def _read(name: str) -> tuple[str, str]:
    if name in builtin_names():
        return resources.files("cdpr_struct.robot.builtin").joinpath(f"{name}.toml").read_text("utf-8"), name
    try:
        return Path(name).read_text("utf-8"), name
    except (OSError, UnicodeDecodeError) as error:
        known = ", ".join(builtin_names())
        raise InputError("ROBOT", "", name, f"a robot file that can be read, or one of: {known}") from error


def _build(table: RobotTable, source: str) -> Robot:
    cables = tuple(_cable(table.cable, entry, source, i) for i, entry in enumerate(table.cables, start=1))
    pulleys = tuple(_pulley(entry) for entry in table.cables)
    body = table.platform
    try:
        platform = Platform(body.mass, np.array(body.center_of_mass), np.array(body.inertia))
        return Robot(
            name=table.name,
            description=table.description,
            gravity=table.gravity,
            home=None if table.home_pose is None else Pose.from_degrees(table.home_pose),
            platform=platform,
            cables=cables,
            platform_anchors=np.array([e.platform_anchor for e in table.cables]),
            frame_anchors=np.array([e.frame_anchor for e in table.cables]),
            pulleys=pulleys,
        )
    except ValueError as error:
        raise InputError(source, "robot", table.name, str(error)) from error


def _pulley(entry: CablesEntry) -> Pulley | None:
    return None if entry.pulley is None else Pulley(entry.pulley.radius, np.array(entry.pulley.axis))


def _cable(default: CableTable, entry: CablesEntry, source: str, number: int) -> Cable:
    values: dict[str, Any] = {}
    for name in ("axial_stiffness", "linear_density", "damping_ratio"):
        own = getattr(entry, name)
        values[name] = getattr(default, name) if own is None else own
    for name in ("axial_stiffness", "linear_density"):
        if values[name] is None:
            raise InputError(source, f"cables[{number}].{name}", "nothing", "give it here or in the [cable] table")
    return Cable(values["axial_stiffness"], values["linear_density"], values["damping_ratio"] or 0.0)
