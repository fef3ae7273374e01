"""What a benchmark answers with, for the screen and for the page."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

Draw = Callable[[Path], None]


@dataclass(frozen=True)
class Answer:
    """text : Markdown, tables and sentences;  figures : file name, and what draws it there."""

    text: str
    figures: dict[str, Draw] = field(default_factory=dict)


@dataclass(frozen=True)
class Question:
    """name : on the command line and of the page;  answer : measures, with few runs and poses if asked to be quick."""

    name: str
    asks: str
    answer: Callable[[bool], Answer]


def paragraphs(*parts: str) -> str:
    """Markdown of parts, empty ones left out."""
    return "\n\n".join(part for part in parts if part)
