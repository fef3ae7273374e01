"""The files of a robot's modes: tables as CSV, frequency ladder, the robot at rest, and the report page."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.crosscheck.mode_motion import ModeMotion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.reports.backbone_text import backbone_columns
from cdpr_struct.reports.bands_told import band_note, band_words
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import backbone, mode_ladder, mode_shapes, robot_drawing
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.mode_viewer import viewer_markup
from cdpr_struct.reports.mode_words import WORDS_NOTE
from cdpr_struct.reports.modes_text import modes_columns, modes_sentence, motion_columns
from cdpr_struct.reports.text import place


def modes_files(point: OperatingPoint, result: Mapping[str, Any], motion: ModeMotion) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name.

    point   : the robot at rest that the modes belong to
    result  : as the command `modes` gives it
    """
    plates = _plates(point, result, motion)
    lengths, tensions = result["lengths_m"], result["tensions_N"]
    curves = result.get("large_motion")
    large = {} if curves is None else {"large_motion.csv": csv_text(backbone_columns(curves))}
    return {
        "modes.csv": csv_text(modes_columns(result)),
        "platform_motion.csv": csv_text(motion_columns(result)),
        **large,
        "cables.csv": csv_text({"cable": range(1, len(lengths) + 1), "length_m": lengths, "tension_N": tensions}),
        **page_files(_page(point, result, plates)),
    }


def _plates(point: OperatingPoint, result: Mapping[str, Any], motion: ModeMotion) -> list[Plate]:
    shapes = mode_shapes.size(point, len(motion.platform))
    drawn = Drawing("large_motion", backbone.SIZE, lambda f: backbone.draw_backbone(f, result))
    large = [Plate("large_motion", "Frequency over amplitude", drawn, backbone.CAPTION)]
    return [
        Plate(
            "modes",
            "Eigenfrequencies",
            Drawing("modes", mode_ladder.SIZE, lambda f: mode_ladder.draw_ladder(f, result)),
            mode_ladder.ladder_caption(result),
        ),
        Plate(
            "mode_shapes",
            "Mode shapes",
            Drawing("mode_shapes", shapes, lambda f: mode_shapes.draw_shapes(f, point, result, motion)),
            mode_shapes.shapes_caption(len(motion.platform)),
            live=viewer_markup(point, result, motion),
        ),
        *(large if "large_motion" in result else []),
        Plate(
            "robot",
            "The robot at rest",
            Drawing("robot", robot_drawing.SIZE, lambda f: robot_drawing.draw_robot(f, point)),
            robot_drawing.robot_caption(point),
        ),
    ]


def _page(point: OperatingPoint, result: Mapping[str, Any], plates: list[Plate]) -> Page:
    robot = point.entered
    return Page(
        robot=result["robot"],
        title=f"{result['robot']}: eigenfrequencies",
        subtitle=(
            f"{len(robot.cables)} cables, platform {robot.platform.mass:g} kg at {place(point.position)}; "
            f"cable model {result['model']}, assembly {result['assembly']}"
        ),
        verdict=[modes_sentence(result)],
        holds=bool(result["count_certified"]),
        facts=_facts(result),
        plates=plates,
        tables=[_mode_table(result), _cable_table(point, result)],
        notes=[("How it was computed", (_MODELS[result["model"]], _KINDS, WORDS_NOTE, _ASSUMED))],
    )


_MODELS = {
    "exact": "Cables: dynamic stiffness about the elastic catenary, without approximation of the sag.",
    "dsm": "Cables: closed-form dynamic stiffness for shallow, taut cables (eqs 2.31 to 2.41), valid inside its "
    "printed limits only.",
    "static": "Cables: static stiffness of the elastic catenary, without mass. Six modes, those of the platform; no "
    "cable modes.",
    "fem": "Cables: geometrically exact bar elements with lumped masses, from the independent finite-element program. "
    "Its frequencies have the error of the mesh; verify extrapolates it away.",
}
_KINDS = (
    "Kind: platform or cable i where that body has half of the kinetic energy or more; cables where the cables "
    "together have nine tenths; else mixed. The count is certified where an exact count of the eigenvalues below the "
    "last frequency (Wittrick and Williams; for finite elements Sylvester's law of inertia) agrees with the list."
)
_ASSUMED = (
    "Assumed: small undamped vibrations about the rest pose, rigid platform, winches that hold their lengths, linear "
    "elastic cables."
)


def _facts(result: Mapping[str, Any]) -> list[tuple[str, str]]:
    hertz, kinds = result["frequencies_hz"], result["kinds"]
    of_platform = [float(f) for f, kind in zip(hertz, kinds, strict=True) if kind == "platform"]
    first = f"{of_platform[0]:.3f} Hz" if of_platform else "none here"
    return [
        (f"{hertz[0]:.3f} Hz", f"first eigenfrequency ({kinds[0]})"),
        (first, "first platform mode (half of the energy or more)"),
        (f"{len(hertz)}", f"modes, {len(of_platform)} of them of the platform"),
        ("certified" if result["count_certified"] else "not certified", "count of the modes"),
    ]


def _mode_table(result: Mapping[str, Any]) -> HtmlTable:
    columns = (result[key] for key in ("frequencies_hz", "platform_energy", "kinds", "motion_words"))
    rows = [
        [str(i), f"{hertz:.5f}", f"{100.0 * share:.1f}", kind, words]
        for i, (hertz, share, kind, words) in enumerate(zip(*columns, strict=True), start=1)
    ]
    names = ["mode", "frequency [Hz]", "platform's share of the kinetic energy [%]", "kind", "platform motion"]
    note = "All digits: modes.csv; motion of the platform: platform_motion.csv."
    if bands := result.get("bands"):
        names.insert(2, f"{bands['level']:g} % band [Hz]")
        inside = band_words(bands, "frequencies_hz", 4)
        rows = [[*row[:2], words, *row[2:]] for row, words in zip(rows, inside, strict=True)]
        note = f"{note} {band_note(bands)}"
    return HtmlTable("Modes", names, rows, note, prose=frozenset({len(names) - 2, len(names) - 1}))


def _cable_table(point: OperatingPoint, result: Mapping[str, Any]) -> HtmlTable:
    sag, chord = 1e3 * point.cables.sag, point.cables.chord
    columns = (result["lengths_m"], result["tensions_N"], chord, sag)
    rows = [
        [str(i), f"{length:.5f}", f"{tension:.3f}", f"{straight:.4f}", f"{deep:.2f}"]
        for i, (length, tension, straight, deep) in enumerate(zip(*columns, strict=True), start=1)
    ]
    scaled = not np.allclose(result["lengths_m"], point.cables.paid_out, rtol=1e-12, atol=0.0)
    note = "Lengths are what the encoders read: offset and scale of the robot file are included." if scaled else ""
    names = ["cable", "unstrained length [m]", "tension at the platform [N]", "chord [m]", "sag [mm]"]
    return HtmlTable("Cables at rest", names, rows, note)
