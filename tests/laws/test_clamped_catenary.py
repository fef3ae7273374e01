"""Frequencies of held cables are those of the full expansion, and taut cables need few polynomials for them."""

import numpy as np
import pytest

from cdpr_struct.dynamics.cable_dynamics import expand_catenaries_at, polynomial_order
from cdpr_struct.dynamics.clamped_catenary import clamped_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse


def at_home(name: str) -> OperatingPoint:
    robot = load_robot(name)
    rotation = np.eye(3)
    return OperatingPoint(robot, robot.home.position, rotation, inverse(robot, robot.home.position, rotation).cables)


@pytest.mark.parametrize("name", ["thesis-3-1", "six-cable-8mm"])
def test_frequencies_are_those_of_the_full_expansion(name):
    point = at_home(name)
    in_plane, across = clamped_frequencies(point.cables, point.arrays.linear_density, 30)
    both = np.sort(np.concatenate([in_plane, across], axis=1), axis=1)
    full = np.sqrt(expand_catenaries_at(point, 30).omega_squared)
    np.testing.assert_allclose(both[:, :20], full[:, :20], rtol=1e-11)
    assert (across[:, 0] <= in_plane[:, 0]).all()


@pytest.mark.parametrize("name", ["thesis-3-1", "thesis-3-1-8mm", "cogiro", "thesis-5", "six-cable-4mm"])
@pytest.mark.parametrize("highest", [20.0, 100.0])
def test_few_polynomials_have_ten_digits_of_taut_cables(name, highest):
    point = at_home(name)
    density, order = point.arrays.linear_density, polynomial_order(point, highest)
    few, many = (clamped_frequencies(point.cables, density, n) for n in (order, order + 20))
    for mine, finer in zip(few, many, strict=True):
        wanted = finer[:, : mine.shape[1]] <= highest
        np.testing.assert_allclose(mine[wanted], finer[:, : mine.shape[1]][wanted], rtol=1e-10)
