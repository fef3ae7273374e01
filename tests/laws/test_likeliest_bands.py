"""Bands after a diagnosis whose means move tensions by tens of newtons: against robots that have these numbers."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.bands.force_bands import UncertainForces
from cdpr_struct.bands.likeliest_robot import at_the_means, likeliest_rests, required
from cdpr_struct.bands.mapped_bands import BELOW, DRAWN, ENDS, BandedQuantity, band_column
from cdpr_struct.errors import CdprError
from cdpr_struct.interface.bands import spread_of
from cdpr_struct.robot.remainder import Remainder
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_from_arrays import robot_from_arrays
from cdpr_struct.robot.tolerances import VARIED, Spread, Tolerances, change_count, changed, places
from cdpr_struct.workspace.quantities import evaluate, quantity_of

FOUND = {"length_offset": np.array([8, -6, 0, 4, -8, 6, 2, -4]) * 1e-3, "axial_stiffness": -0.15, "mass": 60.0}
"""What a diagnosis found beside its causes [m], in the logarithm, [kg]."""
QUANTITIES = (
    "tension-min", "sag-max", "stiffness-min", "tilt", "platform-frequency", "first-frequency", "pose-error",
)  # fmt: skip
LINE = "line:0,0,1.2:0.6,0.4,1.6:2"


def diagnosed() -> cs.Robot:
    """A robot that is far off, and known to within a fiftieth of the usual tolerances."""
    mean = np.zeros(change_count(8))
    for one, place in zip(VARIED, places(8), strict=True):
        mean[place] = FOUND.get(one.field, 0.0)
    return replace(cs.load_robot("cogiro"), posterior=Spread(0.02 * Spread.within(Tolerances(), 8).root, mean))


def corrected() -> cs.Robot:
    """The same robot with its numbers as they are."""
    entered = cs.load_robot("cogiro")
    return robot_from_arrays(entered, changed(RobotArrays.of(entered), diagnosed().posterior.mean))


def apart(low: np.ndarray, high: np.ndarray, ends: list[np.ndarray]) -> float:
    """Largest distance of the ends of bands from those of drawn robots, in widths of these."""
    return float((np.abs([low - ends[0], high - ends[1]]) / (ends[1] - ends[0])).max())


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_a_map_has_the_bands_of_drawn_robots(quantity):
    robot = diagnosed()
    position = robot.home.position + np.array([[0.0, 0.0, 0.0], [0.7, 0.3, 0.2]])
    drawn = BandedQuantity(quantity, robot.posterior, 0.9, None, 150)(robot, position, robot.home.rotation)
    ends = [drawn[band_column(quantity, end)] for end in DRAWN]
    limit = float(0.5 * (ends[0] + ends[1])[0])
    found = BandedQuantity(quantity, robot.posterior, 0.9, limit)(robot, position, robot.home.rotation)
    low, high, sigma = (found[band_column(quantity, end)] for end in ENDS)
    assert apart(low, high, ends) < 0.15
    assert np.allclose(sigma, (high - low) / (2.0 * 1.645), rtol=0.12)
    assert found[BELOW][0] == pytest.approx(0.5, abs=0.2)
    column = quantity_of(quantity).column
    assert np.array_equal(found[column], evaluate(quantity, robot, position, robot.home.rotation)[column])


def test_a_pose_error_has_the_band_of_drawn_robots_and_the_value_as_entered():
    told = cs.pose_error(diagnosed(), pose=(0.3, -0.2, 1.3), band=90, samples=300).answer["bands"]["errors"]
    plain = cs.pose_error("cogiro", pose=(0.3, -0.2, 1.3), band=90).answer["bands"]["errors"]
    for name, row in told.items():
        assert row["value"] == pytest.approx(plain[name]["value"], abs=1e-9)
        assert apart(*row["band"], row["drawn"]) < 0.2, name


def test_forces_along_a_motion_have_the_bands_of_robots_in_balance():
    found = cs.distribute(diagnosed(), LINE, instants=4).found[0]
    forces = UncertainForces(found, found.robot.posterior)
    bands, drawn = forces.bands(0.9), forces.drawn(200, 0.9)
    assert apart(bands.band[drawn.place, :, 0], bands.band[drawn.place, :, 1], np.moveaxis(drawn.ends, -1, 0)) < 0.2
    assert np.array_equal(bands.tension, cs.distribute("cogiro", LINE, instants=4).found[0].distribution.tensions)


def test_sensitivities_are_those_of_the_robot_with_its_numbers_as_they_are():
    held = cs.inverse("cogiro")
    start = cs.Pose(held.pose.position, held.pose.angles)
    ways = {"lengths": held.answer["lengths_m"], "start": start, "count": 4}
    found, own, plain = (cs.sensitivity(robot, **ways).answer for robot in (diagnosed(), corrected(), "cogiro"))
    for table, name in (("tensions", "rate"), ("frequencies", "d_ln_f_d_p")):
        columns = ([row[name] for row in one[table] if name in row] for one in (found, own, plain))
        mine, right, before = map(np.array, columns)
        size = np.abs(right).max()
        assert np.allclose(mine, right, rtol=0.0, atol=1e-5 * size)
        assert not np.allclose(mine, before, rtol=0.0, atol=1e-3 * size)


def test_numbers_beside_the_tolerances_are_in_bands_of_maps_pose_errors_and_motions():
    """A force, a moment and lengths that are drawn anew at every rest, beside what a diagnosis found."""
    robot = replace(diagnosed(), remainder=Remainder(force_N=(30.0,) * 3, moment_Nm=(5.0,) * 3, length_m=0.0005))
    spread = spread_of(robot)
    found = BandedQuantity("tension-min", spread, 0.9, None, 200)(
        robot, robot.home.position[None] + 0.3, robot.home.rotation
    )
    low, high, narrow, wide = (found[band_column("tension-min", end)] for end in (*ENDS[:2], *DRAWN))
    assert apart(low, high, [narrow, wide]) < 0.2
    rows = cs.pose_error(robot, pose=(0.3, -0.2, 1.3), band=90, samples=200).answer["bands"]["errors"]
    assert max(apart(*row["band"], row["drawn"]) for row in rows.values()) < 0.25
    bands = UncertainForces(cs.distribute(robot, LINE, instants=2).found[0], spread)
    drawn, mine = bands.drawn(200, 0.9), bands.bands(0.9).band
    assert apart(mine[drawn.place, :, 0], mine[drawn.place, :, 1], np.moveaxis(drawn.ends, -1, 0)) < 0.2
    assert cs.sensitivity(robot, count=2).answer["shares"]


def test_rests_of_many_points_are_those_of_each():
    robot = diagnosed()
    points = [cs.inverse(robot, pose).point for pose in ((0.0, 0.0, 1.2), (1.0, 0.5, 1.5))]
    together = required(likeliest_rests(points, robot.posterior))
    for point, one in zip(points, together, strict=True):
        alone, spread = at_the_means(point, robot.posterior)
        assert np.allclose(one.position, alone.position, atol=1e-9)
        assert np.allclose(one.cables.tension_at_platform, alone.cables.tension_at_platform, rtol=1e-7)
        assert not spread.mean.any()
        assert one.entered.posterior is None


def test_without_a_diagnosis_a_point_is_its_own_likeliest():
    point, spread = cs.inverse("cogiro").point, Spread.within(Tolerances(), 8)
    there, about = at_the_means(point, spread)
    assert there is point
    assert about is spread


def test_a_robot_whose_likeliest_numbers_hold_no_pose_has_no_band():
    """Nothing is left of cables that are 30 m shorter."""
    robot = diagnosed()
    mean = robot.posterior.mean.copy()
    mean[places(8)[2]] = -30.0
    lost = replace(robot, posterior=replace(robot.posterior, mean=mean))
    with pytest.raises(CdprError, match="does not come to rest"):
        cs.pose_error(lost, pose=(0, 0, 1.2), band=90)
    found = cs.map(lost, "0,0,1.2", "tension-min", band=90).frame()
    assert found["held"].all()
    assert not np.isfinite(found["tension_min_low_N"]).any()
