"""Change functions of a running program: the code of a mutant takes the place of the code that was imported.

Every name under which a function was imported then runs the mutant, and nothing is imported again.
"""

import ast
import gc
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType

from benchmarks.mutation.mutants import ROOT, Mutant, changed_tree

Place = tuple[str, str, int]
"""File, qualified name and first line of a function."""


def code_of(code: CodeType, file: str) -> Iterator[tuple[Place, CodeType]]:
    """A code object and those of the functions within, by place."""
    yield (file, code.co_qualname, code.co_firstlineno), code
    for part in code.co_consts:
        if isinstance(part, CodeType):
            yield from code_of(part, file)


@cache
def file_of(name: str) -> str | None:
    """Name beneath the root, links followed; None for files that are not of this project."""
    path = Path(name)
    real = path.resolve()
    return real.relative_to(ROOT).as_posix() if path.is_absolute() and real.is_relative_to(ROOT) else None


def loaded_functions() -> dict[Place, list[FunctionType]]:
    """Functions of this project that exist now, by place."""
    found: dict[Place, list[FunctionType]] = {}
    for one in gc.get_objects():
        if isinstance(one, FunctionType):
            code = one.__code__
            if (file := file_of(code.co_filename)) is not None:
                found.setdefault((file, code.co_qualname, code.co_firstlineno), []).append(one)
    return found


def changed_code(mutant: Mutant) -> dict[Place, CodeType]:
    """Code of the functions of a mutant's file, by place."""
    tree = ast.fix_missing_locations(changed_tree(mutant))
    return dict(code_of(compile(tree, str(ROOT / mutant.file), "exec"), mutant.file))


def put_in(mutant: Mutant, functions: dict[Place, list[FunctionType]]) -> int:
    """Functions that now run the mutant's code. Only the function that has the change takes it."""
    count = 0
    for place, code in changed_code(mutant).items():
        own = place[1] == mutant.function or place[1].startswith(f"{mutant.function}.<locals>.")
        for function in functions.get(place, []) if own else []:
            function.__code__ = code
            count += 1
    return count


def forget_results() -> None:
    """Empty every cache of results that earlier calls, such as those at import, have filled."""
    for one in list(sys.modules.values()):
        if getattr(one, "__name__", "").startswith("cdpr_struct"):
            for value in list(vars(one).values()):
                if callable(clear := getattr(value, "cache_clear", None)):
                    clear()
