"""Lower bounds say what they promise: by the exact lowest frequency of every cable."""

import dataclasses

import numpy as np
import pytest

from benchmarks.random_robots.drawing import drawn
from cdpr_struct.dynamics.catenary_expansion import expand_catenaries
from cdpr_struct.dynamics.fundamental_frequency import fundamental_frequency
from cdpr_struct.dynamics.trajectory_distribution import THESIS_B, distribute_along
from cdpr_struct.errors import UnholdablePoseError
from cdpr_struct.generated.tension_bound import lower_bound_frequency, lower_bound_printed
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_state import CableStates, cable_stiffness
from cdpr_struct.statics.lost_cables import lost
from cdpr_struct.statics.tension_bound import chord_tension_at, constant, floor_at
from cdpr_struct.statics.tension_distribution import holding_problem
from cdpr_struct.statics.trajectory import helix

ROBOT = load_robot("thesis-5")


@pytest.fixture(scope="module")
def found():
    return {rule: distribute_along(ROBOT, helix(61), rule) for rule in ("fixed", "pose-dependent", "frequency")}


def test_frequency_bound_keeps_its_promise(found):
    r = found["frequency"]
    assert not r.missed.any()
    assert r.frequency.min() / THESIS_B - 1.0 < 1e-6
    tight = r.distribution.at_lower
    assert tight.any()
    np.testing.assert_allclose(r.frequency[tight], THESIS_B, rtol=1e-5)


@pytest.mark.parametrize("rule", ["fixed", "pose-dependent", "frequency"])
def test_bounds_of_chapter_5_lie_above_the_robots_force_min(found, rule):
    """So its forces are those of a robot without limits, to the last digit."""
    assert found[rule].raised_share == 0.0
    free = distribute_along(ROBOT.with_force_limits(0.0), helix(61), rule)
    np.testing.assert_array_equal(found[rule].distribution.tensions, free.distribution.tensions)


def test_where_a_rule_asks_for_less_the_robots_force_min_stands():
    """With b = 8 rad/s eq. (5.15) asks for 47 to 97 N; cable 3 alone has a force_min of 80 N."""
    cables = [dataclasses.replace(c, force_min=80.0 if i == 2 else 0.0) for i, c in enumerate(ROBOT.cables)]
    limited = dataclasses.replace(ROBOT, cables=tuple(cables))
    r, free = (distribute_along(robot, helix(61), b=8.0) for robot in (limited, ROBOT.with_force_limits(0.0)))
    low, asked = r.distribution.lower, free.distribution.lower
    assert (r.raised == (np.arange(8) == 2) * (asked < 80.0)).all()
    assert 0 < r.raised[:, 2].sum() < 61
    assert r.raised_share == r.raised.sum() / (61 * 8)
    np.testing.assert_allclose(low[r.raised], 80.0, rtol=1e-9)
    np.testing.assert_array_equal(low[~r.raised], asked[~r.raised])
    assert (r.distribution.tensions >= low * (1.0 - 1e-9)).all()
    assert not free.raised.any()


def test_forces_along_a_trajectory_keep_the_robots_force_max():
    largest = distribute_along(ROBOT, helix(61)).max_force.max()
    limited = ROBOT.with_force_limits(None, 0.99 * largest)
    with pytest.raises(UnholdablePoseError, match="at t = 30 s no tension distribution holds the platform within"):
        distribute_along(limited, helix(61))
    above = distribute_along(limited, helix(61), upper_bound=np.inf)
    assert above.max_force.max() == pytest.approx(largest, rel=1e-9)


@pytest.mark.slow
def test_frequency_bound_keeps_its_promise_at_every_pose_of_the_helix():
    r = distribute_along(ROBOT, helix(), "frequency")
    assert not r.missed.any()
    assert r.frequency.min() < THESIS_B * (1.0 + 1e-8)


@pytest.mark.parametrize("rule", ["fixed", "pose-dependent"])
def test_printed_bounds_break_it_for_long_cables(found, rule):
    """A cable on the bound has b sqrt(9.81 m / l), so 0.88 b at 12.6 m; sag changes it by less than a per cent."""
    r = found[rule]
    assert r.frequency.min() / THESIS_B == pytest.approx(np.sqrt(9.81 / 12.62), rel=0.01)
    length = r.distribution.lengths
    assert (length[r.missed] > 9.7).all()
    if rule == "pose-dependent":
        tight = r.distribution.at_lower
        expected = THESIS_B * np.sqrt(9.81 / length[tight])
        np.testing.assert_allclose(r.frequency[tight], expected, rtol=0.012)


def test_printed_bound_is_right_at_one_length_only():
    """9.81 m: there the missing length in (5.10) equals the number of g."""
    for length, sign in ((5.0, 1.0), (9.81, 0.0), (15.0, -1.0)):
        printed = lower_bound_printed(THESIS_B, 0.12, 9.81, length)
        needed = lower_bound_frequency(THESIS_B, 0.12, length)
        assert np.sign(round(printed - needed, 9)) == sign


