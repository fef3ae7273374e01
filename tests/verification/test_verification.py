"""The verification page is in step with the pages it quotes, and every row can be repeated."""

import ast
import re
import shlex
from importlib.util import find_spec
from pathlib import Path

import pytest

from benchmarks.__main__ import QUESTIONS, STUDIES
from cdpr_struct.cli.main import COMMANDS
from tests.verification import figures
from tests.verification.page import PAGE, page
from tests.verification.row import Row
from tests.verification.rows import SUBJECTS

ROOT = Path(__file__).parents[2]
ROWS = [row for rows in SUBJECTS.values() for row in rows]
NAMED = pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row.case}: {row.metric}")


def exists(node: str) -> bool:
    """Whether a test, or a file of tests, is there, by its node id without parameters."""
    file, _, name = node.partition("::")
    if not (ROOT / file).is_file():
        return False
    tree = ast.parse((ROOT / file).read_text("utf-8"))
    tests = {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and node.name[:5] == "test_"}
    return name in tests if name else bool(tests)


def can_run(command: str) -> bool:
    """Whether a command's program, module or tests are there."""
    match shlex.split(command):
        case ["python", "-m", "pytest", *paths]:
            return bool(paths) and all((ROOT / path).exists() for path in paths if not path.startswith("-"))
        case ["python", "-m", "benchmarks", question, *_]:
            return question in {*STUDIES, *(known.name for known in QUESTIONS)}
        case ["python", "-m", module, *_]:
            return find_spec(module) is not None
        case ["cdpr-struct", name, *_]:
            return name in {command.NAME for command in COMMANDS}
        case [script]:
            return (ROOT / script).is_file()
    return False


def test_the_page_is_in_step_with_the_pages_it_quotes():
    assert PAGE.read_text("utf-8") == page(), "run: python -m tests.verification, and review the diff"


@NAMED
def test_each_row_can_be_repeated_and_has_a_test(row: Row):
    if row.figure is None:
        assert row.result() == "not measured"
        return
    assert can_run(row.command)
    assert exists(row.test)
    assert row.twin is None or exists(row.twin)
    assert (ROOT / "docs" / row.source).is_file() or re.fullmatch(r"20\d\d-\d\d-\d\d", row.source)


def test_what_is_not_there_is_seen():
    assert not exists("tests/published/test_published.py::test_nothing")
    assert not exists("tests/nowhere.py::test_nothing")
    assert not exists("tests/verification/rows.py")  # a file without tests
    assert not any(map(can_run, ("python -m pytest tests/nowhere", "cdpr-struct nothing", "python -m benchmarks nil")))


def test_a_figure_that_a_page_no_longer_has_is_an_error_and_another_figure_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(figures, "DOCS", tmp_path)
    text = (ROOT / "docs" / "benchmarks.md").read_text("utf-8")
    (tmp_path / "benchmarks.md").write_text(text.replace("| 6.5e-06 % |", "| 0.05 % |", 1), "utf-8")
    assert not figures.exact_beside_fem().met
    (tmp_path / "benchmarks.md").write_text("nothing", "utf-8")
    with pytest.raises(LookupError, match=r"benchmarks.md has no table"):
        figures.exact_beside_fem()
    (tmp_path / "limits.md").write_text("nothing", "utf-8")
    with pytest.raises(LookupError, match=r"limits.md does not say"):
        figures.own_limits()
