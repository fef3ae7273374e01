"""Campaign files: a TOML table naming the simulation under test, the tolerances and the measured data files."""

from dataclasses import fields, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from cdpr_struct.errors import InputError, not_utf8
from cdpr_struct.measurement.ambient_cases import ambient_notes, join_ambient
from cdpr_struct.measurement.ambient_choice import given_choice
from cdpr_struct.measurement.assumed_angles import angle_note
from cdpr_struct.measurement.campaign import AMBIENT, UNKNOWN_ZERO, Campaign, Sheet, Sigmas, States
from cdpr_struct.measurement.campaign_cases import Gathering
from cdpr_struct.measurement.campaign_rows import Rows, read_rows
from cdpr_struct.measurement.campaign_sources import is_there
from cdpr_struct.measurement.campaign_template import KINDS
from cdpr_struct.measurement.identified import lost_notes
from cdpr_struct.measurement.known_robots import require_known
from cdpr_struct.measurement.loss import Loss
from cdpr_struct.measurement.missing_readings import check_placed, missing_notes
from cdpr_struct.measurement.misspelt_cases import misspelt_notes
from cdpr_struct.measurement.robot_scale import check_robot_scale
from cdpr_struct.measurement.signal_cases import join_signals
from cdpr_struct.measurement.swivel_readings import check_swivels
from cdpr_struct.measurement.unit_scale import check_scale
from cdpr_struct.robot.file_complaints import input_error
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import (
    Matrix,
    NotNegative,
    Positive,
    Vector,
    builtin_names,
    load_robot,
)
from cdpr_struct.robot.tolerance_table import TolerancesTable
from cdpr_struct.robot.tolerances import Tolerances
from cdpr_struct.robot.toml_text import toml_table

Kind = Literal[
    "static_state",
    "loaded_pose",
    "cable_frequency",
    "robot_frequency",
    "frf",
    "free_decay",
    "platform_motion",
    "ambient",
]

_CASES_NAMED = 6  # of those with a pose, where one is asked for


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class SigmaTable(_Table):
    tension_N: Positive | None = None
    position_m: Positive | None = None
    rotation_deg: Positive | None = None
    length_m: Positive | None = None
    frequency_hz: Positive | None = None
    acceleration: Positive | None = None
    swivel_deg: Positive | None = None


class MeasurementTable(_Table):
    kind: Kind
    file: str
    sigma: SigmaTable = SigmaTable()
    band_hz: Annotated[list[NotNegative], Field(min_length=2, max_length=2)] | None = None
    order: int | None = None
    frequencies_hz: Annotated[list[Positive], Field(min_length=1)] | None = None


class NominalTable(_Table):
    platform_mass: Positive | None = None
    center_of_mass: Vector | None = None
    platform_inertia: Matrix | None = None
    axial_stiffness: Positive | None = None
    linear_density: Positive | None = None
    gravity: Positive | None = None
    assembly: Literal["consistent", "thesis"] = "consistent"


class LossTable(_Table):
    wrong_name: Positive | None = None
    too_wide: Positive | None = None
    unknown: Positive | None = None


class CampaignTable(_Table):
    robot: str
    model: Literal["static", "dsm", "exact", "spring"] = "dsm"
    tension_distribution: Literal["minimum_norm"] = "minimum_norm"
    lower_bound_N: NotNegative | None = None
    encoders: Literal["absolute", "relative"] = "absolute"
    nominal: NominalTable = NominalTable()
    tolerances: TolerancesTable = TolerancesTable()
    checked: dict[str, Positive] = {}
    loss: LossTable = LossTable()
    measurement: Annotated[list[MeasurementTable], Field(min_length=1)]


