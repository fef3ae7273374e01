"""The switchable catenary that judges the closed form: against the product's exact model and against the FEM."""

import dataclasses

import numpy as np
import pytest

import cdpr_struct.crosscheck.limits_referee as referee
import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.limits_errors import QUANTITIES, measure
from cdpr_struct.crosscheck.limits_groups import CableGroups, broken_limits, inside_printed_limits
from cdpr_struct.crosscheck.limits_reference import Effects, reference_planes
from cdpr_struct.crosscheck.validity_limits import limit_violations
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.taut_cables import taut_cables
from cdpr_struct.statics.catenary_length import length_at_chord_tension
from tests.conftest import at_rest

MIDDLE = np.array([0.5])
TRICKY = CableGroups.of([0.0, 30.0, 60.0, 80.0], [0.24, 0.24, 0.1, 0.2], [20.0, 4.0, 38.0, 2.0])


def groups_of(point) -> CableGroups:
    cables = taut_cables(point)
    along = cables.epsilon * np.tan(np.abs(point.cables.inclination))
    return CableGroups(cables.epsilon, along, cables.tension / cables.axial_stiffness)


def test_end_stiffness_is_that_of_the_products_exact_model():
    """Dimensional, in world axes and for eight real cables there; dimensionless and in chord axes here."""
    point = at_rest("thesis-3-1-8mm", np.array([1.0, 0.5, 0.5]), mass=45.0)
    cables, groups = taut_cables(point), groups_of(point)
    omega = np.array([0.4, 1.7, 2.6])[None, :] * np.pi * cables.frequency_scale[:, None]
    exact = np.stack([cable_dynamics(point, "exact").stiffness(w**2) for w in omega.T], axis=1)
    frame = cables.frame[:, None]
    expected = np.swapaxes(frame, -1, -2) @ exact @ frame / (cables.tension / cables.chord)[:, None, None, None]
    planes = reference_planes(groups, MIDDLE)
    frequency = omega / cables.frequency_scale[:, None]
    lower = (point.cables.inclination < 0.0).astype(int)
    rows = np.arange(len(lower))
    in_plane = planes.in_plane.stiffness(frequency)[rows, lower]
    across = planes.across.stiffness(frequency)[rows, lower, :, 0, 0]
    scale = np.abs(expected).max(axis=(1, 2, 3), keepdims=True)
    # The product's K(0) is a closed form, here it is condensed: both lose digits to EA / tau = 1e3.
    assert (np.abs(in_plane - expected[..., ::2, ::2]) / scale).max() < 1e-8
    assert (np.abs(across - expected[..., 1, 1]) / scale[..., 0]).max() < 1e-8


@pytest.fixture(scope="module")
def verdicts():
    return referee.judge(TRICKY)


def test_fem_confirms_the_catenary_and_not_the_closed_form(verdicts):
    for verdict in verdicts:
        assert verdict.catenary < 2.0 * verdict.uncertainty
        assert verdict.uncertainty < 5e-5
        assert verdict.stiffness < 1e-4  # measured 3e-5 at most, the FEM's own
    assert max(v.closed_form for v in verdicts) > 0.02  # at the crossover; measured 0.029


@pytest.mark.parametrize("missing", ["along_weight", "axial_inertia", "static_strain"])
def test_fem_convicts_a_catenary_that_lacks_an_effect(missing, monkeypatch):
    """Each switch matters somewhere: at the crossover, for K(omega) of a strained cable, for its frequencies."""
    effects = dataclasses.replace(Effects(), **{missing: False})
    monkeypatch.setattr(
        referee, "reference_planes", lambda groups, stations: reference_planes(groups, stations, effects)
    )
    wrong = referee.judge(TRICKY)
    assert max(max(v.catenary, v.stiffness) for v in wrong) > 5e-3


