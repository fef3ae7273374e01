"""Tutorials and how-tos, typed as they stand: exit codes, and the printed lines that the pages show.

A block ```sh is typed line by line; the block ```text after it holds lines of its output ([...]: lines left out).
Comments before a block: <!-- exit 1 --> exit code of its last line, <!-- slow --> not in the everyday suite.
"""

import contextlib
import io
import re
import shlex
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from cdpr_struct.cli.main import run

ROOT = Path(__file__).parents[2]
PAGES = (
    "tutorial_own_robot", "tutorial_model_right", "tutorial_diagnosis", "tutorial_trajectory",
    "tutorial_two_chain_router", "tutorial_hanging_printer", "pulleys", "ropes", "recordings", "recorded_motion",
    "notebooks", "templates", "formats", "first_day", "trust", "importing_recordings", "virtual_sensors",
)  # fmt: skip
NEEDED = {"importing_recordings": "rosbags"}  # packages of extras
ROBOTS = sorted((ROOT / "examples" / "robots").glob("*/README.md"))
BLOCK = re.compile(
    r"((?:^<!-- [\w ]+ -->\n)*)^```sh\n(.*?)^```\n(?:\n^```text\n(.*?)^```\n)?", re.MULTILINE | re.DOTALL
)


@dataclass(frozen=True, slots=True)
class Typed:
    """One block of commands: lines, exit code of the last one, lines of output, and whether it takes long."""

    lines: tuple[str, ...]
    code: int
    shown: tuple[str, ...]
    slow: bool


def blocks(text: str) -> list[Typed]:
    """All blocks of a page in order."""
    found = []
    for comments, typed, shown in BLOCK.findall(text):
        code = re.search(r"exit (\d+)", comments)
        lines = tuple(line for line in (squeezed(line) for line in shown.splitlines()) if line and line != "[...]")
        commands = tuple(typed.replace("\\\n", " ").splitlines())
        found.append(Typed(commands, int(code[1]) if code else 0, lines, "slow" in comments))
    return found


def squeezed(line: str) -> str:
    return " ".join(line.split())


def answer(line: str) -> tuple[int, str]:
    """Exit code and output of one line."""
    if line.startswith("cdpr-struct "):
        told = io.StringIO()
        with contextlib.redirect_stdout(told), contextlib.redirect_stderr(told):
            code = run(shlex.split(line)[1:])
        return code, told.getvalue()
    done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def check(page: str, slow: bool, folder: Path) -> None:
    """Type the blocks of a page of docs/ in a folder that has the examples, as the repository has."""
    typed_in(ROOT / "docs" / f"{page}.md", slow, folder)


def typed_in(page: Path, slow: bool, folder: Path) -> None:
    """Type a page's blocks there."""
    shutil.copytree(ROOT / "examples", folder / "examples")
    with contextlib.chdir(folder):
        for block in blocks(page.read_text("utf-8")):
            if block.slow and not slow:
                continue
            answers = [answer(line) for line in block.lines]
            assert [code for code, _ in answers] == [0] * (len(answers) - 1) + [block.code], (block.lines, answers)
            printed = [squeezed(line) for _, text in answers for line in text.splitlines()]
            assert [line for line in block.shown if line not in printed] == [], (block.lines, printed)


@pytest.mark.parametrize("page", PAGES)
def test_commands_of_the_page_do_what_it_says(page, tmp_path):
    if page in NEEDED:
        pytest.importorskip(NEEDED[page], reason="an extra is not installed")
    check(page, False, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize(
    "page", [page for page in PAGES if "<!-- slow" in (ROOT / f"docs/{page}.md").read_text("utf-8")]
)
def test_long_commands_too(page, tmp_path):
    check(page, True, tmp_path)


def test_the_notebook_reads_what_the_commands_wrote(tmp_path):
    check("notebooks", False, tmp_path)
    (cell,) = re.findall(r"^```python\n(.*?)^```\n", (ROOT / "docs/notebooks.md").read_text("utf-8"), re.M | re.DOTALL)
    names: dict[str, Any] = {}
    with contextlib.chdir(tmp_path):
        exec(cell, names)
    assert list(names["modes"].columns) == ["mode", "frequency_hz", "platform_energy", "kind"]
    assert names["result"]["frequencies_hz"][0] == pytest.approx(names["modes"].frequency_hz[0], rel=1e-6)
    assert {"x_m", "y_m", "z_m"} <= set(names["where"].columns)


@pytest.mark.slow
@pytest.mark.parametrize("robot", ROBOTS, ids=lambda page: page.parent.name)
def test_long_commands_of_example_robots_too(robot, tmp_path):
    typed_in(robot, True, tmp_path)


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda page: page.parent.name)
def test_example_robots_answer_as_their_pages_say_and_as_the_hand_checks(robot, tmp_path):
    typed_in(robot, False, tmp_path)
    (cell,) = re.findall(r"^```python\n(.*?)^```\n", robot.read_text("utf-8"), re.M | re.DOTALL)
    assert "assert " in cell
    with contextlib.chdir(tmp_path):
        exec(cell, {})


def test_every_page_has_commands():
    assert all(blocks((ROOT / "docs" / f"{page}.md").read_text("utf-8")) for page in PAGES)
    assert len(ROBOTS) >= 4
