"""Script C: open the truth, compare, and compute every figure of the acceptance table."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tests.blind.answers import (
    ANY_SIZE,
    LARGEST_AMBIGUOUS_CLASS,
    Answer,
    kind_in_truth,
    names_in_truth,
    read_answer,
    right_answer,
    right_class,
    right_name,
    said_class,
    smallest_multiple,
    wrong_confident_class,
    wrong_confident_name,
)
from tests.blind.campaign_files import opened_truth
from tests.blind.detectability import typical_size
from tests.blind.entered_robot import entered_robot
from tests.blind.intervals import compared, expected_calibration_error, log_score, relative_error, share
from tests.blind.running import RECORD

CLEARLY = 2.0  # multiple of the smallest detectable size from which a name is owed
SEPARABLE = 3.0  # sigmas that the nearest other cause leaves; half its square are nats of evidence
BINS = ((0.5, 0.25, 0.75), (1.0, 0.75, 1.5), (2.0, 1.5, 3.0), (4.0, 3.0, math.inf))  # (label, from, below)
PLAIN_UNITS = {"m", "N"}  # a number in one of them is none in the other
IN_LIBRARY = ("single", "pair", "ambiguous", "handling", "law")


@dataclass(frozen=True, eq=False)
class Scored:
    """A case with its truth and the answer to it."""

    name: str
    truth: dict[str, Any]
    answer: Answer

    @property
    def kind(self) -> str:
        """Kind of the case."""
        return kind_in_truth(self.truth)

    @property
    def hidden(self) -> tuple[str, ...]:
        """Names hidden."""
        return names_in_truth(self.truth)

    @property
    def multiple(self) -> float:
        """Multiple of the referee's smallest detectable size; see `smallest_multiple`."""
        return smallest_multiple(self.truth)

    @property
    def own_multiple(self) -> float | None:
        """Multiple of what the tool itself says is its smallest detectable size of a single effect, if it does."""
        if self.kind != "single":
            return None
        effect, robot = self.truth["effects"][0], str(self.truth["robot"])
        cause, unit = str(effect["cause"]), str(effect.get("unit", ""))
        mass = entered_robot(robot).mass
        limit = smallest_by_tool(self.answer.result.get("minimum_detectable"), cause, mass, unit)
        ours = typical_size(robot, cause)
        return None if limit is None or ours is None else self.multiple * ours / limit


def smallest_by_tool(table: Any, cause: str, robot_mass: float = 1.0, hidden_in: str = "") -> float | None:
    """The tool's minimum_detectable of a cause, a number or a table with `value`, if its unit compares with ours."""
    entry = table.get(cause) if isinstance(table, dict) else None
    unit = ""
    if isinstance(entry, dict):
        entry, unit = entry.get("value"), str(entry.get("unit", ""))
    if not isinstance(entry, int | float) or not 0.0 < entry < math.inf:
        return None
    if {unit, hidden_in} <= PLAIN_UNITS and unit != hidden_in:
        return None
    return float(entry) * (robot_mass if cause == "platform_mass" and unit == "relative" else 1.0)


def scored_cases(campaigns: Path, answers: Path, sealed: Path) -> list[Scored]:
    """All cases that have been diagnosed."""
    names = sorted(path.parent.name for path in answers.glob(f"*/{RECORD}"))
    return [Scored(n, opened_truth(n, campaigns, sealed), read_answer(answers / n)) for n in names]


