"""What a fit down-weights is listed, modal constants among it, and shown, and a sigma stated too small is said."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from matplotlib.figure import Figure

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.diagnosis.sensor_sigmas import doubts, noise_of_kinds, noise_of_peaks
from cdpr_struct.diagnosis.set_aside import set_aside
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.reports.figures.diagnose import draw_residuals
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded
from tests.crosscheck.frf_campaign import Shaken, fem_campaign
from tests.laws.written_campaigns import cogiro, noisy, plan_of, written


@cache
def shaken(factor: float = 1.0) -> Campaign:
    """Six poses, the robot's peaks in three of them."""
    return noisy(written(cogiro(), plan_of(cogiro(), 6, robot_in=(0, 1, 2))), 8, factor)


def fitted(campaign: Campaign):
    data = recorded(campaign)
    where = layout(data)
    return data, where, judged(data, where, Hypothesis())


@pytest.mark.parametrize("factor", [2.5, 1.0])
def test_sigmas_stated_too_small_are_said(factor):
    """Of tensions, poses, lengths and peaks that scatter 2.5 times as much; as stated none is."""
    data, _, found = fitted(shaken(factor))
    noise = [*noise_of_kinds(found), *noise_of_peaks(found)]
    said = {one.name for one in doubts(data.campaign, noise) if one.about == "errors" and one.large}
    assert {one.kind for one in noise} == {"position", "rotation", "tension", "length", "robot_frequency"}
    assert ({"tension", "robot_frequency"} <= said) if factor > 1.0 else not said


def test_the_residual_figure_marks_what_was_down_weighted():
    tension = shaken().states.tension.copy()
    tension[2, 3] *= 1.5
    figure = Figure()
    plain = replace(shaken().without_robot_peaks(), states=replace(shaken().states, tension=tension))
    draw_residuals(figure, diagnosed(plain))
    (marks,) = [line for line in figure.axes[0].lines if line.get_label() == "down-weighted reading"]
    assert len(marks.get_xdata()) == 6  # the balance of that state


@pytest.mark.slow
def test_a_modal_constant_that_is_far_off_is_listed(tmp_path):
    campaign = fem_campaign(tmp_path, Shaken())
    item = campaign.identified[1]
    shape = item.modes.shape.copy()
    shape[0, np.abs(shape[0]).argmax()] *= 3.0
    wrong = (replace(item, modes=replace(item.modes, shape=shape)) if k == 1 else one
             for k, one in enumerate(campaign.identified))  # fmt: skip
    rows = set_aside(*fitted(replace(campaign, identified=tuple(wrong))))
    assert ("frf", item.record.case) in {(one.kind, one.case) for one in rows}
    assert any(abs(one.hertz / item.modes.hertz[0] - 1.0) < 1e-6 for one in rows if one.kind == "frf")