def load_campaign(
    path: str | Path, lower_bound: float | None = None, upper_bound: float | None = None, planned: bool = False
) -> Campaign:
    """Campaign of a TOML file with the data files it names, all checked.

    lower_bound, upper_bound : of the tensions that the simulation commands [N], in place of the campaign's and robot's
    planned : a template that is not filled stands for what it predicts

    Raises
    ------
    InputError : a file, field, row or value that cannot be used, and what would be right.
    """
    source = Path(path)
    table = _table(source)
    entered = _robot(table.robot, source)
    require_known(entered, {entry.kind for entry in table.measurement}, source)
    robot = _nominal(entered, table.nominal, source)
    robot = robot if upper_bound is None else _below(robot, upper_bound, source)
    lowest = table.lower_bound_N if lower_bound is None else lower_bound
    commanding, relative = _commanding(robot, lowest, source), table.encoders == "relative"
    gathering = Gathering(len(robot.cables))
    sheets, cases, choices = [], {}, []
    for number, entry in enumerate(table.measurement, start=1):
        choices += given_choice(entry.kind == AMBIENT, entry.model_dump(), str(source), f"measurement[{number}]")
        rows, sigmas = _rows(entry, source, number, len(robot.cables), planned, relative), _sigmas(entry)
        check_swivels(rows, robot)
        gathering.add(rows, sigmas)
        cases[entry.file] = rows.words.get("case", [])
        sheets.append(_sheet(entry, rows, sigmas))
    _check_poses(gathering)
    check_scale(str(path), robot, _absolute(gathering.states(), relative))
    check_robot_scale(str(path), robot, gathering.states(), gathering.tension_files())
    listed = (gathering.cable_frequencies().state, gathering.robot_frequencies().state, gathering.ambient_states())
    check_placed(str(path), gathering.states(), np.concatenate(listed))
    ambient = join_ambient(gathering, choices)
    identified = join_signals(gathering, commanding, table.model)
    given = table.tolerances.stated()
    return Campaign(
        source=str(path),
        robot=robot,
        robot_name=table.robot,
        model=table.model,
        tolerances=_tolerances(robot, given, relative, source),
        stated=frozenset({**robot.tolerances, **given}),
        states=gathering.states(),
        cable_frequencies=gathering.cable_frequencies(),
        robot_frequencies=gathering.robot_frequencies(),
        series=tuple(series for series, _ in gathering.series),
        identified=identified,
        assembly=table.nominal.assembly,
        tension_distribution=table.tension_distribution,
        lower_bound=lowest,
        checked=table.checked,
        relative_lengths=relative,
        loss=_loss(table.loss, source),
        sheets=tuple(sheets),
        notes=(
            *(note for sheet in sheets if (note := angle_note(sheet.file, sheet.columns))),
            *misspelt_notes(cases),
            *missing_notes(gathering.states()),
            *lost_notes([item.record for item in identified]),
            *ambient_notes(ambient),
        ),
        ambient=ambient,
    )


def _absolute(states: States, relative: bool) -> States:
    """The states with lengths that can be held against the robot's size."""
    return replace(states, length=np.full_like(states.length, np.nan)) if relative else states


def _tolerances(robot: Robot, given: dict[str, float], relative: bool, source: Path) -> Tolerances:
    """Those stated here, those of the robot file, and the defaults of the others; where encoders begin anywhere, their
    zeros are not known at all."""
    if relative and "length_m" in given:
        expected = 'no tolerance of the zeros beside encoders = "relative": these are unknown'
        raise InputError(str(source), "tolerances.length_m", given["length_m"], expected)
    return Tolerances(**{**robot.tolerances, **given, **({"length_m": UNKNOWN_ZERO} if relative else {})})


def _table(source: Path) -> CampaignTable:
    try:
        text = source.read_text("utf-8-sig")
    except UnicodeDecodeError as error:
        raise not_utf8(str(source), error) from error
    except (OSError, ValueError) as error:
        raise InputError("CAMPAIGN", "", str(source), "a campaign file (TOML) that can be read") from error
    try:
        table = toml_table(text, str(source))
        if isinstance(table.get("measurement"), dict):
            raise InputError(str(source), "[measurement]", "single brackets", "[[measurement]], one for each file")
        return CampaignTable.model_validate(table)
    except ValidationError as error:
        raise _kind_error(source, error) or input_error(str(source), error, CampaignTable) from error


def _kind_error(source: Path, error: ValidationError) -> InputError | None:
    """What to say of a kind that `new-campaign` calls by another name; None if it is not that."""
    first = error.errors()[0]
    place = first["loc"]
    meant = KINDS.get(str(first["input"])) if place[0] == "measurement" and place[-1] == "kind" else None
    if meant is None or len(place) != 3:
        return None
    said = f"{first['input']} is a word of new-campaign: its readings are in files of the kind {meant}"
    return InputError(str(source), f"measurement[{int(place[1]) + 1}].kind", first["input"], said)


