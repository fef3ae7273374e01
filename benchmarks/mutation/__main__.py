"""Map the tests, try mutants, and print scores. `python -m benchmarks.mutation -h` explains the options."""

import argparse
import os
import sys
from pathlib import Path

import pytest

from benchmarks.mutation.coverage_map import CoverageMap, Mapping
from benchmarks.mutation.mutants import ROOMS, Mutant, drawn, of_room
from benchmarks.mutation.summary import SURVIVED, results, survivors, table
from benchmarks.mutation.trying import Budget, Trying, tried_keys

PYTEST = (
    *("-q", "-s", "-W", "ignore::pytest.PytestAssertRewriteWarning"),
    *("-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:faulthandler"),
)


def parser() -> argparse.ArgumentParser:
    top = argparse.ArgumentParser(prog="python -m benchmarks.mutation", description=__doc__)
    parts = top.add_subparsers(dest="task", required=True)
    for name, said in (("map", "which test runs which line"), ("run", "try mutants"), ("table", "scores")):
        part = parts.add_parser(name, help=said)
        part.add_argument(
            "--map", type=Path, default=Path("results/mutation/map.json"), help="file of the coverage map"
        )
        if name == "map":
            part.add_argument("tests", nargs="+", help="folders or files of tests")
            continue
        part.add_argument("--seed", type=int, default=1, help="of the sample")
        part.add_argument("--out", type=Path, help="results, one line of JSON each (results/mutation/seed-N.jsonl)")
        if name == "run":
            part.add_argument("--each", type=int, default=100, help="mutants of each room")
            part.add_argument("--rooms", nargs="+", choices=ROOMS, default=list(ROOMS))
            part.add_argument("--budget", type=float, default=30.0, help="processor seconds of tests for one mutant")
            part.add_argument("--again", type=Path, help="try the survivors of these results instead of a sample")
            part.add_argument("--unchanged", action="store_true", help="change nothing: every test must pass")
    return top


def sample(given: argparse.Namespace) -> list[Mutant]:
    """The mutants to try that have no result yet, rooms in turn."""
    if given.again is None:
        rooms = [drawn(room, given.each, given.seed) for room in given.rooms]
        turns = [room[place] for place in range(given.each) for room in rooms if place < len(room)]
    else:
        left = {one["key"] for one in results(given.again) if one["status"] in SURVIVED}
        turns = [one for room in given.rooms for file in of_room(room).values() for one in file if one.key in left]
    done = set(tried_keys(given.out))
    return [mutant for mutant in turns if (mutant.file, mutant.number) not in done]


def run(given: argparse.Namespace) -> int:
    mutants, covered = sample(given), CoverageMap.read(given.map)
    if not mutants:
        print("every mutant of the sample has a result")
        return 0
    tests = {test for mutant in mutants for test in covered.tests(mutant.file, mutant.line)}
    files = sorted({test.split("::")[0] for test in tests})
    budget = Budget(given.budget, given.unchanged)
    return int(pytest.main([*PYTEST, *files], plugins=[Trying(mutants, covered, budget, given.out)]))


def main() -> int:
    given = parser().parse_args()
    os.environ["OMP_NUM_THREADS"] = "1"
    given.map.parent.mkdir(parents=True, exist_ok=True)
    if given.task == "map":
        return int(pytest.main([*PYTEST, *given.tests], plugins=[Mapping(given.map)]))
    given.out = given.out or given.map.with_name(f"seed-{given.seed}.jsonl")
    if given.task == "table":
        print(table(results(given.out)), survivors(results(given.out)), sep="\n\n")
        return 0
    return run(given)


if __name__ == "__main__":
    sys.exit(main())
