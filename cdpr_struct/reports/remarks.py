"""What stands beside every result: warnings, how the rest at locked lengths was found, notes on extensions."""

from collections.abc import Mapping
from typing import Any


def warnings_of(result: Mapping[str, Any]) -> list[str]:
    """Sentences that a reader of the result must not miss."""
    return list(result.get("warnings", ()))


def extensions_of(result: Mapping[str, Any]) -> list[str]:
    """Sentences on the extensions of the robot file."""
    return list(result.get("extensions", {}).get("sentences", ()))


def locked_of(result: Mapping[str, Any]) -> list[str]:
    """Sentences on how the rest at locked lengths was found."""
    return list(result.get("locked", {}).get("sentences", ()))


def remarks(result: Mapping[str, Any]) -> list[str]:
    """Blocks of text to stand below a result; none if there is nothing to remark."""
    warnings = [f"Warning: {sentence}" for sentence in warnings_of(result)]
    parts = ["\n".join(part) for part in (locked_of(result), warnings, extensions_of(result))]
    return [part for part in parts if part]
