"""Files of a result in a directory: each whole or absent, nothing older beside them, nobody else's overwritten.

result.json lists the files written with it and their digests under `files`, so that a later run can tell its own files
from those that a user wrote or changed.
"""

import hashlib
import json
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from cdpr_struct.errors import InputError
from cdpr_struct.reports.plain_json import json_text, result_text

Content = str | bytes | Iterable[bytes]
"""What a file holds; a long one in parts."""

RESULT = "result.json"
_FOREIGN = "a file that this program did not write, or that was changed since; give another place, or --overwrite"


def replace_files(directory: Path, result: Mapping[str, Any], files: Mapping[str, Content], overwrite: bool) -> None:
    """Write result.json and the files of a result, and remove those of an earlier one.

    All are written under temporary names before the first is renamed; result.json, which lists them, comes last.

    Raises
    ------
    InputError : a file is in the way that this program did not write, or the directory cannot be made or written.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with _alone_in(directory):
            _replace(directory, result, files, overwrite)
    except OSError as error:
        raise InputError("--out", "", str(directory), f"a directory that can be written ({error.strerror})") from error


def _replace(directory: Path, result: Mapping[str, Any], files: Mapping[str, Content], overwrite: bool) -> None:
    earlier = _listed(directory)
    with _renamed_at_the_end(directory) as write:
        digests = {name: write(name, content) for name, content in files.items()}
        digests[RESULT] = _digest(result_text(result))
        wanted = {**digests, RESULT: write(RESULT, result_text({**result, "files": digests}))}
        if not overwrite:
            _refuse(directory, {**dict.fromkeys(earlier, _NOTHING), **wanted}, earlier)
    for name in earlier.keys() - wanted.keys():
        (directory / name).unlink(missing_ok=True)


@contextmanager
def _alone_in(directory: Path) -> Iterator[None]:
    """Wait until no other run writes its result here, so that the files of two are never mixed."""
    handle = os.open(directory, os.O_RDONLY)
    try:
        with suppress(ImportError, OSError):  # some systems and network disks have no locks
            import fcntl

            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def refuse_foreign(directory: Path, names: Iterable[str]) -> None:
    """Refuse files that are there and were not written by this program, or were changed since.

    Raises
    ------
    InputError : names the first such file.
    """
    if directory.is_dir():
        _refuse(directory, dict.fromkeys(names, _NOTHING), _listed(directory))


def write_new(path: Path, content: str | bytes, overwrite: bool) -> None:
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


def write_new_files(directory: Path, files: Mapping[str, str], overwrite: bool) -> None:
    """Write files of these names into a directory, all of them or none; none may be there, unless `overwrite`.

    Raises
    ------
    InputError : another file is there, or they cannot be written.
    """
    there = [name for name in files if (directory / name).exists()]
    if there and not overwrite:
        expected = "the file is there already; give another directory, or --overwrite"
        raise InputError("--out", "", str(directory / there[0]), expected)
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with _renamed_at_the_end(directory) as write:
            for name, content in files.items():
                write(name, content)
    except OSError as error:
        raise InputError("--out", "", str(directory), f"a directory that can be written ({error.strerror})") from error


def write_whole(path: Path, content: str | bytes) -> None:
    """Write to a temporary name beside `path`, then rename."""
    with _renamed_at_the_end(path.parent) as write:
        write(path.name, content)


def _refuse(directory: Path, wanted: Mapping[str, str], earlier: Mapping[str, str]) -> None:
    """Refuse files that have neither the wanted digest nor that of an earlier run."""
    for name, digest in wanted.items():
        path = directory / name
        if not path.exists() or _digest(found := path.read_bytes()) == digest:
            continue
        if _own_digest(name, found) != earlier.get(name):
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


@contextmanager
def _renamed_at_the_end(directory: Path) -> Iterator[Callable[[str, Content], str]]:
    """Yields what writes a file under a temporary name and returns its digest; all are renamed at the end."""
    temporary: dict[str, str] = {}

    def write(name: str, content: Content) -> str:
        digest = hashlib.sha256()
        handle, temporary[name] = tempfile.mkstemp(dir=directory, prefix=f".{name}.")
        with os.fdopen(handle, "wb") as file:
            for part in _parts(content):
                digest.update(part)
                file.write(part)
        Path(temporary[name]).chmod(0o644)
        return digest.hexdigest()

    try:
        yield write
        for name, path in temporary.items():
            Path(path).replace(directory / name)
    except BaseException:
        for path in temporary.values():
            Path(path).unlink(missing_ok=True)
        raise


def _parts(content: Content) -> Iterable[bytes]:
    return (_bytes(content),) if isinstance(content, str | bytes) else content


def _bytes(content: str | bytes) -> bytes:
    return content.encode("utf-8") if isinstance(content, str) else content


def _digest(content: str | bytes) -> str:
    return hashlib.sha256(_bytes(content)).hexdigest()


_NOTHING = _digest(b"")
