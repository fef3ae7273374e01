"""Robot files (TOML): read, check with messages that name the field, write."""

import math
from importlib import resources
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from cdpr_struct.errors import InputError, known_names
from cdpr_struct.robot.body_table import BodyTable, body_of
from cdpr_struct.robot.cable import LARGEST_EXPANSION, Cable, Pulley
from cdpr_struct.robot.extensions import Extensions, divided_mast
from cdpr_struct.robot.file_complaints import input_error
from cdpr_struct.robot.lump import LumpTable, lumps_fault
from cdpr_struct.robot.parameters import EXTENSIONS
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.remainder import Remainder
from cdpr_struct.robot.robot import FREEDOMS, Robot, cable_drag_fault, internal_mass_fault, swinging_mass_fault
from cdpr_struct.robot.tolerance_table import PosteriorTable, RemainderTable, TolerancesTable
from cdpr_struct.robot.toml_text import toml_table
from cdpr_struct.robot.winches import winches_fault

LARGEST, SMALLEST = 1e12, 1e-12  # of any number; beyond them squares and products leave what can be computed
Number = Annotated[float, Field(strict=True, ge=-LARGEST, le=LARGEST)]
Positive = Annotated[float, Field(strict=True, gt=SMALLEST, le=LARGEST)]
NotNegative = Annotated[float, Field(strict=True, ge=0.0, le=LARGEST)]
Limit = Annotated[float, Field(strict=True, gt=SMALLEST, allow_inf_nan=True)]  # inf: none
Vector = Annotated[list[Number], Field(min_length=3, max_length=3)]
Matrix = Annotated[list[Vector], Field(min_length=3, max_length=3)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=False, allow_inf_nan=False)


class PlatformTable(_Table):
    mass: Positive
    center_of_mass: Vector = [0.0, 0.0, 0.0]
    inertia: Matrix
    guided: list[Any] = []


class CableNumbers(_Table):
    axial_stiffness: Positive | None = None
    linear_density: Positive | None = None
    damping_ratio: Annotated[float, Field(strict=True, ge=0.0, lt=1.0)] | None = None
    thermal_expansion: Annotated[float, Field(strict=True, ge=-LARGEST_EXPANSION, le=LARGEST_EXPANSION)] | None = None
    force_min: NotNegative | None = None
    force_max: Limit | None = None
    winch_tension: NotNegative | None = None


class PulleyTable(_Table):
    radius: Positive
    axis: Vector = [0.0, 0.0, 1.0]


class CableTable(CableNumbers):
    pulley: PulleyTable | None = None


class CablesEntry(CableTable):
    platform_anchor: Vector
    frame_anchor: Vector
    winch: Annotated[str, Field(strict=True, min_length=1)] | None = None
    winch_ratio: Number = 1.0
    home_length: Positive | None = None


class RobotTable(_Table):
    name: Annotated[str, Field(min_length=1)]
    description: str = ""
    gravity: Any = 9.81
    home_pose: Annotated[list[Number], Field(min_length=3, max_length=6)] | None = None
    platform: PlatformTable
    cable: CableTable = CableTable()
    cables: Annotated[list[CablesEntry], Field(min_length=1)]
    extensions: dict[str, Any] = {}
    bodies: list[BodyTable] = []
    lumps: list[LumpTable] = []
    tolerances: TolerancesTable = TolerancesTable()
    posterior: PosteriorTable | None = None
    remainder: RemainderTable | None = None


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
    return robot_of_text(*_read(str(name_or_path)))


def robot_of_text(text: str, source: str) -> Robot:
    """Robot from the text of a robot file; complaints call the file `source`.

    Raises
    ------
    InputError : as `load_robot`.
    """
    try:
        table = RobotTable.model_validate(toml_table(text, source))
    except ValidationError as error:
        raise input_error(source, error, RobotTable) from error
    return _build(table, source)


def _read(name: str) -> tuple[str, str]:
    if name in builtin_names():
        return resources.files("cdpr_struct.robot.builtin").joinpath(f"{name}.toml").read_text("utf-8"), name
    try:
        return Path(name).read_text("utf-8-sig"), name
    except (OSError, ValueError) as error:
        known = ", ".join(builtin_names())
        raise InputError("ROBOT", "", name, f"a robot file that can be read, or one of: {known}") from error


