"""Keys of the results of every example, and the record of those that are relied upon.

Run, after keys were added: python -m tests.cli.result_keys (a minute)
"""

import json
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from tests.cli.conftest import EXAMPLES, OTHERS, words_of

RECORD = Path(__file__).with_name("result_keys.json")
_NAMED_BY_DATA = {"files", "inputs", "minimum_detectable"}  # their keys are names of files, or of causes that are tried

_BETWEEN = "; "


def keys(result: Any, before: str = "") -> Iterator[str]:
    """Paths of all keys, as `convergence.elements`; places in lists are none."""
    if isinstance(result, Mapping):
        for name, inner in result.items():
            yield before + name
            if name not in _NAMED_BY_DATA:
                yield from keys(inner, f"{before}{name}.")
    elif isinstance(result, list):
        for inner in result:
            yield from keys(inner, before)


def missing(name: str, number: int, result: Mapping[str, Any]) -> list[str]:
    """Recorded keys that the result of an example no longer has."""
    record = json.loads(RECORD.read_text("utf-8"))
    return sorted(set(record["keys"][f"{name} {number}"].split(_BETWEEN)) - set(keys(result)))


def recorded_version() -> int:
    """The version of the schema that the record is of."""
    return int(json.loads(RECORD.read_text("utf-8"))["schema_version"])


def main() -> None:
    """Run every example that writes result.json, and write the record."""
    from cdpr_struct.cli.main import run
    from cdpr_struct.reports.plain_json import SCHEMA_VERSION

    found = {}
    for name, number, line in EXAMPLES:
        if name in OTHERS:
            continue
        with tempfile.TemporaryDirectory() as scratch:
            run([*words_of(line), "--out", scratch, "--quiet"])
            result = json.loads((Path(scratch) / "result.json").read_text("utf-8"))
            found[f"{name} {number}"] = _BETWEEN.join(sorted(set(keys(result))))
    RECORD.write_text(json.dumps({"schema_version": SCHEMA_VERSION, "keys": found}, indent=1) + "\n", "utf-8")


if __name__ == "__main__":
    main()
