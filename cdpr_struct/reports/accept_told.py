"""Verdicts on requirements: keys of result.json, table, CSV, page."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from cdpr_struct.measurement.campaign_rows import POSE
from cdpr_struct.reports.bands_told import band_note
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.text import paragraphs, plain_table

_NAMES = ["requirement", "verdict", "probability that it holds", "decided at", "predicted", "band"]
_WORDS = {"pass": "PASS", "fail": "FAIL", "undecided": "cannot be said"}


@dataclass(frozen=True, slots=True)
class Kept:
    """What a requirement finds at a pose [m, deg].

    value : predicted;  ends : of its band;  chance : that the requirement holds; all nan where the pose is not held
    """

    pose: list[float]
    value: float
    ends: tuple[float, float]
    chance: float

    @classmethod
    def nowhere(cls, pose: list[float]) -> "Kept":
        """Where there is no such state, the requirement does not hold."""
        return cls(pose, np.nan, (np.nan, np.nan), 0.0)


class Requirement(Protocol):
    """A limit and the probability asked for."""

    @property
    def name(self) -> str: ...
    @property
    def quantity(self) -> str: ...
    @property
    def probability(self) -> float: ...
    @property
    def limit(self) -> float: ...
    @property
    def words(self) -> str: ...


def verdict_row(one: Requirement, found: Sequence[Kept]) -> dict[str, Any]:
    """Pass if the limit holds as probably as asked at every pose, fail if it is as probably broken at one."""
    worst = min(found, key=lambda at: at.chance)
    verdict = "undecided"
    if worst.chance >= one.probability:
        verdict = "pass"
    elif 1.0 - worst.chance >= one.probability:
        verdict = "fail"
    return {
        "name": one.name,
        "quantity": one.quantity,
        "words": one.words,
        "limit": one.limit,
        "required_probability": one.probability,
        "probability": worst.chance,
        "verdict": verdict,
        "worst": {"pose": worst.pose, "value": worst.value, "band": list(worst.ends)},
        "at_poses": [{"value": at.value, "band": list(at.ends), "probability": at.chance} for at in found],
    }


def accept_sentences(result: Mapping[str, Any]) -> list[str]:
    """How many pass, fail, or cannot be said."""
    rows, poses = result["requirements"], len(result["poses"])
    count = {key: [row["name"] for row in rows if row["verdict"] == key] for key in _WORDS}
    where = "at the one pose" if poses == 1 else f"at all {poses} poses"
    said = [f"{len(count['pass'])} of {len(rows)} requirements pass {where}."]
    if count["fail"]:
        said.append(f"FAIL: {', '.join(count['fail'])}.")
    if count["undecided"]:
        said.append(f"Within the tolerances it cannot be said of: {', '.join(count['undecided'])}.")
    return said


def _rows(result: Mapping[str, Any]) -> list[list[str]]:
    rows = []
    for row in result["requirements"]:
        worst = row["worst"]
        place = ", ".join(f"{value:.4g}" for value in worst["pose"][:3])
        held = np.isfinite(worst["value"])
        rows.append(
            [
                f"{row['name']}: {row['words']}", _WORDS[row["verdict"]], f"{row['probability']:.3g}", f"({place}) m",
                f"{worst['value']:.4g}" if held else "not there",
                f"{worst['band'][0]:.4g} .. {worst['band'][1]:.4g}" if held else "",
            ]
        )  # fmt: skip
    return rows


def accept_text(result: Mapping[str, Any]) -> str:
    """Every requirement with its verdict and the pose that decides."""
    not_held = [f"Not held: {tuple(row['pose'][:3])}: {row['why']}" for row in result["not_held"][:3]]
    table = plain_table(f"{result['robot']}: requirements", _NAMES, _rows(result))
    return paragraphs(table, " ".join(accept_sentences(result)), *not_held, band_note(result))


def accept_columns(result: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of requirements.csv, one row a requirement and pose."""
    rows = [
        {
            "requirement": row["name"],
            **dict(zip(POSE, pose, strict=True)),
            "value": at["value"],
            "band_low": at["band"][0],
            "band_high": at["band"][1],
            "probability": at["probability"],
        }
        for row in result["requirements"]
        for pose, at in zip(result["poses"], row["at_poses"], strict=True)
    ]
    return {name: [row[name] for row in rows] for name in rows[0]}


def accept_files(result: Mapping[str, Any]) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name."""
    from cdpr_struct.reports.figures import limits_kept
    from cdpr_struct.reports.figures.drawing import Drawing

    rows = result["requirements"]
    drawn = Drawing("requirements", limits_kept.size(result), lambda f: limits_kept.draw_limits(f, result))
    page = Page(
        robot=result["robot"],
        title=f"{result['robot']}: requirements",
        subtitle=f"{len(rows)} requirements at {len(result['poses'])} poses, cable model {result['model']}",
        verdict=accept_sentences(result),
        holds=all(row["verdict"] != "fail" for row in rows),
        facts=[(str(sum(row["verdict"] == key for row in rows)), words) for key, words in _WORDS.items()],
        plates=[Plate("requirements", "Limits and bands", drawn, limits_kept.CAPTION)],
        tables=[HtmlTable("Requirements", _NAMES, _rows(result), band_note(result), prose=frozenset({0, 1, 3}))],
        notes=[("How it was judged", (_HOW,))],
    )
    return {"requirements.csv": csv_text(accept_columns(result)), **page_files(page)}


_HOW = (
    "A requirement passes if at every pose it holds with the probability asked for, and fails if at one pose it is "
    "broken with that probability; between the two the tolerances leave it open: measure what has the largest share of "
    "the variance (sensitivity), or ask for less. A pose that the cables do not hold keeps no requirement. Limits on "
    "every cable count all cables of a robot together."
)