def test_bounds_are_met_at_the_solution_itself(found):
    """(5.14) with the unstrained length that the cable really gets, not that of a first guess."""
    d = found["pose-dependent"].distribution
    needed = lower_bound_printed(THESIS_B, ROBOT.linear_density, ROBOT.gravity, d.lengths)
    assert (d.tensions >= needed * (1.0 - 1e-9)).all()
    fixed = found["fixed"].distribution
    longest = lower_bound_printed(THESIS_B, 0.12, 9.81, fixed.lengths.max())
    assert fixed.lower.max() == pytest.approx(longest, rel=1e-4)


@pytest.mark.parametrize("factor", [0.01, 0.1, 1.0, 50.0])
def test_fundamental_frequency_equals_the_robot_model(factor):
    """The expansion that the robot's modes use, order 40, from slack (sag over a third of the span) to taut."""
    path = helix(5)
    holding = holding_problem(ROBOT, path.position, path.rotation, np.zeros(6))
    tau, _ = chord_tension_at(holding, constant(237.8 * max(factor, 0.0)))
    states = holding.model.hold(holding.arrays, holding.arms.points, tau).states
    ours = fundamental_frequency(states, ROBOT.linear_density)
    for i in range(len(tau)):
        cables = CableStates(*(getattr(states, name)[i] for name in states.__slots__))
        exact = expand_catenaries(cables, ROBOT.linear_density, 40, cable_stiffness(cables)).omega_squared[:, 0]
        np.testing.assert_allclose(ours[i], np.sqrt(exact), rtol=1e-8)


def test_taut_string_is_the_limit():
    path = helix(5)
    holding = holding_problem(ROBOT, path.position, path.rotation, np.zeros(6))
    tau, _ = chord_tension_at(holding, constant(20000.0))
    states = holding.model.hold(holding.arrays, holding.arms.points, tau).states
    string = np.pi / states.length * np.sqrt(states.tension / ROBOT.linear_density / (1.0 + states.tension / 231870.0))
    ours = fundamental_frequency(states, ROBOT.linear_density)
    np.testing.assert_allclose(ours, string, rtol=1e-5)
    wrong = fundamental_frequency(states, 1.02 * ROBOT.linear_density)  # twin
    assert np.abs(wrong / string - 1.0).min() > 5e-3


def test_own_weight_above_the_wanted_tension():
    """A cable that pulls harder than wanted at any length gets its least tension, on the taut side."""
    path = helix(3)
    holding = holding_problem(ROBOT, path.position, path.rotation, np.zeros(6))
    tau, tension = chord_tension_at(holding, constant(1.0))
    assert (tension > 1.0).all()
    for other in (0.8, 1.3):
        states = holding.model.hold(holding.arrays, holding.arms.points, other * tau).states
        assert (states.tension_at_platform > tension * (1.0 - 0.02)).all()


def test_one_cable_whose_upper_bound_lies_below_its_lower_one_is_told(found):
    """Cable 3 at its largest demand, by the robot's force_max of all others."""
    demand = found["fixed"].distribution.lower[0, 2]
    highest = np.where(np.arange(8) == 2, 0.9 * demand, ROBOT.force_max)
    with pytest.raises(UnholdablePoseError, match=rf"cable 3 must carry at least {demand:.4g} N, {0.1 * demand:.4g} N"):
        distribute_along(ROBOT, helix(61), "fixed", upper_bound=highest)


def at_pose_of(seed):
    """The holding problem of a random robot at its pose."""
    case = drawn(seed)
    return holding_problem(case.robot, case.pose.position[None], case.pose.rotation[None], np.zeros(6))


@pytest.mark.parametrize(("seed", "wanted"), [(4830, 17.74), pytest.param(5072, 2.5625, marks=pytest.mark.slow)])
def test_cables_that_leave_their_pulleys_straight_back_end_at_the_least_they_can(seed, wanted):
    """Wraps of up to 180 degrees, beyond which a cable has no state: Newton went to and fro there."""
    holding = at_pose_of(seed)
    tau, pull = chord_tension_at(holding, constant(wanted))
    held = holding.model.hold(holding.arrays, holding.arms.points, tau).states
    assert not lost(held).any()
    np.testing.assert_allclose(pull, held.tension_at_platform, rtol=1e-8)
    edge = pull > wanted * (1.0 + 1e-6)
    assert edge.any()
    slacker = holding.model.hold(holding.arrays, holding.arms.points, np.where(edge, 0.99 * tau, tau)).states
    assert (lost(slacker) | (slacker.tension_at_platform < pull))[edge].all()


@pytest.mark.slow
def test_a_cable_behind_its_wheel_pulls_as_hard_as_it_can_and_is_named_where_more_is_asked():
    holding = at_pose_of(7569)
    tau, pull = chord_tension_at(holding, constant(114e3))
    assert pull[0, 9] < 8e3  # all others as asked
    np.testing.assert_allclose(np.delete(pull[0], 9), 114e3, rtol=1e-6)
    tauter = holding.model.hold(holding.arrays, holding.arms.points, 1.01 * tau).states
    assert lost(tauter)[0, 9]
    with pytest.raises(UnholdablePoseError, match="cable 10 would turn by more than 180° on its pulley"):
        floor_at(holding, constant(114e3))