def _robot(name: str, source: Path) -> Robot:
    if name in builtin_names():
        return load_robot(name)
    if not is_there(source.parent / name):
        known = ", ".join(builtin_names())
        raise InputError(str(source), "robot", name, f"a robot file, its path as seen from here, or one of: {known}")
    return load_robot(source.parent / name)


def _below(robot: Robot, upper_bound: float, source: Path) -> Robot:
    """The robot with another largest cable force."""
    try:
        return robot.with_force_limits(upper=upper_bound)
    except ValueError as error:
        expected = f"a force in N above every force_min of the robot, {robot.force_min.max():g} N"
        raise InputError(str(source), "upper bound", upper_bound, expected) from error


def _commanding(robot: Robot, lower_bound: float | None, source: Path) -> Robot:
    """The robot with the lower bound of force that the simulation commands within, if the campaign gives one."""
    try:
        return robot.with_force_limits(lower_bound)
    except ValueError as error:
        expected = f"a force in N below the robot's least force_max, {robot.force_max.min():g} N"
        raise InputError(str(source), "lower_bound_N", lower_bound, expected) from error


def _loss(table: LossTable, source: Path) -> Loss:
    """The costs of mistakes, those of the default where none is given."""
    given = {k: v for k, v in table.model_dump().items() if v is not None}
    try:
        return Loss(**given)
    except ValueError as error:
        usual = Loss()
        expected = (
            "wrong_name above unknown above too_wide; those not given are "
            f"{usual.wrong_name:g}, {usual.unknown:g} and {usual.too_wide:g}"
        )
        said = ", ".join(f"{k} = {v:g}" for k, v in given.items())
        raise InputError(str(source), "loss", said, expected) from error


def _rows(entry: MeasurementTable, source: Path, number: int, cables: int, planned: bool, relative: bool) -> Rows:
    path = source.parent / entry.file
    if not is_there(path):
        expected = "no such data file; give its path as seen from the campaign file"
        raise InputError(str(source), f"measurement[{number}].file", entry.file, expected)
    return read_rows(entry.kind, path, cables, planned, relative)


def _sigmas(entry: MeasurementTable) -> Sigmas:
    given = {f.name: getattr(entry.sigma, f.name) for f in fields(Sigmas)}
    return replace(Sigmas(), **{k: v for k, v in given.items() if v is not None})


def _check_poses(gathering: Gathering) -> None:
    """Every signal needs a pose: said before minutes go into its modes."""
    for series, _ in gathering.series:
        missing = [case for case in series.case if case not in gathering.known]
        if "x_m" in series.columns or not missing:
            continue
        case, known = missing[0], "; ".join(list(gathering.known)[:_CASES_NAMED])
        expected = (
            f"this file carries no pose, so give that of case {case} in another file (static_state or loaded_pose), or "
            "as columns x_m, y_m, z_m[, rx_deg, ry_deg, rz_deg] of a CSV file"
        )
        expected += f". Cases with a pose: {known}" if known else ""
        raise InputError(series.file, f"case {case}", "no pose", expected)


def _sheet(entry: MeasurementTable, rows: Rows, sigmas: Sigmas) -> Sheet:
    stated = {name for name, value in entry.sigma.model_dump().items() if value is not None}
    return Sheet(entry.kind, entry.file, (*rows.numbers, *rows.words), sigmas, frozenset(stated), rows.headings)


def _nominal(robot: Robot, table: NominalTable, source: Path) -> Robot:
    """The robot with the overrides of the [nominal] table.

    Raises
    ------
    InputError : overrides that no platform has.
    """
    body, cables = robot.platform, robot.cables
    changes: dict[str, Any] = {
        "mass": table.platform_mass,
        "center_of_mass": None if table.center_of_mass is None else np.array(table.center_of_mass),
        "inertia": None if table.platform_inertia is None else np.array(table.platform_inertia),
    }
    try:
        body = replace(body, **{k: v for k, v in changes.items() if v is not None})
    except ValueError as error:
        raise InputError(str(source), "nominal.platform_inertia", table.platform_inertia, str(error)) from error
    cables = tuple(
        replace(
            c,
            axial_stiffness=table.axial_stiffness or c.axial_stiffness,
            linear_density=table.linear_density or c.linear_density,
        )
        for c in cables
    )
    return replace(robot, platform=body, cables=cables, gravity=table.gravity or robot.gravity)
