"""Lowest frequencies of one pose in few calls: what they are, and what counts as their proof."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics, expand_catenaries_at
from cdpr_struct.dynamics.certified_modes import certified_frequencies, certified_modes, quickly_certified
from cdpr_struct.dynamics.condensed_pose import Pose, condensed_pose
from cdpr_struct.dynamics.many_poses import lowest_frequencies, poses_of
from cdpr_struct.dynamics.natural_frequencies import count_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.pose_frequencies import quick_frequencies
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.errors import UnstableEquilibriumError
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

LEVEL = np.eye(3)
ROBOTS = ("thesis-3-1", "thesis-3-1-8mm", "cogiro", "thesis-5")
PROVED = 1e-9
SAME = 2e-9  # the bracket, and as much for the polynomials
PLACES = np.array([[0.0, 0.0, 0.0], [0.9, -0.7, 0.2], [-1.1, 0.4, -0.2]])


def at_rest(robot, place=PLACES[1]) -> OperatingPoint:
    position = robot.home.position + place
    return OperatingPoint(robot, position, LEVEL, inverse(robot, position, LEVEL).cables)


def extended(**given):
    robot = load_robot("thesis-3-1")
    return replace(robot, extensions=Extensions.of(len(robot.cables), given))


@pytest.mark.parametrize("count", [1, 12, 60])
@pytest.mark.parametrize("name", ROBOTS)
def test_frequencies_are_those_of_many_polynomials(name, count):
    for place in PLACES:
        point = at_rest(load_robot(name), place)
        many = ritz_modes(point, expand_catenaries_at(point, 44), count).omega
        found = quickly_certified(point, count)
        assert found is not None or count > 12
        found = certified_frequencies(point, "exact", count) if found is None else found
        np.testing.assert_allclose(2.0 * np.pi * found.hertz, many, rtol=SAME)


@pytest.mark.parametrize("name", ROBOTS)
def test_the_general_count_encloses_every_frequency(name):
    point = at_rest(load_robot(name))
    found = quickly_certified(point, 24)
    low, high = 2.0 * np.pi * found.bracket_hertz.T
    assert (high - low <= 2.1 * PROVED * low).all()
    cables, number = cable_dynamics(point, "exact", 1.5 * high[-1]), np.arange(1, 25)
    assert (count_below(point, cables, low * (1.0 - SAME)) < number).all()
    assert (count_below(point, cables, high * (1.0 + SAME)) >= number).all()


def test_cables_a_millionth_heavier_are_told_apart():
    robot = load_robot("thesis-3-1")
    heavier = tuple(replace(c, linear_density=(1.0 + 1e-6) * c.linear_density) for c in robot.cables)
    ours, theirs = (quick_frequencies(at_rest(r), 12, PROVED) for r in (robot, replace(robot, cables=heavier)))
    assert np.abs(ours / theirs - 1.0).max() > 10.0 * SAME


def test_what_is_not_so_is_not_proved():
    """A bracket beside its frequency, in the wrong order, or beyond the eliminated motions."""
    point = at_rest(load_robot("thesis-3-1"))
    pose = Pose.of(point, "consistent")
    squared = quick_frequencies(point, 12, PROVED) ** 2
    condensed = condensed_pose(pose, float(squared[[0, -1]].mean()), 12, 2)
    assert condensed.encloses(squared * (1.0 - 1e-8), squared * (1.0 + 1e-8)).all()
    assert not condensed.encloses(squared * (1.0 + 1e-8), squared * (1.0 + 2e-8)).any()
    assert not condensed.encloses(squared * (1.0 - 2e-8), squared * (1.0 - 1e-8)).any()
    missing = squared[1:]
    assert not condensed.encloses(missing * (1.0 - 1e-8), missing * (1.0 + 1e-8)).any()
    far = np.full(1, condensed.shift + 1.1 * condensed.reach)
    assert not condensed.encloses(0.1 * squared[:1], far).any()


@pytest.mark.parametrize("shift", [1.0, 3.0, 5.0])
def test_the_reach_ends_below_every_eliminated_motion(shift):
    """Eliminated motions of nearly uniform strings, two of them kept, begin at nine times the first squared."""
    pose = Pose.of(at_rest(load_robot("thesis-3-1")), "consistent")
    lowest = float(pose.strings.min())
    condensed = condensed_pose(pose, shift * lowest, 12, 2)
    assert 8.5 < (condensed.shift + condensed.reach) / lowest < 9.0
    assert condensed_pose(pose, 9.1 * lowest, 12, 2) is None


def test_the_thesis_assembly_is_another():
    point = at_rest(load_robot("thesis-3-1"))
    ours = certified_frequencies(point, "exact", 8, "thesis").hertz
    np.testing.assert_allclose(ours, certified_modes(point, "exact", 8, "thesis").frequencies.hertz, rtol=SAME)
    assert np.abs(ours / certified_frequencies(point, "exact", 8).hertz - 1.0).max() > 1e-5


REFUSED = {
    "pulleys": lambda: replace(load_robot("thesis-3-1"), pulleys=(Pulley(0.05),) + (None,) * 7),
    "masts": lambda: extended(frame_compliance=2e-5),
    "elasticity in line": lambda: extended(series_compliance=2e-5),
    "bending stiffness": lambda: extended(bending_stiffness=0.3),
    "masses at mid-cable": lambda: extended(added_mass=0.02),
    "an internal mass": lambda: extended(internal_mass=5.0, internal_frequency=6.0),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_it_does_not_know_is_left_to_the_modes(name):
    point = at_rest(REFUSED[name]())
    assert quick_frequencies(point, 3, PROVED) is None
    ours = certified_frequencies(point, "exact", 3).hertz
    assert (ours == certified_modes(point, "exact", 3).frequencies.hertz).all()


def test_other_cable_models_are_left_to_the_modes():
    point = at_rest(load_robot("thesis-3-1"))
    for model in ("static", "dsm"):
        assert (
            certified_frequencies(point, model, 5).hertz == certified_modes(point, model, 5).frequencies.hertz
        ).all()


def test_an_unstable_platform_has_no_frequencies():
    robot = load_robot("thesis-5")
    point = at_rest(robot, PLACES[0])
    falling = replace(robot, platform=replace(robot.platform, center_of_mass=np.array([0.0, 0.0, 20.0])))
    with pytest.raises(UnstableEquilibriumError, match="unstable"):
        certified_frequencies(replace(point, robot=falling), "exact", 3)


def test_a_few_poses_are_those_of_a_batch():
    robot = load_robot("thesis-3-1")
    places = robot.home.position + np.linspace(-0.5, 0.5, 8)[:, None]
    turns = np.broadcast_to(LEVEL, (8, 3, 3))
    cables = inverse(robot, places, turns).cables
    many = OperatingPoint(robot, places, turns, cables)
    few, many = (lowest_frequencies(poses_of(many, np.arange(n)), 12) for n in (3, 8))
    assert few.quick.all()
    np.testing.assert_allclose(few.hertz, many.hertz[:3], rtol=2e-7)
    assert (np.ptp(few.bracket_hertz, axis=-1) < 0.1 * np.ptp(many.bracket_hertz[:3], axis=-1)).all()
