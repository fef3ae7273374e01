"""Every method's answers beside the truth, by the functions that score the diagnosis in the blind tests."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path
from typing import Any

from benchmarks.diagnosis_baselines.answering import METHODS, SURE, answers_of
from tests.blind.answers import Answer, right_answer, said_class
from tests.blind.intervals import share
from tests.blind.scoring import Scored, figures, scored_cases

TOOL, TOOL_WITHOUT_CLASSES = "diagnosis", "diagnosis_without_classes"
PARAMETRIC = ("null", "single", "pair", "ambiguous")  # nothing but parameters of the library is wrong
# (what, key), in the order of the table
FIGURES = (
    ("right name where separable, 2x and above", "right_name_at_2x"),
    ("the same without handling errors", "right_name_of_singles"),
    ("right class, 2x and above", "right_class_at_2x"),
    ("wrong name said alone (tool: with confidence), all cases", "wrong_confident_name"),
    ("the same where only parameters of the library are wrong", "wrong_confident_name_parametric"),
    ("any wrong name said, all cases", "any_wrong_name"),
    ("false alarms", "false_alarms"),
    ("detection at 1x", "detection_1x"),
    ("detection at 2x", "detection_2x"),
    ("detection at 4x", "detection_4x"),
    ("pairs: both", "pair_both"),
    ("pairs: at least one", "pair_at_least_one"),
    ("failed", "failed_runs"),
)
_AS_IN_BLIND_TESTS = (
    "right_name_at_2x", "right_class_at_2x", "wrong_confident_name", "false_alarms", "pair_both", "pair_at_least_one",
    "failed_runs",
)  # fmt: skip


def all_scored(
    campaigns: Path, sealed: Path, out: Path, names: list[str], tool: Path | None
) -> dict[str, list[Scored]]:
    """Scored cases of each method, and of the diagnosis if the directory of its answers is given: the same for all."""
    places = {method: answers_of(out, method) for method in METHODS}
    if tool is not None:
        places[TOOL] = tool
    found = {method: scored_cases(campaigns, place, sealed) for method, place in places.items()}
    common = set(names).intersection(*({case.name for case in cases} for cases in found.values()))
    kept = {method: [case for case in cases if case.name in common] for method, cases in found.items()}
    if tool is not None:
        bold = [replace(case, answer=without_classes(case.answer)) for case in kept[TOOL]]
        kept = {**{m: kept[m] for m in METHODS}, TOOL_WITHOUT_CLASSES: bold, TOOL: kept[TOOL]}
    return kept


def without_classes(answer: Answer) -> Answer:
    """The answer with the best cause of each class named alone."""
    if answer.status != "class":
        return answer
    return replace(answer, status="named", groups=(), probability=SURE)


def method_figures(cases: list[Scored]) -> dict[str, dict[str, Any]]:
    """Shares with bands of one method, by the keys of `FIGURES`."""
    whole = figures(cases)
    singles = figures([case for case in cases if case.kind == "single"])
    parametric = figures([case for case in cases if case.kind in PARAMETRIC])
    table = {key: whole[key] for key in _AS_IN_BLIND_TESTS}
    table |= {f"detection_{size}": whole["detection"][size] for size in ("1x", "2x", "4x")}
    table["right_name_of_singles"] = singles["right_name_at_2x"]
    table["wrong_confident_name_parametric"] = parametric["wrong_confident_name"]
    table["any_wrong_name"] = share([_wrong_name(case) for case in cases])
    return table


def _wrong_name(case: Scored) -> bool:
    return case.answer.status == "named" and not set(case.answer.causes) <= set(case.hidden)


def write_tables(found: dict[str, list[Scored]], out: Path) -> dict[str, dict[str, Any]]:
    """figures.csv (method, figure) and cases.csv (method, case); returns the figures of each method."""
    table = {method: method_figures(cases) for method, cases in found.items()}
    rows = []
    for method, entries in table.items():
        for _, key in FIGURES:
            entry = entries[key]
            low, high = entry["band"] or ("", "")
            value = "" if entry["value"] is None else entry["value"]
            rows.append([method, key, value, entry["successes"], entry["cases"], low, high])
    head = ["method", "figure", "value", "successes", "cases", "band_low", "band_high"]
    _write(out / "figures.csv", head, rows)
    lines = [_line(method, case) for method, cases in found.items() for case in cases]
    _write(out / "cases.csv", ["method", "case", "kind", "hidden", "multiple", "status", "said", "right"], lines)
    return table


def _line(method: str, case: Scored) -> list[Any]:
    hidden = " + ".join(str(effect["cause"]) for effect in case.truth["effects"])
    said = "; ".join(" or ".join(sorted(names)) for names in said_class(case.answer))
    right = int(right_answer(case.answer, case.truth))
    return [method, case.name, case.kind, hidden, f"{case.multiple:.3g}", case.answer.status, said, right]


def _write(path: Path, head: list[str], rows: list[list[Any]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows(rows)
