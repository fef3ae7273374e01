"""The model's modes at a measured state: what an identified peak is held against."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.internal_mass import present
from cdpr_struct.dynamics.natural_frequencies import count_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import RitzModes, ritz_modes
from cdpr_struct.errors import CdprError
from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse

_MARGIN, _MOST = 1.35, 60


@dataclass(frozen=True, slots=True, eq=False)
class StateModes:
    """The robot at rest in a measured state, and its modes up to beyond the highest frequency of interest.

    first_frequency : (m,) of the clamped cables [rad/s], infinite without mass
    """

    point: OperatingPoint
    modes: RitzModes
    first_frequency: np.ndarray

    @property
    def hertz(self) -> np.ndarray:
        """(k,) [Hz]."""
        found: np.ndarray = self.modes.omega / (2.0 * np.pi)
        return found


def state_modes(
    robot: Robot, position: np.ndarray, angles: np.ndarray, lengths: np.ndarray, highest: float, model: str
) -> StateModes:
    """Modes of a robot (payload included) at a pose, or at the equilibrium of locked lengths (m,) if they are known.

    highest : [Hz];  model : static, dsm, exact or spring, of the campaign

    Raises
    ------
    CdprError : the pose cannot be held, or is unstable.
    """
    turn = rotation_from_angles(*angles)
    if np.isfinite(lengths).all():
        found = forward(robot, lengths, position, turn).require_converged()
        point = OperatingPoint(robot, found.position, found.rotation, found.cables)
    else:
        point = OperatingPoint(robot, position, turn, inverse(robot, position, turn).cables)
    omega = 2.0 * np.pi * highest * _MARGIN
    name: Literal["static", "exact"] = "static" if model == "static" else "exact"
    cables = cable_dynamics(point, name, omega)
    most = 6 + len(present(point.arrays))
    count = most if name == "static" else int(count_below(point, cables, np.array([omega]), "consistent")[0])
    if count == 0:
        raise CdprError(f"the model has no mode below {highest * _MARGIN:.3g} Hz at this state")
    modes = ritz_modes(point, cables.expansion(omega), min(count, _MOST), "consistent")
    return StateModes(point, modes, cables.first_frequency)
