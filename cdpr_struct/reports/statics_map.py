"""The files of a map of one quantity over the workspace: result, table, figure, report page."""

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.reports.bands_told import band_note
from cdpr_struct.reports.csv_table import LongTable
from cdpr_struct.reports.html import Page, Plate, page_files
from cdpr_struct.reports.map_bands_told import BandLayer, band_layers, map_band_sentences
from cdpr_struct.reports.text import paragraphs
from cdpr_struct.reports.trust_over_poses import deep_sag, slack_poses, trust_over_poses
from cdpr_struct.reports.unheld_poses import what_helps
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import AXES, Grid
from cdpr_struct.workspace.quantities import quantity_of
from cdpr_struct.workspace.work_list import Columns

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.style import Draw
    from cdpr_struct.reports.figures.workspace_map import Layer

_SAME = 1e-9  # relative: values of poses that count as equal
_FRAME = "the numbered frame anchors with the line around them, and the platform in the middle of the map."
_NOTE = (
    "Each value is computed at the reference pose, or for pose errors from it, as the quantity's line in the "
    "documentation says. Tensions are those of minimum norm that balance the platform on sagging cables within the "
    "robot's force limits. Stiffness is the exact derivative of the balance at locked lengths: sag, stretch and "
    "turning lever arms included. A cable hangs slack if its chord tension is below its own weight.",
)


def map_table(grid: Grid, columns: Columns) -> LongTable:
    """CSV of a map, one row a pose; flags as 0 and 1."""
    place = {f"{name}_m": grid.positions[:, i] for i, name in enumerate(AXES)}
    rest = {name: value.astype(int) if value.dtype == bool else value for name, value in columns.items()}
    return LongTable({**place, **rest})


def _where_largest(value: np.ndarray) -> int:
    """The first pose of the largest value; rounding does not decide between poses that symmetry makes equal."""
    top = np.nanmax(value)
    return int(np.flatnonzero(value >= top - _SAME * abs(top))[0])


def map_json(robot: Robot, name: str, grid: Grid, columns: Columns) -> dict[str, Any]:
    """Result of a map of one quantity. Where cables hang slack, the lower bound that would cure it is searched."""
    quantity = quantity_of(name)
    value = map_values(name, columns)
    some = bool(np.isfinite(value).any())
    ends = {
        key: {"value": float(value[at]), "position_m": grid.positions[at]}
        for key, at in (("smallest", _where_largest(-value)), ("largest", _where_largest(value)))
    } if some else {}  # fmt: skip
    return {
        "robot": robot.name,
        "cables": len(robot.cables),
        **({"guided": list(robot.guided)} if robot.guided else {}),
        "mass_kg": robot.platform.mass,
        "quantity": name,
        "unit": quantity.unit,
        "meaning": quantity.meaning,
        "grid": grid.summary(),
        "poses": grid.size,
        "held": int(columns["held"].sum()),
        "unstable": int((columns["held"] & ~np.isfinite(value)).sum()),
        "mean": float(np.nanmean(value)) if some else None,
        **ends,
        "slack_poses": len(slack_poses(columns)),
        **deep_sag(columns),
        **({"shared_poses": int(shared(name, columns).sum())} if quantity.shared else {}),
        **followed(grid, columns),
        "trust": trust_over_poses(robot, grid, columns, released=name.startswith("pose-error")),
    }


def shared(name: str, columns: Columns) -> np.ndarray:
    """(n,) bool: what the quantity describes is shared by modes of which none holds most."""
    column = quantity_of(name).shared
    return columns[column] < 0.5 if column else np.zeros(len(columns["held"]), dtype=bool)


def followed(grid: Grid, columns: Columns) -> dict[str, Any]:
    """Where a mode was followed from, and at how many poses that is in doubt; nothing for other quantities."""
    if "veering" not in columns:
        return {}
    counts = {"veering_poses": int(columns["veering"].sum())}
    if "followed_from" not in columns:
        return counts
    start = np.flatnonzero((columns["followed_from"] == 0) & np.isfinite(columns["mode_Hz"]))
    places = [{"position_m": grid.positions[i], "mode_Hz": float(columns["mode_Hz"][i])} for i in start]
    behind = int(columns["behind_veering"].sum())
    return {"reference": places[0] if places else None, **counts, "behind_veering_poses": behind}