def _build(table: RobotTable, source: str) -> Robot:
    cables = tuple(_cable(table.cable, entry, source, i) for i, entry in enumerate(table.cables, start=1))
    pulleys = tuple(_pulley(table.cable, entry, source, i) for i, entry in enumerate(table.cables, start=1))
    home = _home(table.home_pose, source)
    platform, more = _with_joints(_platform(table.platform, source), table, source), _extensions(table, source)
    if fault := internal_mass_fault(platform, more):
        raise InputError(source, "extensions.internal_mass", more.internal_mass, fault)
    if fault := swinging_mass_fault(platform, more):
        raise InputError(source, "extensions.swinging_mass", more.swinging_mass, fault)
    gravity = _gravity(table.gravity, source)
    if fault := cable_drag_fault(more, float(np.linalg.norm(gravity))):
        raise InputError(source, "extensions.drag_width", table.extensions["drag_width"], fault)
    if fault := winches_fault(cables):
        first = next(cable for cable in cables if cable.winch or cable.home_length)
        raise InputError(source, "cables.winch", first.winch or "nothing", fault)
    lumps = tuple(entry.lump for entry in table.lumps)
    if fault := lumps_fault(lumps, len(cables), more, float(np.linalg.norm(gravity))):
        raise InputError(source, "lumps", f"{len(lumps)} of them", fault)
    try:
        return Robot(
            name=table.name,
            description=table.description,
            gravity=gravity,
            guided=_guided(table.platform.guided, source),
            home=home,
            platform=platform,
            cables=cables,
            platform_anchors=np.array([e.platform_anchor for e in table.cables]),
            frame_anchors=np.array([e.frame_anchor for e in table.cables]),
            pulleys=pulleys,
            extensions=more,
            lumps=lumps,
            tolerances=table.tolerances.stated(),
            posterior=None if table.posterior is None else table.posterior.spread(len(cables), source),
            remainder=None if table.remainder is None else Remainder(**table.remainder.model_dump()),
            bodies=tuple(body_of(entry, source, i) for i, entry in enumerate(table.bodies, start=1)),
        )
    except InputError:
        raise
    except ValueError as error:
        raise InputError(source, "robot", table.name, str(error)) from error


def _gravity(given: Any, source: str) -> Any:
    """A size, downwards, or a vector."""
    expected = "give a number in m/s^2, zero or more, or three in square brackets, like [0.0, 1.7, -9.66]"
    _require_numbers("gravity", given, 3, expected, source)
    if not isinstance(given, list) and given < 0.0:
        raise InputError(source, "gravity", given, expected)
    return np.array(given, dtype=float) if isinstance(given, list) else float(given)


def _guided(given: list[Any], source: str) -> tuple[str, ...]:
    """Freedoms that a guide holds, in their order."""
    if any(name not in FREEDOMS for name in given) or len(set(given)) < len(given) or len(given) == len(FREEDOMS):
        expected = f"give some of {', '.join(FREEDOMS)} in quotes, each once, and leave at least one free"
        raise InputError(source, "platform.guided", given, expected)
    return tuple(name for name in FREEDOMS if name in given)


def _home(values: list[float] | None, source: str) -> Pose | None:
    if values is None:
        return None
    if len(values) not in (3, 6):
        raise InputError(source, "home_pose", values, "give 3 or 6 numbers x,y,z[,rx,ry,rz] in m and deg")
    return Pose.from_degrees(values)


def _platform(body: PlatformTable, source: str) -> Platform:
    try:
        return Platform(body.mass, np.array(body.center_of_mass), np.array(body.inertia))
    except ValueError as error:
        raise InputError(source, "platform.inertia", body.inertia, str(error)) from error


def _extensions(table: RobotTable, source: str) -> Extensions:
    """Extensions of a robot file; every complaint names the key."""
    given = {name: value for name, value in table.extensions.items() if name not in ("causes", "joint_mass")}
    causes = table.extensions.get("causes", [])
    if not isinstance(causes, list) or not all(isinstance(c, str) for c in causes):
        raise InputError(source, "extensions.causes", causes, "give a list of names in quotes")
    for name, value in given.items():
        if name not in EXTENSIONS:
            known = known_names(name, ["causes", "joint_mass", *EXTENSIONS])
            raise InputError(source, f"extensions.{name}", value, f"no such key is known here; {known}")
        _check_extension(name, value, len(table.cables), source)
    made = Extensions.of(len(table.cables), given, tuple(causes))
    anchors = np.array([entry.frame_anchor for entry in table.cables])
    for name in ("frame_compliance", "mast_bending"):
        if divided := divided_mast(anchors, getattr(made, name)):
            carried = ", ".join(str(i + 1) for i in divided)
            expected = f"cables {carried} hang on one mast: give equal numbers for them, that of their mast in m/N"
            raise InputError(source, f"extensions.{name}", given[name], expected)
    return made


