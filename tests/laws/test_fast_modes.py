"""The fast path to the lowest modes of many poses: against the certified modes of each pose, and what it proves."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.dynamics.batched_modes import Batch, first_mode, fits, lowest_modes, reasons_against
from cdpr_struct.dynamics.cable_dynamics import expand_catenaries_at
from cdpr_struct.dynamics.condensed_cables import condensed
from cdpr_struct.dynamics.condensed_robot import pencil
from cdpr_struct.dynamics.corrected_ritz import least_below, most_below
from cdpr_struct.dynamics.lowest_clamped import lowest_clamped
from cdpr_struct.dynamics.many_poses import lowest_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.string_functions import string_functions
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.workspace import vibration
from cdpr_struct.workspace.vibration import SHARE, first_frequencies
from tests.laws.fast_mode_cases import (
    FIRST,
    LEVEL,
    MANY,
    at_rest,
    certified_squared,
    compare,
    largest_error,
    near_home,
    with_extensions,
)

KINKED = 2e-5  # a mass leaves a kink in the cable, which polynomials of order 24 and of 32 resolve to 1e-5
ROBOTS = ("thesis-3-1", "thesis-3-1-8mm", "cogiro", "thesis-5")


@pytest.mark.parametrize("name", ROBOTS)
def test_lowest_modes_are_the_certified_ones(name):
    point = at_rest(load_robot(name), near_home(load_robot(name), 4))
    assert fits(point).all()
    exact, batch = certified_squared(point, 12), Batch.of(point)
    first, many = first_mode(batch), lowest_modes(batch, 12)
    assert largest_error(first.squared, exact[:, 0]) < FIRST
    assert (first.width <= 1e-9).all()
    assert largest_error(many.squared, exact) < MANY
    assert (many.low <= exact * (1.0 + MANY)).all()
    assert (exact <= many.squared * (1.0 + 1e-9)).all()


def test_cables_two_percent_heavier_are_told_apart():
    """The twin of the test above."""
    robot = load_robot("thesis-3-1")
    heavier = replace(robot, cables=tuple(replace(c, linear_density=1.02 * c.linear_density) for c in robot.cables))
    positions = near_home(robot, 3)
    exact = certified_squared(at_rest(robot, positions), 12)
    ours = Batch.of(at_rest(heavier, positions))
    assert largest_error(first_mode(ours).squared, exact[:, 0]) > 1e4 * FIRST
    assert largest_error(lowest_modes(ours, 12).squared, exact) > 1e4 * MANY


@pytest.mark.parametrize("share", [0.3, 1.0, 1.7])
def test_a_shift_encloses_every_frequency_below_the_eliminated_ones(share):
    """By the bound, and by the counts of the series; the polynomials are fine enough to be exact here."""
    robot = load_robot("thesis-3-1")
    point = at_rest(robot, near_home(robot, 6))
    exact, batch = certified_squared(point, 12), Batch.of(point)
    shift = share * batch.lowest_string
    own = condensed(batch.cables, shift, string_functions(12), 1, 5)
    small = pencil(batch.platform, own, shift)
    squared = small.squared[:, :12]
    below = exact < 0.8 * own.lowest[:, None]
    low = small.enclosed(squared)
    assert below[:, :6].all()
    assert (exact <= squared * (1.0 + 1e-9)).all()
    assert (low <= exact * (1.0 + 1e-9))[below].all()
    overstated = replace(small, lowest=1e6 * small.lowest)  # twin
    assert not (overstated.enclosed(squared) <= exact * (1.0 + 1e-9))[below].all()
    for i in range(6):
        for factor in (1.0 - 1e-6, 1.0 + 1e-6):
            near = exact[:, i] * factor
            true = (exact < near[:, None]).sum(axis=1)
            assert (least_below(batch.platform, own, shift, near) <= true).all()
            assert (most_below(batch.platform, own, shift, near) >= true).all()


def test_what_is_not_proved_is_not_said():
    """A shift beyond the eliminated frequencies proves nothing."""
    robot = load_robot("thesis-3-1")
    batch = Batch.of(at_rest(robot, near_home(robot, 3)))
    shift = 5.0 * batch.lowest_string
    own = condensed(batch.cables, shift, string_functions(8), 1, 5)
    small = pencil(batch.platform, own, shift)
    assert np.isnan(small.squared).all()
    assert (small.enclosed(shift) == -np.inf).all()
    assert (most_below(batch.platform, own, shift, shift) > 1000).all()
    assert (least_below(batch.platform, own, shift, shift) == 0).all()


REFUSED = {
    "masts": lambda: with_extensions(frame_compliance=2e-5),
    "bending stiffness": lambda: with_extensions(bending_stiffness=0.5),
    "masses at mid-cable": lambda: with_extensions(added_mass=0.02),
    "parts that move in the platform": lambda: with_extensions(internal_mass=2.0, internal_frequency=5.0),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_does_not_fit_is_the_general_solvers(name):
    robot = REFUSED[name]()
    point = at_rest(robot, near_home(robot, 2))
    assert reasons_against(point) == [name]
    assert not fits(point).any()
    mapped = first_frequencies(robot, near_home(robot, 2), LEVEL)["first_Hz"]
    np.testing.assert_allclose(
        mapped,
        np.sqrt(certified_squared(point, 1)[:, 0]) / (2.0 * np.pi),
        rtol=KINKED if name == "masses at mid-cable" else FIRST,
    )


def test_parameters_of_their_own_do_not_fit():
    robot = load_robot("thesis-3-1")
    point = at_rest(robot, near_home(robot, 3))
    arrays = replace(point.arrays, mass=np.array([50.0, 60.0, 70.0]))
    assert reasons_against(replace(point, robot=arrays)) == ["parameters of their own at each pose"]


@pytest.mark.parametrize(
    "given",
    [
        {"nonlinearity": 0.3, "reference_tension": 200.0},
        {"force": [20.0, 5.0, -30.0], "tilt": [0.01, -0.02]},
        {"hose": 100.0, "hose_center": [0.0, 0.0, 0.5]},
        {"length_offset": 0.01, "length_scale": 1.001, "cell_gain": 1.01},
    ],
    ids=str,
)
def test_loads_stiffening_cables_and_sensors_fit(given):
    robot = with_extensions(**given)
    point = at_rest(robot, near_home(robot, 3))
    assert fits(point).all()
    exact = certified_squared(point, 6)
    assert largest_error(first_mode(Batch.of(point)).squared, exact[:, 0]) < FIRST
    assert largest_error(lowest_modes(Batch.of(point), 6).squared, exact) < MANY


def test_slack_cables_do_not_fit():
    bare = load_robot("thesis-5").with_force_limits(0.0)
    point = at_rest(bare, near_home(bare, 3))
    assert len(point.position)
    assert not fits(point).any()


@pytest.mark.parametrize("name", ROBOTS)
def test_a_clamped_cables_lowest_frequency_lies_out_of_its_plane(name):
    """All the modes of the expansion, in the plane and out of it, against those out of it alone."""
    robot = load_robot(name)
    point = at_rest(robot, near_home(robot, 4))
    batch = Batch.of(point)
    exact = expand_catenaries_at(point, 24).omega_squared[..., 0].T
    np.testing.assert_allclose(lowest_clamped(batch.cables, batch.order), exact, rtol=1e-9)


def test_every_pose_has_its_frequencies():
    """Quick ones, those of a slack cable by certified modes, none where the platform is not stable."""
    robot = load_robot("thesis-5")
    states = [inverse(r, robot.home.position[None], LEVEL).cables for r in (robot, robot.with_force_limits(0.0))]
    both = CableStates(*(np.concatenate([getattr(s, n) for s in states]) for n in CableStates.__slots__))
    turns, places = np.broadcast_to(LEVEL, (2, 3, 3)), np.repeat(robot.home.position[None], 2, axis=0)
    point = OperatingPoint(robot, places, turns, both)
    found = lowest_frequencies(point, 6)
    assert found.quick.tolist() == [True, False]
    exact = np.sqrt(certified_squared(point, 6)) / (2.0 * np.pi)
    np.testing.assert_allclose(found.hertz, exact, rtol=MANY)
    assert (found.bracket_hertz[..., 0] <= exact * (1.0 + 1e-9)).all()
    assert (exact <= found.bracket_hertz[..., 1] * (1.0 + 1e-9)).all()
    falling = replace(robot, platform=replace(robot.platform, center_of_mass=np.array([0.0, 0.0, 20.0])))
    assert np.isnan(lowest_frequencies(replace(point, robot=falling), 3).hertz).all()


@pytest.mark.parametrize("name", ROBOTS)
def test_columns_of_a_map_are_those_of_the_general_solver(name, monkeypatch):
    robot = load_robot(name)
    positions = near_home(robot, 6)
    ours = first_frequencies(robot, positions, LEVEL)
    monkeypatch.setattr(vibration, "fits", lambda point: np.zeros(len(point.position), dtype=bool))
    theirs = first_frequencies(robot, positions, LEVEL)
    assert ours.keys() == theirs.keys()
    for column, values in theirs.items():
        rounding = {"platform_Hz": MANY, SHARE: 1e-3}.get(column, FIRST)  # shapes err like roots of frequencies
        np.testing.assert_allclose(ours[column], values, rtol=rounding)


def test_the_platform_s_motion_is_shared_where_modes_veer():
    """Along a line on which string modes cross the platform's: where its mode holds most, the frequency is smooth."""
    robot = load_robot("cogiro")
    line = robot.home.position + np.linspace([-1.5, 0.3, 0.0], [1.5, 0.3, 0.0], 241)
    found = first_frequencies(robot, line, LEVEL)
    step = np.abs(np.diff(np.log(found["platform_Hz"])))
    share = np.minimum(found[SHARE][1:], found[SHARE][:-1])
    assert found[SHARE].max() == pytest.approx(0.990, abs=1e-3)  # the rest is motion of the cables
    assert step[share < 0.5].max() > 0.03
    assert step[share >= 0.5].max() < 1e-3


