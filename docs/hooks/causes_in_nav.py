"""mkdocs hook: the section `Causes` of the navigation lists every page of docs/causes."""

from pathlib import Path
from typing import Any

SECTION, FOLDER = "Causes", "causes"


def on_config(config: Any) -> Any:
    """Add the pages of the folder to the section, in alphabetical order."""
    pages = sorted(path.name for path in (Path(config.docs_dir) / FOLDER).glob("*.md"))
    section = _section(config.nav)
    section += [page for page in (f"{FOLDER}/{name}" for name in pages) if page not in section]
    return config


def _section(nav: list[Any]) -> list[Any]:
    """The list of pages below the heading, searched at all depths."""
    for entry in nav:
        for title, below in entry.items() if isinstance(entry, dict) else ():
            if title == SECTION:
                return below
            if isinstance(below, list) and (found := _section(below)):
                return found
    return []
