"""Checks beside the robot: what is measured is entered, whatever was hidden."""

import tomllib

import numpy as np
import pytest

from tests.blind.beside_checks import CHECKED, GAUGE, SURVEY, gauge, survey, thermometer
from tests.blind.case_drawing import CaseKind, can_be_separated
from tests.blind.catalogue import EQUIVALENT
from tests.blind.deviations import Deviations
from tests.blind.entered_robot import entered_robot
from tests.blind.suite import composed


@pytest.fixture(params=["thesis-3-1", "cogiro", "thesis-5", "thesis-5-pulleys"])
def robot(request):
    return entered_robot(request.param)


def test_a_survey_enters_every_frame_anchor_within_its_accuracy(robot):
    off = 0.02 * np.random.default_rng(1).standard_normal(3 * robot.cables)
    deviations = Deviations.none(robot.cables).plus("frame_anchor_position", off)
    done = survey(robot, deviations, np.random.default_rng(2))
    table = tomllib.loads(done.robot_text)
    left = np.array([c["frame_anchor"] for c in table["cables"]]) - robot.frame_anchors - off.reshape(-1, 3)
    assert 0.5 * SURVEY < left.std() < 1.5 * SURVEY
    assert done.left == {"frame_anchor_position": SURVEY}
    assert [c["platform_anchor"] for c in table["cables"]] == robot.platform_anchors.tolist()


@pytest.mark.parametrize("hidden", ["joint_compliance", "dead_length"])
def test_a_gauge_reads_joints_and_not_what_lies_behind_the_exit(robot, hidden):
    size = {"joint_compliance": 1e-5, "dead_length": 4.0}[hidden]
    deviations = Deviations.none(robot.cables).plus(hidden, np.full(robot.cables, size))
    done = gauge(robot, deviations, np.random.default_rng(2))
    seen = np.array(tomllib.loads(done.robot_text)["extensions"]["series_compliance"])
    assert np.abs(seen - deviations["joint_compliance"]).max() < 5.0 * GAUGE
    assert "dead_length" not in done.left


def test_a_thermometer_refuses_what_a_robot_file_cannot_hold(robot):
    exact = Deviations.none(robot.cables)
    assert thermometer(robot, exact, np.random.default_rng(1)).robot_text is None
    with pytest.raises(ValueError, match="off its calibration"):
        thermometer(robot, exact.plus("temperature", np.full(1, 20.0)), np.random.default_rng(1))


def test_every_ambiguous_case_has_a_measurement_that_separates_it():
    kinds = [kind for kind in composed("dev", 200, 5) if kind.kind == "ambiguous"]
    assert {kind.effects[0][0] for kind in kinds} == {*EQUIVALENT}
    assert all(can_be_separated(kind) for kind in kinds)
    assert not can_be_separated(CaseKind("single", ((next(iter(CHECKED)), 4.0),)))
