"""docs/commands.md is what the commands say of themselves, and leaves no command, argument or option out."""

import re
from pathlib import Path

import pytest
import typer.main

from cdpr_struct.cli.command_reference import SHARED, reference
from cdpr_struct.cli.main import COMMANDS, app

PAGE = (Path(__file__).parents[2] / "docs" / "commands.md").read_text("utf-8")
SECTIONS = dict(re.findall(r"^## ([\w-]+)\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL))
PARSED = typer.main.get_command(app).commands


def test_the_page_is_current():
    """If not: python -m cdpr_struct.cli.command_reference."""
    assert reference() == PAGE


def test_every_command_has_a_section():
    assert SECTIONS.keys() == PARSED.keys()


@pytest.mark.parametrize("name", PARSED)
def test_every_parameter_of_the_parser_is_in_the_section(name):
    own = [p for p in PARSED[name].params if p.name not in SHARED or p.metavar == "ROBOT.toml"]
    for parameter in own:
        typed = [parameter.metavar] if parameter.param_type_name == "argument" else parameter.opts
        assert all(re.search(rf"^\| `[^`]*{re.escape(text)}", SECTIONS[name], re.MULTILINE) for text in typed), typed


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command.NAME)
def test_examples_are_in_the_section(command):
    assert all(example in SECTIONS[command.NAME] for example in command.EXAMPLES)
