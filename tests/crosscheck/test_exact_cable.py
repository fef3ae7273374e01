"""The exact catenary dynamics against the extrapolated FEM, where the closed-form DSM has no business."""

import numpy as np
import pytest

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.single_cable import describe_cable
from cdpr_struct.crosscheck.verification import verify
from cdpr_struct.dynamics.catenary_expansion import expand_catenaries
from cdpr_struct.statics.cable_state import CableStates, cable_stiffness, heading_and_span
from cdpr_struct.statics.catenary import solve_end_forces

AXIAL_STIFFNESS, DENSITY, GRAVITY = 2.5e5, 0.067, 9.81
SOFT = 1e4
MESHES = (80, 160, 320, 640)


def state(end: np.ndarray, length: float, axial_stiffness: float = AXIAL_STIFFNESS) -> CableStates:
    """One cable from the origin to `end`, as arrays of m = 1."""
    offset = np.array([end])
    heading, span = heading_and_span(offset)
    weight = np.array([DENSITY * GRAVITY])
    forces = solve_end_forces(span, offset[:, 2], np.array([length]), axial_stiffness, weight)
    stiff = np.array([axial_stiffness])
    pull, none = (forces.force_x, forces.force_z), np.zeros(1)
    return CableStates(offset, heading, np.array([length]), none, *pull, stiff, weight, forces.status, none)


def sagging_at(inclination_deg: float, sag_ratio: float) -> tuple[np.ndarray, float]:
    """End point and length of a 10 m chord whose sag is the given fraction of it."""
    angle = np.radians(inclination_deg)
    end = 10.0 * np.array([np.cos(angle), 0.0, -np.sin(angle)])
    low, high = 10.0, 30.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if state(end, middle).sag[0] < 10.0 * sag_ratio else (low, middle)
    return end, 0.5 * (low + high)


CASES = {
    "sag 0.3 at 70 deg": sagging_at(70.0, 0.3),
    "sag 0.3, horizontal": sagging_at(0.0, 0.3),
    "vertical, upper end fixed": (np.array([0.0, 0.0, -10.0]), 9.99),
    "vertical, lower end fixed": (np.array([0.0, 0.0, 10.0]), 9.99),
    "taut at 30 deg": sagging_at(30.0, 0.01),
}


def exact(end, length, order=96, axial_stiffness=AXIAL_STIFFNESS):
    cable = state(end, length, axial_stiffness)
    return expand_catenaries(cable, np.array([DENSITY]), order, cable_stiffness(cable))


def meshes(end, length, axial_stiffness=AXIAL_STIFFNESS):
    data = fem.CableData(length, axial_stiffness, DENSITY)
    return [fem.solve_cable(data, np.zeros(3), end, n, (0.0, 0.0, -GRAVITY)) for n in MESHES]


@pytest.mark.parametrize("case", CASES)
def test_clamped_frequencies(case):
    """First ten frequencies in both planes; measured: 2e-7 or better."""
    ours = np.sqrt(exact(*CASES[case]).omega_squared[0, :10]) / (2.0 * np.pi)
    limit = fem.extrapolate(MESHES, np.array([fem.cable_modes(m, 10).frequencies_hz for m in meshes(*CASES[case])]))
    np.testing.assert_allclose(ours, limit.limit, rtol=1e-6)


@pytest.mark.parametrize("case", CASES)
def test_dynamic_end_stiffness(case):
    """K(omega) between the clamped frequencies, all entries, relative to the largest; measured 2e-7.

    A soft cable (EA = 1e4 N): with 2.5e5 N the rounding of the FEM's condensation, EA n / L against entries near 1 N/m,
    leaves 2e-5.
    """
    end, length = CASES[case]
    expansion = exact(end, length, axial_stiffness=SOFT)
    clamped = np.sqrt(expansion.omega_squared[0, :9])
    gaps = np.diff(clamped)
    omegas = (clamped[:-1] + 0.5 * gaps)[gaps > 0.05 * clamped[:-1]][:4]
    ours = expansion.stiffness(omegas[:, None] ** 2)[:, 0]
    found = np.array([fem.end_dynamic_stiffness(mesh, omegas) for mesh in meshes(end, length, SOFT)])
    limit = fem.extrapolate(MESHES, found.reshape(len(MESHES), -1)).limit.reshape(ours.shape)
    scale = np.abs(ours).max(axis=(1, 2), keepdims=True)
    assert np.abs((ours - limit) / scale).max() < 1e-6


def test_error_falls_exponentially_with_the_order():
    end, length = CASES["sag 0.3 at 70 deg"]
    reference = exact(end, length, 128).omega_squared[0, :6]
    error = [np.abs(exact(end, length, n).omega_squared[0, :6] / reference - 1.0).max() for n in (16, 24, 32)]
    assert error[1] < 0.1 * error[0]
    assert error[2] < 0.1 * error[1]


def test_wrong_axial_stiffness_is_noticed():
    """Twin: the FEM of a cable with EA + 2 % must not pass."""
    end, length = CASES["taut at 30 deg"]
    ours = np.sqrt(exact(end, length).omega_squared[0, :10]) / (2.0 * np.pi)
    other = fem.cable_modes(meshes(end, length, 1.02 * AXIAL_STIFFNESS)[2], 10).frequencies_hz
    assert np.abs(ours / other - 1.0).max() > 1e-3


def test_closed_form_limits_exclude_these_cables():
    """The DSM is refused for all but the taut one."""
    for case in ("sag 0.3 at 70 deg", "sag 0.3, horizontal"):
        cable = state(*CASES[case])
        found = describe_cable(
            float(cable.force_x[0]), float(cable.force_z[0]), CASES[case][1], AXIAL_STIFFNESS, DENSITY, GRAVITY
        )
        assert not found["validity"]["valid"]


@pytest.mark.parametrize(
    ("force", "closed_form_off"), [((100.0, -100.0), 3e-4), ((-10.0, 20.0), 0.043), ((2.0, -40.0), 1e-3)], ids=str
)
def test_the_command_shows_catenary_and_fem_side_by_side(force, closed_form_off):
    """A taut cable, one that sags by a seventh of its chord upwards, and a nearly vertical one."""
    found = describe_cable(*force, 20.0, AXIAL_STIFFNESS, DENSITY, GRAVITY, with_fem=True)
    exact_hertz, closed = found["exact_frequencies_hz"], found["frequencies_hz"]
    both = np.sort(exact_hertz["in_plane"] + exact_hertz["out_of_plane"])
    below = both < min(exact_hertz["in_plane"][-1], exact_hertz["out_of_plane"][-1]) * (1.0 + 1e-9)
    assert below.sum() >= 8
    np.testing.assert_allclose(both[below], np.array(found["fem_frequencies_hz"])[below], rtol=2e-6)
    far = max(abs(a / b - 1.0) for a, b in zip(exact_hertz["in_plane"], closed["in_plane"], strict=True))
    assert far == pytest.approx(closed_form_off, rel=0.4)
    assert "fem_frequencies_hz" not in describe_cable(*force, 20.0, AXIAL_STIFFNESS, DENSITY, GRAVITY)


def test_robot_meets_the_extrapolated_fem_to_a_millionth(thesis_point):
    """First 40 eigenfrequencies of the thesis's robot; measured 2e-8 with 40 to 320 elements, here with fewer."""
    trial = verify(thesis_point, (40, 80, 160), 40)
    assert np.abs(trial.exact_hertz / trial.fem_limit_hertz - 1.0).max() < 1e-6
    assert np.abs(trial.relative_error).max() < 0.01
