"""The files of the list of robots: a table as CSV, a drawing of each robot, and the report page."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import robot_drawing
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.figures.robot_geometry import robot_geometry, unloaded_geometry
from cdpr_struct.reports.figures.style import BLUE, GREY
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.robots_result import frame_size, robots_columns, robots_sentence
from cdpr_struct.reports.text import place
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.inverse_kinematics import inverse

_SIZE = (4.8, 2.9)
_LOW = 0.05  # sag to chord: visible as a bow, and more than a cable in use has


def robots_files(robots: Sequence[Robot], rows: Sequence[Mapping[str, Any]]) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name.

    rows    : one a robot, with `name`, `cables` and `description`, as the command `robots` lists them
    """
    plates = [_plate(robot) for robot in robots]
    return {
        "robots.csv": csv_text(robots_columns(robots)),
        **page_files(_page(robots, rows, plates)),
    }


def _plate(robot: Robot) -> Plate:
    name = "robot_" + re.sub(r"\W", "_", robot.name, flags=re.ASCII)
    point = _at_home(robot)
    geometry = unloaded_geometry(robot, _home(robot)) if point is None else robot_geometry(point)
    colour = GREY if point is None else BLUE
    picture = Drawing(name, _SIZE, lambda f: robot_drawing.draw_geometry(f, geometry, colour))
    where = "its home pose" if robot.home else "the middle of its frame"
    said = f"At {where}, {place(_home(robot).position)}, drawn to scale; numbers at the frame anchors are cables."
    return Plate(name, robot.name, picture, f"{said} {_at_rest(point)}")


def _at_rest(point: OperatingPoint | None) -> str:
    if point is None:
        return "Geometry only: the cables do not hold the platform there, so they are drawn straight, in grey."
    cables, tension = point.cables, point.cables.tension_at_platform
    worst = int(np.argmax(cables.sag))
    low = bool((cables.sag > _LOW * cables.chord).any())
    remedy = " With a --lower-bound on the tensions no cable hangs so low." if low else ""
    return (
        f"Tensions of {tension.min():.4g} to {tension.max():.4g} N hold it; cable {worst + 1} sags most, "
        f"{1e3 * cables.sag[worst]:.4g} mm on a chord of {cables.chord[worst]:.2f} m.{remedy}"
    )


def _home(robot: Robot) -> Pose:
    """The robot's home pose, or the middle of its frame anchors."""
    return robot.home or Pose(robot.frame_anchors.mean(axis=0), np.zeros(3))


def _at_home(robot: Robot) -> OperatingPoint | None:
    """The robot at its home pose on sagging cables; None where they do not hold it."""
    home = _home(robot)
    try:
        held = inverse(robot, home.position, home.rotation)
    except CdprError:
        return None
    return OperatingPoint(robot, home.position, home.rotation, held.cables)


def _page(robots: Sequence[Robot], rows: Sequence[Mapping[str, Any]], plates: Sequence[Plate]) -> Page:
    masses = [robot.platform.mass for robot in robots]
    widest = max(float(frame_size(robot)[:2].max()) for robot in robots)
    return Page(
        title="Built-in robots",
        subtitle="robots that come with the package; every command takes their names",
        verdict=[robots_sentence(rows)],
        holds=True,
        facts=[
            (f"{len(robots)}", "robots"),
            (_ends([len(robot.cables) for robot in robots], 1.0), "cables"),
            (f"{_ends(masses, 1.0)} kg", "platform masses"),
            (f"{widest:.3g} m", "widest frame"),
        ],
        plates=plates,
        tables=[_table(robots, rows)],
        notes=[("How to read", _NOTES)],
        gallery=True,
    )


_NOTES = (
    "Each robot is drawn at its home pose, the one that commands use where no pose is given, with cables that hang in "
    "catenaries and the tensions of least norm that hold the platform. Each drawing has its own scale.",
    "All numbers of a robot, and where they are from, are in its file in cdpr_struct/robot/builtin. A copy of that "
    "file is a good start for a robot of your own.",
)


def _table(robots: Sequence[Robot], rows: Sequence[Mapping[str, Any]]) -> HtmlTable:
    cells = [
        [
            row["name"],
            str(row["cables"]),
            f"{robot.platform.mass:g}",
            _ends(robot.axial_stiffness, 1e3),
            _ends(robot.linear_density, 1.0),
            " × ".join(f"{size:.2f}" for size in frame_size(robot)),
            row["description"],
        ]
        for robot, row in zip(robots, rows, strict=True)
    ]
    columns = [
        "name", "cables", "platform [kg]", "EA [kN]", "density [kg/m]", "frame x × y × z [m]", "description",
    ]  # fmt: skip
    note = "EA and density are per cable; the frame's size is that of the box around its anchors."
    return HtmlTable("Robots", columns, cells, note, prose=frozenset({6}))


def _ends(values: Sequence[float] | np.ndarray, unit: float) -> str:
    """Smallest to largest value, or the one value that all have."""
    low, high = (f"{end / unit:.4g}" for end in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"
