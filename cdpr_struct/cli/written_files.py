"""Files of a result in a directory: each whole or absent, nothing older beside them, nobody else's overwritten.

result.json lists the files written with it and their digests under `files`, so that a later run can tell its own files
from those that a user wrote or changed.
"""

import hashlib
import json
import os
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from cdpr_struct.cli.plain_json import json_text
from cdpr_struct.errors import InputError

RESULT = "result.json"
_FOREIGN = "a file that this program did not write, or that was changed since; give another place, or --overwrite"


def replace_files(
    directory: Path, result: Mapping[str, Any], files: Mapping[str, str | bytes], overwrite: bool
) -> None:
    """Write result.json and the files of a result, and remove those of an earlier one.

    All are written under temporary names before the first is renamed; result.json, which lists them, comes last.

    Raises
    ------
    InputError : a file is in the way that this program did not write, or the directory cannot be made or written.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        contents = {name: _bytes(content) for name, content in files.items()}
        digests = {name: _digest(content) for name, content in contents.items()}
        digests[RESULT] = _digest(_bytes(json_text(result)))
        contents[RESULT] = _bytes(json_text({**result, "files": digests}))
        earlier = _listed(directory)
        if not overwrite:
            _refuse(directory, {**dict.fromkeys(earlier, b""), **contents}, earlier)
        _write_all(directory, contents)
        for name in earlier.keys() - contents.keys():
            (directory / name).unlink(missing_ok=True)
    except OSError as error:
        raise InputError("--out", "", str(directory), f"a directory that can be written ({error.strerror})") from error


def refuse_foreign(directory: Path, names: Iterable[str]) -> None:
    """Refuse files that are there and were not written by this program, or were changed since.

    Raises
    ------
    InputError : names the first such file.
    """
    if directory.is_dir():
        _refuse(directory, dict.fromkeys(names, b""), _listed(directory))


def write_new(path: Path, content: str, overwrite: bool) -> None:
    """Write a single file that the user named, whole or not at all; one with the same content may be there.

    Raises
    ------
    InputError : another file is there, or it cannot be written.
    """
    data = _bytes(content)
    try:
        if not overwrite and path.exists() and path.read_bytes() != data:
            raise InputError("--out", "", str(path), "the file is there already; give another name, or --overwrite")
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, data)
    except OSError as error:
        raise InputError("--out", "", str(path), f"a file that can be written ({error.strerror})") from error


def write_whole(path: Path, content: str | bytes) -> None:
    """Write to a temporary name beside `path`, then rename."""
    _write_all(path.parent, {path.name: _bytes(content)})


def _refuse(directory: Path, wanted: Mapping[str, bytes], earlier: Mapping[str, str]) -> None:
    for name, content in wanted.items():
        path = directory / name
        if path.exists() and (found := path.read_bytes()) != content and _own_digest(name, found) != earlier.get(name):
            raise InputError("--out", "", str(path), _FOREIGN)


def _listed(directory: Path) -> dict[str, str]:
    """Names and digests of the files that an earlier run left; empty if its result.json cannot be read."""
    try:
        files = json.loads((directory / RESULT).read_text("utf-8"))["files"]
        return {str(name): str(digest) for name, digest in files.items() if Path(name).name == name}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def _own_digest(name: str, found: bytes) -> str:
    """Digest of a file that is there; of result.json without the list in it, which cannot hold its own digest."""
    if name != RESULT:
        return _digest(found)
    try:
        result = json.loads(found)
        return _digest(_bytes(json_text({key: value for key, value in result.items() if key != "files"})))
    except (ValueError, AttributeError):
        return _digest(found)


def _write_all(directory: Path, contents: Mapping[str, bytes]) -> None:
    temporary: dict[str, str] = {}
    try:
        for name, data in contents.items():
            handle, temporary[name] = tempfile.mkstemp(dir=directory, prefix=f".{name}.")
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            Path(temporary[name]).chmod(0o644)
        for name in contents:
            Path(temporary[name]).replace(directory / name)
    except BaseException:
        for path in temporary.values():
            Path(path).unlink(missing_ok=True)
        raise


def _bytes(content: str | bytes) -> bytes:
    return content.encode("utf-8") if isinstance(content, str) else content


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
