"""A pytest plugin that tries mutants: tests are collected once, and each mutant runs its tests in a forked process.

A mutant then costs its tests only, not the seconds in which Python, NumPy and the tests are imported. Processor time is
limited, per test and per mutant, since a change may make a loop endless.
"""

import contextlib
import gc
import importlib
import json
import os
import resource
import signal
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import pytest
from _pytest.runner import runtestprotocol
from hypothesis import Phase, settings

from benchmarks.mutation.coverage_map import CoverageMap
from benchmarks.mutation.mutants import ROOMS, ROOT, Mutant
from benchmarks.mutation.patching import forget_results, loaded_functions, put_in

LONGER, AT_LEAST = 5.0, 3.0  # a test that takes five times as long and three seconds more runs without end
HYPOTHESIS = {"derandomize": True, "database": None, "deadline": None, "phases": (Phase.explicit, Phase.generate)}
MEMORY = 4 * 2**30  # bytes


@dataclass(frozen=True, slots=True)
class Budget:
    """Seconds of processor time for the tests of one mutant; unchanged : put no mutant in, as a check of the driver."""

    seconds: float
    unchanged: bool = False


def ordered(tests: Sequence[str], times: dict[str, float]) -> list[str]:
    """Tests, short ones and those of functions not yet tried first."""
    cost, seen = [], {}
    for test in sorted(tests, key=lambda name: times.get(name, 1.0)):
        function = test.split("[")[0]
        seen[function] = seen.get(function, 0) + 1
        cost.append(((times.get(test, 1.0) + 0.01) * seen[function] ** 2, test))
    return [test for _, test in sorted(cost)]


def import_rooms() -> None:
    """All modules that have mutants."""
    for folder in ROOMS.values():
        package = "cdpr_struct." + Path(folder).name
        for path in (ROOT / folder).glob("[a-z]*.py"):
            importlib.import_module(f"{package}.{path.stem}")


def line_about(told: dict) -> str:
    """What became of a mutant."""
    change = f"{told['before']!r} -> {told['after']!r}"
    return f"{told['status']:9} {told['seconds']:6.1f} s {told['file']}:{told['line']} {change} {told['by']}"


class Trying:
    """Runs the mutants instead of the tests."""

    def __init__(self, mutants: Sequence[Mutant], covered: CoverageMap, budget: Budget, results: Path) -> None:
        self.mutants, self.covered, self.budget, self.results = mutants, covered, budget, results

    def pytest_collection(self) -> None:
        """Examples of property tests are always the same, and none is made smaller."""
        settings.register_profile("mutants", parent=settings(), **HYPOTHESIS)
        settings.load_profile("mutants")

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        items = {item.nodeid: item for item in session.items}
        import_rooms()
        functions = loaded_functions()
        gc.freeze()
        with self.results.open("a") as out:
            for number, mutant in enumerate(self.mutants, 1):
                told = asdict(mutant) | {"key": mutant.key} | self._tried(mutant, items, functions)
                out.write(json.dumps(told) + "\n")
                out.flush()
                print(f"{number}/{len(self.mutants)}", line_about(told), flush=True)
        return True

    def _tried(self, mutant: Mutant, items: dict, functions: dict) -> dict[str, object]:
        tests = [test for test in self.covered.tests(mutant.file, mutant.line) if test in items]
        if not tests:
            return {"status": "uncovered", "by": "", "seconds": 0.0, "run": 0, "tests": 0}
        chosen = ordered(tests, self.covered.seconds)
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(reading)
            with contextlib.suppress(BaseException):
                self._run(mutant, [items[test] for test in chosen], functions, writing)
            os._exit(3)
        os.close(writing)
        with os.fdopen(reading) as pipe:
            lines = pipe.read().splitlines()
        _, status, usage = os.wait4(child, 0)
        return _verdict(lines, status, usage.ru_utime + usage.ru_stime) | {"tests": len(chosen)}

    def _run(self, mutant: Mutant, items: list[pytest.Item], functions: dict, out: int) -> None:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))
        if not self.budget.unchanged and not put_in(mutant, functions):
            os.write(out, b"not put in\n")
            os._exit(0)
        forget_results()
        for item, following in zip(items, [*items[1:], None], strict=True):
            if time.process_time() > self.budget.seconds:
                os.write(out, b"budget\n")
                os._exit(0)
            limit = LONGER * self.covered.seconds.get(item.nodeid, 1.0) + AT_LEAST
            signal.setitimer(signal.ITIMER_PROF, limit)  # its signal ends the process
            os.write(out, f"{item.nodeid}\n".encode())
            if _fails(item, following):
                os.write(out, b"failed\n")
                os._exit(0)
        os.write(out, b"passed\n")
        os._exit(0)


def _fails(item: pytest.Item, following: pytest.Item | None) -> bool:
    reports = runtestprotocol(item, nextitem=following, log=False)
    return any(report.failed for report in reports)


def _verdict(lines: list[str], status: int, seconds: float) -> dict[str, object]:
    """From what the child wrote and how it ended."""
    word = lines[-1] if lines else ""
    run = [line for line in lines if "::" in line]
    told = {"by": "", "seconds": round(seconds, 2), "run": len(run)}
    if word == "not put in":
        return told | {"status": "not tried"}
    if word in {"passed", "budget"}:
        return told | {"status": "survived" if word == "passed" else "budget"}
    if word == "failed":
        return told | {"status": "killed", "by": run[-1]}
    ended = "endless" if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGPROF else "crashed"
    return told | {"status": ended, "by": run[-1] if run else ""}


def tried_keys(results: Path) -> Iterator[tuple[str, int]]:
    """File and number of each mutant that has a result."""
    if results.exists():
        for line in results.read_text().splitlines():
            told = json.loads(line)
            yield told["file"], told["number"]
