"""The real robot is computed otherwise than the model that is judged, and each part does what its name says."""

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from tests.blind.bending_masts import FOOT, cantilevers, mast_deflections, mast_motion, mast_springs
from tests.blind.deviations import Deviations, field_sizes
from tests.blind.entered_robot import EnteredRobot, entered_robot
from tests.blind.measuring_plan import Plan, PlanSize, drawn_plan
from tests.blind.observation import Rest
from tests.blind.true_robot import at_rest, true_platform

TINY = PlanSize(static_states=1, locks=1, loads_per_lock=2, frequency_states=1)


def grown(name: str, size: float) -> Deviations:
    return Deviations.none(8).plus(name, np.full(field_sizes(8)[name], size))


def planned(robot: EnteredRobot) -> Plan:
    return drawn_plan(robot, np.random.default_rng(4), size=TINY)


@pytest.mark.parametrize("name", ["cogiro", "thesis-5-pulleys"])
def test_a_dead_piece_of_cable_is_a_joint_of_its_compliance(name):
    """Behind the exit, a rope that only stretches and a spring are one: what keeps the two names together."""
    robot = entered_robot(name)
    command = planned(robot).statics[0]
    joint = 3.0 / robot.axial_stiffness[0]
    dead, spring, none = (
        at_rest(robot, deviations, command, 12)
        for deviations in (grown("dead_length", 3.0), grown("joint_compliance", joint), Deviations.none(8))
    )
    np.testing.assert_allclose(dead.position, spring.position, atol=1e-9)
    assert np.abs(dead.position - none.position).max() > 1e-3


def test_what_is_in_line_sits_behind_the_exit_and_not_in_the_free_length():
    """The stiffness of the free cable stays; it grows by what the line lets out."""
    robot = entered_robot("cogiro")
    command = planned(robot).statics[0]
    rest, give = at_rest(robot, grown("joint_compliance", 2e-5), command, 12), 2e-5
    for cable, paid, stiffness in zip(rest.cables, command.lengths, robot.axial_stiffness, strict=True):
        pull = np.linalg.norm(cable.start_force)
        assert cable.cable.axial_stiffness == stiffness
        let_out = give * pull / (1.0 + pull / stiffness)
        assert cable.cable.unstrained_length == pytest.approx(paid + let_out, abs=1e-6)


def deflected(height: float, force_at: float, top: float) -> float:
    """Deflection at a height of an upright of compliance one at the top, by integrating its curvature twice."""
    z = np.linspace(0.0, height, 20_001)
    curvature = np.maximum(force_at - z, 0.0) * 3.0 / top**3
    return float(cumulative_trapezoid(cumulative_trapezoid(curvature, z, initial=0.0), z)[-1])


@pytest.mark.parametrize(("loaded", "seen"), [(5.0, 5.0), (5.0, 4.0), (4.0, 5.0), (4.0, 4.0)])
def test_masts_bend_as_their_curvature_says(loaded, seen):
    robot = entered_robot("thesis-3-1")  # exits at 5 m and 4 m
    heights = robot.frame_anchors[:, 2]
    pulled = int(np.flatnonzero((robot.masts == 2) & (heights == loaded))[0])
    watched = int(np.flatnonzero((robot.masts == 2) & (heights == seen))[0])
    pulls = np.zeros((8, 3))
    pulls[pulled] = [3.0, -2.0, -7.0]
    moved = mast_deflections(robot, np.full(4, 1e-5), pulls)
    leaning = seen * loaded / 5.0**2  # the foot turns
    share = (1.0 - FOOT) * deflected(seen, loaded, 5.0) + FOOT * leaning
    expected = 1e-5 * share * np.array([3.0, -2.0, 0.0])
    np.testing.assert_allclose(moved[watched], expected, rtol=1e-6, atol=1e-15)
    assert not moved[robot.masts != 2].any()


def test_springs_of_masts_are_the_inverse_of_their_deflections():
    robot, compliance = entered_robot("thesis-3-1"), np.array([1e-5, 0.0, 3e-5, 0.0])
    motion, springs = mast_motion(robot, compliance), mast_springs(robot, compliance)
    pulls = np.random.default_rng(1).standard_normal((8, 3))
    shifts = motion @ np.linalg.solve(springs, np.einsum("mad,ma->d", motion, pulls))
    np.testing.assert_allclose(shifts, mast_deflections(robot, compliance, pulls), atol=1e-18)


def test_an_exit_on_the_floor_stands_still():
    robot = entered_robot("thesis-5")  # lower exits at 0 m
    moved = mast_deflections(robot, np.full(4, 1e-5), np.ones((8, 3)))
    assert moved[robot.frame_anchors[:, 2] > 1.0, :2].all()
    assert not moved[robot.frame_anchors[:, 2] < 1.0].any()
    assert all(len(mast.flexibility) == 1 for mast in cantilevers(robot))


def test_masts_softer_than_their_cables_come_to_rest():
    """Plain repetition drives such masts apart; at rest each exit is where the pulls on it put it."""
    robot, soft = entered_robot("thesis-5"), grown("frame_compliance", 8e-5)
    rest = at_rest(robot, soft, planned(robot).statics[0], 12)
    moved = np.array([cable.nodes[0] for cable in rest.cables]) - robot.frame_anchors
    pulls = -np.array([cable.start_force for cable in rest.cables])
    np.testing.assert_allclose(moved, mast_deflections(robot, soft["frame_compliance"], pulls), atol=1e-9)
    assert np.abs(moved).max() > 1e-3


def test_joints_are_bodies():
    robot = entered_robot("cogiro")
    with_joints, without = (
        true_platform(robot, d, 0.0, np.eye(3)) for d in (grown("joint_mass", 0.5), grown("joint_mass", 0))
    )
    arms = robot.platform_anchors - with_joints.center_of_mass
    away = robot.center_of_mass - with_joints.center_of_mass
    points = 0.5 * (np.sum(arms**2) * np.eye(3) - arms.T @ arms)
    points += robot.mass * (away @ away * np.eye(3) - np.outer(away, away))
    own = with_joints.inertia - without.inertia - points
    np.testing.assert_allclose(own, 8 * 0.4 * 0.5 * 0.03**2 * np.eye(3), atol=1e-9)


def test_friction_turns_with_the_hanging_cable():
    """The exit angle is that of the pull there, which sag makes steeper than the straight line to the platform."""
    robot = entered_robot("cogiro")
    seen = at_rest(robot, Deviations.none(8), planned(robot).statics[0], 24)
    rest = Rest.of(seen)
    straight = seen.position + seen.arms - robot.frame_anchors
    straight_angle = np.arccos(straight[:, 2] / np.linalg.norm(straight, axis=1))
    fine = Rest.of(at_rest(robot, Deviations.none(8), planned(robot).statics[0], 96))
    assert (rest.exit_angles > straight_angle + 1e-3).all()
    np.testing.assert_allclose(rest.exit_angles, fine.exit_angles, atol=2e-5)
