"""What the tool said about a case, and whether that is right."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.blind.catalogue import CAME_IN, CAUSES, LAWS
from tests.blind.running import RECORD, RESULT

CONFIDENT = 0.9
LARGEST_CLASS = 3
LARGEST_AMBIGUOUS_CLASS = 4
ANY_SIZE = 1000


@dataclass(frozen=True)
class Answer:
    """A verdict: status adequate, named, class, unknown, or failed (no usable result)."""

    status: str
    causes: tuple[str, ...]
    groups: tuple[tuple[str, ...], ...]
    probability: float
    seconds: float
    result: dict[str, Any]

    @property
    def significant(self) -> bool:
        """Whether the tool says that something is wrong."""
        return self.status in ("named", "class", "unknown")


def read_answer(folder: Path) -> Answer:
    """The answer stored for a case."""
    record = json.loads((folder / RECORD).read_text("utf-8"))
    path = folder / RESULT
    if not path.exists():
        return Answer("failed", (), (), math.nan, record["seconds"], {})
    result = json.loads(path.read_text("utf-8"))
    verdict = result.get("verdict", {})
    causes = tuple(verdict.get("causes") or ())
    groups = tuple(tuple(g) if isinstance(g, list) else (g,) for g in verdict.get("class") or ())
    probability = verdict.get("probability")
    chance = math.nan if probability is None else float(probability)
    return Answer(str(verdict.get("status", "failed")), causes, groups, chance, record["seconds"], result)


def asking_for_more(answers: Path) -> set[str]:
    """Cases whose verdict is a class and names a next measurement."""
    folders = [path.parent for path in answers.glob(f"*/{RECORD}")]
    said = {folder.name: read_answer(folder) for folder in folders}
    return {n for n, a in said.items() if a.status == "class" and a.result["verdict"].get("next_measurement")}


def kind_in_truth(truth: dict[str, Any]) -> str:
    """Kind of a case; one outside the library when it was drawn may be of a law that has come into it."""
    hidden = [effect["cause"] for effect in truth["effects"]]
    return "law" if truth["kind"] == "outside" and set(hidden) <= {*LAWS, *CAME_IN} else str(truth["kind"])


def names_in_truth(truth: dict[str, Any]) -> tuple[str, ...]:
    """Names that were hidden; none for a null, none for an effect outside the library."""
    if kind_in_truth(truth) in ("null", "outside"):
        return ()
    names = (effect["cause"] for effect in truth["effects"])
    return tuple(CAUSES.get(name, name) for name in names)


def smallest_multiple(truth: dict[str, Any]) -> float:
    """Multiple of the smallest detectable size of the least visible hidden effect; mistakes of notes are infinite."""
    multiples = [effect["multiple"] for effect in truth["effects"]]
    return min((math.inf if m is None else float(m) for m in multiples), default=0.0)


def said_class(answer: Answer) -> tuple[frozenset[str], ...]:
    """One set of possible names for every effect that the tool claims."""
    if answer.status == "named":
        return tuple(frozenset([name]) for name in answer.causes)
    if answer.status == "class":
        return tuple(frozenset(group) for group in answer.groups)
    return ()


def right_class(answer: Answer, hidden: tuple[str, ...], largest: int = LARGEST_CLASS) -> bool:
    """Every claimed set is small and holds its own hidden name, and none is left over or missing."""
    claimed = said_class(answer)
    if len(claimed) != len(hidden) or any(len(names) > largest for names in claimed):
        return False
    return _matched(list(claimed), list(hidden))


def _matched(claimed: list[frozenset[str]], hidden: list[str]) -> bool:
    if not hidden:
        return True
    return any(
        hidden[0] in names and _matched(claimed[:index] + claimed[index + 1 :], hidden[1:])
        for index, names in enumerate(claimed)
    )


def right_name(answer: Answer, hidden: tuple[str, ...]) -> bool:
    """Exactly the hidden names."""
    return answer.status == "named" and sorted(answer.causes) == sorted(hidden) and bool(hidden)


def wrong_confident_name(answer: Answer, hidden: tuple[str, ...]) -> bool:
    """A name that was not hidden, said with more than 90 per cent."""
    return answer.status == "named" and answer.probability > CONFIDENT and not set(answer.causes) <= set(hidden)


def wrong_confident_class(answer: Answer, hidden: tuple[str, ...]) -> bool:
    """A class with no hidden name in it, said with more than 90 per cent."""
    hollow = any(not names & set(hidden) for names in said_class(answer))
    return answer.status == "class" and answer.probability > CONFIDENT and hollow


def right_answer(answer: Answer, truth: dict[str, Any]) -> bool:
    """Whether the verdict as a whole is right: what a probability of it is compared with."""
    hidden = names_in_truth(truth)
    if truth["kind"] == "null":
        return answer.status == "adequate"
    if kind_in_truth(truth) == "outside":
        return answer.status == "unknown"
    if truth["kind"] == "ambiguous":
        return right_class(answer, hidden, LARGEST_AMBIGUOUS_CLASS)
    return right_class(answer, hidden)
