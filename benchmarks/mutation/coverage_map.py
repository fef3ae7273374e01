"""Which tests run which line, and how long does each take? Measured once by `coverage`, one context for each test."""

import json
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from benchmarks.mutation.mutants import ROOMS, ROOT


@dataclass(frozen=True, slots=True)
class CoverageMap:
    """lines : file, line, tests; seconds : processor time of each test."""

    lines: dict[str, dict[int, list[str]]]
    seconds: dict[str, float] = field(default_factory=dict)

    def tests(self, file: str, line: int) -> list[str]:
        return self.lines.get(file, {}).get(line, [])

    def write(self, path: Path) -> None:
        """As JSON, tests by number."""
        names = sorted({test for lines in self.lines.values() for tests in lines.values() for test in tests})
        number = {name: place for place, name in enumerate(names)}
        lines = {
            file: {line: [number[test] for test in tests] for line, tests in lines.items()}
            for file, lines in self.lines.items()
        }
        path.write_text(json.dumps({"tests": names, "seconds": self.seconds, "lines": lines}))

    def beside(self, other: "CoverageMap") -> "CoverageMap":
        """Both maps in one; where both have a test, the lines of either."""
        lines = {
            file: {
                line: sorted({*self.tests(file, line), *other.tests(file, line)})
                for line in self.lines.get(file, {}).keys() | other.lines.get(file, {}).keys()
            }
            for file in self.lines.keys() | other.lines.keys()
        }
        return CoverageMap(lines, self.seconds | other.seconds)

    @staticmethod
    def read(path: Path) -> "CoverageMap":
        told = json.loads(path.read_text())
        names = told["tests"]
        lines = {
            file: {int(line): [names[place] for place in tests] for line, tests in lines.items()}
            for file, lines in told["lines"].items()
        }
        return CoverageMap(lines, told["seconds"])


class Mapping:
    """A pytest plugin that gives each test a context of its own, set-up and all."""

    def __init__(self, out: Path) -> None:
        import coverage  # an extra that only this needs

        self.out, self.seconds = out, {}
        self.coverage = coverage.Coverage(data_file=None, source=[str(ROOT / folder) for folder in ROOMS.values()])

    def pytest_sessionstart(self) -> None:
        self.coverage.start()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        self.coverage.switch_context(item.nodeid)
        start = time.process_time()
        result = yield
        self.seconds[item.nodeid] = round(time.process_time() - start, 3)
        return result

    def pytest_sessionfinish(self) -> None:
        self.coverage.stop()
        found = mapped(self.coverage.get_data(), self.seconds)
        (CoverageMap.read(self.out).beside(found) if self.out.exists() else found).write(self.out)


def mapped(data: object, seconds: dict[str, float]) -> CoverageMap:
    """From what coverage has measured."""
    lines = {}
    for path in data.measured_files():  # type: ignore[attr-defined]
        contexts = data.contexts_by_lineno(path)  # type: ignore[attr-defined]
        lines[Path(path).resolve().relative_to(ROOT).as_posix()] = {
            line: sorted({name.split("|")[0] for name in names if name}) for line, names in contexts.items()
        }
    return CoverageMap(lines, seconds)
