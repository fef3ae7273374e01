"""Examples of the commands' help, run once a session."""

import contextlib
import shlex
from collections.abc import Callable
from pathlib import Path

import pytest

from cdpr_struct.cli.main import COMMANDS, run
from cdpr_struct.cli.output import repeating

ROOT = Path(__file__).parents[2]
ENDLESS = {"view"}  # serves a window until it is interrupted
OTHERS = {
    "import-caspr",
    "import-recording",
    "new-robot",
    "new-campaign",
    "export",
    "rerun",
}  # they write files of their own kind
EXAMPLES = [
    (command.NAME, number, line)
    for command in COMMANDS
    if command.NAME not in ENDLESS
    for number, line in enumerate(command.EXAMPLES)
]
EXTRA = {"ambient": "pyoma2"}  # packages of extras that examples need
FAILS = {"audit": 1, "compare": 1}  # what its examples check does not hold, as the pages show


def words_of(line: str) -> list[str]:
    """Arguments of an example, without where its results go."""
    return [word for word in repeating(shlex.split(line)[1:])[1:-1]]


@pytest.fixture(scope="session")
def runs(tmp_path_factory) -> Callable[[str, int], Path]:
    """(command, number) -> directory with the files of the example, made when it is first asked for."""
    base = tmp_path_factory.mktemp("examples")
    done: dict[tuple[str, int], Path] = {}

    def of(name: str, number: int) -> Path:
        if name in EXTRA:
            pytest.importorskip(EXTRA[name])
        if (name, number) not in done:
            line = next(line for n, k, line in EXAMPLES if (n, k) == (name, number))
            directory = base / f"{name}-{number}"
            with contextlib.chdir(ROOT):
                assert run([*words_of(line), "--out", str(directory), "--quiet"]) == FAILS.get(name, 0), line
            done[name, number] = directory
        return done[name, number]

    return of
