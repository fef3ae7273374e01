"""The public names: loaded when asked for, listed everywhere, and the same in code, docs and help."""

import ast
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import cdpr_struct as cs
from tests.interface.reference import PAGE, documented, names_by_group, page_text, source_text

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "cdpr_struct" / "__init__.py"
NAMES = sorted(set(cs.__all__) - {"__version__"})


def python(code: str) -> str:
    """What a fresh interpreter prints."""
    found = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, cwd=ROOT, check=False
    )
    assert found.returncode == 0, found.stderr
    return found.stdout


def test_importing_the_package_loads_nothing_else():
    loaded = python("import sys, cdpr_struct; print(*[m for m in sys.modules if m.startswith('cdpr_struct')])")
    assert loaded.split() == ["cdpr_struct"]


def test_one_name_loads_neither_figures_nor_tables():
    code = "import sys, cdpr_struct as cs; cs.modes('thesis-3-1', count=1); print(*sys.modules)"
    assert not {"matplotlib", "pandas", "plotly", "typer"} & set(python(code).split())


def test_type_checkers_see_the_names_that_are_loaded():
    tree = ast.parse(SOURCE.read_text("utf-8"))
    typed = next(node for node in tree.body if isinstance(node, ast.If))
    seen = {alias.name: node.module for node in typed.body for alias in node.names}
    assert seen == cs._HOME
    assert set(seen) == set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_name_is_there_and_says_what_it_is(name):
    thing = getattr(cs, name)
    assert name in dir(cs)
    first = documented(thing)
    assert first.endswith(".")
    assert len(first) <= 110


def test_functions_are_spoken_to_in_one_way():
    commands = [cs.modes, cs.inverse, cs.frf, cs.transient, cs.verify, cs.map, cs.pose_error, cs.audit, cs.distribute]
    for function in commands:
        given = inspect.signature(function).parameters
        assert {"payload", "mass", "lower_bound", "upper_bound"} <= given.keys(), function
        assert given["payload"].default == 0.0


def test_no_other_name():
    with pytest.raises(AttributeError, match="has no attribute 'mode'"):
        _ = cs.mode


def test_help_lists_every_name_with_its_meaning():
    shown = " ".join(python("import cdpr_struct; help(cdpr_struct)").split())
    for name in NAMES:
        assert f"{name} {documented(getattr(cs, name))}" in shown, name


def test_docs_and_docstring_are_current():
    assert PAGE.read_text("utf-8") == page_text(), "run: python -m tests.interface.reference"
    assert SOURCE.read_text("utf-8") == source_text(), "run: python -m tests.interface.reference"


def test_every_name_is_in_one_group():
    grouped = [name for names in names_by_group().values() for name in names]
    assert sorted(grouped) == NAMES
