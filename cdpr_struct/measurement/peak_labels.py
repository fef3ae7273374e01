"""Which mode somebody says a peak of the robot is: the body that moves most, and its number."""

import re

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import NOT_SAID, PLATFORM
from cdpr_struct.measurement.campaign_rows import Rows

_CABLE = re.compile(r"(?:cable\s*)?(\d+)")


def peak_label(rows: Rows, i: int, cables: int) -> tuple[int, int]:
    """Body and number of the mode of row i of a file of robot frequencies, `NOT_SAID` where nothing is said.

    Raises
    ------
    InputError : a body that the robot does not have, or a number that is none.
    """
    said = rows.words.get("body", [""] * len(rows))[i].strip().lower()
    found, number = _CABLE.fullmatch(said), rows.get("mode")[i]
    if said and said != "platform" and not (found and 1 <= int(found.group(1)) <= cables):
        raise InputError(rows.file, f"{rows.place(i)}, column body", said, f"platform, cable 1 to {cables}, or nothing")
    body = NOT_SAID if not said else int(found.group(1)) - 1 if found else PLATFORM
    if not np.isfinite(number):
        return body, NOT_SAID
    if body != PLATFORM:
        expected = "nothing, or the body platform beside it"
        raise InputError(rows.file, f"{rows.place(i)}, column mode", float(number), expected)
    return body, int(number)
