"""Campaign files to begin with: which cells to fill, and beside them what the simulation predicts.

A cell that holds `UNFILLED` is refused when the campaign is read, so that a template is never taken for measurements.
Columns that begin with `PREDICTED` are for people.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import expand_catenaries_at, polynomial_order
from cdpr_struct.dynamics.certified_modes import certified_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError, UnholdablePoseError
from cdpr_struct.measurement.cable_columns import FREQUENCY, LENGTH, SWIVEL, TENSION, CableQuantity
from cdpr_struct.measurement.campaign_rows import POSE, PREDICTED, UNFILLED
from cdpr_struct.robot.pose import Pose, angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_writing import printable
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.swivel_angle import swivel_angle, swivel_reference

READINGS = ("tensions", "lengths", "swivels", "cable_frequency", "robot_frequency", "loaded")
KINDS = {
    "tensions": "static_state", "lengths": "static_state", "swivels": "static_state",
    "cable_frequency": "cable_frequency", "robot_frequency": "robot_frequency", "loaded": "loaded_pose",
}  # fmt: skip
"""The kind of file that each of them is read from."""
_FREEDOMS = 6
_PEAKS = 6  # rows of robot frequencies a pose
_NOTHING = 1e-12  # of any number [m, deg, N, Hz]
_SIGMAS = {
    "static_state": "tension_N = 2.0, length_m = 0.0005, position_m = 0.0005, rotation_deg = 0.02",
    "cable_frequency": "frequency_hz = 0.01",
    "robot_frequency": "frequency_hz = 0.01",
    "loaded_pose": "position_m = 0.0005, rotation_deg = 0.02, length_m = 0.0005",
}
_FILES = {
    "static_state": "states.csv",
    "cable_frequency": "cable_frequencies.csv",
    "robot_frequency": "robot_frequencies.csv",
    "loaded_pose": "loaded.csv",
}
_HINTS = {
    "static_state": "one row a pose: cable forces at the platform, unstrained lengths that the encoders say",
    "cable_frequency": "one row a pose: first frequency of each cable, both ends held, plucked up and down (plane in)",
    "robot_frequency": "one row a peak of the spectrum, in any order; delete rows that you do not need, add others",
    "loaded_pose": "two rows a pose at the same locked lengths: without and with the payload; measure both poses",
}
_COMMENTS = (
    f"# Replace each {UNFILLED} by what was measured; leave a cell empty where nothing was measured.",
    "# Pose columns hold the planned pose: replace it by the measured one, and copy it to the rows of the same case in",
    "# the other files, digit by digit. Empty the cells of what was not measured: the planned pose is no reading.",
    "# Give repeated readings a case of their own.",
    f"# Columns {PREDICTED}... are the simulation's, to compare with; they are not read.",
)
_STATIC = {"tensions": TENSION, "lengths": LENGTH, "swivels": SWIVEL}


@dataclass(frozen=True, slots=True, eq=False)
class PlannedPoses:
    """p poses to be measured, at which the robot rests.

    names : of the cases;  poses : as planned;  point : `OperatingPoint` with one batch axis (p,)
    """

    names: Sequence[str]
    poses: Sequence[Pose]
    point: OperatingPoint


def planned(robot: Robot, names: Sequence[str], poses: Sequence[Pose]) -> PlannedPoses:
    """The robot at rest at the planned poses; with fewer cables than freedoms, where it hangs at their lengths.

    Raises
    ------
    CdprError : a pose that the cables cannot hold.
    """
    position = np.array([pose.position for pose in poses])
    rotation = np.array([pose.rotation for pose in poses])
    if len(robot.cables) < _FREEDOMS:
        return _hanging(robot, names, position, rotation)
    try:
        cables = inverse(robot, position, rotation).cables
    except CdprError as error:
        for name, pose in zip(names, poses, strict=True):
            _require_held(robot, name, pose)
        raise CdprError(f"not all poses can be held: {error}") from error
    return PlannedPoses(names, poses, OperatingPoint(robot, position, rotation, cables))


def _hanging(robot: Robot, names: Sequence[str], position: np.ndarray, rotation: np.ndarray) -> PlannedPoses:
    """At the lengths that reach to poses (p, 3), (p, 3, 3)."""
    lengths = inverse(robot, position, rotation, allow_unheld=True).lengths
    rest = forward(robot, lengths, position, rotation)
    for name, place, stable in zip(names, position, rest.stable, strict=True):
        if not stable:
            where = ",".join(_short(value) for value in place)
            raise UnholdablePoseError(f"{name} ({where}): the platform does not come to rest near this pose")
    poses = [Pose(*own) for own in zip(rest.position, angles_from_rotation(rest.rotation), strict=True)]
    return PlannedPoses(names, poses, OperatingPoint(robot, rest.position, rest.rotation, rest.cables))


def _require_held(robot: Robot, name: str, pose: Pose) -> None:
    try:
        inverse(robot, pose.position, pose.rotation)
    except CdprError as error:
        where = ",".join(_short(value) for value in pose.in_degrees())
        raise UnholdablePoseError(f"{name} ({where}): {error}") from error


def campaign_files(plan: PlannedPoses, robot: str, readings: Sequence[str], payload: float) -> dict[str, str]:
    """Contents of campaign.toml and of the data files it names.

    robot    : as the campaign file names it
    readings : of `READINGS`;  payload : of the loaded poses [kg]
    """
    tables = {}
    if quantities := [_STATIC[name] for name in _STATIC if name in readings]:
        tables["static_state"] = _static(plan, quantities)
    if "cable_frequency" in readings:
        tables["cable_frequency"] = _cable_frequencies(plan)
    if "robot_frequency" in readings:
        tables["robot_frequency"] = _robot_frequencies(plan)
    if "loaded" in readings:
        tables["loaded_pose"] = _loaded(plan, payload, "lengths" in readings)
    files = {"campaign.toml": _campaign(robot, list(tables), "swivels" in readings)}
    return files | {_FILES[kind]: _csv(kind, columns) for kind, columns in tables.items()}


_MORE = {
    "cable_frequency": "# Plucked sideways, the plane is out: over a swivelling pulley that is a few per cent lower.",
    "loaded_pose": "# Cells of lengths are empty where the case has its lengths in states.csv.",
}
Columns = Mapping[str, Sequence[str]]


def _static(plan: PlannedPoses, quantities: Sequence[CableQuantity]) -> Columns:
    cables = plan.point.cables
    values = {TENSION: cables.tension_at_platform, LENGTH: plan.point.arrays.reading(cables.paid_out)}
    columns = _poses(plan)
    for quantity in quantities:
        columns |= _swivels(plan) if quantity is SWIVEL else _open(quantity, values[quantity])
    return columns


def _swivels(plan: PlannedPoses) -> dict[str, list[str]]:
    """Columns of the swivel angles; cells of a cable without a pulley are empty."""
    axis, wheels = plan.point.arrays.pulley_axis, plan.point.entered.pulleys
    angle = swivel_angle(plan.point.cables.force_at_frame, axis, swivel_reference(axis))
    columns = _open(SWIVEL, np.degrees(angle))
    bare = [SWIVEL.column(i) for i, wheel in enumerate(wheels, start=1) if wheel is None]
    nothing = [""] * len(plan.names)
    return columns | {f"{before}{name}": nothing for name in bare for before in ("", PREDICTED)}


def _cable_frequencies(plan: PlannedPoses) -> Columns:
    """The first mode in the plane of each cable: over a swivelling pulley the lowest of all is one out of it."""
    expansion = expand_catenaries_at(plan.point, polynomial_order(plan.point, 0.0))
    first = np.sqrt(np.where(expansion.sideways, np.inf, expansion.omega_squared).min(axis=-1))
    named = {"mode": ["1"] * len(plan.names), "plane": ["in"] * len(plan.names)}
    return _poses(plan) | named | _open(FREQUENCY, first / (2.0 * np.pi))


def _robot_frequencies(plan: PlannedPoses) -> Columns:
    hertz = [_first_peaks(_one(plan, i)) for i in range(len(plan.names))]
    columns = {name: np.repeat(cells, _PEAKS).tolist() for name, cells in _poses(plan).items()}
    open_cells = [UNFILLED] * (_PEAKS * len(plan.names))
    return columns | {"frequency_hz": open_cells, f"{PREDICTED}frequency_hz": _numbers(np.concatenate(hertz))}


def _first_peaks(point: OperatingPoint) -> np.ndarray:
    """(`_PEAKS`,) frequencies [Hz]; freedoms in which nothing pushes back, as a point mass turns, have none."""
    found = certified_frequencies(point, "exact", _PEAKS + _FREEDOMS // 2).hertz
    return np.asarray(found[found > _NOTHING][:_PEAKS])


def _loaded(plan: PlannedPoses, payload: float, read_before: bool) -> Columns:
    """Every pose without and with the payload, at the lengths that are locked there.

    read_before : the lengths without payload stand in another file
    """
    robot, point = plan.point.entered, plan.point
    lengths = point.cables.paid_out
    moved = forward(robot.with_load(payload), lengths, point.position, point.rotation)
    angles = np.degrees(angles_from_rotation(moved.rotation))
    bare, count = _poses(plan), len(plan.names)
    columns = {
        "case": _paired(bare["case"], [f"{name} with {payload:g} kg" for name in plan.names]),
        **{name: _paired(bare[name], [UNFILLED] * count) for name in POSE},
        "payload_kg": ["0", f"{payload!r}"] * count,
    }
    readings = np.repeat(point.arrays.reading(lengths), 2, axis=0)
    reached = np.concatenate([moved.position, angles], axis=1)
    told = {f"{PREDICTED}{name}": _paired(bare[name], _numbers(reached[:, k])) for k, name in enumerate(POSE)}
    open_cells = _open(LENGTH, readings)
    if read_before:
        for name in LENGTH.columns(readings.shape[1]):
            open_cells[name] = _paired([""] * count, [UNFILLED] * count)
    return columns | open_cells | told


def _one(plan: PlannedPoses, i: int) -> OperatingPoint:
    point = plan.point
    return OperatingPoint(point.entered, point.position[i], point.rotation[i], point.cables.at(i))


def _poses(plan: PlannedPoses) -> dict[str, list[str]]:
    values = np.array([pose.in_degrees() for pose in plan.poses])
    return {"case": list(plan.names), **{name: [_short(v) for v in values[:, k]] for k, name in enumerate(POSE)}}


def _open(quantity: CableQuantity, predicted: np.ndarray) -> dict[str, list[str]]:
    """A quantity's columns to be filled, and those of its predictions (n, m)."""
    names = quantity.columns(predicted.shape[1])
    told = {f"{PREDICTED}{name}": _numbers(predicted[:, i]) for i, name in enumerate(names)}
    return {name: [UNFILLED] * len(predicted) for name in names} | told


