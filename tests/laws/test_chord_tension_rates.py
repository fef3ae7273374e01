"""At a given chord tension the forces over pulleys change as differences say, though the exits from the wheels move."""

import numpy as np
import pytest

import cdpr_struct as cs
from benchmarks.random_robots.drawing import drawn
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.equilibrium import PlatformArms

_STEP = 1e-5  # of the chord tension


@pytest.mark.parametrize("times", [3.0, 10.0, 100.0])  # from deep sag to taut
@pytest.mark.parametrize("seed", [48, 798, 1131])  # wheels of 3 to 20 % of the chord; before, off by 4 to 30 %
def test_forces_over_pulleys_change_with_the_chord_tension_as_differences_say(seed, times):
    case = drawn(seed)
    worst = missed(case.robot, case.pose, times)
    assert worst <= 1e-8  # of differences, measured 3e-10


def missed(robot: cs.Robot, pose: cs.Pose, times: float) -> float:
    """Largest relative error of a cable's force rate at a multiple of its least chord tension."""
    arrays, model = RobotArrays.of(robot).flattened((1,)), cable_model("sagging")
    points = PlatformArms.at(arrays, pose.position[None], pose.rotation[None]).points
    tau = times * model.least_chord_tension(arrays, points)
    held, more, less = (model.hold(arrays, points, tau * f) for f in (1.0, 1.0 + _STEP, 1.0 - _STEP))
    change = (more.states.force_on_platform - less.states.force_on_platform) / (2.0 * _STEP * tau)[..., None]
    error = np.linalg.norm(held.force_rate - change, axis=-1) / np.linalg.norm(change, axis=-1)
    return float(error.max())
