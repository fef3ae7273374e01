"""What was said about campaigns along a motion: named, with which size, and what about conventions."""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.blind.answers import LARGEST_AMBIGUOUS_CLASS, right_class
from tests.blind.catalogue import CONVENTION
from tests.blind.intervals import share
from tests.blind.moving_sets import DELAY, DRIFT
from tests.blind.scoring import Scored

ALONE, PAIRS, WHOLE = "alone", "beside another", "whole set"
CONFIDENT = 0.9
WITHIN = 1.96  # sigmas of a 95 % interval


def moving_right(case: Scored) -> bool:
    """A null is adequate; what was hidden is named, and nothing else, but what may be said as well."""
    if case.kind == "null":
        return bool(case.answer.status == "adequate")
    said, allowed = set(case.answer.causes), set(case.hidden)
    more = {name for effect in case.truth["effects"] for name in effect.get("may_be_said", ())}
    return case.answer.status == "named" and allowed <= said <= allowed | more


def held(case: Scored) -> bool:
    """Right, or every class that is said holds a name of its own that was hidden, among at most four.

    Of one cable, a wrong length, anchor and drum differ by as little as noise allows along a curve; so do EA and a
    compliance in line. A class of these is no mistake; that of a delay and a drift is, where one of them is clear.
    """
    return moving_right(case) or right_class(case.answer, case.hidden, LARGEST_AMBIGUOUS_CLASS)


def delay_named(case: Scored) -> bool:
    """Whether the delay or the drift is named, whatever else is."""
    return case.answer.status == "named" and bool({DELAY, DRIFT} & set(case.hidden) & set(case.answer.causes))


def covered(case: Scored) -> bool | None:
    """Whether the 95 % interval of a single number holds it; None where none is stated, or another is asked for."""
    effect = next((effect for effect in case.truth["effects"] if effect["cause"] in (DELAY, DRIFT)), None)
    if effect is None or not delay_named(case) or effect["shape"] in ("each", "one"):
        return None
    names = ("delay", "delay_of_lengths", "delay_of_tensions", "drift")
    stated = {**_stated(case)}
    rows = [stated[name] for name in names if name in stated and (name == "drift") == (effect["cause"] == DRIFT)]
    if len(rows) != 1:
        return None
    return abs(rows[0]["value"] - effect["total"][0]) <= WITHIN * rows[0]["sigma"]


def _stated(case: Scored) -> dict[str, Any]:
    """Parameters of the candidate that has the names of the verdict."""
    found: dict[str, Any] = {}
    for row in case.answer.result.get("candidates", ()):
        if set(str(row["cause"]).replace(" ", "").split("+")) <= set(case.answer.causes):
            found = row["parameters"] | found
    return found


def moving_figures(cases: list[Scored]) -> dict[str, Any]:
    """Figures by way, of all alone, of all pairs, and of the whole set."""
    rows: dict[str, list[Scored]] = {}
    for case in cases:
        rows.setdefault(str(case.truth["way"]), []).append(case)
    rows = {name: rows[name] for name in sorted(rows)}
    rows[ALONE] = [case for case in cases if case.kind == "single"]
    rows[PAIRS] = [case for case in cases if case.kind == "pair"]
    return {name: _figures(own) for name, own in (rows | {WHOLE: cases}).items()}


def _figures(cases: list[Scored]) -> dict[str, Any]:
    inside = [covered(case) for case in cases]
    wrong = [
        case.answer.status == "named"
        and case.answer.probability > CONFIDENT
        and not moving_right(case)
        and not set(case.answer.causes) <= set(case.hidden)
        for case in cases
    ]
    return {
        "right": share([moving_right(case) for case in cases]),
        "right_class": share([held(case) for case in cases]),
        "delay_named": share([delay_named(case) for case in cases if case.kind != "null"]),
        "covered": share([one for one in inside if one is not None]),
        "wrong_confident_name": share(wrong),
        "convention_said": share([CONVENTION in _all_said(case) for case in cases]),
        "seconds_median": float(np.median([case.answer.seconds for case in cases])) if cases else None,
    }


def _all_said(case: Scored) -> set[str]:
    return {*case.answer.causes, *(name for group in case.answer.groups for name in group)}


COUNTED = ("right", "right_class", "delay_named", "covered", "wrong_confident_name", "convention_said")


def moving_rows(cases: list[Scored]) -> list[dict[str, Any]]:
    """Every case: what was hidden, of which size, and what was said."""
    return [
        {
            "case": case.name,
            "robot": case.truth["robot"],
            "way": case.truth["way"],
            "tensions": case.truth["tensions"],
            "sizes": [float(effect["size"]) for effect in case.truth["effects"]],
            "status": case.answer.status,
            "said": list(case.answer.causes) or [list(group) for group in case.answer.groups],
            "probability": None if np.isnan(case.answer.probability) else case.answer.probability,
            "right": moving_right(case),
        }
        for case in cases
    ]


def moving_page(scores: dict[str, Any]) -> str:
    """The figures as a table (Markdown), and every case that is not right."""
    run, figures = scores["run"], scores["figures"]
    lines = [f"# Campaigns along a motion, set `{run['set']}`", "", f"Budget `{run['budget']}`, {run['date']}.", ""]
    lines += [
        "| hidden | right | or in a class of 4 | delay or drift named | 95 % interval holds | wrong name, P > .9 |"
    ]
    lines[-1] += " a convention said | median s |"
    lines += ["|---" * 8 + "|"]
    for name, row in figures.items():
        counts = " | ".join(f"{row[key]['successes']} of {row[key]['cases']}" for key in COUNTED)
        lines.append(f"| {name} | {counts} | {row['seconds_median'] or 0.0:.1f} |")
    lines += ["", "| case | robot | hidden | sizes | said | probability |", "|---" * 6 + "|"]
    for row in scores["rows"]:
        if not row["right"]:
            said = "; ".join(one if isinstance(one, str) else " or ".join(one) for one in row["said"])
            chance = "" if row["probability"] is None else f"{row['probability']:.2f}"
            sizes = ", ".join(f"{size:.3g}" for size in row["sizes"])
            lines.append(
                f"| {row['case']} | {row['robot']} | {row['way']} | {sizes} | {row['status']} {said} | {chance} |"
            )
    return "\n".join(lines) + "\n"
