"""Records of vibration filed under each other's case: frequency responses, decays, motions, lists of peaks."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

import numpy as np

from cdpr_struct.hypotheses.correction import Correction
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.signal_states import held_at

_WORDS = {"frf": "frequency responses", "free_decay": "decays", "platform_motion": "motions"}
_OF_LISTS = "robot frequencies"
PAIRS = 500  # of states with robot frequencies: all of 32


def exchanged_records(campaign: Campaign) -> Iterator[Correction]:
    """The robot frequencies of two states, and the records that they come from, exchanged.

    The peaks stay the ones that were used: hypotheses compare on the same data.
    """
    peaks = campaign.robot_frequencies
    for i, j in list(combinations(np.unique(peaks.state).tolist(), 2))[:PAIRS]:
        first, second = peaks.state == i, peaks.state == j
        moved = replace(peaks, state=np.where(first, j, np.where(second, i, peaks.state)))
        names = campaign.states.names[i], campaign.states.names[j]
        identified = _exchanged(campaign.identified, *names)
        new = replace(campaign, robot_frequencies=moved, identified=identified)
        says = f"the {_what(campaign, names)} of cases {names[0]} and {names[1]} are exchanged"
        yield Correction("pose_mismatch", says, new, parameters={"first": i + 1, "second": j + 1})


def _what(campaign: Campaign, names: tuple[str, str]) -> str:
    """What was exchanged, in words."""
    kinds = {item.record.kind for item in campaign.identified if item.record.case in names}
    return _WORDS[kinds.pop()] if len(kinds) == 1 else _OF_LISTS


def _exchanged(identified: tuple[Identified, ...], first: str, second: str) -> tuple[Identified, ...]:
    """Records of two cases held against the model at each other's pose, where each of them has one of a kind."""
    found = list(identified)
    for kind in _WORDS:
        own = [[n for n, item in enumerate(found) if (item.record.kind, item.record.case) == (kind, case)]
               for case in (first, second)]  # fmt: skip
        if len(own[0]) == len(own[1]) == 1:
            (a,), (b,) = own
            found[a], found[b] = held_at(found[a], found[b]), held_at(found[b], found[a])
    return tuple(found)
