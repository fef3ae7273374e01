"""Scores by room, with a band, and the survivors."""

import json
import math
from collections.abc import Sequence
from pathlib import Path

from benchmarks.mutation.mutants import ROOMS

KILLED = ("killed", "endless", "crashed")
SURVIVED = ("survived", "budget", "uncovered")
JUDGED = Path(__file__).with_name("equivalent.json")


def results(path: Path) -> list[dict]:
    return [json.loads(line) for line in path.read_text().splitlines()]


def equivalent() -> dict[str, str]:
    """Key of each mutant that was read and found to change no answer, and why."""
    return {told["key"]: told["why"] for told in json.loads(JUDGED.read_text())} if JUDGED.exists() else {}


def band(killed: int, count: int, z: float = 1.96) -> tuple[float, float]:
    """Wilson's interval of a share, 95 %."""
    if not count:
        return 0.0, 1.0
    share, scale = killed / count, 1.0 + z**2 / count
    middle = (share + z**2 / (2 * count)) / scale
    half = z * math.sqrt(share * (1 - share) / count + z**2 / (4 * count**2)) / scale
    return middle - half, middle + half


def row(room: str, told: Sequence[dict], same: dict[str, str]) -> str:
    killed = sum(one["status"] in KILLED for one in told)
    left = [one for one in told if one["status"] in SURVIVED]
    equal = sum(one["key"] in same for one in left)
    count = killed + len(left) - equal
    low, high = band(killed, count)
    score = f"{100 * killed / count:.0f} % ({100 * low:.0f} to {100 * high:.0f} %)" if count else "-"
    return f"| {room} | {killed + len(left)} | {killed} | {equal} | {len(left) - equal} | {score} |"


def table(told: Sequence[dict]) -> str:
    same = equivalent()
    head = "| room | mutants | killed | equivalent | survivors | score (95 % band) |\n" + 6 * "| --- " + "|"
    rows = [row(room, [one for one in told if one["room"] == room], same) for room in ROOMS]
    return "\n".join([head, *rows, row("all", told, same)])


def survivors(told: Sequence[dict]) -> str:
    """One line each, those judged equivalent last."""
    same = equivalent()
    left = [one for one in told if one["status"] in SURVIVED]
    return "\n".join(
        f"{one['key']} {one['status']:9} {one['run']}/{one['tests']} {one['file']}:{one['line']} {one['function']}: "
        f"`{one['before']}` -> `{one['after']}` {same.get(one['key'], '')}"
        for one in sorted(left, key=lambda one: (one["key"] in same, one["file"], one["line"]))
    )
