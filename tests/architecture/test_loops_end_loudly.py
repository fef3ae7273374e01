"""No search ends silently: a loop with a largest number of rounds says what becomes of what it did not find.

A loop `for .. in range(MOST)` that may stop early is a search. It has an `else`, or what follows it raises or asks once
more what was found, by one of the words below. Those that do neither stand in the list with the reason.
"""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FILES = sorted([*(ROOT / "cdpr_struct").rglob("*.py"), *(ROOT / "fem_reference").rglob("*.py")])
FEW = 3  # rounds written as a number up to which a loop is no search
ASKED = {"NOT_CONVERGED", "cut_short", "counted_lost", "status", "converged", "settled", "proved", "feasible"}
HALVED = "a step is halved; the search around it ends with an error or a mark where steps do not help"
LEFT = "its caller is told what is left: "
DEFENDED = {
    "cdpr_struct/association/belief_propagation.py:_propagated": "an approximation; a test bounds its error",
    "cdpr_struct/bands/designs.py:together": LEFT + "changes are raised in proportion, or `factors` is None",
    "cdpr_struct/dynamics/batched_modes.py:first_mode": LEFT + "nan goes to the general solver",
    "cdpr_struct/dynamics/bracketed_search.py:bracketed_crossings": "a budget of rounds; brackets stay brackets",
    "cdpr_struct/dynamics/bracketed_search.py:bracketed_minima": "a budget of rounds; brackets stay brackets",
    "cdpr_struct/dynamics/harmonic_balance.py:_balanced": HALVED,
    "cdpr_struct/dynamics/lowest_clamped.py:_on_springs": LEFT + "nan goes to the general solver",
    "cdpr_struct/dynamics/natural_frequencies.py:bisect_count": LEFT + "brackets say how wide they are",
    "cdpr_struct/dynamics/pose_frequencies.py:quick_frequencies": LEFT + "None goes to the certified modes",
    "cdpr_struct/dynamics/swept_stiffness.py:swept_stiffness": LEFT + "what no piece covers is evaluated in full",
    "cdpr_struct/hypotheses/choices.py:best_mix": "a local best of many starts; the fit of each hypothesis judges it",
    "cdpr_struct/hypotheses/judge.py:converged": LEFT + "`moved`, which the result's trust tells",
    "cdpr_struct/hypotheses/judge.py:settled": LEFT + "`moved`, which the result's trust tells",
    "cdpr_struct/inference/marginal_scales.py:first_noise": "a beginning; the fit from it says whether it settled",
    "cdpr_struct/inference/positive_part.py:_propagated": "an approximation; a test compares it with the integral",
    "cdpr_struct/residuals/resting_poses.py:solved": "a beginning; the fit from it says whether it settled",
    "cdpr_struct/statics/bounded_steps.py:least_norm": LEFT + "sides that changed; taut_tensions does not count them",
    "cdpr_struct/statics/cable_segments.py:_searched": HALVED,
    "cdpr_struct/statics/catenary.py:_solve_span": LEFT + "solve_end_forces marks cables by their residual",
    "cdpr_struct/statics/distribution_problem.py:_advance": HALVED,
    "cdpr_struct/statics/distribution_problem.py:search": LEFT + "step and imbalance, which make the status",
    "cdpr_struct/statics/distribution_restarts.py:bettered": "every round ends at an optimum, the better of two",
    "cdpr_struct/statics/hanging_balance.py:balanced_together": LEFT + "imbalance, from which `found` is made",
    "cdpr_struct/statics/hanging_search.py:newton": LEFT + "imbalance, from which `found` is made",
    "cdpr_struct/statics/free_orientation.py:hang_freely": LEFT + "imbalance, from which `found` is made",
    "cdpr_struct/statics/guessed_programs.py:solve_guessed": LEFT + "items go to the safeguarded solver",
    "cdpr_struct/statics/minimum_norm.py:_ascend": LEFT + "numbers of the programs without a solution",
    "cdpr_struct/statics/separating_wrench.py:separation": LEFT + "`proven`",
    "cdpr_struct/statics/sufficient_load.py:sufficient_load": "a ladder made finer; the answer is its safe end",
    "cdpr_struct/statics/tension_winches.py:held_at_frame": LEFT + "pulls_as_held asks again",
    "fem_reference/cable_statics.py:_searched": HALVED,
    "fem_reference/robot_statics.py:_descend": HALVED,
}


