"""Irvine's symmetric frequencies, from no sag to deep sag, in few evaluations."""

import numpy as np

from cdpr_struct.dynamics import clamped_cable
from cdpr_struct.dynamics.clamped_cable import symmetric_roots

LAMBDA2 = np.r_[0.0, 1e-12, np.logspace(-6, 5, 200)]


def test_roots_solve_irvines_equation_each_in_its_interval():
    roots = symmetric_roots(LAMBDA2, 20)
    value = clamped_cable.clamped_frequency_function(roots, LAMBDA2[:, None])
    assert np.abs(value / (1.0 + 0.25 * LAMBDA2[:, None])).max() < 1e-13
    turn = roots / np.pi - (2 * np.arange(1, 21) - 1)
    assert ((turn >= -1e-14) & (turn <= 2.0)).all()


def test_without_sag_they_are_those_of_a_string():
    np.testing.assert_allclose(symmetric_roots(np.zeros(1), 30)[0], (2 * np.arange(1, 31) - 1) * np.pi, rtol=1e-15)


def test_few_evaluations_do(monkeypatch):
    calls: list[int] = []
    function = clamped_cable.clamped_frequency_function
    monkeypatch.setattr(
        clamped_cable, "clamped_frequency_function", lambda *given: (calls.append(1), function(*given))[1]
    )
    symmetric_roots(LAMBDA2, 40)
    assert len(calls) <= 20  # measured 16; halving at every step takes 55
