"""The lowest eigenvalue of very many pencils: as LAPACK finds it, and no other is called proved."""

import numpy as np
import pytest
from scipy.linalg import eigh

from cdpr_struct.dynamics.lowest_eigenvalue import lowest_eigenvalue

COUNT, ORDER = 200, 7


def pencils(mixing: float) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness (n, n, k) with its lowest mode near the last coordinate, or not, and mass."""
    rng = np.random.default_rng(4)
    turn = np.eye(ORDER) + mixing * rng.normal(size=(COUNT, ORDER, ORDER))
    squared = np.c_[rng.uniform(4.0, 50.0, (COUNT, ORDER - 1)), rng.uniform(0.5, 1.5, COUNT)]
    stiffness = turn @ (squared[:, :, None] * np.swapaxes(turn, 1, 2))
    root = np.eye(ORDER) + 0.1 * rng.normal(size=(COUNT, ORDER, ORDER))
    return np.moveaxis(stiffness, 0, -1), np.moveaxis(root @ np.swapaxes(root, 1, 2), 0, -1)


def by_lapack(stiffness: np.ndarray, mass: np.ndarray) -> np.ndarray:
    return np.array([eigh(stiffness[..., i], mass[..., i], eigvals_only=True)[0] for i in range(COUNT)])


@pytest.mark.parametrize("mixing", [0.05, 0.3, 1.0])
def test_what_is_proved_is_the_lowest(mixing):
    stiffness, mass = pencils(mixing)
    value, proved = lowest_eigenvalue(stiffness, mass)
    exact = by_lapack(stiffness, mass)
    np.testing.assert_allclose(value[proved], exact[proved], rtol=1e-11)
    if mixing < 0.1:
        assert proved.all()


def test_a_higher_eigenvalue_is_not_proved():
    stiffness, mass = pencils(0.05)
    second = np.array([eigh(stiffness[..., i], mass[..., i], eigvals_only=True)[1] for i in range(COUNT)])
    value, proved = lowest_eigenvalue(stiffness, mass, start=second)
    higher = value > 1.001 * by_lapack(stiffness, mass)
    assert higher.sum() > 50
    assert not proved[higher].any()


def test_unit_mass_is_the_default():
    stiffness, _ = pencils(0.05)
    unit = np.broadcast_to(np.eye(ORDER)[..., None], stiffness.shape)
    np.testing.assert_allclose(lowest_eigenvalue(stiffness)[0], lowest_eigenvalue(stiffness, unit)[0], rtol=1e-13)
