"""The robot at rest, held at a pose (inverse) or at locked lengths (forward): result, text, table, picture, page."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.reports.bands_told import band_columns, band_note, band_words
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.text import paragraphs, place, plain_table, rounded
from cdpr_struct.robot.pose import Pose, angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibria import Equilibria
from cdpr_struct.statics.forward_kinematics import ForwardSolution
from cdpr_struct.statics.inverse_kinematics import InverseSolution
from cdpr_struct.statics.locked_rest import LockedRest
from cdpr_struct.statics.strained_cables import strains

_COLUMNS = ["cable", "unstrained length [m]", "tension at the platform [N]", "sag [mm]", "stretch [mm]"]
_WINCHES = ["winch", "cables", "length [m]", "paid out since home [m]"]
_MODEL_NOTES = {
    "sagging": "Sagging model: each cable is an elastic catenary, exact for any sag.",
    "spring": "Spring model: straight massless springs that cannot push.",
    "ideal": "Ideal model: straight, massless, inextensible cables that cannot push.",
}


def inverse_json(robot: Robot, model: str, pose: Pose, solution: InverseSolution) -> dict[str, Any]:
    """Result of `inverse` at one pose."""
    return {
        "robot": robot.name,
        "mass_kg": robot.platform.mass,
        "model": model,
        "pose": pose.in_degrees(),
        "lengths_m": solution.lengths,
        "tensions_N": solution.tensions,
        "residual_wrench": solution.residual_wrench,
        "strains": strains(solution.cables),
    }


def forward_json(robot: Robot, model: str, lengths: Sequence[float], solution: ForwardSolution) -> dict[str, Any]:
    """Result of `forward` at one set of lengths."""
    angles = np.degrees(angles_from_rotation(solution.rotation))
    return {
        "robot": robot.name,
        "mass_kg": robot.platform.mass,
        "model": model,
        "lengths_m": list(lengths),
        "pose": [*solution.position.tolist(), *angles.tolist()],
        "tensions_N": solution.tensions,
        "slack": solution.cables.slack,
        "residual_wrench": solution.residual_wrench,
        "strains": strains(solution.cables),
        "stable": bool(solution.stable),
        "least_stiffness_N_m": float(solution.least_stiffness),
        "iterations": int(solution.iterations),
    }


def inverse_text(result: Mapping[str, Any]) -> str:
    """Lengths and tensions for a terminal."""
    return paragraphs(_cable_text(result), *_winches_text(result), *_bands_text(result), residual_sentence(result))


def forward_text(result: Mapping[str, Any]) -> str:
    """Pose, stability and tensions for a terminal."""
    cables = _cable_text(result), *_winches_text(result), *_bands_text(result)
    return paragraphs(pose_sentence(result), *cables, residual_sentence(result))


def pose_sentence(result: Mapping[str, Any]) -> str:
    """Where the platform comes to rest."""
    (x, y, z), (rx, ry, rz) = rounded(result["pose"][:3], 5), rounded(result["pose"][3:], 4)
    state = "The platform rests" if result["stable"] else "NOT STABLE: the platform is balanced, but not held,"
    slack = [str(i) for i, loose in enumerate(result["slack"], start=1) if loose]
    loose = f" Slack cables: {', '.join(slack)}." if slack else ""
    return f"{state} at ({x:.5f}, {y:.5f}, {z:.5f}) m, turned by ({rx:.4f}, {ry:.4f}, {rz:.4f})° about x, y, z.{loose}"


def residual_sentence(result: Mapping[str, Any]) -> str:
    """How well forces and moments balance."""
    left = np.abs(result["residual_wrench"])
    return f"Largest unbalanced force {left[:3].max():.2g} N, moment {left[3:].max():.2g} N m."


def inverse_files(
    robot: Robot, pose: Pose, solution: InverseSolution, result: Mapping[str, Any]
) -> dict[str, str | bytes]:
    """CSV, picture and page of a held pose."""
    point = OperatingPoint(robot, pose.position, pose.rotation, solution.cables)
    return _files(point, result, inverse_sentences(result), result["stable"])


def inverse_sentences(result: Mapping[str, Any]) -> list[str]:
    """The outcome at a held pose in words."""
    tension, where = np.asarray(result["tensions_N"]), ", ".join(f"{v:g}" for v in result["pose"][:3])
    verb = "hold" if result["stable"] else "balance, but do not hold"
    held = f"Tensions of {tension.min():.4g} to {tension.max():.4g} N {verb} the pose ({where}) m."
    return [held, residual_sentence(result)]


def forward_files(
    robot: Robot, found: LockedRest, result: Mapping[str, Any], equilibria: bool = False
) -> dict[str, str | bytes]:
    """CSV, picture and page of the pose at locked lengths; with `equilibria`, pictures of other stable poses, too."""
    solution = found.solution
    point = OperatingPoint(robot, solution.position, solution.rotation, solution.cables)
    more = _others(robot, found.others) if equilibria else []
    return _files(point, result, forward_sentences(result), result["stable"], more)


def forward_sentences(result: Mapping[str, Any]) -> list[str]:
    """The outcome at locked lengths in words."""
    stiffness = f"Least stiffness {result['least_stiffness_N_m']:.4g} N/m, rotations as arcs at the anchors."
    return [pose_sentence(result), stiffness, residual_sentence(result)]


def _others(robot: Robot, others: Equilibria) -> list[Plate]:
    """A picture of every other stable pose."""
    from cdpr_struct.reports.figures import interactive, robot_drawing
    from cdpr_struct.reports.figures.drawing import Drawing

    plates = []
    for i, energy in enumerate(others.energy):
        point = OperatingPoint(robot, others.position[i], others.rotation[i], others.cables.at(i))
        name = f"equilibrium_{i + 2}"
        picture = Drawing(name, robot_drawing.SIZE, partial(robot_drawing.draw_robot, point=point))
        caption = (
            f"{energy:+.4g} J against the answer, at {place(point.position)}; {int(others.slack[i])} cables slack. "
            "Whether cables cross each other or the platform is not checked."
        )
        title = f"Stable pose {i + 2} at the same lengths"
        plates.append(Plate(name, title, picture, caption, interactive.robot_plot(point)))
    return plates


def _files(
    point: OperatingPoint, result: Mapping[str, Any], verdict: list[str], holds: bool, more: Sequence[Plate] = ()
) -> dict[str, str | bytes]:
    from cdpr_struct.reports.figures import interactive, robot_drawing
    from cdpr_struct.reports.figures.drawing import Drawing

    picture = Drawing("robot", robot_drawing.SIZE, lambda f: robot_drawing.draw_robot(f, point))
    plate = Plate(
        "robot", "The robot at rest", picture, _caption(point, result["model"]), interactive.robot_plot(point)
    )
    how = (
        _MODEL_NOTES[result["model"]],
        "A platform of given pose is held with the tensions of least norm inside the bounds; at given lengths its "
        "potential energy is minimised, so the pose is a stable one: the one that continuous motion from the home pose "
        "leads to, or in whose basin --start lies.",
    )
    page = Page(
        robot=result["robot"],
        title=f"{result['robot']}: at rest",
        subtitle=f"{len(point.entered.cables)} cables, platform {result['mass_kg']:g} kg, {result['model']} model",
        verdict=verdict,
        holds=holds,
        facts=_facts(result, point.cables),
        plates=[plate, *more],
        tables=[HtmlTable("Cables", _COLUMNS, _rows(point.cables)), *_winches_table(result), *_bands_table(result)],
        notes=[("How it was computed", how)],
    )
    return {
        "cables.csv": csv_text(cable_columns(point.cables, result)),
        **page_files(page),
    }


def _caption(point: OperatingPoint, model: str) -> str:
    tension = point.cables.tension_at_platform
    shape = "hang in catenaries" if model == "sagging" else "are taken as straight"
    return (
        f"{point.entered.name} to scale. Numbers at the frame anchors are cables; colour is the tension, "
        f"{tension.min():.4g} to {tension.max():.4g} N. The cables {shape}."
    )


def _facts(result: Mapping[str, Any], cables: CableStates) -> list[tuple[str, str]]:
    tension = cables.tension_at_platform
    facts = [(f"{tension.min():.4g} N", "smallest tension"), (f"{tension.max():.4g} N", "largest tension")]
    if result["model"] == "sagging":
        facts.append((f"{1e3 * np.nanmax(cables.sag):.3g} mm", "largest sag"))
    return [*facts, (f"{result['mass_kg']:g} kg", "platform with its load")]


def _rows(cables: CableStates) -> list[list[str]]:
    sag = ["slack" if loose else f"{1e3 * v:.2f}" for v, loose in zip(cables.sag, cables.slack, strict=True)]
    return [
        [str(i + 1), f"{length:.5f}", f"{tension:.3f}", sag[i], f"{1e3 * stretch:.3f}"]
        for i, (length, tension, stretch) in enumerate(
            zip(cables.total_length, cables.tension_at_platform, cables.elongation, strict=True)
        )
    ]


def cable_columns(cables: CableStates, result: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of cables.csv, one row a cable, with the band of the tension if there is one."""
    return {
        "cable": range(1, len(cables.length) + 1),
        "length_m": cables.total_length,
        "tension_N": cables.tension_at_platform,
        "tension_at_frame_N": cables.tension_at_frame,
        "chord_m": cables.chord,
        "inclination_deg": np.degrees(cables.inclination),
        "sag_m": cables.sag,
        "elongation_m": cables.elongation,
        "slack": cables.slack.astype(int),
        **(band_columns(result["bands"], "tensions_N", "tension", "N") if "bands" in result else {}),
    }


