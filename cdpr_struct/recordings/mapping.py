"""The mapping file: which channel of a recording is what, in which unit, and which of its samples make a campaign."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from cdpr_struct.errors import NOTHING, InputError, not_utf8
from cdpr_struct.measurement.campaign_file import SigmaTable
from cdpr_struct.robot.file_complaints import input_error
from cdpr_struct.robot.robot_file import NotNegative, Positive
from cdpr_struct.robot.toml_text import toml_table

UNFILLED = "?"  # in the channels of a template
Numbers = float | list[float]
_QUATERNION, _ANGLES = 4, 3
_LARGEST = 1e12


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class TimeTable(_Table):
    """channel: of the time, where the file does not say it itself; several where groups have times of their own."""

    channel: str | list[str] | None = None
    unit: str = ""
    rate_hz: Positive | None = None
    clock: Literal["stamp", "received"] = "stamp"


class ValuesTable(_Table):
    """Reading times unit times factor plus offset is the value in m or N; the sensor tells it delay_s late."""

    channels: Annotated[list[str], Field(min_length=1)]
    unit: str = ""
    factor: Numbers = 1.0
    offset: Numbers = 0.0
    delay_s: float = 0.0


class PositionTable(ValuesTable):
    channels: Annotated[list[str], Field(min_length=3, max_length=3)]


class RotationTable(_Table):
    """order: wxyz or another one of a quaternion; of angles xyz, about fixed axes, or XYZ, about those that moved."""

    form: Literal["quaternion", "angles", "rotation_vector"]
    channels: Annotated[list[str], Field(min_length=3, max_length=4)]
    order: str = ""
    unit: str = ""
    inverse: bool = False
    delay_s: float = 0.0


class SamplingTable(_Table):
    mode: Literal["still", "motion", "free_motion"] = "still"
    span: Annotated[list[float], Field(min_length=2, max_length=2)] | None = None
    rate_hz: Positive | None = None
    every: Annotated[int, Field(ge=1)] = 1
    largest_gap_s: Positive | None = None
    faulty: Literal["refuse", "leave_out"] = "refuse"
    still_speed: Positive = 0.002
    least_s: Positive = 1.0


class MappingFile(_Table):
    robot: str = ""
    model: Literal["static", "dsm", "exact", "spring"] = "exact"
    encoders: Literal["absolute", "relative"] = "absolute"
    payload_kg: NotNegative = 0.0
    time: TimeTable = TimeTable()
    position: PositionTable | None = None
    rotation: RotationTable | None = None
    lengths: ValuesTable | None = None
    tensions: ValuesTable | None = None
    sampling: SamplingTable = SamplingTable()
    sigma: SigmaTable = SigmaTable()


def load_mapping(path: Path) -> MappingFile:
    """The mapping of a TOML file, checked as far as it can be without the recording.

    Raises
    ------
    InputError : a key, a value or a combination that cannot be used.
    """
    try:
        text = path.read_text("utf-8-sig")
    except UnicodeDecodeError as error:
        raise not_utf8(str(path), error) from error
    except (OSError, ValueError) as error:
        raise InputError("MAPPING", "", str(path), "a mapping file (TOML) that can be read") from error
    try:
        mapping = MappingFile.model_validate(toml_table(text, str(path)))
    except ValidationError as error:
        raise input_error(str(path), error, MappingFile) from error
    return checked(mapping, str(path))


def checked(mapping: MappingFile, source: str) -> MappingFile:
    """The mapping, if its tables fit to each other.

    Raises
    ------
    InputError : a field that cannot be used.
    """
    for name, table in (("position", mapping.position), ("lengths", mapping.lengths), ("tensions", mapping.tensions)):
        if table is not None:
            _check_channels(source, name, table.channels, blanks=name != "position")
            _check_numbers(source, name, table)
    if mapping.rotation is not None:
        _check_channels(source, "rotation", mapping.rotation.channels)
        _check_rotation(source, mapping.rotation)
    if mapping.time.channel is not None and mapping.time.rate_hz is not None:
        raise InputError(source, "time.rate_hz", mapping.time.rate_hz, "a channel of the time or a rate, not both")
    span = mapping.sampling.span
    if span is not None and not span[0] < span[1]:
        raise InputError(source, "sampling.span", span, "a begin and a later end in s, like [10.0, 60.0]")
    _check_quantities(mapping, source)
    return mapping


def _check_channels(source: str, name: str, channels: Sequence[str], blanks: bool = False) -> None:
    if UNFILLED in channels:
        expected = "the name of a channel in place of each ?, or no such table; import-recording FILE lists them"
        raise InputError(source, f"{name}.channels", channels, expected)
    given = [channel for channel in channels if channel]
    if not given or (len(given) < len(channels) and not blanks):
        raise InputError(source, f"{name}.channels", channels, "the name of a channel in each place")
    twice = next((channel for i, channel in enumerate(given) if channel in given[:i]), None)
    if twice is not None:
        raise InputError(source, f"{name}.channels", twice, "each channel once; this one is there twice")


def _check_numbers(source: str, name: str, table: ValuesTable) -> None:
    for key, given in (("factor", table.factor), ("offset", table.offset)):
        values = given if isinstance(given, list) else [given]
        if isinstance(given, list) and len(given) != len(table.channels):
            expected = f"one number, or a list of {len(table.channels)}, one a channel"
            raise InputError(source, f"{name}.{key}", given, expected)
        if not all(abs(v) <= _LARGEST and (key == "offset" or v) for v in values):
            expected = f"numbers of at most {_LARGEST:g}" + (", none of them zero" if key == "factor" else "")
            raise InputError(source, f"{name}.{key}", given, expected)


def _check_rotation(source: str, table: RotationTable) -> None:
    count = _QUATERNION if table.form == "quaternion" else _ANGLES
    if len(table.channels) != count:
        raise InputError(source, "rotation.channels", table.channels, f"{count} channels for a {table.form}")
    order = table.order
    if table.form == "quaternion" and sorted(order) != sorted("wxyz"):
        expected = "wxyz, xyzw or another order: what each of the four channels is, w the real part"
        raise InputError(source, "rotation.order", order or NOTHING, expected)
    if table.form == "angles" and not _is_order(order):
        expected = (
            "three axes in the order in which the platform is turned, each about another axis than the one before: "
            "xyz about fixed axes (rx_deg, ry_deg, rz_deg of a campaign), or ZYX in capitals about axes that moved"
        )
        raise InputError(source, "rotation.order", order or NOTHING, expected)
    if table.form == "rotation_vector" and order:
        raise InputError(source, "rotation.order", order, "no order: a rotation vector has x, y, z")


def _is_order(order: str) -> bool:
    if len(order) != _ANGLES or not (set(order) <= set("xyz") or set(order) <= set("XYZ")):
        return False
    return order[0] != order[1] != order[2]


def _check_quantities(mapping: MappingFile, source: str) -> None:
    free = mapping.sampling.mode == "free_motion"
    if free and mapping.position is None:
        raise InputError(
            source, "position", NOTHING, "the tracked position of the platform: a free motion is read from it"
        )
    if not free and mapping.lengths is None and mapping.tensions is None:
        expected = "[lengths] or [tensions] of the cables, or both; poses alone are read of a free motion"
        raise InputError(source, "lengths", NOTHING, expected)
    if mapping.sampling.mode == "still" and mapping.position is None and mapping.lengths is None:
        expected = "[position] or [lengths]: from these it is seen when the robot stands still"
        raise InputError(source, "position", NOTHING, expected)
