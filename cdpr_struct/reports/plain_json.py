"""Results as JSON text."""

import json
import math
from collections.abc import Mapping
from typing import Any

SCHEMA = "schema_version"
SCHEMA_VERSION = 1
"""Of the keys of every result; docs/files.md says what may change without a new number."""


def plain(value: Any) -> Any:
    """Copy of a result that JSON can hold: arrays as lists, nan and infinities as null."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def plain_result(result: Mapping[str, Any]) -> dict[str, Any]:
    """A result with the version of its schema in front, as plain JSON."""
    found: dict[str, Any] = plain({SCHEMA: SCHEMA_VERSION, **result})
    return found


def result_text(result: Mapping[str, Any]) -> str:
    """Text of result.json."""
    return json_text(plain_result(result))


def json_text(value: Mapping[str, Any]) -> str:
    """Text of plain JSON, as result.json is written."""
    return json.dumps(value, indent=2) + "\n"
