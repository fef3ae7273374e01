"""The files of a test plan: tables as CSV, confusions and gains as figures, and the report page."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import plan as figures
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.plan.measurements import MANY
from cdpr_struct.reports.plan.result import detectable_columns
from cdpr_struct.reports.plan.text import plan_sentences


def plan_files(result: Mapping[str, Any]) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name.

    result  : as `plan_json` gives it
    """
    plates = _plates(result)
    return {
        **_tables(result),
        **page_files(_page(result, plates)),
    }


def _tables(result: Mapping[str, Any]) -> dict[str, str]:
    pairs, gains = result["confusable"], result["next"]
    hidden = sorted(result["not_testable"].items())
    separated = [(row["measurement"], s) for row in gains for s in row["separates"]]
    return {
        "detectable.csv": csv_text(detectable_columns(result)),
        "confusable.csv": csv_text(
            {"cause": [a for a, _ in pairs], "taken_for": [b for _, b in pairs], "nats": result["confusable_nats"]}
        ),
        "not_testable.csv": csv_text({"cause": [name for name, _ in hidden], "why": [why for _, why in hidden]}),
        "next.csv": csv_text(
            {
                "measurement": [row["measurement"] for row in gains],
                "gain_nats": [row["gain_nats"] for row in gains],
                "pairs": [len(row["separates"]) for row in gains],
            }
        ),
        "separates.csv": csv_text(
            {
                "measurement": [name for name, _ in separated],
                **{key: [s[key] for _, s in separated] for key in ("cause", "from", "nats_before", "nats_after")},
            }
        ),
    }


def _plates(result: Mapping[str, Any]) -> list[Plate]:
    plates = []
    if result["confusable"]:
        drawn = Drawing("confusions", figures.confusion_size(result), lambda f: figures.draw_confusions(f, result))
        plates.append(Plate("confusions", "Which causes would be confused", drawn, figures.confusion_caption(result)))
    if result["next"]:
        drawn = Drawing("gains", figures.gain_size(result), lambda f: figures.draw_gains(f, result))
        plates.append(Plate("gains", "What to measure next", drawn, figures.gain_caption(result)))
    return plates


def _page(result: Mapping[str, Any], plates: list[Plate]) -> Page:
    found, pairs, hidden = len(result["detectable"]), len(result["confusable"]), len(result["not_testable"])
    best = f"{result['next'][0]['gain_nats']:.1f} nats" if result["next"] else "none"
    return Page(
        title="Test plan: what this campaign can find",
        subtitle="computed before measuring, from the robot, the planned states and the sigmas of the campaign file",
        verdict=plan_sentences(result),
        holds=found > 0,
        facts=[
            (f"{found}", "causes that would be found at their typical size"),
            (f"{pairs}", "pairs of causes that would be confused"),
            (f"{hidden}", "causes that would not be found"),
            (best, "gain of the best next measurement"),
        ],
        plates=plates,
        tables=_html_tables(result),
        notes=[("How it was computed", _NOTES)],
    )


_NOTES = (
    "Smallest detectable size: found with a probability of 0.8 at a false alarm rate of 0.001, against noise and the "
    "tolerances of the campaign. For a cause with several parameters it is their root mean square.",
    "Nats: expected log Bayes factor between two causes; 3 nats are a factor of 20. The true cause has twice its "
    "smallest detectable size, the other one any plausible size.",
    "A gain is that of one simulated measurement with the stated accuracy, added to the campaign; the model is "
    "linearised about the nominal robot. Only the best measurement of each kind is listed.",
)


def _html_tables(result: Mapping[str, Any]) -> list[HtmlTable]:
    sizes = [
        [_words(row["cause"]), f"{least['value']:.3g}", least["unit"], least["pattern"]]
        for row in result["detectable"]
        for least in [row["minimum_detectable"]]
    ]
    pairs = [
        [_words(cause), _words(rival), f"{nats:.2f}"]
        for (cause, rival), nats in zip(result["confusable"], result["confusable_nats"], strict=True)
    ]
    gains = [[row["measurement"], f"{row['gain_nats']:.2f}", _best_pair(row)] for row in result["next"]]
    hidden = [[_words(cause), why] for cause, why in sorted(result["not_testable"].items())]
    tables = (
        HtmlTable(
            "Smallest detectable size (found in 4 of 5 cases)", ["cause", "size", "unit", "pattern"], sizes,
            "Units differ, so sizes in different rows cannot be compared. Relative: to the value in the robot file.",
            prose=frozenset({2, 3}),
        ),
        HtmlTable("Causes that would be confused", ["true cause", "taken for", "evidence between them [nats]"], pairs,
                  prose=frozenset({1})),
        HtmlTable("Next measurements", ["measurement", "gain [nats]", "pair that gains most [nats]"], gains,
                  prose=frozenset({2})),
        HtmlTable("Causes that this campaign would not find", ["cause", "why"], hidden, prose=frozenset({1})),
    )  # fmt: skip
    return [table for table in tables if table.rows]


def _best_pair(row: Mapping[str, Any]) -> str:
    if not row["separates"]:
        return "-"
    first = row["separates"][0]
    pair = f"{_words(first['cause'])} from {_words(first['from'])}"
    after = f"{first['nats_after']:.1f}" if first["nats_after"] < MANY else f"more than {MANY:.0f}"
    return f"{pair}: {first['nats_before']:.1f} before, {after} after"


def _words(name: str) -> str:
    return name.replace("_", " ")