def test_fem_convicts_a_lower_end_that_is_not_mirrored(monkeypatch):
    def wrong_planes(groups, stations):
        planes = reference_planes(groups, stations)
        static = np.repeat(planes.in_plane.static[:, :1], 2, axis=1)
        return dataclasses.replace(planes, in_plane=dataclasses.replace(planes.in_plane, static=static))

    monkeypatch.setattr(referee, "reference_planes", wrong_planes)
    assert max(v.stiffness for v in referee.judge(TRICKY)) > 0.02


def fem_frequencies(alpha_deg, tau, chord, density, stiffness, gravity):
    """First six Omega of a real cable."""
    x, z = chord * np.cos(np.radians(alpha_deg)), chord * np.sin(np.radians(alpha_deg))
    length = float(length_at_chord_tension(x, z, tau, stiffness, density * gravity).length)
    cable = fem.CableData(length, stiffness, density)
    mesh = fem.solve_cable(cable, np.zeros(3), np.array([x, 0.0, z]), 80, np.array([0.0, 0.0, -gravity]))
    return 2.0 * np.pi * fem.cable_modes(mesh, 6).frequencies_hz * chord * np.sqrt(density / tau)


def test_three_groups_are_all_there_is():
    """Two cables of other length, weight, tension and planet with equal groups have equal Omega in the FEM."""
    one = fem_frequencies(50.0, 200.0, 12.0, 0.07, 2.5e4, 9.81)
    other = fem_frequencies(50.0, 900.0, 3.0, 2.52, 2.5e4 * 4.5, 9.81 * 0.5)
    assert other == pytest.approx(one, rel=1e-9)
    twin = fem_frequencies(50.0, 900.0, 3.0, 2.52, 2.5e4 * 5.0, 9.81 * 0.5)
    assert np.abs(twin / one - 1.0).max() > 1e-4


def test_closed_form_becomes_exact_as_the_sag_vanishes():
    """At given lambda^2 the strain and the squared weight along the chord fall with epsilon^2, and so do the errors."""
    sizes = [0.04, 0.02, 0.01, 0.005]
    found = [measure(CableGroups.of(45.0, epsilon, 6.0)) for epsilon in sizes]
    for quantity in ("in_plane_frequency", "across_frequency", "mode_shape"):
        errors = [f[quantity].error.max() for f in found]
        orders = np.log2(np.divide(errors[:-1], errors[1:]))
        assert orders == pytest.approx([2.0] * 3, abs=0.15), quantity
    tiny = measure(CableGroups.of(45.0, 1e-4, 6.0))
    assert max(tiny[q].error.max() for q in QUANTITIES) < 1e-3


def test_a_wrong_lambda_does_not_become_exact(monkeypatch):
    import cdpr_struct.crosscheck.limits_errors as errors

    true_planes = errors.closed_form_planes

    def two_percent_off(groups, stations):
        return true_planes(dataclasses.replace(groups, strain=groups.strain / 1.02), stations)

    monkeypatch.setattr(errors, "closed_form_planes", two_percent_off)
    tiny = measure(CableGroups.of(45.0, 1e-4, 6.0))
    assert tiny["in_plane_frequency"].error.max() > 1e-3


def test_groups_rebuild_the_printed_parameters():
    groups = CableGroups.of([10.0, 60.0], [0.05, 0.1], [3.0, 20.0])
    assert groups.inclination_deg == pytest.approx([10.0, 60.0])
    assert groups.lambda_squared == pytest.approx([3.0, 20.0])
    assert groups.along == pytest.approx(groups.epsilon * np.tan(np.radians([10.0, 60.0])))


def test_limits_agree_with_the_audit_of_single_cables():
    random = np.random.default_rng(5)
    groups = CableGroups.of(random.uniform(0, 89, 400), random.uniform(0, 0.6, 400), random.uniform(0.5, 90, 400))
    broken = broken_limits(groups)
    inside = inside_printed_limits(groups)
    assert inside.any()
    for i in range(len(groups)):
        found = limit_violations(
            1, groups.lambda_squared[i], groups.inclination_deg[i], groups.epsilon[i], groups.epsilon[i] / 8.0
        )
        assert {v.parameter for v in found} == {name for name in broken if broken[name][i]}
        assert inside[i] == (not found)
