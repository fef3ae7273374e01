"""Winches that hold the tension of their cable: the referee's first bar that slides, the product's free frame end."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse

ELEMENTS = (20, 40, 80)
MODES = 14
PLACE = np.array([0.5, -1.0, 0.8])


def thesis(tensions: tuple[float, float] = (250.0, 200.0), **extensions: float) -> Robot:
    robot, held = load_robot("thesis-3-1"), dict(zip((1, 4), tensions, strict=True))
    cables = tuple(replace(c, winch_tension=held.get(i, 0.0)) for i, c in enumerate(robot.cables))
    return replace(robot, cables=cables, extensions=Extensions.of(8, extensions))


def at_rest(robot: Robot) -> tuple[OperatingPoint, np.ndarray]:
    """Where the robot comes to rest at lengths of another pose's tensions, and these lengths."""
    given = inverse(load_robot("thesis-3-1"), PLACE, np.eye(3), lower_bound=100.0).lengths
    found = forward(robot, given, PLACE, np.eye(3))
    assert found.stable
    return OperatingPoint(robot, found.position, found.rotation, found.cables), given


@pytest.mark.parametrize("extensions", [{}, {"frame_compliance": 1e-5}, {"series_compliance": 2e-5}])
def test_both_rest_and_vibrate_alike(extensions):
    robot = thesis(**extensions)
    point, given = at_rest(robot)
    bars = to_fem(robot, robot_paid_out(given))
    meshes = [fem.solve_robot(bars, PLACE, np.eye(3), n) for n in ELEMENTS]
    place = fem.extrapolate(ELEMENTS, np.array([mesh.position for mesh in meshes])).limit
    hertz = fem.extrapolate(ELEMENTS, np.array([fem.robot_modes(mesh, MODES).frequencies_hz for mesh in meshes])).limit
    found = certified_modes(point, "exact", MODES).frequencies
    assert found.certified
    assert np.abs(place - point.position).max() < 1e-8  # m
    assert np.abs(found.hertz / hertz - 1.0).max() < 1e-6
    other = certified_modes(at_rest(thesis((260.0, 200.0), **extensions))[0], "exact", MODES).frequencies  # twin
    assert np.abs(other.hertz / hertz - 1.0).max() > 1e-3


def robot_paid_out(given: np.ndarray) -> np.ndarray:
    """The lengths handed to the referee: its first guess of winches that hold a tension is 0.1 m too short."""
    return given - np.where(np.isin(np.arange(8), (1, 4)), 0.1, 0.0)


def test_locked_lengths_with_the_same_tensions_vibrate_otherwise():
    """At the same rest, a winch that holds its length makes the robot stiffer: no mode is lower, some are higher."""
    point, _ = at_rest(thesis())
    locked = OperatingPoint(load_robot("thesis-3-1"), point.position, point.rotation, point.cables)
    free, held = (certified_modes(p, "exact", 60).frequencies.hertz for p in (point, locked))
    assert (held >= free * (1.0 - 1e-9)).all()
    assert (held / free).max() > 1.05


def test_the_fem_by_its_name_agrees_over_the_interface():
    exact, bars = (cs.modes(thesis(), PLACE.tolist(), model=m, count=10, elements=40) for m in ("exact", "fem"))
    ratio = np.asarray(bars.answer["frequencies_hz"]) / np.asarray(exact.answer["frequencies_hz"])
    assert 1e-6 < np.abs(ratio - 1.0).max() < 4e-4  # of 40 bars


def test_the_referee_says_that_it_has_no_pulley_for_such_a_winch():
    robot = replace(thesis(), pulleys=(Pulley(0.1),) * 8)
    with pytest.raises(CdprError, match="cable 2"):
        to_fem(robot, np.full(8, 10.0))
    with pytest.raises(ValueError, match="use solve_robot"):
        fem.solve_cable(fem.CableData(10.0, 2e5, 0.06, winch_tension=100.0), np.zeros(3), np.ones(3), 10)
