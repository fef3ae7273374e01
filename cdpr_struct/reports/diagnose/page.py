"""The files of a diagnosis: residuals as CSV, figures, extended robot, and the report page."""

from collections.abc import Mapping
from functools import partial
from typing import Any

from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.diagnosis.predicted_frames import PredictedFrames
from cdpr_struct.reports.ambient_page import ambient_plates
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.diagnose import tables
from cdpr_struct.reports.diagnose.recordings import length_tables, stretch_table
from cdpr_struct.reports.diagnose.residual_table import residual_columns
from cdpr_struct.reports.diagnose.signals import signal_plates, signal_table
from cdpr_struct.reports.diagnose.state_errors import state_table, tension_table
from cdpr_struct.reports.diagnose.text import diagnosis_sentences
from cdpr_struct.reports.diagnose.virtual_table import virtual_columns, virtual_tables
from cdpr_struct.reports.figures import diagnose as figures
from cdpr_struct.reports.figures import virtual_sensors as virtual
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.figures.interactive_residuals import residuals_plot
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.robot.robot_writing import robot_toml

_METHOD = (
    "The model is evaluated at the measured pose and tensions. The residuals of wrench balance, cable lengths and "
    "frequencies are compared with sensor noise and tolerances together. The noise model is a mixture of scales: a "
    "reading may be an outlier, and each kind of sensor may scatter more or less than stated. The likelihood sums over "
    "all assignments of peaks to modes. Every cause of the library is fitted with a prior on its size; the evidence "
    "weighs the quality of the fit against the number of parameters. The verdict has the least expected loss. "
    "Held-out states were predicted from fits to all other states."
)
_RESIDUALS = (
    "Each point is one residual, simulated minus measured at the measured state, divided by its standard deviation "
    "under noise and tolerances. Look for points outside the shaded band of +-2 sigma, and for several points inside "
    "it with the same trend; a single point inside it means nothing. Grey lines separate the kinds of readings."
)
_VALUES = "Values of all points: residuals.csv."


