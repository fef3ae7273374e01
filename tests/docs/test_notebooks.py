"""The notebooks of examples/notebooks run, are committed without outputs, and need nothing but the package."""

import contextlib
import json
from pathlib import Path

import matplotlib as mpl
import pytest
from matplotlib import pyplot

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))
LONGEST = 10  # cells: a notebook is a page


def code(path: Path) -> list[str]:
    """Source of the cells of code."""
    cells = json.loads(path.read_text("utf-8"))["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]


def test_there_are_notebooks():
    assert len(NOTEBOOKS) >= 5


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path):
    """In this process, cell by cell: a kernel would take longer to start than most of them to run."""
    names: dict[str, object] = {}
    with contextlib.chdir(ROOT), mpl.rc_context({"backend": "Agg"}):
        for number, cell in enumerate(code(path), start=1):
            exec(compile(cell, f"{path.name}, cell {number}", "exec"), names)
    pyplot.close("all")
    assert "cs" in names


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_small_and_has_no_outputs(path):
    cells = json.loads(path.read_text("utf-8"))["cells"]
    assert len(cells) <= LONGEST
    assert not [cell for cell in cells if cell.get("outputs") or cell.get("execution_count")]
    assert cells[0]["cell_type"] == "markdown"


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_in_a_kernel(path, monkeypatch):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    nbclient.NotebookClient(nbformat.read(path, 4), timeout=60, resources={"metadata": {"path": str(ROOT)}}).execute()