def _paired(first: Iterable[str], second: Iterable[str]) -> list[str]:
    return [cell for pair in zip(first, second, strict=True) for cell in pair]


def _numbers(values: np.ndarray) -> list[str]:
    """Six digits; zero where rounding left something."""
    return [f"{value if abs(value) > _NOTHING else 0.0:.6g}" for value in values]


def _short(value: float) -> str:
    """A planned number without the rounding of degrees and radians."""
    return repr(round(float(value), 9) + 0.0)


def _csv(kind: str, columns: Columns) -> str:
    rows = [",".join(columns), *(",".join(row) for row in zip(*columns.values(), strict=True))]
    more = [_MORE[kind]] if kind in _MORE else []
    return "\n".join([f"# {_HINTS[kind]}.", *more, *_COMMENTS, *rows]) + "\n"


def _campaign(robot: str, kinds: Sequence[str], swivels: bool) -> str:
    lines = [
        "# A campaign to begin with, written by `cdpr-struct new-campaign`. All keys: docs/files.md",
        "# Fill the data files named below, then: cdpr-struct diagnose campaign.toml",
        f'robot = "{_quotable(robot)}"',
        'model = "exact"                              # simulation under test: static, dsm, exact, spring',
        '# encoders = "relative"                       # if they count from an unknown start',
        "",
        "[tolerances]                                 # one sigma of what is never exactly known: yours differ",
        "# anchor_m = 0.001                           # each coordinate of each anchor",
        "# length_m = 0.001                           # each cable's zero",
        "# axial_stiffness = 0.03                     # relative; 0.3 where it was estimated",
        "# linear_density = 0.03                      # relative",
    ]
    for kind in kinds:
        lines += ["", f"[[measurement]]  # {_HINTS[kind]}", f'kind = "{kind}"', f'file = "{_FILES[kind]}"']
        more = ", swivel_deg = 0.1" if swivels and kind == "static_state" else ""
        lines.append(f"sigma = {{ {_SIGMAS[kind]}{more} }}  # of your sensors: replace")
    return "\n".join(lines) + "\n"


def _quotable(text: str) -> str:
    return printable(text).replace("\\", "/").replace('"', " ")
