"""What was said about spoilt campaigns: right, and wrong with confidence, for every way of spoiling or every size."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np

from tests.blind.answers import LARGEST_AMBIGUOUS_CLASS, right_class, wrong_confident_class, wrong_confident_name
from tests.blind.intervals import share
from tests.blind.scoring import Scored

WHOLE = "whole set"
EXCHANGED = ("exchanged", "all")  # ways in which two poses have each other's list of peaks
BARE, PULLEYS = "bare", "missing_pulleys"  # way of the set `wheels` that hides them, and their name


def spoilt_right(case: Scored) -> bool:
    """A null is adequate; what was hidden is named, or in a class of at most four names."""
    case = _beside(case)
    if case.kind == "null":
        return case.answer.status == "adequate"
    if case.truth["way"] == BARE:
        return any(PULLEYS in names and len(names) <= LARGEST_AMBIGUOUS_CLASS for names in case.answer.groups)
    return right_class(case.answer, case.hidden, LARGEST_AMBIGUOUS_CLASS)


def _beside(case: Scored) -> Scored:
    """The case without what may be said beside what is hidden; where nothing else was said, all is well."""
    allowed = set(_true_beside(case)) - set(case.hidden)
    groups = tuple(names for names in case.answer.groups if not set(names) <= allowed)
    if groups == case.answer.groups:
        return case
    causes = tuple(name for name in case.answer.causes if name not in allowed)
    status = case.answer.status if groups else "adequate"
    return replace(case, answer=replace(case.answer, status=status, causes=causes, groups=groups))


def _no_mistake(case: Scored) -> tuple[str, ...]:
    """Names that are no mistake. A controller that knows pulleys which the simulation lacks commands other forces."""
    return (*case.hidden, *(("internal_force",) if case.truth["way"] == BARE else _true_beside(case)))


def _true_beside(case: Scored) -> tuple[str, ...]:
    """Names that are true of the readings beside what is hidden in the robot; exchanged lists are what they are."""
    exchanged = ("pose_mismatch",) if case.truth["way"] in EXCHANGED else ()
    return (*case.truth.get("may_be_said", ()), *exchanged)


def condition(case: Scored) -> str:
    """The row of the table in which a case counts: its way and, where sizes are the question, its multiple.

    Where every cause has its row, what it hides.
    """
    if case.truth.get("by_cause"):
        return " + ".join(case.hidden)
    way, asked = str(case.truth["way"]), float(case.truth["asked"])
    return f"{way}, {asked:g}x" if case.truth["by_size"] else way


def spoilt_figures(cases: list[Scored]) -> dict[str, Any]:
    """Figures of every condition and of the whole set."""
    rows: dict[str, list[Scored]] = {}
    for case in cases:
        rows.setdefault(condition(case), []).append(case)
    ordered = {name: rows[name] for name in sorted(rows, key=_order)}
    return {name: _figures(own) for name, own in ordered.items()} | {WHOLE: _figures(cases)}


def _order(name: str) -> tuple[bool, str, float]:
    way, _, size = name.partition(", ")
    return way != "clean", way, float(size.removesuffix("x") or 0.0)


def _figures(cases: list[Scored]) -> dict[str, Any]:
    nulls, singles = ([case for case in cases if case.kind == kind] for kind in ("null", "single"))
    return {
        "right": share([spoilt_right(case) for case in cases]),
        "nulls_right": share([spoilt_right(case) for case in nulls]),
        "singles_right": share([spoilt_right(case) for case in singles]),
        "wrong_confident_name": share([wrong_confident_name(case.answer, _no_mistake(case)) for case in cases]),
        "wrong_confident_class": share([wrong_confident_class(case.answer, _no_mistake(case)) for case in cases]),
        "pulleys_said": share([any(PULLEYS in names for names in case.answer.groups) for case in cases]),
        "statuses": dict(sorted(Counter(case.answer.status for case in cases).items())),
        "seconds_median": float(np.median([case.answer.seconds for case in cases])) if cases else None,
        "seconds_largest": float(max(case.answer.seconds for case in cases)) if cases else None,
    }


COUNTED = ("right", "nulls_right", "singles_right", "wrong_confident_name", "wrong_confident_class", "pulleys_said")


def spoilt_page(scores: dict[str, Any]) -> str:
    """The figures as a table (Markdown), and every case that is not right."""
    run, figures = scores["run"], scores["figures"]
    lines = [f"# Spoilt campaigns, set `{run['set']}`", "", f"Budget `{run['budget']}`, {run['date']}.", ""]
    lines += [
        "| condition | right | nulls | singles | wrong name, P > .9 | wrong class, P > .9 | pulleys said | failed | s |"
    ]
    lines += ["|---" * 9 + "|"]
    for name, row in figures.items():
        counts = " | ".join(f"{row[key]['successes']} of {row[key]['cases']}" for key in COUNTED)
        lines.append(f"| {name} | {counts} | {row['statuses'].get('failed', 0)} | {row['seconds_median']:.1f} |")
    lines += ["", "| case | robot | condition | hidden | size | said | probability |", "|---" * 7 + "|"]
    for row in scores["rows"]:
        if not row["right"]:
            said = "; ".join(" or ".join(names) for names in row["said"])
            chance = "" if row["probability"] is None else f"{row['probability']:.2f}"
            size = "" if row["multiple"] is None else f"{row['multiple']:.3g}"
            cells = (row["case"], row["robot"], row["condition"], " + ".join(row["hidden"]) or "nothing")
            lines.append("| " + " | ".join((*cells, size, f"{row['status']} {said}", chance)) + " |")
    return "\n".join(lines) + "\n"


def spoilt_rows(cases: list[Scored], rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of `scoring.case_rows` with the condition, and what counts as right here."""
    pairs = zip(cases, rows, strict=True)
    return [row | {"condition": condition(case), "right": spoilt_right(case)} for case, row in pairs]
