"""Mutants: what is changed, what is drawn, and that a changed function runs under every name it was imported by."""

import ast
from collections import Counter

import numpy as np
import pytest

from benchmarks.mutation.coverage_map import CoverageMap
from benchmarks.mutation.mutants import ROOMS, Mutant, all_changes, changed_tree, drawn, of_room
from benchmarks.mutation.patching import loaded_functions, put_in
from benchmarks.mutation.summary import band, row
from benchmarks.mutation.trying import ordered
from cdpr_struct.inference import posterior
from cdpr_struct.inference.posterior import summed


def told(source: str) -> list[str]:
    """The changes of a source, as text."""
    return [ast.unparse(make()) for _, _, (_, make) in all_changes(ast.parse(source))]


@pytest.mark.parametrize(
    ("body", "changes"),
    [
        ("return a + b", ["a - b"]),
        ("return a < b", ["a <= b", "a >= b"]),
        ("return -a", ["a"]),
        ("a *= 2.0", ["a /= 2.0", "4.0"]),
        ("return np.sin(a)", ["np.cos"]),
        ("return a if b and c else 3", ["a if not (b and c) else 3", "b or c", "4"]),
        ("return f(a, axis=1)", ["f(a)", "2"]),
        ("raise ValueError(f'{a + 1}')", ["pass"]),
        ("'text'\n    f(a)", ["pass"]),
        ("return f'{a + b}'", []),
        ("return zip(a, b, strict=True)", []),
        ("x: int | None = a", []),
    ],
)
def test_changes_of_a_statement(body, changes):
    assert told(f"LIMIT = 3\n\n@cache(2)\ndef f(a: int | str, b=1):\n    {body}\n") == changes


def test_a_sample_is_the_same_for_a_seed_and_each_file_has_its_share():
    sample = drawn("inference", 200, 5)
    assert sample == drawn("inference", 200, 5)
    assert sample != drawn("inference", 200, 6)
    assert len(sample) == len(set(sample)) == 200
    files = {f"{ROOMS['inference']}/{name}": len(found) for name, found in of_room("inference").items()}
    total, found = sum(files.values()), Counter(one.file for one in sample)
    assert all(abs(found[name] - 200 * count / total) < 1.0 for name, count in files.items())


def test_every_mutant_of_a_sample_compiles():
    for mutant in drawn("FEM", 20, 0):
        compile(ast.fix_missing_locations(changed_tree(mutant)), mutant.file, "exec")


def test_a_mutant_runs_under_every_name_and_can_be_taken_out():
    found = next(
        one
        for one in of_room("inference")["posterior.py"]
        if one.before == "log_evidence + weight" and one.function == "summed"
    )
    before = summed.__code__
    try:
        assert put_in(found, loaded_functions()) == 1
        assert summed is posterior.summed
        assert summed(np.array([0.0, -3.0]), np.array([0.0, 1.0])) != pytest.approx(
            right := np.log((1 + np.exp(-2)) / (1 + np.e))
        )
    finally:
        summed.__code__ = before
    assert summed(np.array([0.0, -3.0]), np.array([0.0, 1.0])) == pytest.approx(right)


def test_short_tests_and_those_of_other_functions_come_first():
    seconds = {"f[1]": 0.1, "f[2]": 0.1, "g": 0.2, "slow": 9.0}
    assert ordered(list(seconds), seconds) == ["f[1]", "g", "f[2]", "slow"]


def test_maps_add_up_and_come_back_from_a_file(tmp_path):
    one, other = CoverageMap({"a.py": {1: ["t"]}}, {"t": 1.0}), CoverageMap({"a.py": {1: ["s"], 2: ["s"]}}, {"s": 2.0})
    (both := one.beside(other)).write(tmp_path / "map.json")
    assert CoverageMap.read(tmp_path / "map.json") == both
    assert both == CoverageMap({"a.py": {1: ["s", "t"], 2: ["s"]}}, {"t": 1.0, "s": 2.0})


def test_a_band_is_wilsons_and_equivalent_mutants_do_not_count():
    assert band(8, 10) == pytest.approx((0.4902, 0.9433), abs=1e-4)  # Wilson 1927, by hand
    tried = [
        {"status": status, "key": key} for key, status in enumerate(["killed", "endless", "survived", "uncovered"])
    ]
    assert row("FEM", tried, {2: "why"}).startswith("| FEM | 4 | 2 | 1 | 1 | 67 %")


def test_a_mutant_keeps_its_key_when_lines_move():
    one = Mutant("statics", "a.py", 3, 7, "f", "arithmetic", "a + b", "a - b")
    assert one.key == Mutant("statics", "a.py", 30, 9, "f", "arithmetic", "a + b", "a - b").key
