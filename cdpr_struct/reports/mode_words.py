"""The platform's motion in a mode, in words."""

import numpy as np

from cdpr_struct.robot.robot import MOTIONS

STILL = "nearly still"
WORDS_NOTE = (
    "Platform motion: the directions with most of the platform's own kinetic energy, together seven tenths of it or "
    "more (at most three are named): motion of its centre of mass along the world axes, rotation about them. "
    f"{STILL.capitalize()}: the platform has less than 1 % of the energy of the mode."
)
_STILL, _NAMED, _MOST = 0.01, 0.7, 3


def motion_words(platform_energy: np.ndarray, shares: np.ndarray) -> list[str]:
    """Per mode, like "along z" or "along x and about y".

    platform_energy : (k,) share of the platform in the mode's kinetic energy;  shares : (k, 6) of `direction_shares`
    """
    return [STILL if energy < _STILL else _named(own) for energy, own in zip(platform_energy, shares, strict=True)]


def _named(shares: np.ndarray) -> str:
    order = np.argsort(-shares, kind="stable")
    enough = int(np.searchsorted(np.cumsum(shares[order]), _NAMED)) + 1
    *first, last = [MOTIONS[i] for i in order[: min(enough, _MOST)]]
    return f"{', '.join(first)} and {last}" if first else last
