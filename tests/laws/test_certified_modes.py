"""Certified modes are in order where symmetry makes many of them equal."""

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.dynamics.natural_frequencies import NaturalFrequencies
from tests.symmetric_robots import symmetric_robots


@pytest.mark.parametrize("name", ["radial-8-8", "vertical-6", "mirrored-12"])
def test_equal_frequencies_are_in_order(name):
    robot = next(robot for robot in symmetric_robots() if robot.name == name)
    height = float(robot.frame_anchors[:, 2].max())
    for share in (0.3, 0.5, 0.7):
        pose = cs.Pose(np.array([0.0, 0.0, share * height]), np.zeros(3))
        hertz = cs.modes(robot, pose, count=24).modes.hertz
        assert (np.diff(hertz) >= 0.0).all()
        assert np.isclose(hertz[1:], hertz[:-1], rtol=1e-9).sum() > 6  # symmetry makes many equal


def test_ends_taken_from_neighbours_keep_the_proof():
    true = np.array([1.0, 1.0, 1.0, 2.0])  # numbers 1 to 4; what is below, an exact count would say
    brackets = np.array([[0.0, 1.4], [0.9, 1.1], [0.8, 1.2], [1.7, 2.1]])
    found = NaturalFrequencies.in_brackets(brackets)
    assert (np.diff(found.hertz) >= 0.0).all()
    assert (found.bracket_hertz[:, 0] <= true).all()
    assert (true <= found.bracket_hertz[:, 1]).all()