def _cable_text(result: Mapping[str, Any]) -> str:
    rows = [
        [f"cable {i}", f"{length:.5f}", f"{tension:.3f}"]
        for i, (length, tension) in enumerate(zip(result["lengths_m"], result["tensions_N"], strict=True), start=1)
    ]
    names = ["", "length [m]", "tension [N]"]
    if bands := result.get("bands"):
        names.append(f"{bands['level']:g} % band [N]")
        rows = [[*row, words] for row, words in zip(rows, band_words(bands, "tensions_N", 2), strict=True)]
    return plain_table(f"{result['robot']}, {result['model']} cables", names, rows)


def _bands_rows(result: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    """Column names and rows of the band of the pose."""
    bands = result["bands"]
    words = band_words(bands, "pose", 5)
    names = ["", "value", f"{bands['level']:g} % band", "sigma"]
    sigmas = [f"{1e3 * s:.3g} mm" for s in bands["pose_sigma"][:3]] + [f"{s:.3g}°" for s in bands["pose_sigma"][3:]]
    labels = ["x [m]", "y [m]", "z [m]", "rx [°]", "ry [°]", "rz [°]"]
    rows = [[n, f"{v:.5f}", w, s] for n, v, w, s in zip(labels, result["pose"], words, sigmas, strict=True)]
    return names, rows


def _bands_text(result: Mapping[str, Any]) -> list[str]:
    if "bands" not in result:
        return []
    return [plain_table("Pose at these lengths", *_bands_rows(result)), band_note(result["bands"])]


def _bands_table(result: Mapping[str, Any]) -> list[HtmlTable]:
    if "bands" not in result:
        return []
    bands = result["bands"]
    inside = band_words(bands, "tensions_N", 2)
    pulls = [
        [f"tension {i} [N]", f"{t:.2f}", words, f"{s:.3g} N"]
        for i, (t, words, s) in enumerate(
            zip(result["tensions_N"], inside, bands["tension_sigma_N"], strict=True), start=1
        )
    ]
    names, rows = _bands_rows(result)
    return [HtmlTable("Bands of pose and tensions", names, rows + pulls, band_note(bands))]


def _winches_rows(result: Mapping[str, Any]) -> list[list[str]]:
    """What each winch says, if any winds several cables: the length of its first cable, and its change since home."""
    rows = []
    for winch in result.get("winches", ()):
        change = winch["paid_out_since_home_m"]
        since = "-" if change is None else f"{round(change, 5) + 0.0:+.5f}"
        rows.append([winch["name"], ", ".join(map(str, winch["cables"])), f"{winch['length_m']:.5f}", since])
    return rows


def _winches_text(result: Mapping[str, Any]) -> list[str]:
    rows = _winches_rows(result)
    return [plain_table("Winches", _WINCHES, rows)] if rows else []


def _winches_table(result: Mapping[str, Any]) -> list[HtmlTable]:
    rows = _winches_rows(result)
    return [HtmlTable("Winches", _WINCHES, rows)] if rows else []
