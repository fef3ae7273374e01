"""What hangs on the cables."""

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Cause, Parameter
from cdpr_struct.robot.robot_arrays import RobotArrays, plus, times

_XYZ = ("x", "y", "z")


def _mass(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return times(arrays, mass=np.exp(theta[..., 0]))


def _joint(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return arrays.with_point_masses(theta, arrays.platform_anchors)


def _center(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, center_of_mass=theta)


def _inertia(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    half = np.exp(0.5 * theta)
    return times(arrays, inertia=half[..., :, None] * half[..., None, :])


def _force(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, force=theta)


def _hose(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """Stiffness about the campaign's mean position, and the force there: nobody knows where a hose is at rest."""
    return plus(arrays, hose=theta[..., 0], force=theta[..., 1:])


CAUSES = (
    Cause(
        "platform_mass",
        "mass of the platform",
        (Parameter("platform_mass", "ratio", 0.05, True),),
        _mass,
        seen_in=("EQ", "RF"),
        sentence="the platform mass is {percent} of the entered value",
        separated_by="weighing it; a payload series",
        extension="mass",
    ),
    Cause(
        "joint_mass",
        "mass of joints, rings and shackles at the platform anchors",
        (Parameter("joint_mass", "kg", 0.2, positive=True),),
        _joint,
        carrier="cable",
        seen_in=("EQ", "RF"),
        sentence="joints at the platform anchors weigh {value} kg each",
        separated_by="weighing a joint; rotational frequencies",
        extension="joint_mass",
    ),
    Cause(
        "center_of_mass",
        "centre of mass of the platform",
        tuple(Parameter(f"center_of_mass_{a}", "m", 0.015) for a in _XYZ),
        _center,
        seen_in=("EQ", "RF"),
        sentence="the centre of mass of the platform is off by {norm} m",
        separated_by="tilted poses",
        extension="center_of_mass",
    ),
    Cause(
        "platform_inertia",
        "inertia of the platform",
        (Parameter("inertia", "ratio", 0.2, True),),
        _inertia,
        carrier="axis",
        seen_in=("RF",),
        sentence="the platform inertia is {percent} of the entered value",
        separated_by="rotational frequencies; a bifilar pendulum",
        extension="inertia",
    ),
    Cause(
        "external_force",
        "a constant force on the platform",
        tuple(Parameter(f"force_{a}", "N", 10.0) for a in _XYZ),
        _force,
        seen_in=("EQ",),
        sentence="a constant force of {norm} N acts on the platform",
        separated_by="a payload series; removing hoses and wires",
        extension="force",
    ),
    Cause(
        "hose_stiffness",
        "stiffness of a hose or energy chain on the platform",
        (
            Parameter("hose_stiffness", "N/m", 20.0, positive=True),
            *(Parameter(f"hose_force_{a}", "N", 10.0) for a in _XYZ),
        ),
        _hose,
        seen_in=("EQ", "RF"),
        sentence="a hose or energy chain acts on the platform with a stiffness of {value} N/m",
        separated_by="removing the hose; poses farther apart",
        extension="hose",
        becomes=("external_force",),
    ),
)
