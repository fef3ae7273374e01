"""The independent referee: a finite-element model of cables and cable robots made of two-node bars.

Plain arrays, SI units, z up. Imports NumPy and SciPy only and shares no formula with what it judges.
"""

from cdpr_struct.fem_reference.ambient_motion import ambient_record
from cdpr_struct.fem_reference.cable import CableData, CableEquilibrium
from cdpr_struct.fem_reference.cable_damping import damping_rates
from cdpr_struct.fem_reference.cable_modes import CableModes, cable_count_below, cable_modes, end_dynamic_stiffness
from cdpr_struct.fem_reference.cable_statics import solve_cable
from cdpr_struct.fem_reference.errors import (
    CableNotConvergedError,
    CompressedBarError,
    FemError,
    FoldedCableError,
    MastsNotSettledError,
    MissedModesError,
    PulleysNotSettledError,
    RobotNotConvergedError,
    StepNotConvergedError,
    UndefinedSwivelError,
    UnstableEquilibriumError,
    WindNotSettledError,
)
from cdpr_struct.fem_reference.extrapolation import Extrapolation, extrapolate
from cdpr_struct.fem_reference.frequency_response import frequency_response
from cdpr_struct.fem_reference.masts import carrying_beam
from cdpr_struct.fem_reference.motion_problem import TimeHistory
from cdpr_struct.fem_reference.pulley import PulleyData, Wrap
from cdpr_struct.fem_reference.rigid_platform import PlatformData
from cdpr_struct.fem_reference.robot import PointForce, RobotData, RobotEquilibrium
from cdpr_struct.fem_reference.robot_dynamics import count_below, neutral_freedoms, platform_dynamic_stiffness
from cdpr_struct.fem_reference.robot_modes import RobotModes, robot_modes
from cdpr_struct.fem_reference.robot_statics import solve_robot
from cdpr_struct.fem_reference.surroundings import SurroundingsData
from cdpr_struct.fem_reference.time_integration import integrate

__all__ = [
    "CableData",
    "CableEquilibrium",
    "CableModes",
    "CableNotConvergedError",
    "CompressedBarError",
    "Extrapolation",
    "FemError",
    "FoldedCableError",
    "MastsNotSettledError",
    "MissedModesError",
    "PlatformData",
    "PointForce",
    "PulleyData",
    "PulleysNotSettledError",
    "RobotData",
    "RobotEquilibrium",
    "RobotModes",
    "RobotNotConvergedError",
    "StepNotConvergedError",
    "SurroundingsData",
    "TimeHistory",
    "UndefinedSwivelError",
    "UnstableEquilibriumError",
    "WindNotSettledError",
    "Wrap",
    "ambient_record",
    "cable_count_below",
    "cable_modes",
    "carrying_beam",
    "count_below",
    "damping_rates",
    "end_dynamic_stiffness",
    "extrapolate",
    "frequency_response",
    "integrate",
    "neutral_freedoms",
    "platform_dynamic_stiffness",
    "robot_modes",
    "solve_cable",
    "solve_robot",
]
