"""Imports go one way; the numerics know nothing of files, plots or screens."""

import ast
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "cdpr_struct"

EVIDENCE = {"robot", "statics", "dynamics", "measurement", "observation", "inference", "association"}
# What each room of the package may import from it, besides itself, `errors` and `generated`.
MAY_IMPORT = {
    "generated": set(),
    "robot": set(),
    "statics": {"robot"},
    "dynamics": {"robot", "statics"},
    "crosscheck": {"robot", "statics", "dynamics", "workspace"},
    "measurement": {"robot", "statics", "dynamics"},
    "observation": {"robot", "statics", "dynamics", "measurement"},
    "bands": {"robot", "statics", "dynamics", "observation", "workspace"},
    "recordings": {"robot", "measurement"},
    "inference": set(),
    "association": {"observation", "inference"},
    "residuals": EVIDENCE,
    "hypotheses": {*EVIDENCE, "residuals"},
    "diagnosis": {*EVIDENCE, "residuals", "hypotheses"},
    "planning": {*EVIDENCE, "residuals", "hypotheses", "diagnosis"},
    "workspace": {"robot", "statics", "dynamics"},
    "thesis": {"robot", "statics", "dynamics", "crosscheck", "workspace"},
    "reports": {
        "bands",
        "robot",
        "statics",
        "dynamics",
        "crosscheck",
        "measurement",
        "hypotheses",
        "diagnosis",
        "planning",
        "workspace",
        "thesis",
    },
    "interface": {
        "bands",
        "robot",
        "statics",
        "dynamics",
        "crosscheck",
        "measurement",
        "hypotheses",
        "diagnosis",
        "planning",
        "workspace",
        "thesis",
        "reports",
        "live",
        "recordings",
    },
    "live": {
        "robot",
        "statics",
        "dynamics",
        "crosscheck",
        "measurement",
        "observation",
        "reports",
    },
    "cli": {
        "robot",
        "statics",
        "dynamics",
        "crosscheck",
        "measurement",
        "diagnosis",
        "planning",
        "workspace",
        "thesis",
        "reports",
        "interface",
    },
}
NUMERICS = ("generated", "statics", "dynamics", "bands", "crosscheck", "workspace", "residuals", "hypotheses")
WINDOW = "viser"
SCREEN_AND_FILES = {"matplotlib", "plotly", "rich", "typer", "jinja2", "pathlib", "json", "csv"}
BESIDE = {"fem_reference", "derivations"}  # folders of their own; their directions are tested further down
MAY_IMPORT_THE_REFEREE = {"crosscheck"}
MAY_IMPORT_THE_PACKAGE = {"cli"}


@cache
def imports_of(path: Path) -> set[str]:
    """Dotted names of everything that a file imports."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module)
    return found


def files_of(room: str) -> list[Path]:
    files = sorted((PACKAGE / room).rglob("*.py"))
    assert files, f"no files in {room}"
    return files


@pytest.mark.parametrize("room", MAY_IMPORT)
def test_rooms_import_only_what_lies_below(room):
    allowed = MAY_IMPORT[room] | {room, "errors", "generated"}
    for path in files_of(room):
        for name in imports_of(path):
            parts = name.split(".")
            if parts[0] == "cdpr_struct" and len(parts) > 1 and parts[1] not in BESIDE:
                assert parts[1] in allowed, f"{path.relative_to(ROOT)} imports {name}"


@pytest.mark.parametrize("room", sorted(MAY_IMPORT.keys() - MAY_IMPORT_THE_PACKAGE))
def test_no_room_below_the_command_line_imports_the_public_names(room):
    for path in files_of(room):
        assert "cdpr_struct" not in imports_of(path), path


@pytest.mark.parametrize("room", NUMERICS)
def test_numerics_know_nothing_of_files_and_screens(room):
    for path in files_of(room):
        foreign = {name.split(".")[0] for name in imports_of(path)} & SCREEN_AND_FILES
        assert not foreign, f"{path.relative_to(ROOT)} imports {sorted(foreign)}"


def test_one_file_knows_the_browser_window():
    knowing = [p for p in PACKAGE.rglob("*.py") if WINDOW in {n.split(".")[0] for n in imports_of(p)}]
    assert [p.relative_to(PACKAGE).as_posix() for p in knowing] == ["live/window.py"]
    for path in files_of("live"):
        assert not {name.split(".")[0] for name in imports_of(path)} & SCREEN_AND_FILES, path


def test_every_room_is_listed():
    rooms = {path.name for path in PACKAGE.iterdir() if (path / "__init__.py").exists()}
    assert rooms - BESIDE == set(MAY_IMPORT)


def test_fem_and_model_meet_in_one_room_only():
    for room in MAY_IMPORT.keys() - MAY_IMPORT_THE_REFEREE:
        for path in files_of(room):
            assert not any(name.startswith("cdpr_struct.fem_reference") for name in imports_of(path)), path


def test_generated_code_needs_numpy_only():
    for path in files_of("generated"):
        outside = {n for n in imports_of(path) if n.split(".")[0] not in {"numpy", "typing", "collections"}}
        assert all(n.startswith("cdpr_struct.generated") for n in outside), path


def test_one_place_imports_the_plotting_libraries():
    plotting = [p for p in PACKAGE.rglob("*.py") if {n.split(".")[0] for n in imports_of(p)} & {"matplotlib", "plotly"}]
    assert all(
        p.relative_to(PACKAGE).parts[:2] in {("reports", "figures.py"), ("reports", "figures")} for p in plotting
    )
