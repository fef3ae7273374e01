"""Springs at frame ends: the largest compliance across the chord, and springs along axes that store no more energy."""

import numpy as np
import pytest

from cdpr_struct.dynamics.frame_springs import FrameSprings, _groups


@pytest.fixture(scope="module")
def springs():
    """Three springs along random orthonormal directions at 2 cables in 4 poses."""
    rng = np.random.default_rng(4)
    turns = np.linalg.qr(rng.normal(size=(2, 4, 3, 3)))[0]
    return FrameSprings(np.moveaxis(turns, (2, 3), (0, 1)), np.exp(rng.normal(size=(3, 2, 4))), _groups(False, 3))


def compliance(springs, kept):
    """(2, 4, k, k) along some of the axes a, n, y."""
    directions = springs.directions[list(kept)]
    return np.einsum("cqmn,qmn,dqmn->mncd", directions, 1.0 / springs.stiffness, directions)


def test_the_largest_compliance_across_the_chord_is_an_eigenvalue(springs):
    largest = np.linalg.eigvalsh(compliance(springs, (1, 2)))[..., -1]
    np.testing.assert_allclose(springs.give_across, largest, rtol=1e-12)


def test_springs_along_the_axes_store_no_more_energy(springs):
    """Stiffness minus theirs is positive semi-definite; not by far: no further factor of ten is."""
    whole = np.linalg.inv(compliance(springs, (0, 1, 2)))
    along = np.moveaxis(springs.along_axes, 0, -1)[..., None] * np.eye(3)
    assert np.linalg.eigvalsh(whole - along).min() > -1e-12
    assert (np.linalg.eigvalsh(whole - 10.0 * along)[..., 0] < 0.0).all()


def test_some_poses_are_those_of_all(springs):
    some = springs.take(np.array([2, 0]))
    np.testing.assert_array_equal(some.give_across, springs.give_across[:, [2, 0]])
