"""Hide an effect, require finding it: the campaigns of the set `ci`, and no wrong name said with confidence.

Of the twelve campaigns (tests/data/README.md) one is diagnosed every day, with an effect just detectable. The others
are slower, and say the same of nothing hidden, of an ambiguous effect, of two effects at once, of one outside the
library, of mistakes in the notes, and of robots with pulleys.
"""

from pathlib import Path

import pytest

from tests.blind.running import default_command, diagnose
from tests.blind.scoring import case_rows, figures, scored_cases

DATA = Path(__file__).parents[1] / "data" / "blind-ci"
SEALED = DATA.with_name("blind-ci-sealed")
NAMES = [f"c{n:03d}" for n in range(1, 13)]
EVERYDAY = {"c001": "single"}


@pytest.mark.parametrize("name", [n if n in EVERYDAY else pytest.param(n, marks=pytest.mark.slow) for n in NAMES])
def test_no_wrong_name_is_said_with_confidence(name, tmp_path):
    diagnose(DATA / "campaigns" / name, tmp_path / name, "small", default_command())
    cases = scored_cases(DATA / "campaigns", tmp_path, SEALED)
    found = figures(cases)
    assert [case.name for case in cases] == [name]
    assert found["failed_runs"]["successes"] == 0, case_rows(cases)
    assert found["wrong_confident_name"]["successes"] == 0, case_rows(cases)
    assert EVERYDAY.get(name, cases[0].kind) == cases[0].kind
