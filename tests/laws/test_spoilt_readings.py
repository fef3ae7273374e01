"""Readings that are wrong without any cause in the robot: dead cells, digits too many, laws of cells (crime=True)."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.written_campaigns import noisy, plan_of, written


@cache
def sound() -> Campaign:
    robot = load_robot("cogiro")
    return noisy(written(robot, plan_of(robot, 6)), 8)


def reading(tension: np.ndarray) -> Campaign:
    return replace(sound(), states=replace(sound().states, tension=tension))


DEAD = pytest.mark.xfail(strict=True, reason="set aside, but a cable without tension leaves the point of linearisation")


THOUSANDS = pytest.mark.xfail(reason="an error of thousands of sigmas exceeds the widest noise: rounding decides")


@pytest.mark.parametrize("share", [pytest.param(1e-3, marks=DEAD), 3.0, pytest.param(1000.0, marks=THOUSANDS)], ids=str)
def test_a_tension_that_cannot_be_is_told_and_nothing_else(share):
    """A dead cell, a cell of another range, kN for N."""
    tension = sound().states.tension.copy()
    tension[2, 3] *= share
    said = diagnosed(reading(tension))
    assert said.decision.status == "adequate"
    assert [(one.kind, one.case, one.cable) for one in said.set_aside] == [("tension", "s2", 3)]


def test_a_cell_that_is_off_in_all_states_is_no_wrong_reading():
    said = diagnosed(reading(sound().states.tension + np.eye(8)[3] * 30.0))
    assert not said.set_aside
    assert {"load_cell_bias", "load_cell_gain"} & {name for names in said.decision.classes for name in names}


def test_a_cell_that_is_not_linear_is_not_told_as_gain_and_zero():
    tension = sound().states.tension
    said = diagnosed(reading(tension + 15.0 * (tension / 300.0) ** 2))
    assert said.decision.status == "unknown"
    assert "an error of the load cells" in said.outside[0]