def map_values(name: str, columns: Columns) -> np.ndarray:
    """(n,) the quantity; nan where the pose is not held or not stable."""
    good = columns["held"] & columns.get("stable", columns["held"])
    return np.where(good, columns[quantity_of(name).column], np.nan)


def map_files(
    robot: Robot, name: str, grid: Grid, columns: Columns, result: Mapping[str, Any]
) -> dict[str, str | bytes | LongTable]:
    """CSV, figure and page of a map of one quantity; `result` as `map_json` made it."""
    from cdpr_struct.reports.figures import workspace_map

    plates = [_map_plate(robot, name, grid, columns)] if workspace_map.drawable(grid) else []
    if "bands" in result and plates:
        plates += [_band_plate(robot, grid, one) for one in band_layers(name, columns, result["bands"])]
    page = Page(
        robot=robot.name,
        title=f"{robot.name}: {quantity_of(name).label}" + (" over the workspace" if grid.size > 1 else " at a pose"),
        subtitle=f"{len(robot.cables)} cables, platform {robot.platform.mass:g} kg" + _comma(grid.fixed_text()),
        verdict=map_sentences(result),
        holds=result["held"] == result["poses"] and not result["unstable"],
        facts=_map_facts(result),
        plates=plates,
        tables=[],
        notes=[
            ("How it was computed", _NOTE),
            *([("Bands", (band_note(result["bands"]),))] if "bands" in result else []),
        ],
    )
    return {"map.csv": map_table(grid, columns), **page_files(page)}


def map_text(result: Mapping[str, Any]) -> str:
    """What the command prints."""
    noted = [text for _, texts in _band_notes(result) for text in texts]
    return paragraphs("\n".join(map_sentences(result)), *noted)


def _band_notes(result: Mapping[str, Any]) -> list[tuple[str, tuple[str, ...]]]:
    return [("Bands", (band_note(result["bands"]),))] if "bands" in result else []


def map_sentences(result: Mapping[str, Any]) -> list[str]:
    """The outcome in words, and what bands say."""
    return [map_sentence(result), *(map_band_sentences(result) if "bands" in result else [])]


def map_sentence(result: Mapping[str, Any]) -> str:
    """The outcome in words."""
    label, helps = quantity_of(result["quantity"]).label, what_helps(result, (result["quantity"],))
    if result["mean"] is None:
        count = "The pose is not" if result["poses"] == 1 else f"None of the {result['poses']} poses is"
        return f"{count} held by the cables and stable.{helps}"
    low, high = result["smallest"], result["largest"]
    at = ["(" + ", ".join(f"{v:g}" for v in end["position_m"]) + ") m" for end in (low, high)]
    if result["poses"] == 1:
        return f"{label[0].upper()}{label[1:]} at {at[0]}: {low['value']:.4g} {result['unit']}."
    missing = {"cannot be held": result["poses"] - result["held"], "would not be stable": result["unstable"]}
    held = "".join(f" {n} pose{'s' if n > 1 else ''} {what}." for what, n in missing.items() if n)
    if several := result.get("shared_poses"):
        held += f" At {several} poses no mode holds half of the platform's motion."
    held += _veering(result)
    return (
        f"{label[0].upper()}{label[1:]}: {low['value']:.4g} {result['unit']} at {at[0]} to {high['value']:.4g} "
        f"{result['unit']} at {at[1]}, {result['mean']:.4g} {result['unit']} on average.{held}{helps}"
    )


def _veering(result: Mapping[str, Any]) -> str:
    """Where the mode was followed from, and where it could not be followed for sure."""
    said, several = "", result.get("veering_poses")
    if start := result.get("reference"):
        place = ", ".join(f"{v:g}" for v in start["position_m"])
        said = f" Followed from ({place}) m, where it has {start['mode_Hz']:.4g} Hz."
    if several:
        said += f" At {several} of {result['poses']} poses modes veer, and the frequency may step to another mode."
    if several := result.get("behind_veering_poses"):
        said += f" {several} poses are reached only across such poses: there it may be another mode."
    return said


def _map_facts(result: Mapping[str, Any]) -> list[tuple[str, str]]:
    held = (f"{result['held']} of {result['poses']}", "poses held")
    if result["mean"] is None:
        return [held]
    unit = result["unit"]
    if result["poses"] == 1:
        return [(f"{result['mean']:.4g} {unit}", quantity_of(result["quantity"]).label)]
    ends = [(f"{result[key]['value']:.4g} {unit}", key) for key in ("smallest", "largest")]
    return [*ends, (f"{result['mean']:.4g} {unit}", "mean"), held]


