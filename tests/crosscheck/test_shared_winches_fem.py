"""Winches that wind several cables: the referee, given lengths that change equally on each, rests where it was said."""

import numpy as np
import pytest

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.home_lengths import with_home_lengths
from cdpr_struct.statics.shared_winches import wound_rest

ROBOT = "examples/robots/paired-ropes/robot.toml"
PLACE = np.array([1.0, 0.5, 1.5])
ELEMENTS = (10, 20, 40)


def fem_pose(robot, change: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the bars come to rest, extrapolated, when each cable is longer than at home by `change` (6,) [m]."""
    lengths = np.array([cable.home_length for cable in robot.cables]) + change
    meshes = [fem.solve_robot(to_fem(robot, lengths), robot.home.position, np.eye(3), n) for n in ELEMENTS]
    return tuple(
        fem.extrapolate(ELEMENTS, np.array([getattr(mesh, part) for mesh in meshes])).limit
        for part in ("position", "rotation")
    )


@pytest.mark.parametrize("radius", [0.0, 0.05])
def test_the_bars_rest_where_the_winches_were_to_bring_the_platform(radius):
    robot = load_robot(ROBOT)
    if radius:
        robot = type(robot)(
            robot.name, robot.platform, robot.cables, robot.platform_anchors, robot.frame_anchors,
            (Pulley(radius),) * 6, home=robot.home,
        )  # fmt: skip
    robot = with_home_lengths(robot)
    found = wound_rest(robot, PLACE[None], np.zeros(3), (True, True, True))
    assert found.hung.found.all()
    paid_out = np.repeat(found.said[0] - robot.winches.home, 2)
    place, turn = fem_pose(robot, paid_out)
    assert np.abs(place - PLACE).max() < 1e-10  # m; measured 4e-13, with pulleys 3e-12: what is left of extrapolation
    assert np.abs(turn - found.hung.rotation[0]).max() < 1e-10  # measured 7e-13 and 1e-12
    assert np.abs(turn - np.eye(3)).max() > 5e-4  # it is turned
    if not radius:  # twin: a millimetre more on one cable of a winch
        other = fem_pose(robot, paid_out + 1e-3 * np.eye(6)[2])
        assert np.abs(other[1] - found.hung.rotation[0]).max() > 1e-4
