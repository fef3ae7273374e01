"""Laws of damping: each takes energy away at every frequency, and each is the formula of docs/damping.md."""

import numpy as np
import pytest

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics, damped
from cdpr_struct.dynamics.damping import Hysteretic, PowerLaw, Rayleigh, Undamped, Viscous, rates
from cdpr_struct.dynamics.swept_stiffness import (
    RELATIVE_TOLERANCE,
    dynamic_stiffness,
    swept_dynamic_stiffness,
)
from tests.conftest import at_rest

FIRST = np.array([14.0, 15.0, 20.0])
OMEGA = np.linspace(0.0, 300.0, 61)[:, None]
LAWS = {
    "undamped": Undamped(),
    "viscous": Viscous(np.array([0.01, 0.02, 0.05])),
    "hysteretic": Hysteretic(0.03),
    "rayleigh": Rayleigh(0.4, 2e-4),
    "rising": PowerLaw(0.03, 1.0),
    "fading": PowerLaw(0.03, -0.5, 20.0),
}


@pytest.fixture(params=LAWS, ids=str)
def law(request):
    return LAWS[request.param]


def test_every_law_takes_energy_at_every_frequency(law):
    assert (np.imag(law.inertia(OMEGA, FIRST)) <= 0.0).all()
    assert (np.imag(law.elasticity(OMEGA, FIRST)) >= 0.0).all()


def test_every_law_is_lossless_and_finite_at_rest(law):
    rest = np.zeros((1, 1))
    np.testing.assert_array_equal(law.inertia(rest, FIRST), 0.0)
    np.testing.assert_array_equal(law.elasticity(rest, FIRST), 1.0)


def test_rates_give_back_the_law(law):
    """a and b of C = a M + b K; constant for the laws that say so."""
    omega = OMEGA[1:]
    a, b = rates(law, omega, FIRST)
    np.testing.assert_allclose(np.imag(law.inertia(omega, FIRST)), -a * omega, atol=1e-12)
    np.testing.assert_allclose(np.imag(law.elasticity(omega, FIRST)), b * omega, atol=1e-12)
    if law.constant_rates:
        assert max(np.ptp(a, axis=0).max(), np.ptp(b, axis=0).max()) < 1e-12


def test_every_law_is_the_formula_of_its_description():
    """At 40 rad/s, by hand; power law: (40/14)^1, (40/20)^-0.5 of the loss factor."""
    omega = np.array([[40.0]])
    undamped, viscous, hysteretic, rayleigh, rising, fading = LAWS.values()
    for law in (undamped, hysteretic, rising, fading):
        np.testing.assert_allclose(law.inertia(omega, FIRST), np.full((1, 3), 1600.0))
    np.testing.assert_allclose(viscous.inertia(omega, FIRST), [[1600 - 11.2j, 1600 - 24j, 1600 - 80j]])
    np.testing.assert_allclose(rayleigh.inertia(omega, FIRST), np.full((1, 3), 1600.0 - 16.0j))
    for law in (undamped, viscous):
        np.testing.assert_array_equal(law.elasticity(omega, FIRST), np.ones((1, 3)))
    np.testing.assert_allclose(hysteretic.elasticity(omega, FIRST), np.full((1, 3), 1.0 + 0.03j))
    np.testing.assert_allclose(rayleigh.elasticity(omega, FIRST), np.full((1, 3), 1.0 + 0.008j))
    np.testing.assert_allclose(rising.elasticity(omega, FIRST)[0], 1.0 + 0.03j * 40.0 / FIRST)
    np.testing.assert_allclose(fading.elasticity(omega, FIRST), np.full((1, 3), 1.0 + 0.03j / np.sqrt(2.0)))
    assert [law.constant_rates for law in LAWS.values()] == [True, True, False, True, False, False]


def test_power_law_meets_its_special_cases():
    flat = PowerLaw(0.03, 0.0, 20.0).elasticity(OMEGA, FIRST)
    np.testing.assert_array_equal(flat, Hysteretic(0.03).elasticity(OMEGA, FIRST))
    steep = PowerLaw(0.03, 1.0, 20.0).elasticity(OMEGA, FIRST)
    np.testing.assert_allclose(steep, Rayleigh(0.0, 0.03 / 20.0).elasticity(OMEGA, FIRST))


def test_massless_cables_have_no_frequency_of_their_own():
    with pytest.raises(ValueError, match="reference_omega"):
        PowerLaw(0.03, 1.0).elasticity(OMEGA, np.full(3, np.inf))
    massless = Viscous(np.full(3, 0.01)).inertia(OMEGA, np.full(3, np.inf))
    np.testing.assert_allclose(massless, OMEGA**2 + np.zeros(3))


@pytest.fixture(scope="module")
def point():
    return at_rest("thesis-3-1", np.array([1.3, -0.8, 0.9]))


def robot_laws(point):
    return [Viscous(point.robot.damping_ratio), Hysteretic(0.02), Rayleigh(0.2, 1e-4), PowerLaw(0.02, 0.5), Undamped()]


@pytest.mark.parametrize("model", ["static", "dsm", "exact"])
def test_platform_never_gets_energy_from_the_cables(point, model):
    """Passivity: Im D(omega) is positive semi-definite, for each law."""
    omega = np.linspace(0.5, 120.0, 300)
    cables = cable_dynamics(point, model, 120.0)
    for law in robot_laws(point):
        if model == "static" and isinstance(law, PowerLaw):
            law = PowerLaw(0.02, 0.5, 20.0)
        matrices = dynamic_stiffness(point, cables, law, omega)
        loss = np.linalg.eigvalsh(matrices.imag).min(axis=1)
        assert (loss > -1e-9 * np.abs(matrices).max(axis=(1, 2))).all()


@pytest.mark.parametrize("model", ["static", "dsm", "exact"])
@pytest.mark.parametrize("top", [8.0, 45.0])
def test_sweep_is_the_full_evaluation(point, model, top):
    """Poles plus interpolation against every frequency in full; entries relative to their row and column."""
    omega = 2.0 * np.pi * np.linspace(0.0, top, 4000)
    cables = cable_dynamics(point, model, omega[-1])
    for law in robot_laws(point)[: 3 if model == "static" else 5]:
        swept = swept_dynamic_stiffness(point, cables, law, omega)[::13]
        full = dynamic_stiffness(point, cables, law, omega[::13])
        size = np.sqrt(np.abs(np.einsum("kii->ki", full)).max(axis=0))
        error = np.abs(swept - full) / (size[:, None] * size)
        assert error.max() < 10.0 * RELATIVE_TOLERANCE  # measured 6e-10, power law near omega = 0


def test_viscous_law_is_the_thesis_formula(point):
    cables = cable_dynamics(point, "dsm")
    omega = np.linspace(1.0, 100.0, 7)[:, None]
    ratio = point.robot.damping_ratio
    np.testing.assert_array_equal(Viscous(ratio).inertia(omega, cables.first_frequency), damped(cables, ratio, omega))