def figures(cases: list[Scored], served: Sequence[Scored] = (), rates: Sequence[Scored] = ()) -> dict[str, Any]:
    """Every figure of the acceptance table, with its band and number of cases.

    served : ambiguous cases diagnosed again with the measurements that separate them
    rates  : more nulls, just detectable effects and pairs, counted where these are asked for and nowhere else
    """
    nulls = [c for c in (*cases, *rates) if c.kind == "null"]
    singles = [c for c in cases if c.kind == "single"]
    sized = [c for c in (*cases, *rates) if c.kind == "single"]
    pairs = [c for c in (*cases, *rates) if c.kind == "pair"]
    clear = [c for c in cases if c.kind in ("single", "handling") and c.multiple >= 0.95 * CLEARLY]
    inside = [c for c in cases if c.kind in IN_LIBRARY]
    return {
        "false_alarms": share([c.answer.significant for c in nulls]),
        "detection": _by_size(sized, lambda c: c.multiple, lambda c: c.answer.significant),
        "of_which_in_the_set": {
            "false_alarms": share([c.answer.significant for c in cases if c.kind == "null"]),
            "detection": _by_size(singles, lambda c: c.multiple, lambda c: c.answer.significant),
            **_pair_figures([c for c in cases if c.kind == "pair"]),
        },
        "wrong_confident_among_rates": share([_wrong_with_confidence(c) for c in rates]),
        "right_class_at_2x": share([right_class(c.answer, c.hidden) for c in clear]),
        "right_name_at_2x": share([right_name(c.answer, c.hidden) for c in clear if _separable(c)]),
        "right_class_by_size": _by_size(singles, lambda c: c.multiple, lambda c: right_class(c.answer, c.hidden)),
        **_confidence_figures(cases),
        **_pair_figures(pairs),
        "ambiguous_class_reported": share([_class_reported(c) for c in cases if c.kind == "ambiguous"]),
        "resolved_by_more_measurements": share([_resolved(c) for c in served]),
        **_interval_figures([c for c in cases if c.kind in ("single", "pair")]),
        **_gain_figures([c for c in inside if right_answer(c.answer, c.truth)]),
        **_probability_figures(cases),
        **_time_figures(cases),
        "failed_runs": share([c.answer.status == "failed" for c in (*cases, *rates)]),
        "detection_by_own_multiple": _by_own(singles),
        "by_cause": _by_cause(cases),
        "cases": len(cases),
    }


def _wrong_with_confidence(case: Scored) -> bool:
    return wrong_confident_name(case.answer, case.hidden) or wrong_confident_class(case.answer, case.hidden)


def _confidence_figures(cases: list[Scored]) -> dict[str, Any]:
    """Wrong with confidence; unknown where it should and where it should not be said."""
    inside, outside = ([c for c in cases if c.kind in kinds] for kinds in (IN_LIBRARY, ("outside",)))
    return {
        "wrong_confident_name": share([wrong_confident_name(c.answer, c.hidden) for c in cases]),
        "wrong_confident_class": share([wrong_confident_class(c.answer, c.hidden) for c in cases]),
        "unknown_caught": share([c.answer.status == "unknown" for c in outside]),
        "unknown_inside_library": share([c.answer.status == "unknown" for c in inside]),
    }


def _resolved(case: Scored) -> bool:
    """The name alone; or nothing left, once what was hidden has been measured itself and entered."""
    measured = {"platform_mass"} if "weighed_kg" in case.truth else set(case.truth.get("measured", ()))
    entered = set(case.hidden) <= measured and case.answer.status == "adequate"
    return right_name(case.answer, case.hidden) or entered


def _separable(case: Scored) -> bool:
    """Whether no other single cause could explain the data nearly as well."""
    return all(effect.get("sigmas_left", math.inf) >= SEPARABLE for effect in case.truth["effects"])


def _by_size(
    cases: list[Scored], size: Callable[[Scored], float | None], flag: Callable[[Scored], bool]
) -> dict[str, Any]:
    """Shares in bins of the multiple of the smallest detectable size."""
    found = {}
    for label, low, high in BINS:
        within = [c for c in cases if (value := size(c)) is not None and low <= value < high]
        found[f"{label:g}x"] = share([flag(c) for c in within])
    return found


def _by_own(singles: list[Scored]) -> dict[str, Any] | None:
    """Detection against the tool's own smallest detectable size; None if it states none."""
    if all(case.own_multiple is None for case in singles):
        return None
    return _by_size(singles, lambda c: c.own_multiple, lambda c: c.answer.significant)


def _pair_figures(pairs: list[Scored]) -> dict[str, Any]:
    """A pair is right if all, or at least one, of its names is in what is claimed."""
    named = [[any(name in names for names in said_class(c.answer)) for name in c.hidden] for c in pairs]
    return {
        "pair_both": share([right_class(c.answer, c.hidden) for c in pairs]),
        "pair_at_least_one": share([any(flags) for flags in named]),
    }


