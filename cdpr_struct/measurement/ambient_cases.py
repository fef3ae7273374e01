"""Frequencies found in the ambient records of a campaign become robot frequencies of its states, as those of a list."""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.measurement.ambient_choice import AmbientChoice
from cdpr_struct.measurement.ambient_columns import ORIGIN
from cdpr_struct.measurement.ambient_records import AmbientRecord, identified_records
from cdpr_struct.measurement.campaign import NOT_SAID
from cdpr_struct.measurement.campaign_cases import Gathering
from cdpr_struct.measurement.signal_records import records

_OF_A_LIST = (-1, -1)


def join_ambient(gathering: Gathering, choices: Sequence[AmbientChoice]) -> tuple[AmbientRecord, ...]:
    """Identify the modes of all ambient records; those that are no periodic forces join the
    gathered frequencies.

    choices : of each file of ambient records

    Raises
    ------
    InputError : pyOMA-2 is not installed, or a record that cannot be used.
    """
    given = [
        (record, sigmas, choice)
        for (series, sigmas), choice in zip(gathering.ambient, choices, strict=True)
        for record in records(series, gathering.m)
    ]
    found = identified_records(given)
    places = {name: place for place, name in enumerate(gathering.known)}
    for one in found:
        for i in np.flatnonzero(~one.modes.periodic).tolist():
            row = len(gathering.robot_rows)
            gathering.shapes[row] = _platform_shape(one, i)
            gathering.robot_rows.append(
                (places[one.case], float(one.modes.hertz[i]), float(one.sigma[i]), NOT_SAID, NOT_SAID)
            )
    return found


def ambient_notes(found: Sequence[AmbientRecord]) -> tuple[str, ...]:
    """Sentences on records that show no mode, and on periodic forces in them."""
    sines = tuple(
        f"Ambient record {one.case}: {hertz:.4g} Hz is a periodic force, not a mode; it is not used."
        for one in found
        for hertz in one.modes.hertz[one.modes.periodic]
    )
    return sines + tuple(
        f"Ambient record {one.case} adds no frequency: no pole between {one.band[0]:.3g} and {one.band[1]:.3g} Hz is "
        "stable."
        for one in found
        if one.modes.periodic.all()
    )


def _platform_shape(one: AmbientRecord, mode: int) -> np.ndarray:
    """(6,) complex motion of the platform in a mode, nan where no channel of its origin looks."""
    seen = np.full(6, np.nan, dtype=complex)
    for axis, name in enumerate(ORIGIN):
        if name in one.channels:
            seen[axis] = one.modes.shape[mode, one.channels.index(name)]
    return seen
