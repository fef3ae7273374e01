"""The files of a run of the derivations: the formulas as CSV, what differs, and the report page."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.html import HtmlTable, Page, page_files

_LINES_SHOWN = 400


def derive_files(result: Mapping[str, Any]) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name.

    result  : as the command `derive` gives it
    """
    formulas = result["formulas"]
    keys = ("id", "thesis_equation", "status", "note")
    return {
        "formulas.csv": csv_text({key: [formula[key] for formula in formulas] for key in keys}),
        **({"changes.diff": result["diff"]} if result["diff"] else {}),
        **page_files(_page(result)),
    }


def _page(result: Mapping[str, Any]) -> Page:
    formulas = result["formulas"]
    corrected = sum(formula["status"] == "corrected" for formula in formulas)
    verified = sum(formula["status"] == "verified" for formula in formulas)
    return Page(
        title="Formulas: derived, and compared with the thesis",
        subtitle="every closed form of the package, from the differential equations to generated Python and LaTeX",
        verdict=_verdict(result),
        holds=not result["diff"] and not result["value_errors"],
        facts=[
            (f"{len(formulas)}", "formulas derived"),
            (f"{verified}", "verified: the thesis's print is right"),
            (f"{corrected}", "corrected: the print is wrong or incomplete"),
            (f"{len(_changed_files(result))}", "generated files that differ"),
        ],
        plates=[],
        tables=[_formula_table(result)],
        notes=[("How it was computed", _NOTES)],
        listings=_listings(result),
    )


_NOTES = (
    "Each formula is derived with sympy and printed as Python (cdpr_struct/generated) and into a LaTeX formula sheet "
    "(derivations/latex/formula_sheet.tex), which shows it. The thesis's print is compared with it; where they "
    "disagree, the note says what is wrong in print and how it shows.",
    "The generated Python is evaluated and held against the derivation at 50 digits.",
)


def _verdict(result: Mapping[str, Any]) -> list[str]:
    names, wrong = _changed_files(result), len(result["value_errors"])
    lines = []
    if names:
        noun = "file differs" if len(names) == 1 else "files differ"
        lines.append(f"{len(names)} {noun} from what the derivations give: {', '.join(names)}.")
    if wrong:
        noun = "number has" if wrong == 1 else "numbers have"
        lines.append(f"{wrong} generated {noun} left the 50-digit value of the derivation.")
    return lines or ["The generated Python and LaTeX are what the derivations give."]


def _changed_files(result: Mapping[str, Any]) -> list[str]:
    """Names of the files in the diff."""
    head = "+++ fresh/"
    return [line.removeprefix(head).strip() for line in result["diff"].splitlines() if line.startswith(head)]


def _formula_table(result: Mapping[str, Any]) -> HtmlTable:
    corrected_first = sorted(result["formulas"], key=lambda formula: formula["status"] != "corrected")
    rows = [[f["id"], f["thesis_equation"], f["status"], f["note"]] for f in corrected_first]
    columns = ["formula", "thesis equation", "status", "note"]
    return HtmlTable("Formulas, corrected ones first", columns, rows, prose=frozenset({1, 2, 3}))


def _listings(result: Mapping[str, Any]) -> list[tuple[str, str]]:
    found = []
    if result["diff"]:
        lines = result["diff"].splitlines()
        hidden = len(lines) - _LINES_SHOWN
        more = [f"... {hidden} more lines in changes.diff"] if hidden > 0 else []
        found.append(("Differences", "\n".join([*lines[:_LINES_SHOWN], *more])))
    if result["value_errors"]:
        found.append(("Numbers that left their 50-digit value", "\n".join(result["value_errors"])))
    return found
