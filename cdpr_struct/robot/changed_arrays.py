"""Robots as arrays with fields changed by sums and factors."""

from dataclasses import replace

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays


def plus(arrays: RobotArrays, **changes: np.ndarray) -> RobotArrays:
    """The robot with changes added to the named fields; batch axes broadcast."""
    return replace(arrays, **{name: getattr(arrays, name) + change for name, change in changes.items()})


def times(arrays: RobotArrays, **factors: np.ndarray) -> RobotArrays:
    """The robot with the named fields multiplied; batch axes broadcast."""
    return replace(arrays, **{name: getattr(arrays, name) * factor for name, factor in factors.items()})