def _class_reported(case: Scored) -> bool:
    return case.answer.status == "class" and right_class(case.answer, case.hidden, LARGEST_AMBIGUOUS_CLASS)


def _interval_figures(cases: list[Scored]) -> dict[str, Any]:
    """Coverage of 95 per cent intervals where the name is right; median relative error at 2x and above."""
    covered, errors = [], []
    for case in cases:
        if not right_name(case.answer, case.hidden):
            continue
        for effect in case.truth["effects"]:
            robot = entered_robot(str(case.truth["robot"]))
            numbers = compared(effect, _parameters(case.answer, effect["cause"]), robot.mass, robot.masts)
            covered += [number.covered for number in numbers]
            if numbers and effect["multiple"] >= 0.95 * CLEARLY:
                errors.append(relative_error(numbers))
    return {
        "interval_coverage": share(covered),
        "median_relative_error": float(np.median(errors)) if errors else None,
    }


def _parameters(answer: Answer, cause: str) -> dict[str, dict[str, Any]]:
    """Stated parameters of a cause in the first candidate that has it, alone or together with others."""
    for candidate in answer.result.get("candidates", []):
        if cause in str(candidate.get("cause", "")).replace("+", " ").split():
            return dict(candidate.get("parameters", {}))
    return {}


def _gain_figures(cases: list[Scored]) -> dict[str, Any]:
    """Held-out error before over after, where the answer is right and an effect was there to be found."""
    ratios = [c.answer.result.get("gain", {}).get("ratio") for c in cases if c.multiple >= 0.95 * CLEARLY]
    known = [float(ratio) for ratio in ratios if isinstance(ratio, int | float)]
    median = float(np.median(known)) if known else None
    return {"heldout_ratio_median": median, "heldout_better": share([r > 1.0 for r in known])}


def _probability_figures(cases: list[Scored]) -> dict[str, Any]:
    """Of answers that name something: that nothing was found is no claim about small effects.

    A stated probability is that the class holds what was hidden, however large the class is.
    """
    stated = [c for c in cases if said_class(c.answer) and not math.isnan(c.answer.probability)]
    chances = np.array([c.answer.probability for c in stated])
    right = np.array([right_class(c.answer, c.hidden, ANY_SIZE) for c in stated], dtype=float)
    return {
        "calibration_error": expected_calibration_error(chances, right),
        "log_score": log_score(chances, right.astype(bool)),
    }


def _time_figures(cases: list[Scored]) -> dict[str, Any]:
    seconds = [c.answer.seconds for c in cases]
    if not seconds:
        return {"seconds_median": None, "seconds_largest": None}
    return {"seconds_median": float(np.median(seconds)), "seconds_largest": float(max(seconds))}


def _by_cause(cases: list[Scored]) -> dict[str, Any]:
    """For every hidden name: cases, found, right class, right name."""
    table: dict[str, Any] = {}
    for case in cases:
        for effect in case.truth["effects"]:
            row = table.setdefault(effect["cause"], {"cases": 0, "found": 0, "right": 0})
            row["cases"] += 1
            row["found"] += int(case.answer.significant)
            row["right"] += int(right_answer(case.answer, case.truth))
    return dict(sorted(table.items()))


def case_rows(cases: list[Scored]) -> list[dict[str, Any]]:
    """One row a case: what was hidden, what was said."""
    return [
        {
            "case": c.name,
            "robot": c.truth["robot"],
            "kind": c.kind,
            "hidden": [effect["cause"] for effect in c.truth["effects"]],
            "multiple": None if math.isinf(c.multiple) else round(c.multiple, 3),
            "own_multiple": c.own_multiple,
            "status": c.answer.status,
            "said": [sorted(names) for names in said_class(c.answer)],
            "probability": None if math.isnan(c.answer.probability) else c.answer.probability,
            "right": right_answer(c.answer, c.truth),
            "seconds": c.answer.seconds,
        }
        for c in cases
    ]
