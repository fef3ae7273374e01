"""The files that a campaign is made of."""

import tomllib
from pathlib import Path


def campaign_bytes(path: str | Path) -> bytes:
    """Contents of the campaign file and of the robot and data files that it names, as far as they can be read."""
    source = Path(path)
    contents = [_content(source)]
    try:
        table = tomllib.loads(contents[0].decode("utf-8-sig"))
        named = [table.get("robot"), *(entry.get("file") for entry in table.get("measurement", ()))]
    except (ValueError, AttributeError, RecursionError):
        return contents[0]  # the reader will say what is wrong with it
    contents += [_content(source.parent / name) for name in named if isinstance(name, str)]
    return b"".join(len(part).to_bytes(8, "big") + part for part in contents)


def _content(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except (OSError, ValueError):
        return b""
