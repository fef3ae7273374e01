"""A test plan's result: detectable sizes, confusions, next measurements."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.diagnosis.plan import SAME, confusable, minimum_detectable
from cdpr_struct.diagnosis.refit import Ground
from cdpr_struct.reports.text import paragraphs, plain_table


def plan_json(ground: Ground, not_testable: Mapping[str, str]) -> dict[str, Any]:
    """result.json of `plan`."""
    found = minimum_detectable([c for c in ground.candidates if c.name not in not_testable])
    pairs = confusable(ground)
    hints = {c.name: c.cause.separated_by for c in ground.candidates}
    following: dict[str, float] = {}
    for pair in pairs:
        hint = hints.get(pair["cause"], "")
        if hint:
            following[hint] = max(following.get(hint, 0.0), SAME - pair["nats"])
    return {
        "detectable": [{"cause": n, "minimum_detectable": v} for n, v in found.items()],
        "confusable": [[p["cause"], p["taken_for"]] for p in pairs],
        "confusable_nats": [p["nats"] for p in pairs],
        "next": [{"measurement": m, "gain_nats": g} for m, g in sorted(following.items(), key=lambda x: -x[1])[:8]],
        "not_testable": dict(not_testable),
    }


def plan_text(result: Mapping[str, Any]) -> str:
    """The plan for a terminal."""
    sizes = [
        [row["cause"], f"{row['minimum_detectable']['value']:.3g}", row["minimum_detectable"]["unit"],
         row["minimum_detectable"]["pattern"]]
        for row in result["detectable"]
    ]  # fmt: skip
    pairs = [[a, b] for a, b in result["confusable"]]
    blocks = [plain_table("Smallest size found 4 times out of 5", ["cause", "size", "unit", "pattern"], sizes)]
    if pairs:
        blocks.append(plain_table("Would be taken for each other", ["cause", "for"], pairs))
    blocks += [f"Would help: {row['measurement']}." for row in result["next"][:3]]
    return paragraphs(*blocks)
