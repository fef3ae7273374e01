"""Columns of an ambient record: time, pose, and one acceleration a sensor."""

import re
from collections.abc import Sequence

from cdpr_struct.measurement.assumed_angles import ANGLES
from cdpr_struct.measurement.quaternions import QUATERNION

_CHANNEL = re.compile(r"a[xyz]|a[xyz]?_\w+")
_BESIDE = ("case", "time_s", "x_m", "y_m", "z_m", *ANGLES, *QUATERNION, "payload_kg", "temperature_K")
ORIGIN = ("ax", "ay", "az")
"""Channels of the platform's origin in world axes, which show the direction of a mode."""


def ambient_channels(columns: Sequence[str]) -> list[str]:
    """Names of the accelerations: ax, ay, az of the platform's origin, or a_NAME, ax_NAME .. of any other sensor."""
    return [name for name in columns if _CHANNEL.fullmatch(name)]


def ambient_known(columns: Sequence[str]) -> list[str]:
    """Columns that an ambient record may have."""
    return [*_BESIDE, *ORIGIN, *(name for name in ambient_channels(columns) if name not in ORIGIN)]


def ambient_needed(columns: Sequence[str]) -> tuple[str, ...]:
    """Columns that an ambient record must have; what it lacks in place of a channel is said in words."""
    return ("time_s",) if ambient_channels(columns) else ("time_s", "ax, ay, az or a_NAME")
