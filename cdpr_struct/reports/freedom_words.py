"""Sentences on the directions in which the platform is free to move, and on what a guide holds."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.text import rounded


def freedom_sentences(result: Mapping[str, Any]) -> list[str]:
    """What is to be said of them below a result; nothing of a platform that is held by its cables alone."""
    said = []
    if neutral := result.get("neutral_freedoms"):
        count = "one direction" if len(neutral) == 1 else f"{len(neutral)} directions"
        ways = "; ".join(entry["words"] for entry in neutral)
        said.append(f"Nothing pushes the platform back in {count} (0 Hz): {ways}. There {neutral[0]['reason']}.")
    if guide := result.get("guide"):
        push = rounded(guide["reaction_wrench"], 4)
        force, moment = (", ".join(f"{value:g}" for value in part) for part in (push[:3], push[3:]))
        said.append(
            f"A guide holds {', '.join(guide['holds'])}; on the platform, about its origin, it exerts ({force}) N and "
            f"({moment}) N m."
        )
    return said