@pytest.mark.parametrize("mass", [30.0, 60.0])
def test_a_mapped_pose_does_not_depend_on_its_company(mass):
    """Poses with heavy and with light sag, alone and together; the general solver, which some platform modes come from,
    drops what lies far above the highest string of its batch."""
    robot = load_robot("thesis-3-1-8mm").with_load(mass=mass)
    positions = near_home(robot, 12)
    whole = first_frequencies(robot, positions, LEVEL)
    for part in (slice(0, 1), slice(5, 6), slice(7, 12)):
        alone = first_frequencies(robot, positions[part], LEVEL)
        for name, rounding in (("first_Hz", 1e-12), ("cable_1_Hz", 1e-12), ("platform_Hz", 1e-9)):
            np.testing.assert_allclose(alone[name], whole[name][part], rtol=rounding)


def test_random_robots_agree_with_certified_modes():
    found = compare(7, robots=12, poses=6)
    assert found["stable"] >= 20
    assert found["error"] < FIRST
    assert found["many_error"] < MANY
    assert found["missed"] == 0
    assert found["proved"] > 0.95


@pytest.mark.slow
def test_random_robots_agree_with_certified_modes_at_ten_thousand_poses():
    found = compare(8, robots=100, poses=100)
    print(found)
    assert found["error"] < FIRST
    assert found["many_error"] < MANY
    assert found["missed"] == 0
    assert found["proved"] > 0.95
