"""The coordinate along a hanging cable: hyperbolic angles without loss of digits, and an arc length that turns back."""

from types import SimpleNamespace

import numpy as np
import pytest

from cdpr_struct.dynamics.catenary_coordinate import CatenaryCoordinate

HORIZONTAL = np.array([40.0, 40.0, 40.0, 3.0, 1e-3, 40.0])  # N
FRAME = np.array([5.0, -30.0, -12.0, -12.0, -12.0, 5.0])  # N, vertical tension at the frame end
WEIGHT = np.array([2.0, 2.0, 3.0, 3.0, 3.0, 1e-5])  # N/m; the last one is straight
LENGTH = np.full(6, 9.0)
XI = np.linspace(-1.0, 1.0, 41)


@pytest.fixture
def coordinate():
    """Vertical tension of one sign, of the other, and of both: with a lowest point, in sharper and sharper bends."""
    tension = np.hypot(HORIZONTAL, FRAME)
    cables = SimpleNamespace(
        force_x=HORIZONTAL, force_z=FRAME + WEIGHT * LENGTH, weight=WEIGHT, length=LENGTH, tension_at_frame=tension
    )
    return CatenaryCoordinate.of(cables)


def test_the_angle_is_the_difference_of_inverse_hyperbolic_sines(coordinate):
    exact = np.arcsinh((FRAME + WEIGHT * LENGTH) / HORIZONTAL) - np.arcsinh(FRAME / HORIZONTAL)
    np.testing.assert_allclose(coordinate.angle, exact, rtol=1e-9)  # the difference loses digits, not the coordinate


def test_arc_lengths_run_from_end_to_end_and_turn_back(coordinate):
    """In the sharpest bend, of a radius of 0.3 mm, terms of 12 N cosh(20) cancel to 27 N: 1e-7 of the arc is left."""
    arc, rate = coordinate.arc(XI)
    np.testing.assert_allclose(arc[:, 0], 0.0, atol=1e-12)
    np.testing.assert_allclose(arc[:, -1], LENGTH, rtol=1e-7)
    assert (np.diff(arc) > 0.0).all()
    for cable in range(5):
        found = coordinate.xi(arc[cable] / LENGTH[cable])[cable]
        np.testing.assert_allclose(found, XI, atol=1e-8)
    step, smooth = 1e-5, [0, 1, 2, 3, 5]
    above, below = (coordinate.arc(XI[1:-1] + shift)[0] for shift in (step, -step))
    np.testing.assert_allclose((above - below)[smooth] / (2.0 * step), rate[smooth, 1:-1], rtol=1e-6)


def test_a_straight_cable_has_arc_length_for_coordinate(coordinate):
    arc, rate = coordinate.arc(XI)
    np.testing.assert_allclose(arc[5], 4.5 * (1.0 + XI))
    np.testing.assert_allclose(rate[5], 4.5)
    np.testing.assert_allclose(coordinate.xi(np.array([0.0, 0.25, 1.0]))[5], [-1.0, -0.5, 1.0])
