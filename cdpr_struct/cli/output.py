"""Where a command's results go: screen, JSON on stdout, or a directory of files, each whole or absent."""

import json
import math
import os
import tempfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from cdpr_struct.errors import InputError


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


def emit(result: Mapping[str, Any], as_json: bool, text: Callable[[], None]) -> None:
    """Print the result: as JSON and nothing else, or by calling `text`; then what is to be said about extensions."""
    if as_json:
        print(json.dumps(plain(result), indent=2))
        return
    text()
    if "extensions" in result:
        print("\n" + "\n".join(result["extensions"]["sentences"]))


def write_files(directory: Path, files: Mapping[str, str | bytes], sometimes: Iterable[str] = ()) -> None:
    """Write the files of a result; each appears whole under its name or not at all.

    sometimes : names that the command writes for other results; what an earlier run left there is removed

    Raises
    ------
    InputError : the directory cannot be made or written.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        for name, content in files.items():
            write_whole(directory / name, content)
        for name in set(sometimes) - set(files):
            (directory / name).unlink(missing_ok=True)
    except OSError as error:
        raise InputError("--out", "", str(directory), f"a directory that can be written ({error.strerror})") from error


def write_whole(path: Path, content: str | bytes) -> None:
    """Write to a temporary name beside `path`, then rename."""
    data = content.encode("utf-8") if isinstance(content, str) else content
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        Path(temporary).chmod(0o644)
        Path(temporary).replace(path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def result_json(result: Mapping[str, Any]) -> str:
    """Text of result.json."""
    return json.dumps(plain(result), indent=2) + "\n"
