"""Internal forces that nobody read: off alike in all frames of a motion, each state on its own otherwise."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.residuals.recorded import recorded
from tests.moving_campaigns import filmed


def test_frames_share_one_error_of_the_internal_forces():
    """n frames with a sigma s sqrt(n) each allow a common error d at the price of one with s: d^2 / (2 s^2)."""
    campaign = filmed(1, 24)
    alone = recorded(replace(campaign, states=replace(campaign.states, time=np.full(24, np.nan))))
    frames = recorded(campaign)
    tensions = slice(6, 10)
    assert frames.unread[:, tensions] == pytest.approx(np.sqrt(24.0) * alone.unread[:, tensions])
    assert frames.unread[:, :6] == pytest.approx(alone.unread[:, :6])
    assert frames.unread[:, 10:] == pytest.approx(alone.unread[:, 10:])
