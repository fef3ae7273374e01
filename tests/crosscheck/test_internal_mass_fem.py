"""A part of the platform on an elastic mount against the referee, whose mass slides on a spring of its own."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.fem_reference.eigen_solver import frequencies_hz, lowest_eigenpairs
from cdpr_struct.fem_reference.inner_mass import InnerMassData, with_inner_mass
from cdpr_struct.fem_reference.robot_modes import robot_matrices
from cdpr_struct.generated.platform import rotation
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

MASS, HERTZ, AXIS = 6.0, 7.8, np.array([0.36, 0.48, 0.8])
ELEMENTS, MODES = (10, 20), 16
AGREED = 1e-5  # relative, of the extrapolated FEM


def point() -> OperatingPoint:
    robot, turn = load_robot("cogiro"), rotation(0.08, -0.05, 0.12)
    given = {"internal_mass": MASS, "internal_frequency": HERTZ, "internal_direction": AXIS}
    robot = replace(robot, extensions=Extensions.of(8, given))
    place = robot.home.position + np.array([0.6, -0.4, 0.3])
    return OperatingPoint(robot, place, turn, inverse(robot, place, turn).cables)


def in_fem(mass: float) -> np.ndarray:
    """First frequencies [Hz] of the referee with the mass on its spring, extrapolated with order two."""
    found = []
    for elements in ELEMENTS:
        rest = solve_in_fem(point(), elements)
        inner = InnerMassData(mass, mass * (2.0 * np.pi * HERTZ) ** 2, np.zeros(3), AXIS)
        matrices = with_inner_mass(*robot_matrices(rest), rest.rotation, inner)
        found.append(frequencies_hz(lowest_eigenpairs(*matrices, MODES, -1.0)[0]))
    return found[1] + (found[1] - found[0]) / 3.0


def test_modes_are_the_referees():
    exact = certified_modes(point(), "exact", MODES).frequencies.hertz
    np.testing.assert_allclose(exact, in_fem(MASS), rtol=AGREED)


def test_a_lighter_mass_is_seen():
    """The twin that must fail: 2 % less on the same frequency."""
    exact = certified_modes(point(), "exact", MODES).frequencies.hertz
    with pytest.raises(AssertionError):
        np.testing.assert_allclose(exact, in_fem(0.98 * MASS), rtol=AGREED)