def result_files(
    found: Diagnosis, result: Mapping[str, Any], predicted: PredictedFrames | None = None
) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name."""
    shown = [*plates(found, result), *virtual_plates(predicted)]
    files: dict[str, str | bytes] = {
        "residuals.csv": csv_text(residual_columns(found)),
        **({} if predicted is None else _virtual_files(predicted)),
        **page_files(page(found, result, shown)),
    }
    if found.extended is not None:
        comments = [*robot_comments(result), *_without_place(found)]
        files["extended_robot.toml"] = robot_toml(found.extended, f"{found.campaign.robot.name}-extended", comments)
    return files


def plates(found: Diagnosis, result: Mapping[str, Any]) -> list[Plate]:
    """The figures."""
    shown = [
        Plate(
            "residuals",
            "What the simulation gets wrong",
            Drawing("residuals", figures.RESIDUAL_SIZE, lambda f: figures.draw_residuals(f, found)),
            f"{_RESIDUALS} Faint lines separate the states, named above where there is room. {_VALUES}",
            residuals_plot(residual_columns(found), figures.ROW_NAMES),
            live_caption=f"{_RESIDUALS} {_VALUES}",
        )
    ]
    if result["errors_by_state"]:
        drawn = Drawing("state_errors", figures.STATES_SIZE, lambda f: figures.draw_state_errors(f, result))
        said = (
            "Rms of measured less predicted in each state, in the unit of each kind. Look where the second bar is no "
            "shorter than the first: there the causes do not help. Moments are over the platform's radius."
        )
        shown.append(Plate("state_errors", "Errors by state", drawn, said))
    if result["candidates"]:
        drawn = Drawing("evidence", figures.EVIDENCE_SIZE, lambda f: figures.draw_evidence(f, result))
        said = "Look for the longest bar, and for those within 3 nats of it (a factor of 20 in probability): the data "
        said += "hardly distinguish these causes. Nats: log Bayes factor against the nominal model, prior included."
        shown.append(Plate("evidence", "Which cause explains it", drawn, said))
    drawn = Drawing("probabilities", figures.PROBABILITY_SIZE, lambda f: figures.draw_probabilities(f, result))
    said = (
        "Posterior probabilities of the likeliest sets of causes; blue: those named in the verdict. Look whether one "
    )
    said += "dominates or several share the probability. Unknown: laws outside the library."
    shown.append(Plate("probabilities", "How probable each answer is", drawn, said))
    signals = signal_plates(found.damped, found.campaign.identified)
    return shown + signals + ambient_plates(found.campaign.ambient)


def _virtual_files(predicted: PredictedFrames) -> dict[str, str | bytes]:
    """Tables of the campaign and of a later one."""
    named = {"virtual_sensors.csv": predicted.own, "virtual_sensors_later.csv": predicted.later}
    return {name: csv_text(virtual_columns(own)) for name, own in named.items() if own is not None}


def virtual_plates(predicted: PredictedFrames | None) -> list[Plate]:
    """A figure of the campaign's states, and one of a later campaign's."""
    if predicted is None:
        return []
    shown = [("virtual_sensors", "What sensors would say in every state", predicted.own)]
    if predicted.later is not None:
        shown.append(("virtual_sensors_later", "The same of readings that were not fitted", predicted.later))
    return [
        Plate(name, title, Drawing(name, virtual.SIZE, partial(virtual.draw_virtual, found=own)), virtual.CAPTION)
        for name, title, own in shown
    ]


def robot_comments(result: Mapping[str, Any]) -> list[str]:
    """What a reader of extended_robot.toml must know: where it is from and how far it can be trusted."""
    said, gain = result["verdict"], result["gain"]
    lines = [
        f"Written by cdpr-struct diagnose {result['campaign']}.",
        said["sentence"],
        *tables.standing(result),
        *result["warnings"],
    ]
    if any(len(names) > 1 for names in said["class"]):
        lines.append(
            "WARNING: these data do not distinguish the causes of a class; this file holds the likeliest of each class."
        )
    if said["status"] == "class" and not gain["confirmed"] and gain["ratio"] is not None:
        lines.append("WARNING: not confirmed by held-out states; do not rely on it.")
    return lines


def _without_place(found: Diagnosis) -> list[str]:
    """A line for causes that no robot file can hold: they are of single states."""
    names = [size.part.cause.name for size in found.sizes if size.part.cause.carrier == "state"]
    lines = [f"Not in this file, because robot files have no field for it: {', '.join(names)}."] if names else []
    return lines + (
        [f"Not in this file: the drift of the {found.drift.sensor.replace('_', ' ')}."] if found.drift else []
    )


def page(found: Diagnosis, result: Mapping[str, Any], shown: list[Plate]) -> Page:
    """The report page."""
    said = result["verdict"]
    states = len(found.campaign.states.names)
    counted = "1 state" if states == 1 else f"{states} states"
    return Page(
        robot=found.campaign.robot.name,
        title=f"{found.campaign.robot.name}: what the simulation gets wrong, and why",
        subtitle=f"model {found.campaign.model}, {counted}, {found.campaign.source}",
        verdict=diagnosis_sentences(result),
        holds=said["status"] == "adequate",
        facts=_facts(result),
        plates=shown,
        tables=_tables(result),
        notes=[("How it was computed", [_METHOD])],
    )


def _facts(result: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Errors of each kind, and what was gained where it was not fitted."""
    facts = [
        (f"{row['rms']:.3g} {row['unit']}", f"rms error, {row['kind'].replace('_', ' ')}")
        for row in result["simulation_error"]
    ]
    gain = result["gain"]
    if gain["confirmed"]:
        said = f"smaller error in held-out states ({gain['counted']} of {gain['of']} readings, those affected by the "
        facts.append((f"{gain['ratio']:.1f}×", f"{said}cause)"))
        if gain["generic_fudge_ratio"] is not None:
            fudge = f"{gain['generic_fudge_ratio']:.1f}×"
            facts.append((fudge, "the same for a generic fit of one common EA and one cell gain, over all readings"))
    return facts


def _tables(result: Mapping[str, Any]) -> list[HtmlTable]:
    shown = (
        tables.errors(result),
        state_table(result),
        tension_table(result),
        tables.candidates(result["candidates"], 20, 3),
        tables.left_out(result["gain"]),
        *length_tables(result),
        stretch_table(result),
        *virtual_tables(result),
        tables.next_steps(result["next_measurements"]),
        tables.set_aside(result["set_aside"]),
        tables.noise(result["noise"]),
        tables.all_sizes(result["candidates"]),
        tables.not_shown(result),
        tables.detectable(result),
        tables.tolerances(result),
        tables.sigmas(result["sigmas"]),
        signal_table(result),
    )
    return [table for table in shown if table]
