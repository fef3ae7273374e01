"""The lines of the README and the programs in examples/python run."""

import re
import runpy
from pathlib import Path

import matplotlib as mpl
import pytest
from matplotlib import pyplot

ROOT = Path(__file__).parents[2]
PROGRAMS = sorted((ROOT / "examples" / "python").glob("*.py"))


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with mpl.rc_context({"backend": "Agg"}):
        yield
    pyplot.close("all")


def blocks(page: str) -> list[str]:
    """Python code of a page that needs nothing before it."""
    return [code for code in re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text("utf-8"), re.M | re.S)
            if code.startswith("import cdpr_struct")]  # fmt: skip


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_the_first_lines_run(page, capsys):
    (code,) = blocks(page)
    exec(compile(code, page, "exec"), {})
    if page == "README.md":
        shown = capsys.readouterr().out
        assert "2.483092" in shown
        assert len(shown.splitlines()) == 1 + 12
        assert "thesis-3-1: eigenfrequencies" in Path("modes.svg").read_text("utf-8")
        assert len([line for line in code.splitlines() if line]) == 5


def test_there_are_programs():
    assert len(PROGRAMS) >= 3


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_a_program_runs(path, capsys):
    runpy.run_path(str(path), run_name="__main__")
    assert len(capsys.readouterr().out.splitlines()) >= 3
