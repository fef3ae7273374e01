"""Laws that the dynamic stiffness and the natural frequencies obey whatever the numbers."""

import dataclasses

import numpy as np
import pytest

import cdpr_struct.dynamics.certified_modes as certified_modes_module
import cdpr_struct.dynamics.frame_give as frame_give_module
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics, damped, expand_catenaries_at, polynomial_order
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.clamped_cable import clamped_count, symmetric_roots
from cdpr_struct.dynamics.natural_frequencies import (
    count_below,
    natural_frequencies,
    static_frequencies,
)
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    attachment,
    geometric_stiffness,
    platform_dynamic_stiffness,
    platform_mass_matrix,
    platform_static_stiffness,
)
from cdpr_struct.dynamics.taut_cable_expansion import expand_taut_cables
from cdpr_struct.dynamics.taut_cables import taut_cables
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_response import end_stiffness
from cdpr_struct.statics.cable_state import cable_stiffness
from cdpr_struct.statics.inverse_kinematics import inverse
from tests.conftest import at_rest

POSES = ([0.0, 0.0, 0.5], [1.3, -0.8, 0.9], [-2.5, 2.0, 0.5])
ROBOTS = ("thesis-3-1", "thesis-3-1-8mm", "cogiro")


@pytest.fixture(scope="module", params=[(r, p) for r in ROBOTS for p in POSES], ids=str)
def point(request):
    return at_rest(request.param[0], np.array(request.param[1]))


@pytest.fixture(scope="module", params=["dsm", "exact"])
def model(request):
    return request.param


def test_platform_stiffness_is_symmetric(point, model):
    """A symmetric matrix is what reciprocity asks for; the weight's and the cables' moments must cancel for it."""
    cables = cable_dynamics(point, model)
    for stiffness in (platform_static_stiffness(point), platform_dynamic_stiffness(point, cables, np.array([300.0]))):
        np.testing.assert_allclose(stiffness, stiffness.T, atol=1e-9 * np.abs(stiffness).max())


def test_rough_cables_have_the_modes_of_fine_ones(point):
    """To seven digits, with fewer polynomials."""
    omega = 60.0
    fine, rough = (cable_dynamics(point, "exact", omega, rough=r).expansion(omega) for r in (False, True))
    count = int(count_below(point, cable_dynamics(point, "exact", omega), np.array([omega]))[0])
    assert count > 6
    np.testing.assert_allclose(ritz_modes(point, rough, count).omega, ritz_modes(point, fine, count).omega, rtol=1e-7)
    sizes = [cable_dynamics(point, "exact", omega, rough=r).full.omega_squared.shape[-1] for r in (False, True)]
    assert sizes[1] < 0.9 * sizes[0]


def test_exact_cables_are_resolved_to_ten_digits(point):
    """Against polynomials of an order higher by thirty, for all modes below the frequency that is asked for."""
    omega = 60.0
    found, fine = (expand_catenaries_at(point, polynomial_order(point, omega) + more) for more in (0, 30))
    modes, better = (ritz_modes(point, expansion, 80).omega for expansion in (found, fine))
    below = better < omega
    assert below.sum() > 6
    np.testing.assert_allclose(modes[below], better[below], rtol=1e-10)  # rounding: up to 2e-11


def test_dsm_at_rest_is_near_the_static_stiffness(point):
    """At omega = 0 the DSM differs from the catenary's tangent by terms of order epsilon only."""
    dynamic = platform_dynamic_stiffness(point, cable_dynamics(point, "dsm"), np.zeros(1))
    static = platform_static_stiffness(point)
    scale = np.sqrt(np.outer(np.diag(static), np.diag(static)))
    assert np.abs((dynamic - static) / scale).max() < 3.0 * taut_cables(point).epsilon.max()


def test_exact_model_at_rest_is_the_static_stiffness(point):
    """The catenary's closed-form compliance (2.24)-(2.26) and the spectral solution of its equations agree."""
    assert relative_gap(force_of_static_shapes(point), static_ends(point)) < 1e-8  # the slope's finite difference


@pytest.mark.parametrize(("radius", "allowed"), [(1e-5, 1e-8), (0.05, 3e-8), (0.3, 3e-6)])
@pytest.mark.parametrize("axis", [[0.0, 0.0, 1.0], [0.3, 0.2, 1.0]], ids=str)
def test_pulleys_in_the_dynamics_are_those_of_the_statics(radius, allowed, axis):
    """Springs at the frame end against the statics' exit equation, which also counts the weight that rolls off."""
    robot = load_robot("thesis-3-1")
    robot = dataclasses.replace(robot, pulleys=tuple(Pulley(radius, np.array(axis)) for _ in robot.cables))
    position = np.array([0.5, -1.0, 0.8])
    held = OperatingPoint(robot, position, np.eye(3), inverse(robot, position, np.eye(3)).cables)
    assert relative_gap(force_of_static_shapes(held), static_ends(held)) < allowed
    pinned = relative_gap(cable_stiffness(held.cables), static_ends(held))
    assert pinned > 100.0 * allowed or radius < 0.01, "a fixed exit point must not pass for a pulley"


