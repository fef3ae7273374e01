"""A frequency response with everything that is needed to read it: the eigenfrequencies in its band."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableDynamics, CableModel, cable_dynamics
from cdpr_struct.dynamics.certified_modes import certified
from cdpr_struct.dynamics.damping import DampingLaw
from cdpr_struct.dynamics.frequency_response import FrequencyResponse, Quantity, frequency_response
from cdpr_struct.dynamics.natural_frequencies import count_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import MODES_OF_A_POINT, CablePort, Port
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly

MOST_MODES = 400


@dataclass(frozen=True, slots=True, eq=False)
class ModesInBand:
    """Undamped eigenfrequencies from zero to the top of a band.

    hertz     : (k,) ascending
    kinds     : k names, as `RitzModes.kinds`
    certified : an exact count proves that none is missing
    complete  : False if there are more than MOST_MODES; the list then ends before the band does
    """

    hertz: np.ndarray
    kinds: list[str]
    certified: bool
    complete: bool


@dataclass(frozen=True, slots=True, eq=False)
class ResponseSweep:
    """Frequency response, the robot it belongs to, and the robot's modes."""

    point: OperatingPoint
    model: CableModel
    response: FrequencyResponse
    modes: ModesInBand


def sweep_response(
    point: OperatingPoint,
    model: CableModel,
    law: DampingLaw,
    excite: Port,
    respond: tuple[Port, ...],
    hertz: np.ndarray,
    quantity: Quantity = "acceleration",
    assembly: Assembly = "consistent",
) -> ResponseSweep:
    """Response over the band (f,) [Hz] and the eigenfrequencies below its top.

    Where a cable itself is shaken its modal sum converges as slowly as 1 / number of modes; so more are taken then.
    """
    margin = MODES_OF_A_POINT if isinstance(excite, CablePort) else 1.0
    cables = cable_dynamics(point, model, margin * 2.0 * np.pi * float(hertz[-1]))
    response = frequency_response(point, cables, law, excite, respond, hertz, quantity, assembly)
    return ResponseSweep(point, model, response, modes_below(point, cables, float(hertz[-1]), assembly))


def modes_below(
    point: OperatingPoint, cables: CableDynamics, highest_hertz: float, assembly: Assembly = "consistent"
) -> ModesInBand:
    """Every eigenfrequency below `highest_hertz`, counted, with its kind."""
    omega = 2.0 * np.pi * highest_hertz
    below = int(count_below(point, cables, np.array([omega]), assembly)[0])
    count = min(below, MOST_MODES)
    if count == 0:
        return ModesInBand(np.zeros(0), [], True, True)
    shapes = ritz_modes(point, cables.expansion(omega), count, assembly)
    found = certified(point, cables, shapes, assembly)
    return ModesInBand(found.hertz, shapes.kinds(), found.certified, count == below)
