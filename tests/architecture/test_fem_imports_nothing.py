"""The referee may share no code with what it judges: its imports are walked, not trusted."""

import ast
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "fem_reference"
ITSELF = "cdpr_struct.fem_reference"  # the name of the folder, whose own code is all that it may use of the package
ALLOWED = {"numpy", "scipy", ITSELF} | set(sys.stdlib_module_names)
DYNAMIC = {"importlib", "runpy", "imp"}


def imported(name: str) -> str:
    """The referee's name where a module is one of its own, else the top-level name."""
    return ITSELF if f"{name}.".startswith(f"{ITSELF}.") else name.split(".")[0]


def foreign_imports(source: str) -> set[str]:
    """Names that a source imports and may not: top-level ones, or the referee's own."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {imported(alias.name) for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add("relative import" if node.level else imported(str(node.module)))
        elif isinstance(node, ast.Name) and node.id in ("__import__", "exec", "eval"):
            names.add(node.id)
    return (names - ALLOWED) | (names & DYNAMIC)


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.py")), ids=lambda path: path.name)
def test_module_imports_only_numpy_scipy_and_itself(path):
    assert foreign_imports(path.read_text(encoding="utf-8")) == set()


def test_the_package_is_where_the_test_looks():
    assert len(list(PACKAGE.rglob("*.py"))) > 10


@pytest.mark.parametrize(
    "line",
    [
        "from cdpr_struct.statics import catenary",
        "from cdpr_struct import statics",
        "import cdpr_struct.fem_reference_of_others",
        "def f():\n    import cdpr_struct.derivations.catenary",
        "from .. import cdpr_struct",
        "m = __import__('cdpr_struct')",
        "import importlib",
    ],
)
def test_a_forbidden_import_is_seen(line):
    assert foreign_imports(line)