def test_weight_that_rolls_off_a_leaning_wheel_couples_its_swivel_with_turns_of_the_cable(monkeypatch):
    """Deep sag on large wheels: the symmetric part of the statics' stiffness, up to the square of what couples."""
    robot = load_robot("six-cable-8mm")
    wheels = tuple(Pulley(0.3, np.array([0.4, 0.2, 1.0])) for _ in robot.cables)
    robot = dataclasses.replace(robot, pulleys=wheels, platform=dataclasses.replace(robot.platform, mass=10.0))
    position = robot.home.position
    held = OperatingPoint(robot, position, np.eye(3), inverse(robot, position, np.eye(3)).cables)
    statics = static_ends(held)
    statics = 0.5 * (statics + np.swapaxes(statics, 1, 2))
    assert relative_gap(force_of_static_shapes(held), statics) < 1e-5  # measured 4.5e-6
    monkeypatch.setattr(frame_give_module, "_leant", lambda point, wheel, direction: direction)
    assert relative_gap(force_of_static_shapes(held), statics) > 1e-4, "ends that do not lean must be seen"


@pytest.mark.parametrize(
    ("wheel", "allowed"),
    [(None, 1e-5), (Pulley(0.3), 1e-4), (Pulley(0.3, np.array([0.4, 0.2, 1.0])), 1e-4)],
    ids=["eyelet", "upright wheel", "leaning wheel"],
)
def test_what_slides_out_of_an_elastic_line_weighs(wheel, allowed, monkeypatch):
    """Soft lines: the symmetric part of the statics' stiffness, on wheels but for squares of what couples."""
    robot = load_robot("six-cable-8mm")
    light, soft = dataclasses.replace(robot.platform, mass=10.0), Extensions.of(6, {"series_compliance": 5e-3})
    wheels = robot.pulleys if wheel is None else (wheel,) * 6
    robot = dataclasses.replace(robot, pulleys=wheels, platform=light, extensions=soft)
    position = robot.home.position
    held = OperatingPoint(robot, position, np.eye(3), inverse(robot, position, np.eye(3)).cables)
    statics = static_ends(held)
    statics = 0.5 * (statics + np.swapaxes(statics, 1, 2))
    assert relative_gap(force_of_static_shapes(held), statics) < allowed  # measured 1.1e-6, 7.1e-5, 5.2e-5
    if wheel is not None and wheel.axis[0]:
        monkeypatch.setattr(frame_give_module, "_drawn", lambda point, wheel, along: np.zeros(along.shape))
        assert relative_gap(force_of_static_shapes(held), statics) > 2e-3, "it pulls a leaning wheel round"
    monkeypatch.setattr(frame_give_module, "_weight_let_out", lambda point: 0.0)
    assert relative_gap(force_of_static_shapes(held), statics) > 5e-3, "without weight"


def static_ends(point):
    return end_stiffness(RobotArrays.of(point.robot), point.cables)


def relative_gap(ours, reference):
    return np.abs(ours - reference).max() / np.abs(reference).max()


def force_of_static_shapes(point):
    """Stiffness of the moving ends from the slope of the static shapes there: f = D du/ds."""
    exact = cable_dynamics(point, "exact").full
    h = 1e-5
    static, _ = exact.shapes(np.array([1.0 - 2.0 * h, 1.0 - h, 1.0]))
    slope = (3.0 * static[:, 2] - 4.0 * static[:, 1] + static[:, 0]) / (2.0 * h)
    cables = point.cables
    force = np.stack([cables.force_x, np.zeros_like(cables.force_x), cables.force_z], axis=-1)
    tension = np.linalg.norm(force, axis=-1)
    tangent = force / tension[:, None]
    outer = tangent[:, :, None] * tangent[:, None, :]
    along = cables.axial_stiffness[..., None, None] * outer
    across = (tension / (1.0 + tension / cables.axial_stiffness))[:, None, None] * (np.eye(3) - outer)
    local = (along + across) @ slope / cables.length[:, None, None]
    return exact.frame @ local @ np.swapaxes(exact.frame, -1, -2)


def test_a_damped_platform_never_gives_energy(point, model):
    """Passivity: the imaginary part of K is positive semi-definite at every omega > 0."""
    cables = cable_dynamics(point, model, 120.0)
    omega = np.linspace(1.0, 120.0, 400)
    squared = damped(cables, point.robot.damping_ratio, omega[:, None])
    stiffness = platform_dynamic_stiffness(point, cables, squared)
    dissipation = np.linalg.eigvalsh(stiffness.imag)
    assert dissipation.min() > -1e-9 * np.abs(stiffness).max()
    assert dissipation.max() > 0.0