def loops(tree: ast.AST) -> Iterator[tuple[str, ast.For, list[ast.stmt]]]:
    """Name of the function, loop, and the statements behind the loop in its function, of every bounded search."""
    for function in ast.walk(tree):
        if isinstance(function, ast.FunctionDef):
            for body in bodies(function):
                for i, node in enumerate(body):
                    if isinstance(node, ast.For) and is_bounded(node) and leaves(node):
                        yield function.name, node, [s for s in function.body if s.lineno > node.lineno] + body[i + 1 :]


def bodies(node: ast.AST) -> Iterator[list[ast.stmt]]:
    """Lists of statements of a function, not of functions in it."""
    for name in ("body", "orelse", "finalbody"):
        part = getattr(node, name, None)
        if isinstance(part, list) and part:
            yield part
            for child in part:
                if not isinstance(child, ast.FunctionDef | ast.ClassDef):
                    yield from bodies(child)


def is_bounded(node: ast.For) -> bool:
    """Whether it goes over range() of a named constant or of a number that is not small."""
    call = node.iter
    if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "range"):
        return False
    parts = [part for argument in call.args for part in ast.walk(argument)]
    constants = [part.id if isinstance(part, ast.Name) else part.attr for part in parts if name_of(part)]
    numbers = [part.value for part in parts if isinstance(part, ast.Constant) and type(part.value) is int]
    limits = any(word.strip("_").isupper() or word in ("limit", "attempts", "halvings", "rounds") for word in constants)
    return limits or any(number > FEW for number in numbers)


def name_of(node: ast.AST) -> str:
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


def leaves(node: ast.For) -> bool:
    """Whether the loop may end before its last round."""

    def inside(statements: list[ast.stmt], own: bool) -> bool:
        for one in statements:
            if isinstance(one, ast.Return) or (own and isinstance(one, ast.Break)):
                return True
            nested = own and not isinstance(one, ast.For | ast.While)
            parts = [part for name in ("body", "orelse", "handlers") for part in getattr(one, name, [])]
            if inside([part for part in parts if isinstance(part, ast.stmt | ast.ExceptHandler)], nested):
                return True
        return False

    return inside(node.body, True)


def is_loud(node: ast.For, behind: list[ast.stmt]) -> bool:
    """Whether the loop has an `else`, or what is behind it raises or asks again."""
    if node.orelse:
        return True
    parts = [part for statement in behind for part in ast.walk(statement)]
    return any(isinstance(part, ast.Raise) or name_of(part).strip("_") in ASKED for part in parts)


@cache
def silent() -> set[str]:
    """File and function of those that are not."""
    found = set()
    for path in FILES:
        text = path.read_text("utf-8")
        for function, node, behind in loops(ast.parse(text)) if " in range(" in text else ():
            if not is_loud(node, behind):
                found.add(f"{path.relative_to(ROOT).as_posix()}:{function}")
    return found


def test_every_search_is_loud_or_defended():
    assert sorted(silent() - DEFENDED.keys()) == []


def test_the_list_names_no_other():
    assert sorted(DEFENDED.keys() - silent()) == []


@pytest.mark.parametrize(
    ("source", "loud"),
    [
        ("for _ in range(_MOST):\n  if x: break", False),
        ("for _ in range(60):\n  if x: break\n return y", False),
        ("for _ in range(MOST):\n  if x: break\n else:\n  raise E", True),
        ("for _ in range(MOST):\n  if x: return 1\n raise E", True),
        ("for _ in range(MOST):\n  if x: break\n return R(y, converged)", True),
    ],
)
def test_a_silent_loop_is_seen(source, loud):
    text = "def f():\n " + source
    ((_, node, behind),) = loops(ast.parse(text))
    assert is_loud(node, behind) is loud


@pytest.mark.parametrize("source", ["for _ in range(_MOST):\n  x()", "for _ in range(2):\n  if x: break"])
def test_a_fixed_count_and_two_tries_are_no_search(source):
    assert not list(loops(ast.parse("def f():\n " + source)))
