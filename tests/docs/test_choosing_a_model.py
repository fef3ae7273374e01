"""The table of docs/choosing_a_model.md is what the program beside it prints."""

import contextlib
import runpy
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_table_is_what_the_program_prints(capsys):
    with contextlib.chdir(ROOT):
        runpy.run_path("examples/models/compare.py", run_name="__main__")
    printed = capsys.readouterr().out.splitlines()
    page = (ROOT / "docs" / "choosing_a_model.md").read_text("utf-8").splitlines()
    assert len(printed) == 5
    assert [line for line in printed if line not in page] == []
