"""Rates, bands and chances of robots within their tolerances, against solutions made anew."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.bands.chances import DrawnRest, chance
from cdpr_struct.bands.compared import assigned, compared
from cdpr_struct.bands.designs import KNOBS, Design
from cdpr_struct.bands.drawn_robots import drawn_robots
from cdpr_struct.bands.frequency_bands import chance_above, frequency_bands
from cdpr_struct.bands.locked_response import locked_response, step_sizes
from cdpr_struct.bands.mode_rates import ModeRates, mode_rates
from cdpr_struct.bands.rest_bands import rest_bands
from cdpr_struct.bands.sensitivities import movers, variance_shares
from cdpr_struct.crosscheck.robot_modes import robot_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.interface.operating_point import rest
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_from_arrays import robot_from_arrays
from cdpr_struct.robot.tolerances import (
    VARIED,
    Spread,
    Tolerances,
    change_count,
    changed,
    places,
    tolerance_count,
    tolerance_factor,
)
from cdpr_struct.statics.forward_kinematics import forward


def entered(name: str) -> cs.Robot:
    robot = cs.load_robot(name)
    if not name.startswith("thesis-3-1"):
        return robot
    wheel = cs.Pulley(0.05, np.array([0.0, 0.0, 1.0]))
    return replace(robot, pulleys=(wheel,) * len(robot.cables), guided=())


def at_rest(name: str) -> OperatingPoint:
    return rest(entered(name), None, None).point


def stiffening() -> OperatingPoint:
    """A robot at rest whose cables have EA (T / T0)^0.15."""
    robot = entered("cogiro")
    law = {"stiffening_exponent": 0.15, "incremental_ratio": 1.0 / 0.85, "reference_tension": 400.0}
    law = {name: np.array(value) for name, value in law.items()}
    return cs.inverse(robot_from_arrays(robot, replace(RobotArrays.of(robot), **law))).point


def with_change(point: OperatingPoint, change: np.ndarray) -> OperatingPoint:
    """The changed robot at rest at the same lengths, solved anew."""
    arrays = RobotArrays.of(point.entered)
    robot = changed(arrays, change)
    found = forward(robot, arrays.reading(point.cables.paid_out), point.position, point.rotation)
    assert bool(found.stable)
    return OperatingPoint(robot, found.position, found.rotation, found.cables)


def differences(point: OperatingPoint, step: np.ndarray) -> np.ndarray:
    """(7 + m,) ln f of four modes, position and tensions, with a change less with its opposite."""
    up, down = with_change(point, step), with_change(point, -step)
    parts = [
        np.log(robot_modes(up, "exact", 4).hertz / robot_modes(down, "exact", 4).hertz),
        up.position - down.position,
        up.cables.tension_at_platform - down.cables.tension_at_platform,
    ]
    return np.concatenate(parts)


def slope(point: OperatingPoint, step: np.ndarray) -> np.ndarray:
    """The same per step of this direction: whole solutions, small steps for modes that are close to each other, larger
    ones for tensions, which are solved to a part in 10^11 of the forces."""
    size = step.sum() / step_sizes(point)[step != 0.0].sum()
    coarse, fine = (differences(point, factor * step) / (2.0 * factor * size) for factor in (2.0, 1.0))
    return (4.0 * fine - coarse) / 3.0


@pytest.mark.parametrize("name", ["cogiro", "thesis-3-1", "six-cable-8mm"])
def test_rates_are_those_of_solutions_made_anew(name):
    """Frequencies, pose and tensions, by a frame anchor, a length, EA, density, mass, centre of mass and inertia."""
    point = at_rest(name)
    cables = point.arrays.cable_count
    hertz = robot_modes(point, "exact", 4).hertz
    response = locked_response(point)
    found = mode_rates(point, hertz, response, Spread.within(Tolerances(), cables))
    steps = step_sizes(point)
    chosen = [place.start + (place.stop - place.start) // 2 for place in places(cables)]
    for one, index in zip(VARIED, chosen, strict=True):
        step = steps[index] * np.eye(len(steps))[index]
        expected = np.split(np.concatenate([slope(point, 0.1 * step)[:4], slope(point, 2.0 * step)[4:]]), [4, 7])
        expected = [part / steps[index] for part in expected]
        own = [found.own[index, :4], response.pose[index, :3], response.tension[index]]
        for rate, difference in zip(own, expected, strict=True):
            assert np.abs(rate - difference).max() <= 1e-6 * max(np.abs(difference).max(), 1e-2), one.field


@pytest.mark.parametrize("field", ["length_offset", "axial_stiffness", "mass"])
def test_rates_of_cables_that_stiffen_know_that_they_do(field):
    """EA follows the tension at rest, and in vibration is larger than the secant; to a part in a hundred thousand."""
    point = stiffening()
    hertz, response = robot_modes(point, "exact", 4).hertz, locked_response(point)
    found = mode_rates(point, hertz, response, Spread.within(Tolerances(), 8))
    index = places(8)[[one.field for one in VARIED].index(field)].start
    step = step_sizes(point)[index] * np.eye(change_count(8))[index]
    expected = slope(point, step) / step[index]
    rates = np.concatenate([found.own[index, :4], response.pose[index, :3], response.tension[index]])
    for part in (slice(4), slice(4, 7), slice(7, None)):
        assert np.allclose(rates[part], expected[part], rtol=0.0, atol=1e-5 * np.abs(expected[part]).max())


def test_reels_share_half_of_the_variance():
    factor = tolerance_factor(Tolerances(axial_stiffness=0.04), 3)
    assert factor.shape == (change_count(3), tolerance_count(3))
    place = places(3)[[one.field for one in VARIED].index("axial_stiffness")]
    covariance = factor[place] @ factor[place].T
    assert np.allclose(covariance, 0.04**2 * (0.5 * np.eye(3) + 0.5))


def test_frequencies_that_may_meet_have_the_bands_of_drawn_robots():
    """Twelve cable modes within 8 per cent: rates of single modes would give bands that are wrong by a half."""
    point = at_rest("thesis-3-1")
    spread = Spread.within(Tolerances(), 8)
    hertz = robot_modes(point, "exact", 6).hertz
    found = mode_rates(point, hertz, locked_response(point), spread)
    bands = frequency_bands(found, spread, 0.9)
    assert any(len(group) > 6 for group in bands.meeting)
    drawn = drawn_robots(point, spread, 400, hertz)
    assert drawn.lost == 0
    ends = drawn.quantiles("hertz", 0.9)
    width = ends[:, 1] - ends[:, 0]
    gap = np.abs(np.stack([bands.low[:6], bands.high[:6]], axis=-1) - ends)
    assert (gap <= 0.15 * width[:, None]).all()
    alone = np.exp(1.645 * np.linalg.norm(found.own[:, :6].T @ spread.root, axis=1)) * hertz
    assert (np.abs(alone - ends[:, 1]) > 0.3 * width).any()


def test_pose_and_tensions_have_the_bands_of_drawn_robots():
    point = at_rest("cogiro")
    spread = Spread.within(Tolerances(), 8)
    found = rest_bands(point, locked_response(point), spread, 0.9)
    drawn = drawn_robots(point, spread, 800)
    for mine, name in ((found.pose, "pose"), (found.tension, "tension")):
        ends = drawn.quantiles(name, 0.9)
        assert (np.abs(mine - ends) <= 0.12 * (ends[:, 1] - ends[:, 0])[:, None]).all()


def test_a_drawn_robot_that_is_not_off_is_the_one_as_entered():
    """With cables that are stiffer in vibration than at rest."""
    point = stiffening()
    hertz = robot_modes(point, "exact", 3).hertz
    drawn = drawn_robots(point, Spread(np.zeros((change_count(8), 1)), np.zeros(change_count(8))), 2, hertz)
    assert drawn.lost == 0
    assert np.allclose(drawn.hertz, hertz, rtol=1e-6)
    assert np.allclose(drawn.tension, point.cables.tension_at_platform, rtol=1e-6)


def test_a_band_is_as_wide_as_its_tolerances():
    """Twice the tolerances, twice the sigma; none, no band."""
    point = at_rest("cogiro")
    response = locked_response(point)
    none, root = np.zeros(change_count(8)), tolerance_factor(Tolerances(), 8)
    sizes = [rest_bands(point, response, Spread(factor * root, none), 0.5).pose_sigma for factor in (0, 1, 2)]
    assert not sizes[0].any()
    assert np.allclose(sizes[2], 2.0 * sizes[1])


def test_two_modes_that_cross_repel_as_their_small_matrix_says():
    """Mixing alone splits a double frequency evenly: the lower one is never above, the upper never below."""
    spread = Spread(np.array([[0.01]]), np.zeros(1))
    rates = ModeRates(np.array([2.0, 2.0]), np.zeros((1, 2)), np.array([[0, 1]]), np.ones((1, 1)), np.array([0, 0]))
    bands = frequency_bands(rates, spread, 0.9)
    assert bands.high[0] <= 2.0 <= bands.low[1]
    assert chance_above(rates, spread, 0, 2.0) == 0.0
    assert chance_above(rates, spread, 1, 2.0) == 1.0


def test_shares_of_the_variance_are_those_of_each_tolerance_alone():
    point = at_rest("cogiro")
    tension = locked_response(point).tension
    shares = variance_shares(tension, Spread.within(Tolerances(), 8), 8)
    assert np.allclose(sum(shares.values()), 1.0)
    none = dict.fromkeys(Tolerances.__slots__, 0.0)
    only = tolerance_factor(Tolerances(**(none | {"anchor_m": 0.001})), 8)
    whole = np.linalg.norm(tension.T @ tolerance_factor(Tolerances(), 8), axis=1)
    own = (np.linalg.norm(tension.T @ only, axis=1) / whole) ** 2
    assert np.allclose(shares["frame_anchors"] + shares["platform_anchors"], own)


def test_every_number_of_a_robot_moves_once():
    single = [index for one in movers(6) if len(one.index) == 1 for index in one.index]
    cells = sum(one.count(6) for one in VARIED if one.of_cells)
    assert sorted(single) == sorted(set(single))
    assert len(single) == change_count(6) - cells


def test_chances_are_shares_of_robots_within_the_tolerances():
    point = at_rest("cogiro")
    drawn = DrawnRest.of(point, locked_response(point), Spread.within(Tolerances(), 8), point)
    middle = point.cables.tension_at_platform[2]
    assert abs(chance(drawn.tension[:, 2:3], middle, None) - 0.5) < 0.01
    assert chance(drawn.tension, None, 1e6) == 1.0
    assert chance(drawn.tension, 1e6, None) == 0.0
    assert drawn.position_error.min() > 0.0


def test_readings_are_judged_together():
    """Two readings that share one error: one sigma off alike is nothing, one sigma off against each other is much."""
    rates, spread = np.array([[1.0, 1.0]]), Spread(np.eye(1), np.zeros(1))
    ends = np.array([[-1.645, 1.645]] * 2)
    noise = np.full(2, 0.1)

    def p(first: float, second: float) -> float:
        return compared(np.array([first, second]), noise, np.zeros(2), ends, rates, spread, 0.9).p_value

    assert p(1.0, 1.0) > 0.5
    assert p(1.0, -1.0) < 1e-10


def test_frequencies_without_a_number_go_to_the_nearest_modes():
    found = assigned(np.array([2.05, 1.02]), np.array([1.0, 1.5, 2.0]), np.full(3, 0.02))
    assert found.tolist() == [2, 0]


@pytest.mark.parametrize("name", ["cogiro", "six-cable-4mm"])
def test_a_design_reaches_the_frequency(name):
    """What is found is put into the robot, and the command's own function asked again."""
    robot = cs.load_robot(name)
    design = Design(robot, robot.home, 0, "exact", "consistent")
    wanted = 1.03 * design.frequency({})
    changes = [design.alone("platform_mass", wanted), design.together(wanted, ("axial_stiffness", "frame_anchors"))]
    for change in changes:
        assert change.factors is not None
        again = cs.modes(design.changed(change.factors), robot.home, count=1).answer["frequencies_hz"][0]
        assert again == pytest.approx(wanted, rel=1e-6)


