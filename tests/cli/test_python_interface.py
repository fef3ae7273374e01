"""What Python answers is what the command answers: every example of every command, called as a function.

The option `--lower-bound 150` is the argument `lower_bound=150`: nothing but this rule is used to call the functions.
"""

import json

import pytest

import cdpr_struct as cs
from cdpr_struct.cli.main import COMMANDS
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.plain_json import result_text
from tests.cli.conftest import EXAMPLES, OTHERS, ROOT, words_of

NOT_IN_PYTHON = {
    "derive",
    "import-caspr",
    "new-robot",
    "new-campaign",
    "export",
    "rerun",
    "view",
}  # they write files of their own kind, or open a window
LONG = ("diagnose", "plan")
MAIN_TABLE = {
    "robots": "robots.csv",
    "cable": "profile.csv",
    "inverse": "cables.csv",
    "forward": "cables.csv",
    "map": "map.csv",
    "modes": "modes.csv",
    "verify": "eigenfrequencies.csv",
    "frf": "frf.csv",
    "transient": "transient.csv",
    "spectrogram": "modes.csv",
    "audit": "audit.csv",
    "ambient": "modes.csv",
    "diagnose": "residuals.csv",
    "plan": "detectable.csv",
}
CASES = [
    pytest.param(name, number, marks=pytest.mark.slow) if name in LONG and number == 0 else (name, number)
    for name, number, _ in EXAMPLES
    if name not in {*NOT_IN_PYTHON, *OTHERS}
]
RESERVED = {"raise": "raise_mode"}  # words that Python keeps for itself


def value_of(text: str) -> object:
    """What a person would write in Python: a number where it is one."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def called(line: str) -> cs.Result:
    """The function that an example's words name, with their options as arguments."""
    name, *words = words_of(line)
    positional, given = [], {}
    while words:
        word = words.pop(0)
        if not word.startswith("--"):
            positional.append(word)
        else:
            takes_value = words and not words[0].startswith("--")
            option = word.removeprefix("--").replace("-", "_")
            given[RESERVED.get(option, option)] = value_of(words.pop(0)) if takes_value else True
    function = getattr(cs, name.replace("-", "_"))
    if given.pop("limits", False):
        function = cs.limits
    return function(*positional, **given)


@pytest.fixture
def line_of(monkeypatch):
    monkeypatch.chdir(ROOT)
    return {(name, number): line for name, number, line in EXAMPLES}


@pytest.mark.parametrize(("name", "number"), CASES)
def test_python_answers_as_the_command_does(name, number, runs, line_of):
    files = runs(name, number)
    commanded = json.loads((files / "result.json").read_text("utf-8"))
    del commanded["files"], commanded["run"]
    found = called(line_of[name, number])
    answered = found.to_json()
    if "command" in commanded:
        assert commanded["command"] == ["cdpr-struct", *words_of(line_of[name, number]), "--out=DIR"]
        commanded["command"] = None
    assert list(answered) == list(commanded)
    assert answered == commanded
    assert json.loads(result_text(found.answer)) == answered
    if name in MAIN_TABLE:
        frame = found.frame()
        table = (files / MAIN_TABLE[name]).read_text("utf-8")
        assert csv_text({column: frame[column] for column in frame.columns}) == table


def test_every_command_is_a_function():
    names = {command.NAME.replace("-", "_") for command in COMMANDS if command.NAME not in NOT_IN_PYTHON}
    assert names <= set(cs.__all__)


def test_numbers_are_given_as_numbers():
    assert (value_of("100"), value_of("1e5"), value_of("0,0,1")) == (100, 1e5, "0,0,1")
