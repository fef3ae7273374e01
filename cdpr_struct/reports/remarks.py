"""What stands beside every result: trust, warnings, what is to be known of the rest, notes on extensions."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.freedom_words import freedom_sentences
from cdpr_struct.reports.trust import trust_sentences


def warnings_of(result: Mapping[str, Any]) -> list[str]:
    """Sentences that a reader of the result must not miss."""
    return list(result.get("warnings", ()))


def extensions_of(result: Mapping[str, Any]) -> list[str]:
    """Sentences on the extensions of the robot file."""
    return list(result.get("extensions", {}).get("sentences", ()))


def rest_of(result: Mapping[str, Any]) -> list[str]:
    """Sentences on how the rest at locked lengths was found, on neutral freedoms, what a guide holds, and on trust."""
    return [*result.get("locked", {}).get("sentences", ()), *freedom_sentences(result), *trust_sentences(result)]


def remarks(result: Mapping[str, Any]) -> list[str]:
    """Blocks of text to stand below a result; none if there is nothing to remark."""
    warnings = [f"Warning: {sentence}" for sentence in warnings_of(result)]
    parts = ["\n".join(part) for part in (rest_of(result), warnings, extensions_of(result))]
    return [part for part in parts if part]
