"""The table in a room's README lists every file of the room and tells the truth about what each imports."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "cdpr_struct"
ROOMS = (
    "statics", "dynamics", "crosscheck", "workspace", "observation", "bands", "inference", "association",
    "residuals", "hypotheses", "hypotheses/causes", "diagnosis", "planning", "interface", "live", "recordings",
)  # fmt: skip
LONGEST_CHAIN = 11  # files of one room that import each other in a row; only ever to become fewer
SHORT = {"observation", "inference", "association", "residuals", "hypotheses", "diagnosis", "planning"}
LONGEST_SHORT_CHAIN = 7


def table(room: str) -> dict[str, set[str]]:
    """File name: what it may import, files of the room and other rooms."""
    rows = [line.strip("| ").split("|") for line in (PACKAGE / room / "README.md").read_text("utf-8").splitlines()]
    rows = [[cell.strip() for cell in row] for row in rows if len(row) == 3 and row[0].strip().endswith(".py")]
    return {name: set(allowed.split(", ")) - {"-"} for name, _, allowed in rows}


def imports(room: str, name: str) -> set[str]:
    """What a file imports: files and folders of its room, and other rooms except the generated code."""
    found, own = set(), "cdpr_struct." + room.replace("/", ".")
    for node in ast.walk(ast.parse((PACKAGE / room / name).read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            package, _, rest = node.module.partition(".")
            if node.module == own:
                found |= {alias.name for alias in node.names}
            elif node.module.startswith(f"{own}."):
                found.add(node.module.removeprefix(f"{own}.").split(".")[0])
            elif package == "cdpr_struct" and rest.split(".")[0] not in {"generated", "errors", ""}:
                found.add(rest.split(".")[0])
        elif isinstance(node, ast.Import):
            found |= {"fem_reference" for alias in node.names if alias.name == "cdpr_struct.fem_reference"}
    return found


def chain(room: Path) -> int:
    """Number of files in the longest row of files of a room, folders included, in which each imports the next."""
    files = {".".join(p.relative_to(PACKAGE.parent).with_suffix("").parts): p for p in room.rglob("*.py")}
    lengths: dict[str, int] = {}

    def length(name: str, above: tuple[str, ...]) -> int:
        assert name not in above, f"a circle: {' > '.join([*above, name])}"
        if name not in lengths:
            below = files.keys() & names_in(files[name])
            lengths[name] = 1 + max((length(n, (*above, name)) for n in below), default=0)
        return lengths[name]

    return max(length(name, ()) for name in files)


def names_in(path: Path) -> set[str]:
    """Dotted names that a file imports, taken for modules."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return found


@pytest.mark.parametrize("room", sorted({room.split("/")[0] for room in ROOMS}))
def test_imports_in_a_room_make_no_circle_and_no_long_chain(room):
    assert chain(PACKAGE / room) <= (LONGEST_SHORT_CHAIN if room in SHORT else LONGEST_CHAIN)


@pytest.mark.parametrize("room", ROOMS)
def test_table_lists_every_file(room):
    files = {path.name for path in (PACKAGE / room).glob("*.py")} - {"__init__.py"}
    assert set(table(room)) == files


@pytest.mark.parametrize(("room", "name"), [(room, name) for room in ROOMS for name in sorted(table(room))])
def test_imports_are_those_of_the_table(room, name):
    assert imports(room, name) == table(room)[name]