def _check_extension(name: str, value: Any, cables: int, source: str) -> None:
    key = EXTENSIONS[name]
    count = key.entries(cables)
    single = "one number" if not count else f"{count} numbers in square brackets, or one for all"
    unit = "" if key.unit == "1" else f" in {key.unit}"
    expected = f"give {single}{unit}{key.range}"
    _require_numbers(f"extensions.{name}", value, count, expected, source)
    try:
        Extensions.of(cables, {name: value})
    except ValueError as error:
        raise InputError(source, f"extensions.{name}", value, expected) from error


def _require_numbers(field: str, value: Any, count: int, expected: str, source: str) -> None:
    values = value if isinstance(value, list) else [value]
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) and abs(v) <= LARGEST for v in values)
    if not numbers or (isinstance(value, list) and (not count or len(value) != count)):
        raise InputError(source, field, value, expected)


def _with_joints(platform: Platform, table: RobotTable, source: str) -> Platform:
    """Joints at the platform anchors become part of the platform."""
    masses = table.extensions.get("joint_mass", 0.0)
    count = len(table.cables)
    expected = f"give one mass in kg, zero or more, or {count} in square brackets"
    _require_numbers("extensions.joint_mass", masses, count, expected, source)
    each = np.broadcast_to(np.asarray(masses, dtype=float), (count,))
    if (each < 0.0).any():
        raise InputError(source, "extensions.joint_mass", masses, expected)
    return (
        platform.with_masses_at(each, np.array([e.platform_anchor for e in table.cables])) if each.any() else platform
    )


def _pulley(default: CableTable, entry: CablesEntry, source: str, number: int) -> Pulley | None:
    own = entry.pulley or default.pulley
    if own is None:
        return None
    try:
        return Pulley(own.radius, np.array(own.axis))
    except ValueError as error:
        place = "cable" if entry.pulley is None else f"cables[{number}]"
        raise InputError(source, f"{place}.pulley.axis", own.axis, str(error)) from error


def _cable(default: CableTable, entry: CablesEntry, source: str, number: int) -> Cable:
    values: dict[str, Any] = {}
    for name in CableNumbers.model_fields:
        own = getattr(entry, name)
        values[name] = getattr(default, name) if own is None else own
    for name in ("axial_stiffness", "linear_density"):
        if values[name] is None:
            raise InputError(source, f"cables[{number}].{name}", "nothing", "give it here or in the [cable] table")
    given = {name: value for name, value in values.items() if value is not None}
    _check_limits(given, entry, source, number)
    if not 1e-3 <= abs(entry.winch_ratio) <= 1e3:
        expected = "a ratio from 0.001 to 1000 in size, negative if the cable winds against the others of its winch"
        raise InputError(source, f"cables[{number}].winch_ratio", entry.winch_ratio, expected)
    home = entry.home_length or 0.0
    return Cable(**given, winch=entry.winch or "", winch_ratio=entry.winch_ratio, home_length=home)


def _check_limits(given: dict[str, float], entry: CablesEntry, source: str, number: int) -> None:
    """Force limits of a cable, as far as they are given, each by its own key or that of [cable]."""
    low, high = given.get("force_min", 0.0), given.get("force_max", math.inf)
    for name in ("force_max", "force_min"):
        field = f"cable.{name}" if getattr(entry, name) is None else f"cables[{number}].{name}"
        if name == "force_max" and LARGEST < high < math.inf:
            raise InputError(source, field, high, f"a force in N, at most {LARGEST:g}; without a limit, leave it out")
        if not high > low and name in given:
            other = f"above force_min = {low:g} N" if name == "force_max" else f"below force_max = {high:g} N"
            raise InputError(source, field, given[name], f"give a force in N {other}")
