"""A test plan for a terminal."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.text import paragraphs, plain_table

SHOWN = 8  # measurements


def plan_text(result: Mapping[str, Any]) -> str:
    """The plan for a terminal."""
    sizes = [
        [row["cause"], f"{row['minimum_detectable']['value']:.3g}", row["minimum_detectable"]["unit"],
         row["minimum_detectable"]["pattern"]]
        for row in result["detectable"]
    ]  # fmt: skip
    pairs = [[a, b] for a, b in result["confusable"]]
    blocks = [
        plain_table("Smallest detectable size (found in 4 of 5 cases)", ["cause", "size", "unit", "pattern"], sizes)
    ]
    if pairs:
        blocks.append(plain_table("Causes that would be confused", ["true cause", "taken for"], pairs))
    hidden = [[cause, why] for cause, why in sorted(result["not_testable"].items())]
    if hidden:
        blocks.append(plain_table("Causes that this campaign would not find", ["cause", "why"], hidden))
    if result["next"]:
        head = "Next measurements (gain over all confused pairs, at most 5 nats each; then the pair that gains most)"
        helps = [f"{row['gain_nats']:.1f} nats: {row['sentence']}" for row in result["next"][:SHOWN]]
        blocks.append("\n".join([head, *helps]))
    return paragraphs(*blocks)


def plan_sentences(result: Mapping[str, Any]) -> list[str]:
    """What the campaign would find and confuse, and what to measure next, in words."""
    found, pairs = len(result["detectable"]), len(result["confusable"])
    total = found + len(result["not_testable"])
    lines = [f"This campaign would find {found} of {total} causes at their typical size."]
    if pairs:
        noun = "pair of causes" if pairs == 1 else "pairs of causes"
        lines.append(f"It would confuse {pairs} {noun}: the verdict would be a class, not a name.")
    else:
        lines.append("It would confuse no two causes.")
    if result["next"]:
        lines.append(f"Best next measurement: {result['next'][0]['sentence'].replace('_', ' ')}.")
    return lines
