"""At locked lengths the answer is the pose that continuous motion leads to, and other stable poses are told."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from cdpr_struct.errors import ConvergenceError
from cdpr_struct.robot.pose import Pose, angles_from_rotation
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics import equilibria
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.continuation import continued
from cdpr_struct.statics.equilibrium import rotation_from_vector
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.locked_balance import LockedBalance
from cdpr_struct.statics.locked_rest import locked_rest
from cdpr_struct.statics.potential_energy import potential_energy

COGIRO_LENGTHS = [10.1013, 9.8141, 6.562, 6.1095, 12.6744, 11.9695, 14.4796, 14.6593]
SAGGING = cable_model("sagging")


def degrees(rotation):
    return np.degrees(angles_from_rotation(rotation))


@pytest.mark.parametrize("model", ["sagging", "spring", "ideal"])
def test_no_tumbled_pose_where_the_start_at_the_asked_lengths_tumbles(model):
    robot = load_robot("cogiro")
    found = locked_rest(robot, COGIRO_LENGTHS, model=model)
    assert found.solution.position == pytest.approx([-3.869, 2.913, 0.782], abs=0.03)
    assert degrees(found.solution.rotation) == pytest.approx([5.3, -2.1, -8.6], abs=0.2)
    assert (found.way, found.jumps) == ("continued", 0)


def test_start_chooses_the_tumbled_pose_and_the_upright_one_is_told():
    found = locked_rest(load_robot("cogiro"), COGIRO_LENGTHS, Pose.from_degrees([-3.769, 2.688, 0.983, -22, 68, 73]))
    assert degrees(found.solution.rotation) == pytest.approx([-22.4, 67.8, 72.9], abs=0.1)
    assert found.way == "descended"
    assert found.others.position[0] == pytest.approx([-3.8688, 2.9127, 0.7823], abs=1e-4)
    assert found.others.energy[0] == pytest.approx(-230.4, abs=0.1)


@pytest.mark.parametrize("count", [60, pytest.param(1500, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["cogiro", "thesis-3-1", "thesis-5", "six-cable-4mm", "six-cable-8mm"])
def test_forward_undoes_inverse_from_home(name, count):
    """Measured: all of 3774 held poses of five robots; a start at home alone misses 62."""
    robot, rng = load_robot(name), np.random.default_rng(0)
    span = np.ptp(robot.frame_anchors, axis=0)
    place = robot.home.position + rng.uniform(-0.35, 0.35, (count, 3)) * span * [1.0, 1.0, 0.8]
    turn = Rotation.from_euler("xyz", rng.uniform(-10.0, 10.0, (count, 3)), degrees=True).as_matrix()
    held = inverse(robot, place, turn, allow_unheld=True)
    own = held.held & forward(robot, np.where(held.held[:, None], held.lengths, 10.0), place, turn).stable
    assert own.sum() >= 2
    home = inverse(robot, robot.home.position, robot.home.rotation).lengths
    known = (home, robot.home.position, robot.home.rotation)
    way = continued(RobotArrays.of(robot), known, held.lengths[own], SAGGING, np.zeros(6))
    assert np.linalg.norm(way.position - place[own], axis=-1).max() < 1e-5


def test_far_away_is_reached_in_proportion_to_the_robot():
    """A robot forty times as large, asked 150 m from home."""
    small = load_robot("cogiro")
    large = replace(
        small,
        cables=tuple(replace(c, axial_stiffness=1600.0 * c.axial_stiffness) for c in small.cables),
        frame_anchors=40.0 * small.frame_anchors,
        platform_anchors=40.0 * small.platform_anchors,
        home=Pose(40.0 * small.home.position, np.zeros(3)),
    )
    place = large.home.position + np.array([120.0, -90.0, 20.0])
    lengths = inverse(large, place, np.eye(3)).lengths
    found = locked_rest(large, lengths)
    assert found.solution.position == pytest.approx(place, abs=1e-5)
    assert forward(large, lengths, large.home.position, np.eye(3)).converged


def test_an_equilibrium_that_ends_is_told_as_a_jump():
    """Eight lengths at random fit no pose; cables go slack one by one, and now and then the platform rolls over."""
    robot = load_robot("cogiro")
    arrays, home = RobotArrays.of(robot), robot.home
    begin = inverse(robot, home.position, home.rotation).lengths
    rng = np.random.default_rng(4)
    asked = begin + rng.normal(size=(40, 8)) * 0.6
    way = continued(arrays, (begin, home.position, home.rotation), asked, SAGGING, np.zeros(6))
    assert 1 <= (way.jumps > 0).sum() <= 20  # measured 8
    assert (way.steps >= way.jumps).all()
    assert forward(robot, asked, way.position, way.rotation).stable.all()


def test_neighbours_on_the_way_are_near_each_other():
    """Halving every step of the way changes nothing where no jump was told."""
    robot = load_robot("thesis-3-1")
    home = robot.home
    begin = inverse(robot, home.position, home.rotation).lengths
    place = home.position + np.array([4.1, -3.6, 0.0])
    asked = inverse(robot, place, np.eye(3)).lengths
    position, rotation = home.position, home.rotation
    for share in np.linspace(0.0, 1.0, 101)[1:]:
        near = forward(robot, begin + share * (asked - begin), position, rotation)
        position, rotation = near.position, near.rotation
    found = locked_rest(robot, asked)
    assert found.jumps == 0
    assert found.solution.position == pytest.approx(position, abs=1e-9)


CHANGES = {
    "as entered": {},
    "slack": {"length_scale": np.asarray(1.1)},
    "masts": {"frame_compliance": np.full(8, 5e-5)},
    "pulleys": {"pulley_radius": np.full(8, 0.1)},
    "in line": {"series_compliance": np.full(8, 5e-5)},
    "loads": {
        "hose": np.asarray(100.0), "hose_center": np.ones(3), "force": np.array([1.0, 2.0, 3.0]),
        "tilt": np.array([0.01, 0.02]),
    },
}  # fmt: skip


@pytest.mark.parametrize("model", ["sagging", "spring"])
@pytest.mark.parametrize("case", CHANGES)
def test_wrench_is_the_slope_of_the_energy(case, model):
    robot = load_robot("cogiro")
    arrays, chosen = replace(RobotArrays.of(robot), **CHANGES[case]), cable_model(model)
    reading = inverse(robot, robot.home.position, robot.home.rotation).lengths
    length, step = arrays.paid_out(reading), 1e-5
    place = robot.home.position + np.array([0.03, -0.02, 0.01])
    shift = np.concatenate([step * np.eye(3), np.zeros((3, 3))])
    turns = rotation_from_vector(np.concatenate([np.zeros((3, 3)), step * np.eye(3)]))
    energy = [
        potential_energy(
            arrays, place + sign * shift, turn,
            LockedBalance(arrays, np.tile(length, (6, 1)), np.zeros((6, 6)), chosen).states(place + sign * shift, turn),
            np.zeros(6),
        )
        for sign, turn in ((1.0, turns), (-1.0, np.swapaxes(turns, -1, -2)))
    ]  # fmt: skip
    balance = LockedBalance(arrays, length[None], np.zeros((1, 6)), chosen)
    wrench = balance.evaluate(place[None], np.eye(3)[None]).wrench[0]
    assert (energy[1] - energy[0]) / (2.0 * step) == pytest.approx(wrench, rel=1e-6, abs=1e-6 * np.abs(wrench).max())


def test_tangent_is_the_curvature_of_the_energy_along_the_ways_of_the_descent():
    robot = replace(
        load_robot("cogiro"), platform_anchors=load_robot("cogiro").platform_anchors + np.array([0.3, -0.2, 0.4])
    )
    arrays, chosen = RobotArrays.of(robot), cable_model("sagging")
    length = inverse(load_robot("cogiro"), robot.home.position, robot.home.rotation).lengths
    place, turn, step = robot.home.position + np.array([0.03, -0.02, 0.01]), rotation_from_vector(np.full(3, 0.1)), 1e-3

    def energy(motion):
        balance = LockedBalance(arrays, length[None], np.zeros((1, 6)), chosen)
        there = balance.moved(place[None], turn[None], motion[None])
        return potential_energy(arrays, *there, balance.states(*there), np.zeros(6))[0]

    found = LockedBalance(arrays, length[None], np.zeros((1, 6)), chosen).evaluate(place[None], turn[None])
    assert np.linalg.norm(found.wrench[0, :3]) > 1e3  # far from balance: the ways' own curvature counts
    for motion in np.random.default_rng(1).normal(size=(8, 6)):
        change = energy(step * motion) - 2.0 * energy(np.zeros(6)) + energy(-step * motion)
        # differences of fourth order; without the curvature of the ways 6e-2 of it is missing
        assert change / step**2 == pytest.approx(motion @ found.tangent[0] @ motion, rel=1e-3)


def test_under_a_moment_the_tangent_at_rest_is_the_derivative_of_the_wrench():
    robot = load_robot("six-cable-4mm")
    load = np.array([0.0, 0.0, 0.0, 9.0, 6.0, -8.0])
    length = inverse(robot, robot.home.position, robot.home.rotation).lengths
    rest = locked_rest(robot, length, external_wrench=load).solution
    balance = LockedBalance(RobotArrays.of(robot), np.tile(length, (12, 1)), np.tile(load, (12, 1)), SAGGING)
    step, own = 1e-6, (np.tile(rest.position, (12, 1)), np.tile(rest.rotation, (12, 1, 1)))
    found = balance.evaluate(*balance.moved(*own, step * np.concatenate([np.eye(6), -np.eye(6)])))
    rates = -(found.wrench[:6] - found.wrench[6:]).T / (2.0 * step)
    tangent = balance.evaluate(*own).tangent[0]
    np.testing.assert_allclose(tangent, rates, atol=1e-6 * np.abs(rates).max())
    assert np.abs(tangent - tangent.T).max() > 8.9  # the moment itself, half on both sides: it has no energy


@pytest.mark.slow
def test_the_largest_moment_that_is_held_is_told():
    robot = load_robot("six-cable-4mm")
    length = inverse(robot, robot.home.position, robot.home.rotation).lengths
    found = locked_rest(robot, length, external_wrench=[0.0, 0.0, 0.0, 18.0, 0.0, 0.0])
    assert bool(found.solution.stable)
    assert found.jumps == 0  # rates of motion without the moment's own part find 512
    # a branch that was followed by its arc length turns back at 18.66 N m
    with pytest.raises(ConvergenceError, match=r"under a moment of 30 N m.* beyond 18\.6\d* N m"):
        locked_rest(robot, length, external_wrench=[0.0, 0.0, 0.0, 30.0, 0.0, 0.0])


def test_a_platform_whose_cables_meet_in_a_point_turns_about_it_all_the_way():
    robot = load_robot("cogiro")
    point, hangs = np.array([0.1, 0.05, 0.3]), robot.home.position + np.array([0.0, 0.0, 1.0])
    cables = tuple(replace(cable, axial_stiffness=1e8) for cable in robot.cables)
    robot = replace(robot, platform_anchors=np.tile(point, (8, 1)), cables=cables)
    length = np.linalg.norm(robot.frame_anchors - hangs, axis=1)
    upset = rotation_from_vector(np.array([[0.0, 3.0, 0.0], [2.0, 0.0, 0.0], [0.5, -1.0, 1.0]]))
    found = forward(robot, length, hangs - upset @ point, upset)
    assert found.converged.all()
    down = found.rotation @ (robot.platform.center_of_mass - point)
    np.testing.assert_allclose(down[:, :2], 0.0, atol=1e-6)  # the centre of mass hangs below the point
    assert (down[:, 2] < 0.0).all()
    assert found.iterations.max() < 60  # about the origin, 200 are not enough


def test_equilibria_are_balanced_distinct_and_stable():
    robot = load_robot("cogiro")
    found = locked_rest(robot, inverse(robot, robot.home.position, robot.home.rotation).lengths)
    others = found.others
    assert others.count >= 6  # 64 times as many descents find seven
    assert (others.least_stiffness > 0.0).all()
    again = forward(robot, found.solution.cables.total_length, others.position, others.rotation)
    assert np.linalg.norm(again.position - others.position, axis=-1).max() < 1e-6
    apart = np.linalg.norm(others.rotation[:, None] - others.rotation, axis=(-2, -1)) + np.eye(others.count)
    assert apart.min() > 1e-3
    assert (np.diff(others.energy) >= 0.0).all()


def test_the_slowest_descents_find_no_other_equilibrium(monkeypatch):
    robot = load_robot("thesis-3-1")
    lengths = inverse(robot, robot.home.position, robot.home.rotation).lengths
    usual = locked_rest(robot, lengths, robot.home).others
    monkeypatch.setattr(equilibria, "_SPARED", 0)
    every = locked_rest(robot, lengths, robot.home).others
    assert usual.count == every.count > 0
    np.testing.assert_allclose(usual.energy, every.energy, rtol=1e-6)  # ends of different descents to the same rest


def test_a_platform_balanced_on_a_saddle_is_pushed_off_whatever_its_companions_do():
    # upside down, all turned by 180 degrees: a mass hung from one point balances above it, too
    robot = replace(load_robot("cogiro"), platform_anchors=np.tile([0.0, 0.0, 0.5], (8, 1)))
    held = inverse(robot, robot.home.position, np.eye(3))
    upside_down = np.diag([1.0, -1.0, -1.0])
    place = robot.home.position + np.array([0.0, 0.0, 1.0])  # the anchors stay where they are
    alone = forward(robot, held.lengths, place, upside_down)
    both = forward(robot, held.lengths, np.stack([place, robot.home.position]), np.stack([upside_down, np.eye(3)]))
    assert alone.stable
    assert both.stable.all()
    np.testing.assert_array_equal(both.position[0], alone.position)
    assert alone.rotation[2, 2] > 0.99  # it hangs
