"""The files that a campaign is made of."""

from pathlib import Path

from cdpr_struct.robot.toml_text import toml_table


def is_there(path: Path) -> bool:
    """Whether a path is that of a file; no file has a name that the system refuses."""
    try:
        return path.is_file()
    except OSError:  # too long
        return False


def campaign_bytes(path: str | Path) -> bytes:
    """Contents of the campaign file and of the robot and data files that it names, as far as they can be read."""
    source = Path(path)
    contents = [_content(source), *(_content(named) for named in _named(source))]
    if len(contents) == 1:
        return contents[0]
    return b"".join(len(part).to_bytes(8, "big") + part for part in contents)


def campaign_files(path: str | Path) -> list[Path]:
    """The campaign file, and those of the robot and data files it names that are there; another file stands alone."""
    source = Path(path)
    return [source, *(named for named in _named(source) if is_there(named))]


def _named(source: Path) -> list[Path]:
    """Paths that a campaign file names; none of a file that is no campaign, of which its reader says what is wrong."""
    try:
        table = toml_table(_content(source).decode("utf-8-sig"), str(source))
        names = [table.get("robot"), *(entry.get("file") for entry in table.get("measurement", ()))]
    except (ValueError, AttributeError):
        return []
    return [source.parent / name for name in names if isinstance(name, str)]


def _content(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except (OSError, ValueError):
        return b""
