"""What came of all seeds, as tables in Markdown."""

import re
from collections import Counter
from collections.abc import Sequence
from typing import Any

from benchmarks.markdown_page import table
from benchmarks.random_robots.drawing import KINDS
from benchmarks.random_robots.trying import worst_balance

_EXAMPLES = 4  # seeds named for every kind of violation


def summary(found: Sequence[dict[str, Any]]) -> str:
    """Counts by kind of robot, worst balance, and violations by kind."""
    rows = [_row(kind, [told for told in found if told["kind"] == kind]) for kind in KINDS]
    head = ["robots", "seeds", "held", "refused", "refusals proven", "other poses told", "frequencies", "refused as "
            "unstable or slack", "worst balance", "violations"]  # fmt: skip
    return f"{table(head, [*rows, _row('all', found)])}\n\n{violations(found)}"


def violations(found: Sequence[dict[str, Any]]) -> str:
    """By kind, with seeds to look at."""
    seeds: dict[str, list[int]] = {}
    count: Counter[str] = Counter()
    for told in found:
        for said in told["violations"]:
            name = re.sub(r"[-+]?\d[\d.e+-]*", "#", said)
            count[name] += 1
            seeds.setdefault(name, []).append(told["seed"])
    rows = [[name, str(n), ", ".join(map(str, sorted(seeds[name])[:_EXAMPLES]))] for name, n in count.most_common()]
    return table(["violation", "times", "seeds"], rows) if rows else "No violations."


def _row(name: str, found: Sequence[dict[str, Any]]) -> list[str]:
    held = [told for told in found if told["inverse"] == "answered"]
    refused = [told for told in found if told["inverse"] != "answered"]
    proven = sum(told.get("holdable") in ("no", "no, sampled") for told in refused)
    vibrating = sum(told.get("modes") == "answered" for told in held)
    worst = max(map(worst_balance, held), default=0.0)
    return [
        name,
        str(len(found)),
        str(len(held)),
        str(len(refused)),
        str(proven),
        str(sum(told.get("rivals", 0) > 0 for told in held)),
        str(vibrating),
        str(len(held) - vibrating),
        f"{worst:.1e}",
        str(sum(bool(told["violations"]) for told in found)),
    ]
