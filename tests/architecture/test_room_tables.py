"""The table in a room's README lists every file of the room and tells the truth about what each imports."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "cdpr_struct"
ROOMS = ("statics", "dynamics", "crosscheck", "workspace", "inference", "association", "planning")


def table(room: str) -> dict[str, set[str]]:
    """File name: what it may import, files of the room and other rooms."""
    rows = [line.strip("| ").split("|") for line in (PACKAGE / room / "README.md").read_text("utf-8").splitlines()]
    rows = [[cell.strip() for cell in row] for row in rows if len(row) == 3 and row[0].strip().endswith(".py")]
    return {name: set(allowed.split(", ")) - {"-"} for name, _, allowed in rows}


def imports(room: str, name: str) -> set[str]:
    """What a file imports: files of its room, and other rooms except the generated code."""
    found = set()
    for node in ast.walk(ast.parse((PACKAGE / room / name).read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            package, _, rest = node.module.partition(".")
            own_room, _, module = rest.partition(".")
            if package == "cdpr_struct" and own_room == room:
                found |= {module} if module else {alias.name for alias in node.names}
            elif package == "cdpr_struct" and own_room not in {"generated", "errors", ""}:
                found.add(own_room)
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names if alias.name == "fem_reference"}
    return found


@pytest.mark.parametrize("room", ROOMS)
def test_table_lists_every_file(room):
    files = {path.name for path in (PACKAGE / room).glob("*.py")} - {"__init__.py"}
    assert set(table(room)) == files


@pytest.mark.parametrize(("room", "name"), [(room, name) for room in ROOMS for name in sorted(table(room))])
def test_imports_are_those_of_the_table(room, name):
    assert imports(room, name) == table(room)[name]
