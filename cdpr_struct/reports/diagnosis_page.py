"""The files of a diagnosis: residuals as CSV, figures, extended robot, and the report page."""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from itertools import count
from typing import Any

import numpy as np

from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.diagnosis.extended_model import extended_robot_toml
from cdpr_struct.diagnosis.residuals import UNITS
from cdpr_struct.diagnosis.sigma_check import tolerance_unit
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.diagnosis_signals import signal_plates, signal_tables
from cdpr_struct.reports.diagnosis_tables import (
    candidate_table,
    error_table,
    gain_table,
    next_table,
    sigma_table,
    size_table,
    standing,
)  # fmt: skip
from cdpr_struct.reports.figures import diagnosis as figures
from cdpr_struct.reports.figures.style import svg
from cdpr_struct.reports.html import HtmlTable, Page, Plate, render_page

"""Files that not every diagnosis has."""


def diagnosis_files(found: Diagnosis, result: Mapping[str, Any]) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name."""
    plates = [
        Plate(
            "residuals",
            "What the simulation gets wrong",
            svg("residuals", figures.RESIDUAL_SIZE, lambda f: figures.draw_residuals(f, found)),
            "Each point is one residual at the measured state, in its own standard deviation under noise and "
            "tolerances. "
            "Look for points outside the shaded band of +-2 sigma, and for several inside it that go together: one "
            "alone says nothing there. Faint lines part the states, whose "
            "names stand above where there is room; values of all points: residuals.csv.",
        ),
    ]
    if result["candidates"]:
        drawn = svg("evidence", figures.EVIDENCE_SIZE, lambda f: figures.draw_evidence(f, result))
        said = "See which bar is longest, and which end within three nats of it (a factor of twenty in probability): "
        said += "these the data hardly tell apart. Nats: the logarithm of how much likelier a cause makes the data."
        plates.append(Plate("evidence", "Which cause explains it", drawn, said))
    plates += signal_plates(found, result)
    files: dict[str, str | bytes] = {
        "residuals.csv": _residuals_csv(found),
        **{f"{plate.name}.svg": plate.svg for plate in plates},
        "report.html": render_page(diagnosis_page(found, result, plates)),
    }
    if result["extended_model"]:
        files["extended_robot.toml"] = extended_robot_toml(found, [*robot_comments(result), *_without_place(found)])
    return files


def robot_comments(result: Mapping[str, Any]) -> list[str]:
    """What a reader of extended_robot.toml must know: where it is from and how far it can be trusted."""
    said, gain = result["verdict"], result["gain"]
    lines = [
        f"Written by cdpr-struct diagnose {result['campaign']}.",
        said["sentence"],
        *standing(result),
        *result["warnings"],
    ]
    if any(len(names) > 1 for names in said["class"]):
        lines.append(
            "WARNING: these data do not tell the causes of a class; of each only the likeliest is in this file."
        )
    if said["status"] == "class" and not gain["confirmed"] and gain["ratio"] is not None:
        lines.append("WARNING: not confirmed by anything that was left out of the fit; do not rely on it.")
    return lines


def _without_place(found: Diagnosis) -> list[str]:
    """A line for causes that no robot file can hold: they are of the commands, the tracker or the notes."""
    fit = found.selection.fit
    names = [c.candidate.name for c in fit.choices if not c.candidate.cause.extension] if fit else []
    return [f"Not in this file, which has no place for it: {', '.join(names)}."] if names else []


def diagnosis_page(found: Diagnosis, result: Mapping[str, Any], plates: list[Plate]) -> Page:
    """The report page."""
    said = result["verdict"]
    more = [line[:1].upper() + line[1:] for line in standing(result)]
    more += [f"Where: {said['location']}."] if said["location"] else []
    facts = [
        (f"{row['rms']:.3g} {row['unit']}", f"rms error, {row['kind'].replace('_', ' ')}{_of_expected(row)}")
        for row in result["simulation_error"]
    ]
    if result["gain"]["confirmed"]:
        counted, of = result["gain"]["counted"], result["gain"]["of"]
        said_of = f"smaller error where it was not fitted ({counted} of {of} readings, those that the cause concerns)"
        facts.append((f"{result['gain']['ratio']:.1f}×", said_of))
        fudge = f"{result['gain']['generic_fudge_ratio']:.1f}×"
        facts.append((fudge, "the same by a generic fit of common EA and cell gain, all readings"))
    return Page(
        title=f"{found.campaign.robot_name}: what the simulation gets wrong, and why",
        subtitle=f"model {found.campaign.model}, {_counted(found)}, {found.campaign.source}",
        verdict=[said["sentence"], *more],
        holds=said["status"] == "adequate",
        facts=facts,
        plates=plates,
        tables=_tables(result) + signal_tables(dict(result)),
        notes=[("How it was computed", [_METHOD])],
    )


def _counted(found: Diagnosis) -> str:
    states = len(found.campaign.states.names)
    return "1 state" if states == 1 else f"{states} states"


def _of_expected(row: Mapping[str, Any]) -> str:
    """What noise and tolerances let expect, in brackets."""
    return "" if row["expected"] is None else f" ({row['expected']:.3g} {row['unit']} expected of noise and tolerances)"


_METHOD = (
    "Measured pose and tensions are put into the model; what is left of wrench balance, cable lengths and frequencies "
    "is judged against sensor noise and tolerances together. Every cause of the library is fitted with a prior on its "
    "size; "
    "the evidence counts how well it predicts and how many numbers it needed. Held-out states were predicted from "
    "fits to all the others."
)


def _tables(result: Mapping[str, Any]) -> list[HtmlTable]:
    candidates = result["candidates"]
    shown = (
        error_table(result),
        candidate_table(candidates, 20, 3),
        gain_table(result["gain"]),
        next_table(result["verdict"]["next_measurement"]),
        size_table(candidates),
    )
    tables = [table for table in shown if table]
    why = [[name.replace("_", " "), reason] for name, reason in sorted(result["why_not_testable"].items())]
    tables.append(HtmlTable("What these data cannot show", ["cause", "why"], why))
    sizes = [[n.replace("_", " "), f"{v['value']:.3g}", v["unit"]] for n, v in result["minimum_detectable"].items()]
    tables.append(HtmlTable("Smallest size found 4 times out of 5", ["cause", "size", "unit"], sizes))
    tolerances = [
        [n, f"{v['value']:g}", tolerance_unit(n) or "of its value", "stated" if v["stated"] else "default"]
        for n, v in result["tolerances"].items()
    ]
    tables.append(
        HtmlTable("Tolerances taken into account, one sigma", ["tolerance", "size", "unit", "source"], tolerances)
    )
    sigmas = sigma_table(result["sigmas"])
    return tables + ([sigmas] if sigmas else [])


def _residuals_csv(found: Diagnosis) -> str:
    """Residuals as entered and with the causes, block by block as in docs/diagnosis.md; rows are counted in each."""
    labels, null = found.entered_setting.labels, found.entered
    rows: defaultdict[tuple[str, int], Iterator[int]] = defaultdict(lambda: count(1))
    fit = found.selection.fit
    after = fit.left if fit is not None and len(fit.white) == len(null.r) else np.full(len(null.r), np.nan)
    places = zip(labels.block.tolist(), labels.state.tolist(), strict=True)
    return csv_text(
        {
            "block": labels.block,
            "case": [found.campaign.states.names[i] for i in labels.state],
            "row": [next(rows[place]) for place in places],
            "cable": [cable + 1 if cable >= 0 else "" for cable in labels.cable.tolist()],
            "residual": null.r,
            "unit": [UNITS[block] for block in labels.block.tolist()],
            "sigma": np.sqrt(np.diagonal(null.covariance)),
            "with_causes": after,
        }
    )
