"""Versions that are said to be supported are those that were measured and locked."""

import re
import tomllib
from pathlib import Path

from tests.verification.figures import table

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
REQUIREMENT = re.compile(r"([\w.-]+)(?:\[[\w,]+\])?(?:>=([\w.]+))?$")


def bounds() -> dict[str, str]:
    """Lower bounds of all direct dependencies that have one, by their name in lower case."""
    extras = PROJECT["optional-dependencies"].values()
    parts = [REQUIREMENT.match(line).groups() for line in (*PROJECT["dependencies"], *(x for e in extras for x in e))]
    return {name.lower(): bound for name, bound in parts if bound}


def release(version: str) -> tuple[int, ...]:
    """Numbers of a version, with zeros at its end."""
    return (*(int(part) for part in version.split(".")), 0, 0, 0)


def below_or_above(lock: str) -> dict[str, tuple[str, str]]:
    """Direct dependencies of which the lock has another version than the bound, as far as the bound is written."""
    locked = dict(line.split("==") for line in lock.splitlines() if "==" in line and not line.startswith("#"))
    found = {name: (bound, locked.get(name, "0")) for name, bound in bounds().items()}
    digits = {name: bound.count(".") + 1 for name, (bound, _) in found.items()}
    return {n: pair for n, pair in found.items() if len({release(v)[: digits[n]] for v in pair}) > 1}


def test_the_lock_of_lowest_versions_says_what_pyproject_says():
    """A bound may have fewer digits than the lowest version that there is: openseespy>=3.7 is 3.7.0.1."""
    lock = (ROOT / ".ci" / "lowest.txt").read_text("utf-8")
    assert below_or_above(lock) == {}
    assert below_or_above(lock.replace("numpy==2.0.0", "numpy==2.1.0")) == {"numpy": ("2.0", "2.1.0")}
    assert set(below_or_above("")) == set(bounds())


def test_classifiers_are_the_versions_on_the_page():
    versions = {row[0] for row in table("install.md", "Python", "packages")}
    said = {line.rpartition(" ")[2] for line in PROJECT["classifiers"] if "Python :: 3." in line}
    assert {".".join(version.split(".")[:2]) for version in versions} == said
    assert PROJECT["requires-python"] == f">={min(said, key=release)}"
