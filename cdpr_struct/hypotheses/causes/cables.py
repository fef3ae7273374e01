"""What a cable is besides stiff."""

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Cause, Parameter, Seen
from cdpr_struct.robot.changed_arrays import plus, times
from cdpr_struct.robot.robot_arrays import RobotArrays


def _density(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return times(arrays, linear_density=np.exp(theta))


def _bending(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, bending_stiffness=theta * np.abs(theta))


def _added(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, added_mass=theta)


def _several_modes(seen: Seen) -> str:
    return "" if seen.cable_modes >= 2 else "needs two or more modes of the same cable"


CAUSES = (
    Cause(
        "cable_linear_density",
        "linear density of the cables",
        (Parameter("linear_density", "ratio", 0.08, True),),
        _density,
        carrier="cable",
        seen_in=("EQ", "CO", "CF", "RF"),
        sentence="the linear density of the cables is {percent} of the entered value",
        separated_by="weighing 5 m of cable",
        extension="linear_density",
    ),
    Cause(
        "bending_stiffness",
        "bending stiffness of the cables",
        (Parameter("bending_stiffness", "N m^2", 0.3, squared=True, positive=True),),
        _bending,
        carrier="cable",
        seen_in=("CF",),
        sentence="the bending stiffness of the cables is {value} N m^2",
        needs=_several_modes,
        separated_by="four or more modes of a short cable",
        extension="bending_stiffness",
    ),
    Cause(
        "cable_added_mass",
        "a sensor or marker on the cables",
        (Parameter("added_mass", "kg", 0.02, positive=True),),
        _added,
        carrier="cable",
        seen_in=("CF",),
        sentence="masses of {value} kg are attached to the cables",
        needs=_several_modes,
        separated_by="moving or removing the sensor",
        extension="added_mass",
    ),
)
