"""What result.json records of its run: the command, the program's version, and the digests of the files it read."""

import hashlib
from collections.abc import Iterator, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

RUN = "run"
_MOST_FILES = 10_000  # of a folder that is an input


def run_record(words: Sequence[str]) -> dict[str, Any]:
    """Command, version, and the digest of each file that the words name, or that a campaign file among them names."""
    return {"command": list(words), "version": version("cdpr-struct"), "inputs": digests(words)}


def digests(words: Sequence[str]) -> dict[str, str]:
    """SHA-256 by path, as seen from here, of the files that a command reads."""
    from cdpr_struct.robot.robot_file import builtin_names

    known, found = builtin_names(), {}
    for word in words[2:]:
        for text in {word, word.partition("=")[2]} - {"", *known}:
            for path in _files(text):
                found[path.as_posix()] = _digest(path)
    return dict(sorted(found.items()))


def _files(text: str) -> Iterator[Path]:
    """Files that a word stands for: itself, the files of a folder, and those that a campaign is made of."""
    from cdpr_struct.measurement.campaign_sources import campaign_files

    path = Path(text)
    try:
        if path.is_dir() and text not in (".", ".."):
            yield from sorted(inner for inner in path.iterdir() if inner.is_file())[:_MOST_FILES]
        elif path.is_file():
            yield from (campaign_files(path) if path.suffix == ".toml" else [path])
    except (OSError, ValueError):  # a word that no path can be
        return


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
