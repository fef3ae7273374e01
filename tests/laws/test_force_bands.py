"""Bands of cable forces along a motion against robots that are drawn and balanced one by one."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.bands.drawn_robots import drawn_rests
from cdpr_struct.bands.force_bands import UncertainForces
from cdpr_struct.bands.locked_response import LockedStations
from cdpr_struct.robot.tolerances import Spread, Tolerances

ENTERED = Path(__file__).parents[2] / "examples/bands/robot.toml"
LINE = "line:0,0,1.2:1.5,1,2:2"
WITHIN = Spread.within(Tolerances(), 8)


def uncertain(name: str, trajectory: str, **options) -> UncertainForces:
    found = cs.distribute(name, trajectory, **options).found[0]
    return UncertainForces(found, Spread.within(Tolerances(**found.robot.tolerances), len(found.robot.cables)))


@pytest.mark.parametrize(
    ("name", "trajectory", "options"),
    [
        pytest.param("thesis-5", "helix", {"instants": 31}, marks=pytest.mark.slow),
        ("cogiro", LINE, {"instants": 5}),
        pytest.param(str(ENTERED), LINE, {"instants": 9}, marks=pytest.mark.slow),
    ],
)
def test_bands_are_those_of_robots_in_balance(name, trajectory, options):
    forces = uncertain(name, trajectory, **options)
    bands, drawn = forces.bands(0.9), forces.drawn(300, 0.9)
    assert drawn.lost == 0
    mine = bands.band[drawn.place]
    assert (np.abs(mine - drawn.ends) <= 0.16 * np.ptp(mine, axis=-1)[..., None]).all()


def test_robots_are_balanced_under_the_inertia_of_the_motion():
    """A mass that is off changes the tensions by its weight and its inertia, which the wrench of 300 kg stands for."""
    point = cs.inverse("cogiro", wrench=(0, 0, -3000.0, 0, 0, 0)).point
    bare = replace(point, robot=cs.load_robot("cogiro"))
    wrench = np.array([0.0, 0.0, -3000.0, 0.0, 0.0, 0.0])
    rest = drawn_rests(bare, Spread(0.0 * WITHIN.root, WITHIN.mean), 1, wrench=wrench)[0]
    assert rest.position[0] == pytest.approx(point.position, abs=1e-7)
    assert rest.cables.tension_at_platform[0] == pytest.approx(point.cables.tension_at_platform, rel=1e-6)
    with_wrench, entered = (LockedStations.about(bare, wrench=wrench), LockedStations.about(point))
    one, other = (each.slope(each.rests.cables.tension_at_platform) for each in (with_wrench, entered))
    assert np.allclose(one, other, rtol=1e-5, atol=1e-6 * np.abs(other).max())


def test_a_bound_that_is_active_is_broken_by_half_of_the_robots():
    bands = uncertain("thesis-5", "helix", instants=31).bands(0.9)
    assert bands.below.max() == pytest.approx(0.5, abs=0.01)
    assert bands.all_above < 0.05
    assert bands.all_taut > 0.999
    assert bands.all_below == 1.0
    assert (bands.slack <= bands.below).all()
    assert (bands.above < 0.01).all()


def test_a_bound_raised_as_told_is_kept_as_surely_as_told():
    """Of the fixed bound: raised by the margin, distributed again, and judged against the bound that was wanted."""
    forces = uncertain("thesis-5", "helix", instants=11, bound="fixed")
    wanted, by = float(forces.found.distribution.lower.max()), forces.bands(0.9).raised(0.95)
    assert by > 0.0
    again = uncertain("thesis-5", "helix", instants=11, bound="fixed", lower_bound=wanted + by)
    lower = again.found.distribution
    judged = replace(again.found, distribution=replace(lower, lower=np.full_like(lower.tensions, wanted)))
    assert UncertainForces(judged, again.spread).bands(0.9).all_above == pytest.approx(0.95, abs=0.03)


def test_without_tolerances_the_bound_holds():
    forces = uncertain("cogiro", LINE, instants=3)
    bands = UncertainForces(forces.found, Spread(0.0 * WITHIN.root, WITHIN.mean)).bands(0.9)
    assert bands.all_taut == 1.0
    assert not bands.sigma.any()
    assert np.allclose(bands.band, bands.tension[..., None])
