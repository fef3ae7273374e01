"""Frequency responses filed under each other's case, with the FEM as truth: the exchange is found."""

import numpy as np
import pytest

from cdpr_struct.hypotheses.exchanged import exchanged_records
from cdpr_struct.hypotheses.handled import promising, readings_felt
from cdpr_struct.hypotheses.handling import corrections
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.residuals.recorded import recorded
from tests.crosscheck.frf_campaign import Shaken, fem_campaign

SAYS = "the frequency responses of cases p0 and p2 are exchanged"


@pytest.fixture(scope="module")
def clean(tmp_path_factory) -> Campaign:
    return fem_campaign(tmp_path_factory.mktemp("frf"), Shaken())


def exchanged(campaign: Campaign) -> Campaign:
    return next(one.campaign for one in exchanged_records(campaign) if one.sentence == SAYS)


def promised(campaign: Campaign) -> list[str]:
    data = recorded(campaign)
    return [one.sentence for one in promising(data, corrections(campaign), readings_felt(data))]


def test_the_exchange_is_worth_judging_where_it_happened_and_only_there(clean):
    assert promised(exchanged(clean)) == [SAYS]
    assert promised(clean) == []


def test_an_exchange_undone_is_none(clean):
    again = exchanged(exchanged(clean))
    assert np.array_equal(again.robot_frequencies.state, clean.robot_frequencies.state)
    assert [item.record.case for item in again.identified] == [item.record.case for item in clean.identified]
