"""Shells complete commands and built-in robots."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def completed(words: str, place: int) -> list[str]:
    """What bash is told when TAB is pressed at a word."""
    asked = {"_CDPR_STRUCT_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": str(place)}
    line = [sys.executable, "-m", "cdpr_struct"]
    return subprocess.run(
        line, capture_output=True, text=True, cwd=ROOT, env=os.environ | asked, check=True
    ).stdout.split()


@pytest.mark.parametrize(
    ("words", "place", "expected"),
    [
        ("cdpr-struct rer", 1, ["rerun"]),
        ("cdpr-struct modes thesis-3", 2, ["thesis-3-1", "thesis-3-1-8mm"]),
        ("cdpr-struct spectrogram x.csv --robot cog", 4, ["cogiro"]),
    ],
)
def test_words_are_completed(words, place, expected):
    assert completed(words, place) == expected


def test_the_script_for_a_shell_is_shown():
    """The name of the shell is given: tests may run without one above them that could be recognised."""
    line = [sys.executable, "-m", "cdpr_struct", "--show-completion", "bash"]
    env = os.environ | {"_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"}
    shown = subprocess.run(line, capture_output=True, text=True, cwd=ROOT, env=env, check=False)
    assert "complete -o default -F _cdpr_struct_completion cdpr-struct" in shown.stdout, shown.stderr
