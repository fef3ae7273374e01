"""Bands of frequency responses and vibrations against robots that are changed and solved one by one, step by step."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.bands.drawn_curves import CurveBands, each_robot, response_bands, thinned_lines
from cdpr_struct.bands.drawn_robots import drawn_rests
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.interface.damping_law import read_damping
from cdpr_struct.robot.tolerances import Spread, Tolerances, change_count, places

ONE = Spread(np.zeros((change_count(8), 1)), np.zeros(change_count(8)))  # nothing is off
STOP = {"initial_velocity": (0.2, 0, 0.1), "duration": 1.0, "highest": 8.0}


def heavier(mass: float) -> Spread:
    """Robots whose platform is heavier by so much, all of them."""
    mean = np.zeros(change_count(8))
    mean[places(8)[5]] = mass
    return Spread(ONE.root, mean)


@pytest.mark.parametrize("damping", ["viscous", "modal:0.01"])
def test_robots_that_are_not_off_have_the_response_as_entered(damping):
    found = cs.frf("cogiro", excite="fz", respond="z,rx", band=(1, 4, 0.05), damping=damping)
    law = read_damping(damping, found.sweep.point.entered, False)
    bands = response_bands(found.sweep, law, ONE, 0.9, 20)
    entered = np.abs(found.sweep.evenly.response).T
    for part in (bands.low, bands.middle, bands.high):
        assert np.allclose(part, entered, rtol=1e-4)
    assert np.allclose(bands.largest, entered.max(axis=1)[:, None], rtol=1e-4)


def test_heavier_robots_have_the_response_of_the_heavier_robot():
    """At the lengths of the robot as entered, where the heavier one hangs lower."""
    robot = cs.load_robot("cogiro")
    sweep = cs.frf(robot, excite="fz", respond="z", band=(2, 4, 0.1)).sweep
    law = read_damping("viscous", robot, False)
    bands = response_bands(sweep, law, heavier(30.0), 0.9, 20)
    rest = cs.forward(robot.with_load(mass=robot.platform.mass + 30.0), cs.inverse(robot).solution.lengths).point
    hertz = sweep.evenly.hertz
    cables = cable_dynamics(rest, "exact", 2.0 * np.pi * hertz[-1])
    ports = sweep.response.excite, sweep.response.respond
    again = frequency_response(rest, cables, law, *ports, hertz)
    assert np.allclose(bands.middle[0], np.abs(again.response[:, 0]), rtol=1e-3)
    assert not np.allclose(bands.middle[0], np.abs(sweep.evenly.response[:, 0]), rtol=0.05)


def test_heavier_robots_vibrate_as_the_heavier_robot():
    robot = replace(cs.load_robot("cogiro"), posterior=heavier(30.0))
    bands = cs.transient(robot, **STOP, band=90, samples=20).within
    lengths = cs.inverse(robot).solution.lengths
    again = cs.transient("cogiro", lengths=lengths, mass=robot.platform.mass + 30.0, **STOP).record.vibration
    assert np.allclose(bands.bands.middle.T, again.displacement, atol=1e-6)
    assert np.allclose(bands.bands.low, bands.bands.high)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["cogiro", "thesis-3-1"])
def test_other_robots_drawn_from_the_same_tolerances_have_a_band_as_wide(name):
    robot = cs.load_robot(name)
    sweep = cs.frf(robot, excite="fz", respond="z", band=(1, 5, 0.05)).sweep
    law, spread = read_damping("viscous", robot, False), Spread.within(Tolerances(), 8)
    others = Spread(spread.root[:, ::-1], spread.mean)  # the same normal numbers, given to other tolerances
    one, other = (response_bands(sweep, law, which, 0.8, 50) for which in (spread, others))
    assert not np.allclose(one.middle, other.middle, rtol=1e-6)
    ratio = (np.log(other.high) - np.log(other.low)) / (np.log(one.high) - np.log(one.low))
    assert abs(np.median(ratio) - 1.0) < 0.25


def test_a_resonance_that_moves_by_its_width_has_no_peak_in_the_median():
    """Why nothing here is to first order: each robot peaks, the median does not."""
    robot = cs.load_robot("cogiro")
    sweep = cs.frf(robot, excite="fz", respond="z", band=(2.5, 3.0, 0.002), damping="viscous:0.001").sweep
    law, spread = read_damping("viscous:0.001", robot, False), Spread.within(Tolerances(), 8)
    bands = response_bands(sweep, law, spread, 0.9, 60)
    assert bands.largest[0, 0] > 2.0 * bands.middle.max()


def test_every_robot_stands_where_it_rests():
    rests, kept = drawn_rests(cs.inverse("cogiro").point, Spread.within(Tolerances(), 8), 5)
    for number, one in enumerate(each_robot(rests)):
        assert one.position.tolist() == rests.position[number].tolist()
        assert one.rotation.tolist() == rests.rotation[number].tolist()
        assert one.cables.tension_at_platform.tolist() == rests.cables.tension_at_platform[number].tolist()
        assert float(one.arrays.mass) == float(rests.arrays.mass[number])
    assert len(kept) == number + 1 == 5


def test_lines_are_thinned_to_what_a_picture_shows():
    chosen = thinned_lines(np.arange(100_000))
    assert len(chosen) == 2000
    assert chosen[[0, -1]].tolist() == [0, 99_999]
    assert thinned_lines(np.arange(7)).tolist() == list(range(7))


def test_bands_of_curves_are_their_quantiles():
    curves = np.linspace(-1.0, 1.0, 101)[:, None, None] * np.array([1.0, -3.0])[None, :, None]
    found = CurveBands.of(np.array([5.0, 6.0]), curves, 0.9, 1)
    assert found.low[0] == pytest.approx([-0.9, -2.7])
    assert found.high[0] == pytest.approx([0.9, 2.7])
    assert found.largest_at[0].tolist() == [6.0, 6.0]
    assert (found.count, found.lost) == (101, 1)