def test_a_frequency_out_of_reach_is_said_so():
    robot = cs.load_robot("six-cable-4mm")
    change = Design(robot, robot.home, 0, "static", "consistent").alone("platform_mass", 1e3)
    assert change.factors is None
    assert set(KNOBS) >= {"platform_mass"}


def test_a_diagnosed_robot_has_the_bands_of_its_posterior_and_says_so():
    entered = cs.load_robot("cogiro")
    within = Spread.within(Tolerances(), 8)
    known = replace(entered, posterior=Spread(0.25 * within.root, within.mean))
    before, after = (cs.inverse(robot, band=90) for robot in (entered, known))
    widths = [np.ptp(one.answer["bands"]["pose"], axis=1) for one in (before, after)]
    assert np.allclose(widths[1], 0.25 * widths[0])
    assert [one.answer["bands"]["known_from"] for one in (before, after)] == ["tolerances", "diagnosis"]
    assert "defaults used" in before.text()
    assert "that a diagnosis left probable" in after.text()
    assert "about the likeliest of these robots" in after.text()
    assert "about the likeliest of these robots" not in before.text()
    assert "defaults used" not in after.text()


def test_modes_that_change_places_before_the_likeliest_robot_have_its_bands():
    """A diagnosis that moves tensions by tens of newtons: bands are about the robot as it most probably is."""
    entered = cs.load_robot("cogiro")
    within = Spread.within(Tolerances(), 8)
    off = np.zeros(len(within.mean))
    off[places(8)[2]] = [0.004, -0.003, 0.0, 0.002, -0.004, 0.003, 0.001, -0.002]  # lengths [m]
    known = replace(entered, posterior=Spread(0.02 * within.root, off))
    held = cs.inverse(entered)
    start = cs.Pose(held.pose.position, held.pose.angles)
    found = cs.modes(known, lengths=held.answer["lengths_m"], start=start, count=6, band=90)
    moved = robot_from_arrays(entered, changed(RobotArrays.of(entered), off))
    truth = cs.modes(moved, lengths=held.answer["lengths_m"], start=start, count=6).modes.hertz
    low, high = np.array(found.answer["bands"]["frequencies_hz"]).T
    assert ((low < truth) & (truth < high)).all()
    assert ((found.modes.hertz < low) | (found.modes.hertz > high)).any()  # of the robot without what was found beside
    rest = cs.forward(known, held.answer["lengths_m"], start=start, band=90).answer["bands"]
    own = cs.forward(moved, held.answer["lengths_m"], start=start)
    np.testing.assert_allclose(np.mean(rest["tensions_N"], axis=1), own.answer["tensions_N"], rtol=1e-9)
