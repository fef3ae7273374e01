"""The stored campaigns are what the generator makes: two of them every day, all of them with `-m slow`."""

import math
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from tests.blind.__main__ import WHOLE, jobs_of, make_case
from tests.blind.campaign_files import opened_truth

DATA = Path(__file__).parents[1] / "data"
OUT, SEALED = DATA / "blind-ci", DATA / "blind-ci-sealed"
SAME = 1e-6  # relative: nine digits are written, and the referee's equilibria are solved to 1e-9 or better
EVERYDAY = ("c002", "c008")  # the thesis's robot; CoGiRo, with a follow-up
AGAIN = "run: python -m tests.blind make --set ci --out tests/data/blind-ci --again, and review the diff"
JOBS = {job[1]: job for job in jobs_of("ci", "", WHOLE["ci"], OUT, SEALED, again=True)}
NAMES = [name if name in EVERYDAY else pytest.param(name, marks=pytest.mark.slow) for name in JOBS]


def differences(stored: Any, fresh: Any, where: str) -> list[str]:
    """Places at which two nested values differ by more than the last digits of their numbers."""
    if isinstance(stored, dict) and isinstance(fresh, dict) and stored.keys() == fresh.keys():
        return [line for key in stored for line in differences(stored[key], fresh[key], f"{where}.{key}")]
    if isinstance(stored, list) and isinstance(fresh, list) and len(stored) == len(fresh):
        pairs = enumerate(zip(stored, fresh, strict=True))
        return [line for i, (a, b) in pairs for line in differences(a, b, f"{where}[{i}]")]
    if isinstance(stored, float) and isinstance(fresh, float):
        same = math.isclose(stored, fresh, rel_tol=SAME, abs_tol=1e-12) or (math.isnan(stored) and math.isnan(fresh))
        return [] if same else [f"{where}: stored {stored!r}, fresh {fresh!r}"]
    return [] if stored == fresh else [f"{where}: stored {stored!r}, fresh {fresh!r}"]


def content(folder: Path) -> dict[str, Any]:
    """Tables by column and texts of a campaign; its manifest, a hash, is compared by the truth behind it."""
    tables = {path.name: pd.read_csv(path).to_dict("list") for path in sorted(folder.glob("*.csv"))}
    return tables | {path.name: path.read_text("utf-8") for path in sorted(folder.glob("*.toml"))}


@pytest.mark.parametrize("name", NAMES)
def test_a_stored_campaign_is_what_the_generator_makes(name, tmp_path):
    fresh, fresh_sealed = tmp_path / "fresh", tmp_path / "sealed"
    make_case((*JOBS[name][:3], fresh, fresh_sealed))
    made = sorted(path.relative_to(fresh) for path in fresh.rglob(name))
    assert made == sorted(path.relative_to(OUT) for path in OUT.rglob(name))
    for folder in made:
        part = folder.parent.parent
        truth = opened_truth(name, OUT / part / "campaigns", SEALED / part)
        drift = differences(truth, opened_truth(name, fresh / part / "campaigns", fresh_sealed / part), "truth")
        drift += differences(content(OUT / folder), content(fresh / folder), str(folder))
        assert not drift, "\n".join([*drift[:10], AGAIN])


def test_a_changed_number_and_a_missing_row_are_seen(tmp_path):
    """Twin: 1e-5 of one tension, and a table one row shorter."""
    stored = content(OUT / "campaigns" / "c002")
    for change in (lambda t: t.__setitem__(3, t[3] * (1.0 + 1e-5)), lambda t: t.pop()):
        drifted = {key: dict(value) if isinstance(value, dict) else value for key, value in stored.items()}
        tensions = list(stored["static_state.csv"]["tension_N"])
        change(tensions)
        drifted["static_state.csv"]["tension_N"] = tensions
        assert len(differences(stored, drifted, "c002")) == 1
    assert not differences(stored, content(OUT / "campaigns" / "c002"), "c002")


def test_nothing_is_stored_that_the_set_does_not_hold():
    assert {path.name for path in (OUT / "campaigns").iterdir()} == set(JOBS)
    assert {path.stem for path in SEALED.glob("*.json")} == set(JOBS)
