"""A test plan's result: detectable sizes, confusions, next measurements."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.diagnosis.planned_campaign import Plan
from cdpr_struct.diagnosis.planned_gain import Gain
from cdpr_struct.reports.text import paragraphs, plain_table

SHOWN = 8
MANY = 50.0  # nats beyond which the number says nothing more


def plan_json(plan: Plan) -> dict[str, Any]:
    """result.json of `plan`."""
    return {
        "detectable": [{"cause": n, "minimum_detectable": v} for n, v in plan.detectable.items()],
        "confusable": [[p["cause"], p["taken_for"]] for p in plan.confusable],
        "confusable_nats": [p["nats"] for p in plan.confusable],
        "next": [_next(gain) for gain in plan.gains],
        "not_testable": dict(plan.not_testable),
    }


def _next(gain: Gain) -> dict[str, Any]:
    first = gain.separations[0]
    size = f"{first.after:.0f}" if first.after < MANY else f"more than {MANY:.0f}"
    return {
        "measurement": gain.measurement,
        "gain_nats": gain.nats,
        "sentence": f"{gain.measurement}: separates {first.cause} from {first.rival}, expected {size} nats",
        "separates": [
            {"cause": s.cause, "from": s.rival, "nats_before": s.before, "nats_after": s.after}
            for s in gain.separations
            if s.after > s.before + 0.1
        ],
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
    hidden = [[cause, why] for cause, why in sorted(result["not_testable"].items())]
    if hidden:
        blocks.append(plain_table("Would not be found with this campaign", ["cause", "why"], hidden))
    if result["next"]:
        head = "Would help (nats over all pairs, each counted up to 5; then those of the pair that it helps most)"
        helps = [f"{row['gain_nats']:.1f} nats: {row['sentence']}" for row in result["next"][:SHOWN]]
        blocks.append("\n".join([head, *helps]))
    return paragraphs(*blocks)
