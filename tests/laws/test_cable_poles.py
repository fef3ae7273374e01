"""The sum over the cables' poles is the full stiffness; the closed form's modal integrals are those of its shapes."""

import numpy as np
import pytest

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.cable_poles import UPPER, CableFactors
from cdpr_struct.dynamics.damping import Hysteretic, PowerLaw, Rayleigh, Undamped, Viscous
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.swept_stiffness import dynamic_stiffness, swept_stiffness
from cdpr_struct.dynamics.taut_cable_expansion import expand_taut_cables
from cdpr_struct.dynamics.taut_cables import taut_cables
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

TOP = 2.0 * np.pi * 8.0
LAWS = {
    "undamped": Undamped(),
    "viscous": Viscous(np.full(8, 0.01)),
    "hysteretic": Hysteretic(0.02),
    "rayleigh": Rayleigh(0.2, 1e-4),
    "power": PowerLaw(0.02, 0.5, 15.0),
}


@pytest.fixture(scope="module")
def point():
    robot, position = load_robot("thesis-3-1"), np.array([1.3, -0.8, 0.9])
    return OperatingPoint(robot, position, np.eye(3), inverse(robot, position, np.eye(3)).cables)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("model", ["static", "exact"])
def test_the_sum_over_all_poles_is_the_full_stiffness(point, model, law):
    omega = np.linspace(0.0, TOP, 41)
    cables = cable_dynamics(point, model, TOP)
    found = swept_stiffness(point, cables, LAWS[law], (0.0, TOP)).model.upper(
        CableFactors.of(LAWS[law], omega, cables.first_frequency)
    )
    full = dynamic_stiffness(point, cables, LAWS[law], omega)[:, *UPPER].T
    assert np.abs(found[:, 0] + 1j * found[:, 1] - full).max() < 1e-10 * np.abs(full).max()


def test_exactly_at_a_pole_the_stiffness_is_finite(point):
    cables = cable_dynamics(point, "exact", TOP)
    poles = swept_stiffness(point, cables, LAWS["undamped"], (0.0, TOP)).model.poles
    place = np.sqrt(poles.omega_squared[:1])
    factors = CableFactors(place, np.ones((8, 1)), np.full((8, 1), poles.omega_squared[0]))
    gap = poles.terms(np.arange(1), factors)[0, 0, 0]
    assert gap == pytest.approx(1.0 / (np.finfo(float).eps * poles.omega_squared[0]))
    beside = np.flatnonzero(np.abs(poles.omega_squared / poles.omega_squared[0] - 1.0) > 1e-3)
    others = poles.terms(np.append(0, beside), factors)[1 : 1 + len(beside), 0, 0]
    np.testing.assert_allclose(others, 1.0 / (poles.omega_squared[beside] - poles.omega_squared[0]), rtol=1e-9)


@pytest.mark.parametrize("model", ["dsm", "exact"])
def test_a_law_that_is_not_smooth_at_rest_needs_no_finer_segments(point, model):
    cables = cable_dynamics(point, model, TOP)
    smooth, rough = (swept_stiffness(point, cables, LAWS[law], (0.0, TOP)) for law in ("viscous", "power"))
    assert [piece.low for piece in rough.pieces] == [piece.low for piece in smooth.pieces]


@pytest.mark.parametrize("pairs", [1, 9])
def test_integrals_of_the_closed_forms_modes_are_those_of_their_shapes(point, pairs):
    cables = taut_cables(point)
    mass = cables.linear_density * cables.chord
    nodes, weights = np.polynomial.legendre.leggauss(80)
    found = expand_taut_cables(cables, pairs)
    static, modes = found.shapes(0.5 * (nodes + 1.0))
    static[..., 0, :] = 0.0  # motion along the chord carries no mass
    weights = 0.5 * weights * mass[:, None]
    close = {"rtol": 1e-12, "atol": 1e-12 * np.sqrt(mass.max())}
    np.testing.assert_allclose(np.einsum("mpsa,mpsa,ms->mp", modes, modes, weights), 1.0, rtol=1e-12)
    np.testing.assert_allclose(np.einsum("mpsa,msab,ms->mpb", modes, static, weights), found.coupling, **close)
    np.testing.assert_allclose(np.einsum("msca,mscb,ms->mab", static, static, weights), found.end_mass, **close)
    np.testing.assert_allclose(np.einsum("mpsc,ms->mpc", modes, weights), found.rigid_modes, **close)
    np.testing.assert_allclose(np.einsum("msca,ms->mac", static, weights), found.rigid_end, **close)
