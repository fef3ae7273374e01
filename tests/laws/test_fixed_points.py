"""Fixed points of small vectors: an affine map is solved like a secant, what has settled stays."""

import numpy as np
import pytest

from cdpr_struct.statics.fixed_point import FixedPoint


def searched(x: np.ndarray, image, steps: int) -> np.ndarray:
    search = FixedPoint()
    for _ in range(steps):
        x = search.next(x, image(x))
    return x


@pytest.mark.parametrize("size", [0.5, 0.95, 3.0])  # repetition alone would take 50 or 500 steps, or lead away
def test_affine_maps_of_two_unknowns_take_four_steps(size):
    rng = np.random.default_rng(3)
    turn = np.linalg.qr(rng.standard_normal((5, 2, 2)))[0]
    end = rng.standard_normal((5, 2))
    found = searched(np.zeros((5, 2)), lambda x: end + size * ((x - end)[:, None] @ turn)[:, 0], 4)
    assert np.abs(found - end).max() <= 1e-9 * (1.0 + size**4)  # rounding that grows with the steps


def test_a_point_that_has_settled_stays_beside_others():
    settled = np.array([[0.3, -0.2], [1.0, 2.0]])

    def image(x: np.ndarray) -> np.ndarray:
        return np.where([[True], [False]], settled, np.cos(x))

    found = searched(settled, image, 12)
    assert (found[0] == settled[0]).all()
    assert np.abs(found[1] - np.cos(found[1])).max() <= 1e-12
