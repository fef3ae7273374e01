"""The files of an audit of a robot's cables: table as CSV, figure as SVG, and the report page."""

import numpy as np

from cdpr_struct.crosscheck.limits_poses import PoseAudit
from cdpr_struct.crosscheck.validity_limits import ValidityLimits, limit_violations
from cdpr_struct.errors import UnholdablePoseError
from cdpr_struct.reports.audit_result import (
    CABLE_COLUMNS,
    COUNT_COLUMNS,
    audit_columns,
    cable_rows,
    count_rows,
    poses_in_degrees,
    sentences,
)
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import audit_map, limits
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.figures.frame_plan import FramePlan
from cdpr_struct.reports.figures.interactive_map import map_plot
from cdpr_struct.reports.figures.style import Draw
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.text import place
from cdpr_struct.workspace.grid import AXES, Grid

_UNHELD_SHOWN = 100
_NOTES = (
    "The printed limits of the closed-form dynamic stiffness: λ² ≤ 24 (2.40); λ² at least 20 % away from the "
    "crossovers "
    "4n²π²; ε ≤ 0.24 up to 30° of inclination and ε ≤ 0.1 up to 60° (2.41, whose print 0.01 contradicts its own d/l "
    "≤ 1/80); "
    "sag over chord at most 1/20 (2.2.1).",
    "Tensions are those of minimum norm that hold the pose on sagging cables. To test the limits themselves, "
    "run `cdpr-struct audit --limits`.",
)


def audit_files(audit: PoseAudit, grid: Grid | None = None, time: np.ndarray | None = None) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name. At most one of grid and time is given."""
    plates = _plates(audit, grid, time)
    what = f"at {place(audit.position[0])}" if len(audit.held) == 1 else f"{len(audit.held)} poses"
    page = Page(
        robot=audit.robot.name,
        title=f"{audit.robot.name}: cables against the validity limits of the closed form",
        subtitle=f"{len(audit.robot.cables)} cables, platform {audit.robot.platform.mass:g} kg, {what}",
        verdict=sentences(audit),
        holds=bool(audit.held.any()) and not (audit.count > 0).any(),
        facts=_facts(audit),
        plates=plates,
        tables=_tables(audit),
        notes=[("The limits", _NOTES)],
    )
    return {"audit.csv": csv_text(audit_columns(audit, time)), **page_files(page)}


def _facts(audit: PoseAudit) -> list[tuple[str, str]]:
    held = int(audit.held.sum())
    broken = sum(int(b.sum()) for b in audit.broken.values())
    cables = np.any([b.any(axis=0) for b in audit.broken.values()], axis=0)
    return [
        (f"{held} of {len(audit.held)}", "poses held"),
        (f"{int((audit.count > 0).sum())}", "poses with a broken limit"),
        (f"{broken}", "broken limits in all"),
        (f"{int(cables.sum())} of {len(cables)}", "cables concerned"),
    ]


def _plates(audit: PoseAudit, grid: Grid | None, time: np.ndarray | None) -> list[Plate]:
    if not audit.held.any():
        return []
    draw, size = audit_figure(audit, grid, time)
    if len(audit.held) == 1:
        caption = limits.limits_caption(_one_pose(audit))
        return [Plate("limits", "Cables against the printed limits", Drawing("limits", size, draw), caption)]
    if grid is not None and len(grid.free) == 2:
        caption = audit_map.audit_map_caption(audit)
        plot = map_plot(grid, audit_map.audit_layers(audit), FramePlan.of(audit.robot, grid))
        drawing, live = Drawing("map", size, draw), audit_map.audit_map_caption(audit, wide=False)
        return [Plate("map", "Broken limits over the workspace", drawing, caption, plot, live_caption=live)]
    return [
        Plate("course", "Limits along the way", Drawing("course", size, draw), audit_map.audit_course_caption(audit))
    ]


def audit_figure(audit: PoseAudit, grid: Grid | None, time: np.ndarray | None) -> tuple[Draw, tuple[float, float]]:
    """What draws the limits of one pose, over two axes of the grid, or along the way, and its size [inch].

    Raises
    ------
    UnholdablePoseError : no pose is held, so there is nothing to draw.
    """
    if not audit.held.any():
        raise UnholdablePoseError("no pose is held by the cables: there is nothing to draw")
    if len(audit.held) == 1:
        shown = _one_pose(audit)
        return lambda f: limits.draw_limits(f, shown), limits.SIZE
    if grid is not None and len(grid.free) == 2:
        return lambda f: audit_map.draw_audit_map(f, audit, grid), audit_map.MAP_SIZE
    course, label = _course(audit, grid, time)
    return lambda f: audit_map.draw_audit_course(f, audit, course, label), audit_map.COURSE_SIZE


def _course(audit: PoseAudit, grid: Grid | None, time: np.ndarray | None) -> tuple[np.ndarray, str]:
    if time is not None:
        return time, "time [s]"
    if grid is not None and len(grid.free) == 1:
        return grid.axes[grid.free[0]], f"{AXES[grid.free[0]]} [m]"
    return np.arange(len(audit.held), dtype=float), "pose, in the order of the table [count]"


def _one_pose(audit: PoseAudit) -> ValidityLimits:
    value = {name: v[0] for name, v in audit.value.items()}
    found = [
        violation
        for i in range(audit.tension.shape[1])
        for violation in limit_violations(
            i + 1, value["lambda2"][i], value["alpha_deg"][i], value["epsilon"][i], value["sag_ratio"][i]
        )
    ]
    return ValidityLimits(
        lambda_squared=value["lambda2"],
        epsilon=value["epsilon"],
        inclination_deg=value["alpha_deg"],
        sag_ratio=value["sag_ratio"],
        crossover_distance=value["crossover_distance"],
        violations=tuple(found),
    )


def _tables(audit: PoseAudit) -> list[HtmlTable]:
    if len(audit.held) == 1:
        marked = frozenset(np.flatnonzero(np.any([b[0] for b in audit.broken.values()], axis=0)).tolist())
        return [HtmlTable("Cables", CABLE_COLUMNS, cable_rows(audit, 0), marked=marked)]
    tables = [HtmlTable("Limits over all poses", COUNT_COLUMNS, count_rows(audit))]
    unheld = np.flatnonzero(~audit.held)
    if len(unheld):
        poses = poses_in_degrees(audit)
        rows = [[", ".join(f"{v:g}" for v in poses[i]), audit.reason[i]] for i in unheld[:_UNHELD_SHOWN]]
        more = f"{len(unheld) - _UNHELD_SHOWN} more in audit.csv." if len(unheld) > _UNHELD_SHOWN else ""
        tables.append(
            HtmlTable("Poses that cannot be held", ["pose [m, deg]", "why"], rows, more, prose=frozenset({1}))
        )
    return tables
