"""Results as JSON text."""

import json
import math
from collections.abc import Mapping
from typing import Any


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


def json_text(result: Mapping[str, Any]) -> str:
    """Text of result.json."""
    return json.dumps(plain(result), indent=2) + "\n"