def map_figure(robot: Robot, name: str, grid: Grid, columns: Columns) -> tuple["Draw", tuple[float, float]]:
    """What draws a map over one to three axes into an empty figure, and its size [inch]."""
    return _layer_figure(robot, grid, _layer(name, columns))


def _layer_figure(robot: Robot, grid: Grid, layer: "Layer") -> tuple["Draw", tuple[float, float]]:
    from cdpr_struct.reports.figures import frame_plan, workspace_map, workspace_slices

    plan = frame_plan.FramePlan.of(robot, grid)
    solid = len(grid.free) == 3
    size = workspace_slices.slices_size(grid) if solid else workspace_map.map_size(grid)
    draw = workspace_slices.draw_slices if solid else workspace_map.draw_map
    return partial(draw, grid=grid, layer=layer, plan=plan), size


def _layer(name: str, columns: Columns) -> "Layer":
    """What the figure of a quantity shows, and which poses it marks."""
    from cdpr_struct.reports.figures import workspace_map

    quantity, value = quantity_of(name), map_values(name, columns)
    marked, mark = columns.get("more_stable_pose"), workspace_map.OTHER
    if marked is None:
        marked, mark = shared(name, columns), "no mode holds half of the platform's motion"
    if "veering" in columns:
        marked, mark = columns["veering"], "modes veer: the step to a neighbour may lead to another mode"
    signed = name.startswith("pose-error")
    return workspace_map.Layer(quantity.label, quantity.unit, value, marked, signed, mark)


def _map_plate(robot: Robot, name: str, grid: Grid, columns: Columns) -> Plate:
    from cdpr_struct.reports.figures import frame_plan, interactive_map
    from cdpr_struct.reports.figures.drawing import Drawing

    quantity = quantity_of(name)
    draw, size = map_figure(robot, name, grid, columns)
    picture = Drawing("map", size, draw)
    caption, live = _captions(robot, name, grid, columns)
    plot = interactive_map.map_plot(grid, [_layer(name, columns)], frame_plan.FramePlan.of(robot, grid))
    return Plate("map", f"{quantity.label[0].upper()}{quantity.label[1:]}", picture, caption, plot, live_caption=live)


def _band_plate(robot: Robot, grid: Grid, one: BandLayer) -> Plate:
    from cdpr_struct.reports.figures import frame_plan, interactive_map
    from cdpr_struct.reports.figures.drawing import Drawing

    draw, size = _layer_figure(robot, grid, one.layer)
    plot = interactive_map.map_plot(grid, [one.layer], frame_plan.FramePlan.of(robot, grid))
    return Plate(one.name, one.heading, Drawing(one.name, size, draw), one.caption, plot)


def _captions(robot: Robot, name: str, grid: Grid, columns: Columns) -> tuple[str, str]:
    """What to see in the picture, and in the map that can be zoomed: only what each of them shows."""
    from cdpr_struct.reports.figures import workspace_slices

    quantity, gaps = quantity_of(name), bool(np.isnan(map_values(name, columns)).any())
    about = (
        f"{robot.name}, {robot.platform.mass:g} kg{_comma(grid.fixed_text())}: {quantity.meaning} [{quantity.unit}]."
    )
    picture, live = [about], [about]
    if len(grid.free) == 3:
        slices = workspace_slices.Slices.of(grid)
        picture.append(slices.said())
        live.append(f"The slider goes through the slices along {AXES[slices.axis]}.")
    if gaps:
        picture.append("Hatched: poses that cannot be held or are not stable.")
        live.append(f"{'Blank' if len(grid.free) > 1 else 'Gaps'}: poses that cannot be held or are not stable.")
    if "veering" in columns and columns["veering"].any():
        picture.append("Triangles: modes veer, the frequency may step there.")
    if len(grid.free) > 1:
        picture.append(f"In the frame: the mapped rectangle in blue, {_FRAME}")
        live.append(f"Blue line: the mapped rectangle. The button “whole frame” shows {_FRAME}")
    return " ".join(picture), " ".join(live)


def _comma(text: str) -> str:
    return f", {text}" if text else ""
