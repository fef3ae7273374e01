"""Pulleys that nobody entered: which axes, how large, and when there are none (crime=True)."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.hypotheses.causes import library
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.causes.pulleys import AXES, axes
from cdpr_struct.hypotheses.choices import best_mix
from cdpr_struct.hypotheses.hypothesis import SCALES
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.observation.nearby_rest import NearbyRest
from cdpr_struct.observation.rest import static_residuals
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.written_campaigns import extended, noisy, on_pulleys, plan_of, written

CAUSE = LIBRARY["missing_pulleys"]
NUMBERS = len(CAUSE.parameters)
OUTWARDS = AXES.index("outwards")


def theta_of(cables: int, way: int, radius: float, zero: float = 0.0, lean: float = 0.0) -> np.ndarray:
    """(1, m * numbers) the same of all cables; `lean` [rad] in the first direction."""
    own = np.zeros(NUMBERS)
    own[way], own[len(AXES)], own[len(AXES) + 1] = radius, zero, radius * lean
    return np.tile(own, cables)[None]


def along(robot: Robot, way: int, radius: float) -> Robot:
    """The robot with a pulley of one radius on each cable, its axis one of `AXES`."""
    own = axes(RobotArrays.of(robot))[:, way]
    return replace(robot, pulleys=tuple(Pulley(radius, axis) for axis in own))


@pytest.mark.parametrize("seed", range(5))
def test_the_best_mix_of_ways_is_that_of_all(seed):
    """Against all 4^5 = 1024 mixes, with the same gain in closed form, each by hand."""
    rng = np.random.default_rng(seed)
    columns = rng.normal(size=(40, 20))
    gram = columns.T @ columns
    score = columns.T @ (columns[:, rng.integers(0, 4, 5) + 4 * np.arange(5)].sum(axis=1) + rng.normal(size=40))

    def gain(mix: tuple[int, ...]) -> float:
        own = np.array(mix) + 4 * np.arange(5)
        s, g = max(score[own].sum(), 0.0), gram[np.ix_(own, own)].sum()
        return 0.5 * s**2 / (g + SCALES[-1] ** -2) - 0.5 * np.log1p(SCALES[-1] ** 2 * g)

    best = max(product(range(4), repeat=5), key=gain)
    assert best_mix(gram.reshape((5, 4, 5, 4)), score.reshape((5, 4))) == best


def test_axes_are_unit_vectors_that_mean_what_they_say():
    arrays = RobotArrays.of(load_robot("cogiro"))
    found = dict(zip(AXES, np.moveaxis(axes(arrays), -2, 0), strict=True))
    away = arrays.frame_anchors - arrays.frame_anchors.mean(axis=0)
    for name, axis in found.items():
        np.testing.assert_allclose(np.linalg.norm(axis, axis=-1), 1.0, rtol=1e-12, err_msg=name)
    assert ((found["outwards"] * away).sum(axis=-1) > 0.0).all()
    np.testing.assert_allclose(found["outwards"][:, 2], 0.0, atol=1e-15)
    np.testing.assert_allclose(np.cross(found["up"], found["outwards"]), found["left"], atol=1e-15)
    for one, other in (("up", "down"), ("+x", "-x"), ("+y", "-y"), ("outwards", "inwards"), ("left", "right")):
        np.testing.assert_array_equal(found[one], -found[other])


def test_a_pulley_is_put_where_there_is_none_and_leans_by_its_angle():
    robot = load_robot("cogiro")
    robot = replace(robot, pulleys=(Pulley(0.05), *(None,) * 7))
    arrays = RobotArrays.of(robot)
    angle = 0.05  # rad
    found = CAUSE.apply(arrays, theta_of(8, OUTWARDS, 0.03, zero=0.01, lean=angle))
    np.testing.assert_allclose(found.pulley_radius[0], [0.05] + [0.03] * 7)
    np.testing.assert_allclose(found.length_offset[0], [0.0] + [0.01] * 7)
    np.testing.assert_array_equal(found.pulley_axis[0, 0], [0.0, 0.0, 1.0])
    leaning = np.arccos((found.pulley_axis[0, 1:] * axes(arrays)[1:, OUTWARDS]).sum(axis=-1))
    np.testing.assert_allclose(leaning, angle, rtol=5e-3)  # the tangent, and 1 mm of 30 that soften it near none


@pytest.mark.parametrize("way", range(len(AXES)), ids=AXES)
def test_residuals_near_a_state_know_pulleys_that_are_not_there_yet(way):
    """Forward differences of a thousandth of the radius: the curvature is about the radius over the length."""
    robot = load_robot("cogiro")
    data, step = recorded(written(robot, plan_of(robot, 2))), 1e-5
    nearby = NearbyRest.about(data.arrays, data.readings, data.known, data.radius)
    moved = CAUSE.apply(data.arrays, theta_of(8, way, step))
    before = static_residuals(data.arrays, data.readings, data.known, data.radius)
    exact = static_residuals(moved, data.readings, data.known, data.radius) - before
    found = nearby.residuals(moved, data.readings) - before
    for rows in (slice(0, 6), slice(6, None)):
        size = np.abs(exact[:, rows]).max()
        assert size > 0.0
        assert np.abs(found - exact)[:, rows].max() < 1e-4 * size  # measured 2e-5: step over length


def test_residuals_near_pulleys_know_that_their_axes_turn():
    """Central differences of a hundredth of a radian: their error is of the second order in it."""
    robot = on_pulleys("cogiro", 0.05)
    data, angle = recorded(written(robot, plan_of(robot, 2))), 1e-3
    nearby = NearbyRest.about(data.arrays, data.readings, data.known, data.radius)

    def turned(by: float) -> RobotArrays:
        axis = data.arrays.pulley_axis + np.array([by, 2.0 * by, 0.0])
        return replace(data.arrays, pulley_axis=axis / np.linalg.norm(axis, axis=-1, keepdims=True))

    exact = [static_residuals(turned(a), data.readings, data.known, data.radius) for a in (angle, -angle)]
    found = [nearby.residuals(turned(a), data.readings) for a in (angle, -angle)]
    for rows in (slice(0, 6), slice(6, None)):
        expected = (exact[0] - exact[1])[:, rows]
        assert np.abs((found[0] - found[1])[:, rows] - expected).max() < 1e-3 * np.abs(expected).max()


def campaign_of(robot: Robot, entered: Robot, seed: int) -> Campaign:
    return noisy(written(robot, plan_of(robot, 10), entered), seed)


@pytest.mark.parametrize("homed", [pytest.param(False, marks=pytest.mark.slow), True])
def test_pulleys_are_named_with_their_axes_and_radius(homed):
    """Three sigmas of the radius; the extended robot has the pulleys, and lengths homed without them their zeros."""
    entered, radius, zero = load_robot("cogiro"), 0.04, 0.03
    real = along(entered, OUTWARDS, radius)
    said = diagnosed(campaign_of(extended(real, length_offset=np.full(8, zero)) if homed else real, entered, 3))
    assert said.decision.classes == (("missing_pulleys",),)
    size = said.candidates[0].sizes[0]
    assert "axes outwards" in size.part.pattern.label
    assert ("homed" in size.part.pattern.label) == homed
    assert abs(size.mean[0] - radius) < 3.0 * size.sigma[0]
    found = RobotArrays.of(said.extended)
    assert np.abs(found.pulley_radius - radius).max() < 3.0 * size.sigma[0]
    aligned = (found.pulley_axis * RobotArrays.of(real).pulley_axis).sum(axis=-1)
    assert aligned.min() > np.cos(np.radians(5.0))
    assert np.abs(found.length_offset - homed * zero).max() < 0.005  # of 0.03 m


def test_wrong_zeros_alone_are_no_pulleys():
    """Lengths homed without pulleys of no radius are wrong zeros, and nothing else."""
    entered = load_robot("cogiro")
    zeros = np.array([0.02, -0.01, 0.03, 0.01, -0.02, 0.015, 0.025, -0.03])
    said = diagnosed(campaign_of(extended(entered, length_offset=zeros), entered, 4))
    assert said.decision.classes == (("unstrained_length_offset",),)


def test_a_robot_whose_cables_all_have_pulleys_lacks_none():
    robot, bare = on_pulleys("cogiro", 0.05), load_robot("cogiro")
    for one, name, other in ((robot, "pulley_radius", CAUSE.name), (bare, CAUSE.name, "pulley_radius")):
        found, hidden = library.testable(seen_in(recorded(written(one, plan_of(one, 2)))), {})
        assert name in {cause.name for cause in found}
        assert "pulley" in hidden[other]
