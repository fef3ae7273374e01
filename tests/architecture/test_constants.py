"""Every number that the diagnosis rests on stands in docs/diagnosis_constants.md, and few of them are set by hand."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.hand_set import HAND_SET, changed
from cdpr_struct.hypotheses import alternatives, correction
from cdpr_struct.planning import recommendations

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "diagnosis_constants.md"
ROOMS = (
    "observation", "association", "inference", "residuals", "hypotheses", "hypotheses/causes", "diagnosis", "planning",
)  # fmt: skip
CLASSES = {"numerical", "budget", "prior", "derived", "name", "hand-set"}
MOST_HAND_SET = 25  # only ever to become fewer
PLAIN = {0.0, 0.5, 1.0, 2.0}  # numbers of formulas: halves, squares and the like
Named = tuple[str, str]


def is_number(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and type(node.value) in (int, float)


def constants(source: str) -> set[str]:
    """Names that a module gives to numbers, alone or within anything."""
    found = set()
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None:
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            if any(map(is_number, ast.walk(node.value))):
                found |= {n.id for target in targets for n in ast.walk(target) if isinstance(n, ast.Name)}
    return found


def bare_numbers(source: str) -> set[float]:
    """Numbers with a point within functions and classes, plain ones left out."""
    return {
        float(node.value)
        for part in ast.parse(source).body
        if isinstance(part, ast.FunctionDef | ast.ClassDef)
        for node in ast.walk(part)
        if isinstance(node, ast.Constant) and type(node.value) is float and node.value not in PLAIN
    }


def rows(page: str) -> Iterator[tuple[str, list[str], str]]:
    """File, code words of the second column, and last column, of every table row of the page."""
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip("| ").split(" | ")]
        if line.startswith("| ") and cells[0].endswith(".py"):
            yield cells[0], re.findall(r"`([^`]+)`", cells[1]), cells[2]


def sections() -> dict[str, list[tuple[str, list[str], str]]]:
    """Rows of the page by the heading above them."""
    parts = re.split(r"^## ", PAGE.read_text("utf-8"), flags=re.MULTILINE)[1:]
    return {part.splitlines()[0]: list(rows(part)) for part in parts}


def on_page() -> dict[Named, str]:
    """Class of each constant."""
    parts = sections()
    found = {(file, name): "hand-set" for file, names, _ in parts["Set by hand"] for name in names}
    return found | {(file, name): kind for file, names, kind in parts["All others"] for name in names}


def in_code() -> set[Named]:
    files = [(f"{room}/{path.name}", path) for room in ROOMS for path in (ROOT / "cdpr_struct" / room).glob("*.py")]
    return {(file, name) for file, path in files for name in constants(path.read_text("utf-8"))}


def test_every_constant_is_on_the_page_and_no_other():
    assert on_page().keys() == in_code()


def test_every_constant_has_a_class():
    assert set(on_page().values()) <= CLASSES


def test_few_are_set_by_hand():
    assert sum(kind == "hand-set" for kind in on_page().values()) <= MOST_HAND_SET


def test_the_benchmark_tries_those_set_by_hand():
    assert {(f"{one.room}/{one.file}.py", one.name) for one in HAND_SET} == {
        named for named, kind in on_page().items() if kind == "hand-set"
    }


@pytest.mark.parametrize("room", ROOMS)
def test_numbers_within_functions_are_on_the_page(room):
    said = {(file, float(number)) for file, numbers, _ in sections()["Numbers within functions"] for number in numbers}
    for path in sorted((ROOT / "cdpr_struct" / room).glob("*.py")):
        file = f"{room}/{path.name}"
        assert {(file, n) for n in bare_numbers(path.read_text("utf-8"))} == {one for one in said if one[0] == file}


@pytest.mark.parametrize("line", ["NEAR = 3.0", "A, B = 1, 'x'", "TABLE: dict = {'a': (1, 2)}", "X = np.array([0.3])"])
def test_a_constant_is_seen(line):
    assert constants(line)


def test_a_bare_number_is_seen():
    assert bare_numbers("def f(x):\n    return x > 0.3 and 0.5 * x") == {0.3}


def test_a_change_reaches_every_module_and_what_is_computed_from_it_and_is_undone():
    price, scales = (next(one for one in HAND_SET if one.name == name) for name in ("PRICE", "SCALES"))
    before = alternatives.PRICE, correction.PRICE, alternatives.SCALES, recommendations.WIDE
    with changed(price, 2.0), changed(scales, 2.0):
        assert alternatives.PRICE == correction.PRICE == 2.0 * before[0]
        assert tuple(2.0 * scale for scale in before[2]) == alternatives.SCALES
        assert pytest.approx(2.0 * before[3]) == recommendations.WIDE
    assert before == (alternatives.PRICE, correction.PRICE, alternatives.SCALES, recommendations.WIDE)
