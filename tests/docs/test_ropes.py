"""The table of docs/ropes.md is what its formulas and its factors give."""

import math
import re
from pathlib import Path

import pytest

from cdpr_struct.robot.ropes import ROPES as KINDS

PAGE = (Path(__file__).parents[2] / "docs" / "ropes.md").read_text("utf-8")


def rows(after: str) -> dict[str, list[str]]:
    """Cells of the first table after a text, by rope."""
    lines = PAGE[PAGE.index(after) :].splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith("|"))
    table = lines[first : next(n for n in range(first, len(lines)) if not lines[n].startswith("|"))]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in table]
    return {name: rest for name, *rest in cells if not name.startswith("---")}


FACTORS, COMPUTED = rows("lubricant included"), rows("<!-- computed -->")
HEAD = "EA [kN]; rho [kg/m]"
ROPES = [name for name in COMPUTED if name != HEAD]


def test_the_tables_have_the_same_ropes():
    assert list(FACTORS)[1:] == ROPES
    assert len(ROPES) >= 5


@pytest.mark.parametrize("rope", ROPES)
def test_computed_values_follow_from_the_factors(rope):
    fill, lay, density, modulus = map(float, FACTORS[rope][:4])
    low, high = map(float, FACTORS[rope][4].split(" to "))
    assert low <= modulus <= high
    for diameter, cell in zip(COMPUTED[HEAD], COMPUTED[rope], strict=True):
        section = fill * math.pi / 4.0 * float(re.sub(" mm", "", diameter)) ** 2  # mm^2
        stiffness, mass = map(float, cell.split("; "))
        assert stiffness == pytest.approx(section * modulus, rel=5e-3)  # printed with three digits
        assert mass == pytest.approx(section * 1e-6 * density * lay, rel=5e-3)


def test_new_robots_have_the_ropes_of_the_page():
    assert [kind.name for kind in KINDS.values()] == ROPES
    for kind in KINDS.values():
        fill, lay, density, modulus = map(float, FACTORS[kind.name][:4])
        assert (kind.fill, kind.lay, kind.density, kind.modulus) == (fill, lay, density, 1e9 * modulus)
        stiffness, mass = map(float, COMPUTED[kind.name][COMPUTED[HEAD].index("4 mm")].split("; "))
        assert kind.axial_stiffness(0.004) == pytest.approx(1e3 * stiffness, rel=5e-3)
        assert kind.linear_density(0.004) == pytest.approx(mass, rel=5e-3)
