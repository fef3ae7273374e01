"""What a check beside the robot has bounded is no longer free to be anything."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.causes.registry import LIBRARY, causes_for
from cdpr_struct.diagnosis.prepared import BUDGETS, prepare
from cdpr_struct.diagnosis.ranking import Search
from cdpr_struct.diagnosis.selection import select
from cdpr_struct.diagnosis.setting import make_setting
from cdpr_struct.errors import InputError
from tests.laws.crime_campaign import clean_campaign, hidden


def test_a_check_narrows_the_prior_and_never_widens_it():
    campaign = replace(clean_campaign(2), checked={"dead_length": 0.1, "temperature": 99.0, "bending_stiffness": 1e-4})
    causes = {cause.name: cause for cause in causes_for(make_setting(campaign)[0])[0]}
    assert [p.prior for p in causes["dead_length"].parameters] == [0.1]
    assert causes["temperature"].parameters == LIBRARY["temperature"].parameters
    assert causes["bending_stiffness"].parameters[0].prior == pytest.approx(0.01)  # theta is the root
    assert LIBRARY["dead_length"].parameters[0].prior > 1.0


def test_a_check_of_no_cause_is_refused():
    with pytest.raises(InputError, match="dead_lenght"):
        causes_for(make_setting(replace(clean_campaign(2), checked={"dead_lenght": 0.1}))[0])


def test_of_two_causes_that_look_alike_the_one_that_was_not_checked_is_left():
    """A dead length and a compliance in line are the same to the model, until a dial gauge has seen no compliance."""
    campaign = hidden(lambda world: world.plus(series_compliance=np.full(world.cables, 1.2e-5)))
    pair, gains = ("dead_length", "joint_compliance"), {}
    for checked in ({}, {"joint_compliance": 1e-7}):
        prepared = prepare(replace(campaign, checked=checked), BUDGETS["small"])
        ground = replace(prepared.ground, candidates=[c for c in prepared.ground.candidates if c.name in pair])
        fits = {fit.names[0]: fit.gain for fit in select(Search(ground), 6.0, 1).first}
        gains[bool(checked)] = fits["dead_length"] - fits.get("joint_compliance", 0.0)
    assert abs(gains[False]) < 3.0
    assert gains[True] > 10.0
