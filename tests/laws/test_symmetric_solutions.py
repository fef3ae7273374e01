"""Many complex symmetric systems at once agree with LAPACK, small pivots included."""

import numpy as np
import pytest

from cdpr_struct.dynamics.cable_poles import UPPER
from cdpr_struct.dynamics.frequency_response import symmetric_solutions


def systems(count: int) -> np.ndarray:
    rng = np.random.default_rng(4)
    matrices = rng.normal(size=(count, 6, 6)) + 1j * rng.normal(size=(count, 6, 6))
    return matrices + np.swapaxes(matrices, 1, 2)


@pytest.mark.parametrize("forces", [1, 3000])
def test_solutions_are_those_of_lapack(forces):
    matrices = systems(3000)
    force = np.random.default_rng(5).normal(size=(6, forces))
    found = symmetric_solutions(matrices[:, *UPPER].T, force)
    push = np.broadcast_to(force, (6, 3000)).T[..., None]
    residual = np.abs((matrices @ found.T[..., None] - push)[..., 0]).max(axis=1)
    assert (residual <= 1e-10 * (1.0 + np.abs(found).max(axis=0))).all()


def test_a_vanishing_pivot_costs_no_digits():
    matrices = systems(4)
    matrices[0, 0, 0] = 0.0
    matrices[1, 0, 0] = 1e-13 * np.abs(matrices[1]).max()
    matrices[2, :2, :2] = [[1.0, 1.0], [1.0, 1.0 + 1e-14]]
    force = np.ones((6, 1))
    found = symmetric_solutions(matrices[:, *UPPER].T, force)
    np.testing.assert_allclose(found.T, np.linalg.solve(matrices, np.ones((4, 6, 1)))[..., 0], rtol=1e-11)
