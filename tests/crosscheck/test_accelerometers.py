"""Sizes of FRFs, with the FEM as truth: a wrong gain is found with its value, the right one gives nothing."""

import pytest
from matplotlib.figure import Figure

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.reports.figures.diagnose import draw_residuals
from tests.crosscheck.frf_campaign import Shaken, fem_campaign

GAIN = 1.15


@pytest.mark.slow
def test_a_wrong_gain_is_named_with_its_value(tmp_path):
    said = diagnosed(fem_campaign(tmp_path, Shaken(gain=(GAIN,) * 3)))
    assert said.decision.classes == (("accelerometer_gain",),)
    gain = said.sizes[0].parameters["gain"]
    assert abs(gain["value"] - GAIN) < 1.96 * gain["sigma"]
    assert gain["sigma"] < 0.05
    draw_residuals(Figure(), said)


@pytest.mark.slow
def test_the_right_gain_is_adequate(tmp_path):
    assert diagnosed(fem_campaign(tmp_path, Shaken())).decision.status == "adequate"