def test_closed_form_is_its_modal_expansion(point):
    """Closed form and expansion of the taut cable are the same cable; what is left is the tail of the series."""
    cables = taut_cables(point)
    omega2 = (1.37 * np.pi * cables.frequency_scale) ** 2
    local = _in_chord_axes(cables, expand_taut_cables(cables, 60).stiffness(omega2))
    closed = _in_chord_axes(cables, cable_dynamics(point, "dsm").stiffness(omega2))
    stiff = np.abs(closed[:, 1:, 1:]).max()
    assert np.abs(local - closed)[:, 1:, 1:].max() < 2e-5 * stiff
    np.testing.assert_allclose(local[:, 0, 0], closed[:, 0, 0], rtol=1e-6)
    np.testing.assert_allclose(local[:, 0, 2], closed[:, 0, 2], rtol=2e-4, atol=1e-5 * stiff)


def _in_chord_axes(cables, stiffness):
    return np.swapaxes(cables.frame, -1, -2) @ stiffness @ cables.frame


def test_count_jumps_by_one_at_every_natural_frequency(point, model):
    cables = cable_dynamics(point, model, 80.0)
    found = natural_frequencies(point, cables, 45)
    assert found.certified
    omega = 2.0 * np.pi * found.hertz
    assert (count_below(point, cables, omega * (1.0 - 1e-9)) < np.arange(1, 46)).all()
    assert (count_below(point, cables, omega * (1.0 + 1e-9)) >= np.arange(1, 46)).all()


def test_quick_modes_are_those_of_the_count(point, model):
    """Two ways through the same model: bisection of the transcendental count, and an eigenproblem with a correction."""
    quick = certified_modes(point, model, 40)
    slow = natural_frequencies(point, quick.cables, 40).hertz
    np.testing.assert_allclose(quick.frequencies.hertz, slow, rtol=2e-9)
    assert (2.0 * np.pi * slow < quick.shapes.omega * (1.0 + 1e-9)).all(), "Ritz frequencies are upper bounds"


def test_a_bad_first_guess_is_repaired_by_bisection(point, monkeypatch):
    """Twin: frequencies off by 1 % must not be certified; the count finds the right ones."""
    right = certified_modes(point, "exact", 12).frequencies
    monkeypatch.setattr(certified_modes_module, "_corrected", lambda point, cables, shapes, way: 1.01 * shapes.omega)
    repaired = certified_modes(point, "exact", 12).frequencies
    assert repaired.certified
    np.testing.assert_allclose(repaired.hertz, right.hertz, rtol=3e-9)


def test_reduced_expansion_keeps_the_stiffness(point):
    full = cable_dynamics(point, "exact", 60.0).full
    omega2 = np.linspace(1.0, 60.0, 200)[:, None] ** 2
    reference, ours = full.stiffness(omega2), full.reduced(60.0).stiffness(omega2)
    assert full.reduced(60.0).omega_squared.shape[1] < full.omega_squared.shape[1]
    assert (np.abs(ours - reference).max(axis=(-1, -2)) / np.abs(reference).max(axis=(-1, -2))).max() < 2e-8


def test_energy_shares_sum_to_one_and_shapes_meet_the_platform(point, model):
    shapes = certified_modes(point, model, 30).shapes
    np.testing.assert_allclose(shapes.platform_energy + shapes.cable_energy.sum(axis=1), 1.0, atol=1e-9)
    ends = shapes.cable_motion(np.array([1.0]))[:, :, 0]
    moved = np.einsum("mai,ki->kma", attachment(point), shapes.platform)
    np.testing.assert_allclose(ends, moved, atol=1e-9 * np.abs(moved).max())


def test_clamped_count_steps_at_the_listed_frequencies(point):
    cables = taut_cables(point)
    symmetric = symmetric_roots(cables.lambda_squared, 4)
    for i, scale in enumerate(cables.frequency_scale):
        n = np.arange(1, 9)
        every = np.sort(np.concatenate([np.pi * n, 2.0 * np.pi * n[:4], symmetric[i]]))
        apart = np.flatnonzero(np.diff(every[:9]) > 1e-6)
        omega = 0.5 * (every[apart] + every[apart + 1]) * scale
        expected = [(every * scale < w).sum() for w in omega]
        assert clamped_count(cables, omega[:, None])[:, i].tolist() == expected


def test_static_frequencies_are_rayleigh_quotients(point):
    """sum of omega^2 is the trace of M^-1 K."""
    hertz = static_frequencies(point)
    trace = np.trace(
        np.linalg.solve(platform_mass_matrix(point.robot, point.rotation), platform_static_stiffness(point))
    )
    assert ((2.0 * np.pi * hertz) ** 2).sum() == pytest.approx(trace, rel=1e-9)


def test_geometric_term_is_absent_from_the_thesis_assembly(point):
    difference = platform_static_stiffness(point) - platform_static_stiffness(point, "thesis")
    np.testing.assert_allclose(difference[3:, 3:], geometric_stiffness(point), atol=1e-6)
    assert np.abs(difference[:3]).max() == 0.0
    assert np.abs(difference[3:, 3:]).max() > 0.0
