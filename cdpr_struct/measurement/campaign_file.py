"""Campaign files: a TOML table naming the simulation under test, the tolerances and the measured data files."""

import tomllib
from dataclasses import fields, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, NonNegativeFloat, PositiveFloat, ValidationError

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import Campaign, Sigmas, Tolerances
from cdpr_struct.measurement.campaign_cases import Gathering
from cdpr_struct.measurement.campaign_rows import Rows, read_rows
from cdpr_struct.measurement.signal_cases import join_signals
from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import builtin_names, input_error, load_robot

Kind = Literal[
    "static_state", "loaded_pose", "cable_frequency", "robot_frequency", "frf", "free_decay", "platform_motion"
]
Positive = PositiveFloat | None


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class SigmaTable(_Table):
    tension_N: Positive = None
    position_m: Positive = None
    rotation_deg: Positive = None
    length_m: Positive = None
    frequency_hz: Positive = None
    acceleration: Positive = None


class MeasurementTable(_Table):
    kind: Kind
    file: str
    sigma: SigmaTable = SigmaTable()


class NominalTable(_Table):
    platform_mass: Positive = None
    center_of_mass: Annotated[list[float], Field(min_length=3, max_length=3)] | None = None
    platform_inertia: Annotated[list[list[float]], Field(min_length=3, max_length=3)] | None = None
    axial_stiffness: Positive = None
    linear_density: Positive = None
    gravity: Positive = None
    assembly: Literal["consistent", "thesis"] = "consistent"


class TolerancesTable(_Table):
    anchor_m: NonNegativeFloat | None = None
    length_m: NonNegativeFloat | None = None
    axial_stiffness: NonNegativeFloat | None = None
    linear_density: NonNegativeFloat | None = None
    platform_mass_kg: NonNegativeFloat | None = None
    center_of_mass_m: NonNegativeFloat | None = None
    platform_inertia: NonNegativeFloat | None = None
    load_cell_gain: NonNegativeFloat | None = None
    load_cell_bias_N: NonNegativeFloat | None = None
    damping: NonNegativeFloat | None = None
    pulley_radius_m: NonNegativeFloat | None = None


class CampaignTable(_Table):
    robot: str
    model: Literal["static", "dsm", "exact", "spring"] = "dsm"
    tension_distribution: Literal["minimum_norm"] = "minimum_norm"
    lower_bound_N: NonNegativeFloat = 0.0
    nominal: NominalTable = NominalTable()
    tolerances: TolerancesTable = TolerancesTable()
    checked: dict[str, PositiveFloat] = {}
    measurement: Annotated[list[MeasurementTable], Field(min_length=1)]


def load_campaign(path: str | Path) -> Campaign:
    """Campaign of a TOML file with the data files it names, all checked.

    Raises
    ------
    InputError : a file, field, row or value that cannot be used, and what would be right.
    """
    source = Path(path)
    try:
        table = CampaignTable.model_validate(tomllib.loads(source.read_text("utf-8")))
    except (OSError, UnicodeDecodeError) as error:
        raise InputError("CAMPAIGN", "", str(path), "a campaign file (TOML) that can be read") from error
    except tomllib.TOMLDecodeError as error:
        raise InputError(str(path), "", str(error), "a TOML file") from error
    except ValidationError as error:
        raise input_error(str(path), error) from error
    robot = _nominal(_robot(table.robot, source), table.nominal, source)
    gathering = Gathering(len(robot.cables))
    for entry in table.measurement:
        gathering.add(_rows(entry, source, len(robot.cables)), _sigmas(entry))
    identified = join_signals(gathering, robot, table.model)
    given = {k: v for k, v in table.tolerances.model_dump().items() if v is not None}
    return Campaign(
        source=str(path),
        robot=robot,
        robot_name=table.robot,
        model=table.model,
        tolerances=Tolerances(**given),
        stated=frozenset(given),
        states=gathering.states(),
        cable_frequencies=gathering.cable_frequencies(),
        robot_frequencies=gathering.robot_frequencies(),
        series=tuple(series for series, _ in gathering.series),
        identified=identified,
        assembly=table.nominal.assembly,
        tension_distribution=table.tension_distribution,
        lower_bound=table.lower_bound_N,
        checked=table.checked,
    )


def _robot(name: str, source: Path) -> Robot:
    if name in builtin_names():
        return load_robot(name)
    return load_robot(source.parent / name if not Path(name).is_absolute() else name)


def _rows(entry: MeasurementTable, source: Path, cables: int) -> Rows:
    return read_rows(entry.kind, source.parent / entry.file, cables)


def _sigmas(entry: MeasurementTable) -> Sigmas:
    given = {f.name: getattr(entry.sigma, f.name) for f in fields(Sigmas)}
    return replace(Sigmas(), **{k: v for k, v in given.items() if v is not None})


def _nominal(robot: Robot, table: NominalTable, source: Path) -> Robot:
    """The robot with the overrides of the [nominal] table."""
    body, cables = robot.platform, robot.cables
    changes: dict[str, Any] = {
        "mass": table.platform_mass,
        "center_of_mass": None if table.center_of_mass is None else np.array(table.center_of_mass),
        "inertia": None if table.platform_inertia is None else np.array(table.platform_inertia),
    }
    try:
        body = replace(body, **{k: v for k, v in changes.items() if v is not None})
    except ValueError as error:
        raise InputError(str(source), "nominal", "values given", str(error)) from error
    cables = tuple(
        Cable(table.axial_stiffness or c.axial_stiffness, table.linear_density or c.linear_density, c.damping_ratio)
        for c in cables
    )
    return replace(robot, platform=body, cables=cables, gravity=table.gravity or robot.gravity)
