"""The table in the statics room's README is complete and says the truth about imports."""

import ast
from pathlib import Path

import pytest

ROOM = Path(__file__).parents[2] / "cdpr_struct" / "statics"
PREFIX = "cdpr_struct.statics."


def table() -> dict[str, set[str]]:
    """File name: what it may import."""
    rows = [line.strip("| ").split("|") for line in (ROOM / "README.md").read_text("utf-8").splitlines()]
    rows = [[cell.strip() for cell in row] for row in rows if len(row) == 3 and row[0].strip().endswith(".py")]
    return {name: set(allowed.split(", ")) - {"-"} for name, _, allowed in rows}


@pytest.mark.parametrize("name", sorted(table()))
def test_imports_are_those_of_the_table(name):
    tree = ast.parse((ROOM / name).read_text("utf-8"))
    modules = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module}
    inside = {m.removeprefix(PREFIX).removesuffix(".py") for m in modules if m.startswith(PREFIX)}
    if any(m.startswith("cdpr_struct.robot") for m in modules):
        inside.add("robot")
    assert inside == table()[name]
