"""Many diagnoses in one table."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from cdpr_struct.reports.figures import many_inputs as figures
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import Plate
from cdpr_struct.reports.many_inputs import rows_csv, rows_files, rows_text, unanswered

Row = Mapping[str, Any]
STATUSES = ("named", "class", "unknown", "adequate")
_COLUMNS = {
    "campaign": ("folder", "s"),
    "verdict": ("status", "s"),
    "causes": ("causes", "s"),
    "probability": ("probability", ".2f"),
    "p-value": ("p_value", ".2g"),
    "held-out gain": ("heldout_ratio", ".3g"),
}
_ON_THE_PAGE = {**_COLUMNS, "what it says": ("sentence", "s")}


def campaign_row(result: Mapping[str, Any]) -> dict[str, Any]:
    """What the table shows of one result.json."""
    verdict = result["verdict"]
    return {
        "status": verdict["status"],
        "causes": list(verdict["causes"]),
        "probability": verdict["probability"],
        "p_value": result["p_value"],
        "heldout_ratio": result["gain"]["ratio"],
        "sentence": verdict["sentence"],
    }


def campaigns_text(rows: Sequence[Row]) -> str:
    """For the terminal."""
    return rows_text(_summary(rows), _COLUMNS, rows)


def campaigns_files(rows: Sequence[Row]) -> dict[str, str | bytes]:
    """The table as CSV, its figure and the page."""
    told = [row for row in rows if not row["message"]]
    plates = []
    if told:
        names, values = [row["folder"] for row in told], [row["probability"] for row in told]
        groups = [row["status"] for row in told]
        picture = Drawing(
            "verdicts",
            figures.size(len(told)),
            lambda f: figures.draw_values(f, names, values, groups, STATUSES, "probability of the verdict [-]"),
        )
        said = (
            "Probability of each campaign's verdict, coloured by its kind. Look for campaigns of one robot whose "
            "verdicts differ, and for low probabilities: these say what to measure next."
        )
        plates.append(Plate("verdicts", "Verdicts", picture, said))
    counts = Counter(row["status"] for row in told)
    facts = [(str(counts[status]), status) for status in STATUSES]
    return {
        "campaigns.csv": rows_csv(rows),
        **rows_files(
            "Diagnoses of many campaigns", [_summary(rows)], facts, plates, _ON_THE_PAGE, rows, frozenset({0, 1, 2, 6})
        ),
    }


def _summary(rows: Sequence[Row]) -> str:
    counts = Counter(row["status"] for row in rows if not row["message"])
    kinds = ", ".join(f"{counts[status]} {status}" for status in STATUSES if counts[status])
    failed = len(unanswered(rows))
    return f"{len(rows)} campaigns: {kinds or 'no verdict'}" + (f"; {failed} without an answer." if failed else ".")
