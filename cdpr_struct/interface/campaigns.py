"""Measuring campaigns, given as such or as files, and the causes that a diagnosis knows."""

import os
from collections.abc import Mapping
from typing import Any

from cdpr_struct.errors import InputError
from cdpr_struct.hypotheses.causes.cause import Cause
from cdpr_struct.hypotheses.causes.library import LIBRARY, installed
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import read_bounds, require_file
from cdpr_struct.interface.given import CampaignLike
from cdpr_struct.interface.vibration_model import dropped_by
from cdpr_struct.measurement import campaign_file
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.reports.trust import Trust


def read_campaign(
    given: CampaignLike, lower_bound: float | None, upper_bound: float | None, planned: bool = False
) -> Campaign:
    """The campaign; bounds of cable force [N] replace those of its robot while it is read from its file.

    planned : a template that is not filled stands for what it predicts

    Raises
    ------
    InputError : no such file, an unusable one, or bounds for a campaign that was read already.
    """
    bounds = read_bounds(lower_bound, upper_bound)
    if not isinstance(given, Campaign):
        require_file(given)
        return campaign_file.load_campaign(os.fspath(given), *bounds, planned)
    for name, value in zip(("lower_bound", "upper_bound"), bounds, strict=True):
        if value is not None:
            raise InputError(name, "", value, "a campaign that was read has its bounds: give them to load_campaign")
    return given


_VIBRATING = ("cable_frequency", "robot_frequency", "frf", "free_decay")


def with_dropped(told: Mapping[str, Any], campaign: Campaign) -> dict[str, Any]:
    """The result of a campaign; its `trust` says, too, what the model under test leaves out of vibrating cables."""
    more = dropped_by(campaign.model, campaign.robot) if set(campaign.kinds()).intersection(_VIBRATING) else []
    return {**told, "trust": Trust((*told.get("trust", Trust()).checks, *more))}


@answered
def load_campaign(
    path: str | os.PathLike[str], lower_bound: float | None = None, upper_bound: float | None = None
) -> Campaign:
    """Read a campaign file and the data files it names, all checked.

    Parameters
    ----------
    path : of the campaign file
    lower_bound, upper_bound : of the cable forces [N]; default: those of the robot file

    Raises
    ------
    InputError : no such file, or an unusable one.
    """
    return read_campaign(path, lower_bound, upper_bound)


def causes() -> dict[str, Cause]:
    """List the causes that a diagnosis looks for, by name, those of installed packages among them."""
    installed()
    return dict(LIBRARY)
