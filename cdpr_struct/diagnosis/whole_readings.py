"""The states as this diagnosis can use them: tensions and lengths of all cables or of none, and the whole pose."""

from dataclasses import replace

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import Campaign


def whole_readings(campaign: Campaign) -> Campaign:
    """Tensions and lengths of static states that were read of some cables only are left out in that state.

    Raises
    ------
    InputError : a state whose pose was not measured in full.
    """
    states = campaign.states
    posed = np.isfinite(states.position).all(axis=1) & np.isfinite(states.angles).all(axis=1)
    if not posed.all():
        name = states.names[int(np.flatnonzero(~posed)[0])]
        expected = "position and angles of every state; leave states without them out"
        raise InputError(campaign.source, f"case {name}: pose", "not measured in full", expected)
    some = [
        kind & np.isfinite(v).any(axis=1) & ~np.isfinite(v).all(axis=1)
        for kind, v in ((states.static, states.tension), (states.static | states.loaded, states.length))
    ]
    if not any(flags.any() for flags in some):
        return campaign
    tension, length = (
        np.where(flags[:, None], np.nan, v) for flags, v in zip(some, (states.tension, states.length), strict=True)
    )
    lock = np.where(some[1], -1, states.lock)
    lock[lock >= 0] = np.unique(lock[lock >= 0], return_inverse=True)[1]
    return replace(campaign, states=replace(states, tension=tension, length=length, lock=lock))
