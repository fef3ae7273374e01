"""Which mutants has a room, and which of them are drawn?

Left out, as no change of an answer is asked for: docstrings and other text, messages (all within `raise`), type hints,
decorators, defaults of parameters, and everything outside functions: names, types, tolerances and limits of steps.
Numbers below 1e-5 within functions are tolerances, too.
"""

import ast
import hashlib
import random
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from benchmarks.mutation.operators import IDLE, Change, changes

ROOT = Path(__file__).parents[2]
ROOMS = {
    "statics": "cdpr_struct/statics",
    "dynamics": "cdpr_struct/dynamics",
    "inference": "cdpr_struct/inference",
    "FEM": "fem_reference",
}
MESSAGES = {"errors.py"}  # files that make sentences only
HIDDEN = {"annotation", "returns", "decorator_list", "args"}  # fields of statements that are no calculation


@dataclass(frozen=True, slots=True)
class Mutant:
    """One change of one file.

    file : beneath the root; line : where the changed node begins; number : among the changes of the file
    function : qualified name of the outermost function, or method, that has it
    before, after : the expression or statement
    before_it : equal changes of the function that come before it
    """

    room: str
    file: str
    line: int
    number: int
    function: str
    operator: str
    before: str
    after: str
    before_it: int = 0

    @property
    def key(self) -> str:
        """Short name that outlasts changes in other functions."""
        told = [self.file, self.function, self.operator, self.before, self.after]
        told += [str(self.before_it)] if self.before_it else []
        return hashlib.sha1("\n".join(told).encode(), usedforsecurity=False).hexdigest()[:10]


def nodes(tree: ast.AST) -> Iterator[tuple[ast.AST, str, int | None, ast.AST]]:
    """Parent, field, place in a list, and node of everything in a tree that may be changed, top down."""
    for field, value in ast.iter_fields(tree):
        if (field in HIDDEN and isinstance(tree, ast.stmt | ast.arg)) or isinstance(value, str):
            continue
        for place, node in enumerate(value) if isinstance(value, list) else [(None, value)]:
            if not isinstance(node, ast.AST) or isinstance(node, ast.JoinedStr):
                continue
            if isinstance(node, ast.keyword) and node.arg in IDLE:
                continue
            yield tree, field, place, node
            if not isinstance(node, ast.Raise):
                yield from nodes(node)


def functions(tree: ast.Module) -> Iterator[tuple[str, ast.FunctionDef]]:
    """Functions of a module and methods of its classes, with their qualified names."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            yield node.name, node
        elif isinstance(node, ast.ClassDef):
            yield from ((f"{node.name}.{part.name}", part) for part in node.body if isinstance(part, ast.FunctionDef))


def all_changes(tree: ast.Module) -> Iterator[tuple[str, tuple[ast.AST, str, int | None, ast.AST], Change]]:
    """Function, place and change, in the order that gives them their numbers."""
    for name, function in functions(tree):
        for spot in nodes(function):
            yield from ((name, spot, change) for change in changes(spot[3]))


def mutants_of(room: str, path: Path) -> list[Mutant]:
    file = path.relative_to(ROOT).as_posix()
    seen: Counter[tuple[str, ...]] = Counter()
    found = []
    for number, (function, (*_, node), (operator, make)) in enumerate(all_changes(ast.parse(path.read_text("utf-8")))):
        change = (function, operator, _told(node), _told(make()))
        found.append(Mutant(room, file, node.lineno, number, *change, seen[change]))  # type: ignore[attr-defined]
        seen[change] += 1
    return found


def _told(node: ast.AST) -> str:
    if isinstance(node, ast.If | ast.While):
        return f"{'if' if isinstance(node, ast.If) else 'while'} {ast.unparse(node.test)}"
    return ast.unparse(node)


def changed_tree(mutant: Mutant) -> ast.Module:
    """The module's tree with the change made."""
    tree = ast.parse((ROOT / mutant.file).read_text("utf-8"))
    for number, (_, (parent, field, place, _), (_, make)) in enumerate(all_changes(tree)):
        if number == mutant.number:
            if place is None:
                setattr(parent, field, make())
            else:
                getattr(parent, field)[place] = make()
            return tree
    raise ValueError(f"{mutant.file} has no change number {mutant.number}")


@cache
def of_room(room: str) -> dict[str, list[Mutant]]:
    """Mutants by file."""
    paths = sorted((ROOT / ROOMS[room]).glob("*.py"))
    return {path.name: found for path in paths if path.name not in MESSAGES and (found := mutants_of(room, path))}


def drawn(room: str, count: int, seed: int) -> list[Mutant]:
    """A sample stratified by file: each file has its share of `count`, the rest by chance; in random order."""
    chance = random.Random(f"{seed} {room}")
    files = list(of_room(room).values())
    total = sum(map(len, files))
    shares = [count * len(one) / total for one in files]
    counts = [int(share) for share in shares]
    chances = [share - whole for share, whole in zip(shares, counts, strict=True)]
    start, passed = chance.random(), 0.0  # systematic drawing of what the whole shares leave
    for place, part in enumerate(chances):
        counts[place] += int(passed + part + start) - int(passed + start)
        passed += part
    chosen = [mutant for one, number in zip(files, counts, strict=True) for mutant in chance.sample(one, number)]
    chance.shuffle(chosen)
    return chosen
