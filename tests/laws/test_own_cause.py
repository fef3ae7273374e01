"""The cause of one's own in the docs, run as printed, on readings of a robot that has it (crime=True)."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.reports.diagnose.result import result_json
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.written_campaigns import noisy, plan_of, written

PAGE = Path(__file__).parents[2] / "docs" / "own_cause.md"
WARMER = 40.0  # [K]


@pytest.fixture
def own():
    """The names that the printed script defines; its cause is taken out of the library again."""
    before, names = dict(LIBRARY), {"__name__": "own_cause"}
    page = PAGE.read_text("utf-8")
    exec(re.search(r"```python\n(.*?)```", page, re.S)[1], names)
    yield names
    LIBRARY.clear()
    LIBRARY.update(before)


def warmed(kelvin: float, expansion: float):
    """The frame was entered as it was when cold."""
    robot = load_robot("cogiro")
    cold = replace(robot, frame_anchors=robot.frame_anchors / (1.0 + expansion * kelvin))
    return noisy(written(robot, plan_of(robot, 8), cold), 5)


def test_the_printed_cause_is_found_with_its_size(own):
    found = diagnosed(warmed(2.0 * WARMER, own["ALUMINIUM"]))
    assert found.decision.classes == (("warm_frame",),)
    assert "the frame is warmer by" in result_json(found)["verdict"]["sentence"].lower()
    (size,) = found.sizes
    assert abs(size.mean[0] - 2.0 * WARMER) < 3.0 * size.sigma[0]


def test_it_is_not_found_where_it_is_not(own):
    assert diagnosed(warmed(0.0, own["ALUMINIUM"])).decision.status == "adequate"
