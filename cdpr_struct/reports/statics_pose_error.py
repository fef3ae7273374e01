"""The files of static pose errors: result, tables, figures, report page."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.reports.csv_table import LongTable, csv_text
from cdpr_struct.reports.figures import pose_error as pose_error_figure
from cdpr_struct.reports.figures import workspace_map
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.figures.frame_plan import FramePlan
from cdpr_struct.reports.figures.interactive_map import map_plot
from cdpr_struct.reports.figures.style import Draw
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.pose_error_bands_told import (
    pose_error_bands_columns,
    pose_error_bands_plate,
    pose_error_bands_table,
)
from cdpr_struct.reports.statics_map import map_table
from cdpr_struct.reports.text import place, rounded
from cdpr_struct.reports.trust_over_poses import slack_poses, trust_over_poses
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.sufficient_load import SufficientLoad
from cdpr_struct.workspace.pose_error_map import PARTS, PoseErrorMap

POSE_ERROR_NOTES = (
    "For each reference pose the lengths of straight, inextensible cables are computed and locked; then the platform "
    "is let go, once on elastic catenaries (sagging model), once on massless springs that cannot push (spring "
    "model). If the robot's force limits ask for a preload, the cables are shortened beforehand by the stretch that "
    "this internal force alone causes. Sagging minus reference is the global error, spring minus reference the part of "
    "axial elasticity, and the rest is what sag adds.",
    "Every equilibrium is stable: the potential energy is minimised with its exact second derivative. Where the "
    "spring model has several, the one continuous with the reference pose is taken, found by softening the cables "
    "in stages.",
)


def pose_error_json(errors: PoseErrorMap, robot: Robot) -> dict[str, Any]:
    """Result of a map of pose errors. Where cables hang slack, the lower bound that would cure it is searched."""
    worst = {part: errors.extreme(part) for part in PARTS}
    return {
        "robot": errors.robot,
        "mass_kg": errors.mass,
        "grid": errors.grid.summary(),
        "poses": errors.grid.size,
        "held": int(errors.columns["held"].sum()),
        "stable": int(errors.columns["stable"].sum()),
        "counted": int(errors.counts.sum()),
        "more_stable_pose": int(errors.more_stable.sum()),
        "mean_mm": {part: errors.mean(part) for part in PARTS},
        "largest_mm": {part: {"value": value, "position_m": where} for part, (value, where) in worst.items()},
        "slack_poses": len(slack_poses(errors.columns)),
        "trust": trust_over_poses(robot, errors.grid, errors.columns, released=True),
    }


def sufficient_load_json(found: SufficientLoad, pose: Pose) -> dict[str, Any]:
    """Result of the search for the sufficient load."""
    return {"tolerance_mm": 1e3 * found.tolerance, "pose": pose.in_degrees(), "mass_kg": found.mass}


def error_table(errors: PoseErrorMap, bands: Mapping[str, Any] | None = None) -> LongTable:
    """pose_error.csv, one row a pose, with bands if there are any."""
    more = {} if bands is None else pose_error_bands_columns(bands)
    return map_table(errors.grid, {**errors.columns, **more})


def pose_error_files(
    robot: Robot,
    errors: PoseErrorMap | None,
    load: tuple[SufficientLoad, Pose] | None,
    bands: Mapping[str, Any] | None = None,
) -> dict[str, str | bytes | LongTable]:
    """CSV, figures and page of pose errors over a grid, of the sufficient load at a pose, or both.

    bands : key `bands` of the result at one pose
    """
    tables: dict[str, str | bytes | LongTable] = {}
    plates = []
    if errors is not None:
        tables["pose_error.csv"] = error_table(errors, bands)
        plates += _pose_error_plates(robot, errors)
    if load is not None:
        tables["sufficient_load.csv"] = csv_text(load_columns(load[0]))
        plates.append(_ladder_plate(*load))
    if bands is not None:
        plates.append(pose_error_bands_plate(bands))
    page = Page(
        robot=robot.name,
        title=f"{robot.name}: static pose error",
        subtitle=f"{len(robot.cables)} cables, platform {robot.platform.mass:g} kg",
        verdict=pose_error_sentences(errors, load),
        holds=errors is None or bool(errors.counts.all()),
        facts=_facts(errors, load),
        plates=plates,
        tables=[
            *([] if errors is None else [_pose_error_table(errors)]),
            *([] if bands is None else [pose_error_bands_table(bands)]),
        ],
        notes=[("How it was computed", POSE_ERROR_NOTES)],
    )
    return {**tables, **page_files(page)}


def pose_error_sentences(errors: PoseErrorMap | None, load: tuple[SufficientLoad, Pose] | None) -> list[str]:
    """The outcome in words."""
    lines = []
    if errors is not None:
        sag, axial, total = (errors.mean(part) for part in PARTS)
        average = "On average the platform" if errors.grid.size > 1 else "The platform"
        lines.append(
            f"{average} hangs {abs(total):.2f} mm too {'high' if total > 0.0 else 'low'}: "
            f"sag adds {sag:+.2f} mm, stretch {axial:+.2f} mm."
        )
        left_out = errors.grid.size - int(errors.counts.sum())
        if left_out:
            lines.append(f"{left_out} of {errors.grid.size} poses do not count: not held, or not stable.")
        if errors.more_stable.any():
            lines.append(f"At {int(errors.more_stable.sum())} poses the spring model has another, more stable pose.")
    if load is not None:
        lines.append(_load_sentence(*load))
    return lines


def _load_sentence(found: SufficientLoad, pose: Pose) -> str:
    x, y, z = pose.position
    where, tolerance = f"At ({x:g}, {y:g}, {z:g}) m", f"{1e3 * found.tolerance:g} mm"
    if np.isnan(found.mass):
        top = f"{found.masses[-1]:g} kg"
        return f"{where} sag adds more than {tolerance} even at {top}: keep the sagging model."
    return f"{where} the spring model is good to {tolerance} from a mass of {found.mass:.4g} kg on, load included."


def _pose_error_plates(robot: Robot, errors: PoseErrorMap) -> list[Plate]:
    if not workspace_map.drawable(errors.grid):
        return []
    draw, size = main_figure(errors, None, robot)
    picture = Drawing("pose_error", size, draw)
    layers = list(pose_error_figure.error_layers(errors).values())
    plot = map_plot(errors.grid, layers, FramePlan.of(robot, errors.grid))
    said, live = (pose_error_figure.pose_error_caption(errors, live) for live in (False, True))
    return [Plate("pose_error", "Pose error along z", picture, said, plot, live_caption=live)]


def main_figure(
    errors: PoseErrorMap | None, load: tuple[SufficientLoad, Pose] | None, robot: Robot | None
) -> tuple[Draw, tuple[float, float]]:
    """What draws the errors over the grid (without one, over the load) into an empty figure, and its size [inch]."""
    if errors is not None:
        plan = None if robot is None else FramePlan.of(robot, errors.grid)
        return lambda f: pose_error_figure.draw_pose_error(f, errors, plan), pose_error_figure.pose_error_size(errors)
    if load is None:
        raise ValueError("main_figure needs errors or a load")
    return lambda f: pose_error_figure.draw_load_ladder(f, load[0]), pose_error_figure.LOAD_SIZE


def _ladder_plate(found: SufficientLoad, pose: Pose) -> Plate:
    draw, size = main_figure(None, (found, pose), None)
    picture = Drawing("sufficient_load", size, draw)
    return Plate(
        "sufficient_load",
        "From which load on will the spring model do?",
        picture,
        pose_error_figure.load_ladder_caption(found),
    )


def load_columns(found: SufficientLoad) -> dict[str, Any]:
    """Columns of sufficient_load.csv, one row a mass."""
    parts = {"sag": found.sag_error, "axial": found.axial_error, "global": found.global_error}
    errors = {f"{part}_{axis}_mm": 1e3 * value[:, i] for part, value in parts.items() for i, axis in enumerate("xyz")}
    return {"mass_kg": found.masses, **errors}


def _facts(errors: PoseErrorMap | None, load: tuple[SufficientLoad, Pose] | None) -> list[tuple[str, str]]:
    facts = []
    if errors is not None:
        whole = "mean error along z" if errors.grid.size > 1 else "error along z"
        names = {"global": whole, "sag": "of it from sag", "axial": "of it from stretch"}
        facts += [(f"{errors.mean(part):+.2f} mm", name) for part, name in names.items()]
        if errors.grid.size > 1:
            facts.append((f"{int(errors.counts.sum())} of {errors.grid.size}", "poses held and stable"))
    if load is not None:
        mass = load[0].mass
        text = "none found" if np.isnan(mass) else f"{mass:.4g} kg"
        facts.append((text, f"spring model good to {1e3 * load[0].tolerance:g} mm"))
    return facts


def _pose_error_table(errors: PoseErrorMap) -> HtmlTable:
    if errors.grid.size == 1:
        return _one_pose_table(errors)
    rows = []
    for part in ("global", "sag", "axial"):
        value, where = errors.extreme(part)
        spread = errors.vertical(part)
        at = "(" + ", ".join(f"{v:g}" for v in where) + ")"
        rows.append(
            [
                part,
                f"{errors.mean(part):+.3f}",
                f"{np.nanmin(spread):+.3f}",
                f"{np.nanmax(spread):+.3f}",
                f"{value:+.3f}",
                at,
            ]
        )
    columns = ["along z [mm]", "mean", "lowest", "highest", "of largest size", "at [m]"]
    note = "All components, rotations and flags of every pose are in pose_error.csv."
    return HtmlTable("Pose error over the grid", columns, rows, note)


def _one_pose_table(errors: PoseErrorMap) -> HtmlTable:
    rows = [
        [part, *(f"{v:+.3f}" for v in rounded((errors.columns[f"{part}_{axis}_mm"][0] for axis in "xyz"), 3))]
        for part in ("global", "sag", "axial")
    ]
    note = "Rotations and flags are in pose_error.csv."
    return HtmlTable(f"Pose error at {place(errors.grid.positions[0])}", ["", "x [mm]", "y [mm]", "z [mm]"], rows, note)
