"""Whole diagnoses of campaigns along a motion, made by the referee: late tensions are named, else nothing.

The figures are those of `python -m tests.blind make --set delays`; these are two cases of other seeds.
"""

import pytest

import cdpr_struct as cs
from tests.blind.campaign_files import write_case
from tests.blind.moving_sets import MovingKind, moving_case

pytestmark = pytest.mark.slow


def said(kind: MovingKind, folder):
    case = moving_case(kind, (99, 100))
    file = write_case(case, "c", (99, 100), folder / "campaigns", folder / "sealed")
    return cs.diagnose(file).answer, case.truth


def test_tensions_that_are_late_are_named_with_their_delay(tmp_path):
    answer, truth = said(MovingKind("tensions"), tmp_path)
    assert (answer["verdict"]["status"], answer["verdict"]["causes"]) == ("named", ["sensor_delay"])
    (size,) = answer["candidates"][0]["parameters"].values()
    assert size["value"] == pytest.approx(truth["effects"][0]["total"][0], abs=3.0 * size["sigma"])
    assert size["sigma"] < 0.25 * abs(size["value"])


def test_nothing_is_named_where_nothing_is_late(tmp_path):
    assert said(MovingKind("null"), tmp_path)[0]["verdict"]["status"] == "adequate"
