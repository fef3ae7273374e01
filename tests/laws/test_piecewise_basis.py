"""Functions and coordinate of cables that bend at point masses, cable by cable from first principles."""

import numpy as np
import pytest

from cdpr_struct.dynamics.piecewise_basis import PiecewiseBasis, PiecewiseCoordinate
from cdpr_struct.dynamics.polynomial_basis import gauss_rule
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import cable_model
from tests.laws.test_lumps import LUMPS, loaded


@pytest.fixture(scope="module")
def cables():
    """Masses at two cables; all of the robot's cables at a chord tension of 60 N."""
    robot = loaded("thesis-3-1")
    arrays = RobotArrays.of(robot)
    points = arrays.platform_anchors + robot.home.position
    return cable_model("sagging").hold(arrays, points, np.full(8, 60.0)).states


def test_elements_end_at_the_masses_and_begin_with_the_tension_that_is_left_there(cables):
    found = PiecewiseCoordinate.of(cables)
    np.testing.assert_array_equal(found.length, cables.length)
    assert not found.ends[:, 0].any()
    assert (np.diff(found.ends) > 0.0).all()
    for number in range(8):
        masses = [
            (cables.length[number] - one.from_platform, 9.81 * one.mass) for one in LUMPS if one.cable == number + 1
        ]
        for arc, _ in masses:
            assert np.abs(found.ends[number] - arc).min() < 1e-12
        for low, part in zip(found.ends[number], found.parts, strict=False):
            below = cables.weight[number] * (cables.length[number] - low)
            below += sum(weight for arc, weight in masses if arc > low + 1e-9)
            assert part.frame_vertical[number] == pytest.approx(cables.force_z[number] - below, abs=1e-9)


def test_arc_and_coordinate_turn_each_other_back(cables):
    found, xi = PiecewiseCoordinate.of(cables), np.linspace(-1.0, 1.0, 61)
    arc, rate = found.arc(xi)
    np.testing.assert_allclose(found.xi(arc / cables.length[:, None]), np.broadcast_to(xi, arc.shape), atol=1e-9)
    inner = xi[1:-1] + 1e-3  # beside the ends of elements, where the rate jumps
    step = 1e-6
    slope = (found.arc(inner + step)[0] - found.arc(inner - step)[0]) / (2.0 * step)
    np.testing.assert_allclose(slope, found.arc(inner)[1], rtol=1e-6)
    assert (rate > 0.0).all()


def test_a_rule_that_is_kept_cannot_be_changed():
    assert not any(part.flags.writeable for part in gauss_rule(7))


@pytest.mark.parametrize("elements", [1, 2, 3])
def test_functions_are_continuous_with_their_slopes_and_two_ramps(elements):
    basis = PiecewiseBasis(4, elements)
    xi, step = np.linspace(-0.97, 0.97, 38), 1e-6
    values, slopes = basis.values(xi)
    assert values.shape == slopes.shape == (basis.count, 38)
    assert basis.count == 3 * elements + elements - 1 + 2
    np.testing.assert_allclose(
        (basis.values(xi + step)[0] - basis.values(xi - step)[0]) / (2 * step), slopes, atol=1e-8
    )
    np.testing.assert_allclose(values[-2:], [0.5 - 0.5 * xi, 0.5 + 0.5 * xi], atol=1e-14)
    np.testing.assert_allclose(basis.values(np.array([-1.0, 1.0]))[0][:-2], 0.0, atol=1e-14)
    inner = 2.0 * np.arange(1, elements) / elements - 1.0
    below, above = (basis.values(inner + shift)[0] for shift in (-1e-12, 1e-12))
    np.testing.assert_allclose(below, above, atol=1e-10)
    np.testing.assert_allclose(above[-2 - len(inner) : -2], np.eye(len(inner)), atol=1e-10)  # a hat at each inner end


@pytest.mark.parametrize("elements", [1, 2, 3])
def test_nodes_of_all_elements_integrate_squares_of_functions(elements):
    """Against the middles of 60000 pieces, whose error is below 1e-8; functions alone do not vanish."""
    basis = PiecewiseBasis(4, elements)
    nodes, weights, values, slopes = basis.on_gauss_nodes()
    np.testing.assert_array_equal(values, basis.values(nodes)[0])
    np.testing.assert_array_equal(slopes, basis.values(nodes)[1])
    assert weights.sum() == pytest.approx(2.0)
    middles = (np.arange(60000) + 0.5) / 30000 - 1.0
    square = (basis.values(middles)[0] ** 2).sum(axis=1) / 30000
    np.testing.assert_allclose((values**2) @ weights, square, rtol=1e-7)
