"""The files of a workspace: where all requirements hold, how large that is, and what rejects the other poses."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.reports.csv_table import LongTable
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.text import with_sigma
from cdpr_struct.reports.trust_over_poses import deep_sag, slack_poses, trust_over_poses
from cdpr_struct.reports.unheld_poses import what_helps
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.region import Region
from cdpr_struct.workspace.requirements import Requirement, reasons
from cdpr_struct.workspace.work_list import Columns

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.style import Draw

_UNITS = {1: ("length", "m"), 2: ("area", "m^2"), 3: ("volume", "m^3")}
_WORDS = {"held": "cannot be held within the force limits", "stable": "would not be stable at locked lengths"}
_NOTE = (
    "A pose belongs to the workspace if the cables hold it within their force limits, it is stable at locked lengths, "
    "and every requirement is met. Forces are those of least norm on sagging cables. Under each wrench of a set the "
    "sagging cables are balanced anew; margins of force count at the worst wrench, distances, tilt and everything else "
    "under the robot's own load.",
    "A cell of the grid counts with the share of its corners that belong to the workspace. Each halving of the grid "
    "computes poses in cells whose corners disagree. The error is what the last halving changed on the parts of the "
    "boundary that face along each axis, added up, and the scatter of a boundary that lies anywhere between poses. "
    "Holes and islands smaller than a cell of the first grid are not seen.",
    "Distances leave out what lies within the anchor zone, along the cable, of an anchor that two cables share or that "
    "sits on the body. Cable on pulleys is left out. A cable that crosses a body has the distance 0.",
)


def table_columns(requirements: tuple[Requirement, ...], fails: np.ndarray) -> dict[str, np.ndarray]:
    """Columns `holds` (bool), `rejected_by` (the first reason) and `rejections` (how many) of map.csv."""
    names = np.array([*reasons(requirements), ""])
    first = np.where(fails.any(axis=1), fails.argmax(axis=1), len(names) - 1)
    return {"holds": ~fails.any(axis=1), "rejected_by": names[first], "rejections": fails.sum(axis=1)}


def result(
    robot: Robot, grid: Grid, requirements: tuple[Requirement, ...], found: tuple[Columns, np.ndarray], region: Region
) -> dict[str, Any]:
    """Result of a workspace; found : columns over the grid, and what fails (n, 2 + r)."""
    columns, fails = found
    kind, unit = _UNITS[len(grid.free)]
    unstable = int((columns["held"] & ~columns["stable"]).sum())
    alone = fails & (fails.sum(axis=1) == 1)[:, None]
    first = np.where(fails.any(axis=1), fails.argmax(axis=1), -1)
    rejections = [
        {
            "requirement": name,
            "poses": int(fails[:, i].sum()),
            "share": float(fails[:, i].mean()),
            "first": int((first == i).sum()),
            "alone": int(alone[:, i].sum()),
        }
        for i, name in enumerate(reasons(requirements))
    ]
    levels = [{"poses": one.grid.size, kind: one.volume, "error": one.error} for one in region.levels]
    return {
        "robot": robot.name,
        "cables": len(robot.cables),
        **({"guided": list(robot.guided)} if robot.guided else {}),
        "mass_kg": robot.platform.mass,
        "quantity": "workspace",
        "unit": unit,
        "grid": grid.summary(),
        "poses": grid.size,
        "held": int(columns["held"].sum()),
        "unstable": unstable,
        "requirements": [one.text for one in requirements],
        "hold_all": int((~fails.any(axis=1)).sum()),
        "measure": kind,
        "workspace": {
            kind: region.volume,
            "error": region.error,
            "inner": region.inner,
            "outer": region.outer,
            "ends_at_grid": region.touches_edge,
            "levels": levels,
        },
        "rejections": rejections,
        "slack_poses": len(slack_poses(columns)),
        **deep_sag(columns),
        "trust": trust_over_poses(robot, grid, columns),
    }


def sentences(told: Mapping[str, Any]) -> list[str]:
    """The outcome in words."""
    found, kind, unit = told["workspace"], told["measure"], told["unit"]
    asked = ", ".join(told["requirements"]) or "held and stable"
    edge = " It reaches the edge of the grid and may go on beyond." if found["ends_at_grid"] else ""
    said = [
        f"Workspace ({asked}): {kind} {with_sigma(found[kind], found['error'])} {unit}; "
        f"{told['hold_all']} of {told['poses']} poses of the grid hold.{edge}"
    ]
    for one in told["rejections"]:
        if one["poses"]:
            words = _WORDS.get(one["requirement"])
            what = words or f"fail {one['requirement']}"
            alone = "" if words else f", {one['alone']} of them only this"
            helps = what_helps(told, told["requirements"]) if one["requirement"] == "held" else ""
            said.append(f"{one['poses']} poses ({100.0 * one['share']:.3g} %) {what}{alone}.{helps}")
    return said


def figure(
    robot: Robot, grid: Grid, requirements: tuple[Requirement, ...], fails: np.ndarray, region: Region
) -> tuple["Draw", tuple[float, float]]:
    """What draws slices, area or line of a workspace into an empty figure, and its size [inch]."""
    from cdpr_struct.reports.figures import workspace_region as drawn

    names = ["meets all", *reasons(requirements)]
    why = np.where(fails.any(axis=1), fails.argmax(axis=1) + 1, 0)
    draw = partial(drawn.draw_region, grid=grid, why=why, names=names, region=region)
    return draw, drawn.region_size(grid)


def plates(
    robot: Robot, grid: Grid, requirements: tuple[Requirement, ...], fails: np.ndarray, region: Region
) -> list[Plate]:
    """The figure, and on the page the surface of the workspace in the frame."""
    from cdpr_struct.reports.figures import workspace_region as drawn
    from cdpr_struct.reports.figures.drawing import Drawing

    draw, size = figure(robot, grid, requirements, fails, region)
    surface = drawn.surface(robot, region) if len(grid.free) == 3 else None
    said = "Coloured: the first requirement that rejects each pose. Black line: the boundary of the workspace on the "
    said += "finest grid."
    live = f"{said} Below: the surface of the workspace between the numbered frame anchors." if surface else ""
    return [Plate("map", "Workspace", Drawing("map", size, draw), said, surface, live_caption=live, both=True)]


def files(
    robot: Robot, grid: Grid, columns: Mapping[str, Any], shown: Sequence[Plate], told: Mapping[str, Any]
) -> dict[str, str | bytes | LongTable]:
    """CSV, figure and page."""
    found, kind, unit = told["workspace"], told["measure"], told["unit"]
    rows = [
        [one["requirement"], str(one["poses"]), f"{100.0 * one['share']:.3g} %", str(one["first"]), str(one["alone"])]
        for one in told["rejections"]
    ]
    levels = [[str(one["poses"]), f"{one[kind]:.5g}", f"{one['error']:.2g}"] for one in found["levels"]]
    fixed = grid.fixed_text()
    page = Page(
        robot=robot.name,
        title=f"{robot.name}: workspace",
        subtitle=f"{len(robot.cables)} cables, platform {robot.platform.mass:g} kg" + (f", {fixed}" if fixed else ""),
        verdict=sentences(told),
        holds=told["hold_all"] == told["poses"],
        facts=[
            (f"{with_sigma(found[kind], found['error'])} {unit}", kind),
            (f"{told['hold_all']} of {told['poses']}", "poses hold"),
        ],
        plates=shown,
        tables=[
            HtmlTable(
                "What rejects poses",
                ["requirement", "poses", "share", "decides (first)", "alone"],
                rows,
                "A pose that is not held or not stable is asked nothing else.",
                prose=frozenset({0}),
            ),
            HtmlTable("Refinement", ["poses of the grid", f"{kind} [{unit}]", f"error [{unit}]"], levels),
        ],
        notes=[("How it was computed", _NOTE)],
    )
    return {"map.csv": LongTable(columns), **page_files(page)}
