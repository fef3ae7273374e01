"""As many modes as a question needs, of which nobody knows beforehand how many these are."""

from collections.abc import Callable

import numpy as np

from cdpr_struct.crosscheck.robot_modes import RobotModes, robot_modes
from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.interface.bands import Banded

_FIRST, _MOST = 20, 320


def enough_modes(
    banded: Banded, model: CableModel, least: int, enough: Callable[[np.ndarray, np.ndarray], bool]
) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (k,) [Hz] above zero and the platform's shares (k,) of the kinetic energy, twice as many each time.

    Massless cables have those of the platform only; there the search ends at the first time.

    least : modes that are needed in any case;  enough : says of both whether more are not needed
    """
    count = max(_FIRST, least)
    while True:
        hertz, energy = _some(banded, model, count)
        if model == "static" or count >= _MOST or enough(hertz, energy):
            return hertz, energy
        count = min(2 * count, _MOST)


def _some(banded: Banded, model: CableModel, count: int) -> tuple[np.ndarray, np.ndarray]:
    most = 6 - len(banded.point.entered.guided) if model == "static" else count
    found: RobotModes = robot_modes(banded.point, model, min(most, count), banded.assembly, 0)
    vibrating = found.hertz > 0.0
    return found.hertz[vibrating], found.platform_energy[vibrating]
