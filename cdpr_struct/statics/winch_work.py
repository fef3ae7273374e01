"""Force, power and work of the winches along a trajectory.

The energy of fig. 5.6 is not defined in the thesis. Of the definitions tried, the one that meets its two printed
numbers and their ratio is the total work of the cable forces, paid for in both directions (no recuperation, no holding
losses):

    E = sum_i integral |T_i| |dl_i|,     T_i tension at the platform, l_i unstrained length.

What a motor sees differs: the tension at the frame, and the length that passes the winch.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.statics.cable_state import CableStates


@dataclass(frozen=True, slots=True, eq=False)
class WinchWork:
    """Along k instants with m cables.

    spent       : (k,) energy of fig. 5.6 up to each instant [J], as defined above
    winch_power : (k, m) mechanical power that each winch gives, > 0 while it reels in against the tension [W]
    driving     : (k,) work of the winches while they drive, up to each instant [J]
    net         : (k,) work given minus work taken back [J]: what the platform and the cables have gained
    """

    spent: np.ndarray
    winch_power: np.ndarray
    driving: np.ndarray
    net: np.ndarray

    @property
    def total(self) -> float:
        """Energy of the whole trajectory [J]."""
        return float(self.spent[-1])

    @property
    def braking(self) -> np.ndarray:
        """(k,) work that the winches take up while braking, up to each instant [J], >= 0."""
        return self.driving - self.net


def winch_work(time: np.ndarray, cables: CableStates) -> WinchWork:
    """Work along a trajectory, by the trapezoidal rule.

    Parameters
    ----------
    time : (k,) [s]
    cables : CableStates (k, m)
    """
    length, platform = cables.total_length, cables.tension_at_platform
    change = np.diff(length, axis=0)
    spent = (0.5 * (platform[1:] + platform[:-1]) * np.abs(change)).sum(axis=1)
    pull = cables.tension_at_frame * (1.0 + cables.tension_at_frame / cables.axial_stiffness)
    given = -0.5 * (pull[1:] + pull[:-1]) * change
    rate = np.gradient(length, time, axis=0) if len(time) > 1 else np.zeros_like(length)
    return WinchWork(
        spent=_summed(spent),
        winch_power=-pull * rate,
        driving=_summed(np.maximum(given, 0.0).sum(axis=1)),
        net=_summed(given.sum(axis=1)),
    )


def _summed(parts: np.ndarray) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(parts)])
