"""Laws of frequency responses: reciprocity, passivity, statics, superposition, and where the peaks are."""

import numpy as np
import pytest

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.damping import Hysteretic, PowerLaw, Rayleigh, Undamped, Viscous
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.frequency_sweep import sweep_response
from cdpr_struct.dynamics.modal_basis import modal_basis
from cdpr_struct.dynamics.natural_frequencies import natural_frequencies
from cdpr_struct.dynamics.ports import CablePort, platform_port
from cdpr_struct.dynamics.robot_dynamic_stiffness import platform_static_stiffness
from tests.conftest import at_rest

HERTZ = np.arange(0.5, 12.0, 0.01)
X, Y, Z = np.eye(3)
CORNER = np.array([0.3, -0.2, 0.1])
PORTS = (
    platform_port("z", Z, False, CORNER),
    platform_port("x", X, False, np.zeros(3)),
    platform_port("ry", Y, True, CORNER),
    CablePort("cable5@0.3:z", 4, 0.3, Z),
    CablePort("cable5@0.7:y", 4, 0.7, Y),
    CablePort("cable2@0.5:x", 1, 0.5, X),
)
LAWS = [Viscous(np.full(8, 0.01)), Hysteretic(0.02), Rayleigh(0.2, 1e-4), PowerLaw(0.02, 0.7)]


@pytest.fixture(scope="module")
def point():
    return at_rest("thesis-3-1", np.array([1.3, -0.8, 0.9]))


@pytest.fixture(scope="module", params=["dsm", "exact"])
def cables(point, request):
    return cable_dynamics(point, request.param, 2.0 * np.pi * 12.0)


def compliance(point, cables, law, hertz=HERTZ):
    """(f, n, n) displacement per force between all PORTS."""
    columns = [
        frequency_response(point, cables, law, excite, PORTS, hertz, "displacement").response for excite in PORTS
    ]
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_reciprocity_and_passivity(point, cables, law):
    """H is symmetric, and -Im H positive semi-definite: no shaker at any set of ports ever gets energy back."""
    matrix = compliance(point, cables, law)
    size = np.abs(matrix).max(axis=(1, 2))
    assert (np.abs(matrix - np.swapaxes(matrix, 1, 2)).max(axis=(1, 2)) < 1e-12 * size).all()
    assert (np.linalg.eigvalsh(-matrix.imag).min(axis=1) > -1e-10 * size).all()


def test_static_limit_is_the_compliance(point):
    platform = PORTS[:3]
    expected = np.stack([port.twist for port in platform]) @ np.linalg.solve(
        platform_static_stiffness(point), platform[0].twist
    )
    for model in ("static", "exact"):
        cables = cable_dynamics(point, model)
        hertz = np.array([0.0, 1e-5])
        found = frequency_response(point, cables, Hysteretic(0.02), platform[0], platform, hertz, "displacement")
        np.testing.assert_allclose(found.response[0], expected, rtol=1e-7)


def test_quantities_are_derivatives(point, cables):
    responses = {
        quantity: frequency_response(point, cables, LAWS[0], PORTS[0], PORTS, HERTZ, quantity).response
        for quantity in ("displacement", "velocity", "acceleration")
    }
    omega = 2.0 * np.pi * HERTZ[:, None]
    np.testing.assert_allclose(responses["velocity"], 1j * omega * responses["displacement"])
    np.testing.assert_allclose(responses["acceleration"], -(omega**2) * responses["displacement"])


def test_response_is_the_sum_over_all_modes(point):
    """Undamped: sum of shape_i shape_j / (omega_n^2 - omega^2) over every mode that the exact model has."""
    cables = cable_dynamics(point, "exact")
    highest = 1e9
    count = 6 + cables.expansion(highest).omega_squared.size
    basis = modal_basis(point, cables, Undamped(), count, highest)
    shapes = np.stack([basis.shape_at(port) for port in PORTS], axis=1)
    hertz = np.arange(0.503, 12.0, 0.111)
    gap = basis.omega**2 - (2.0 * np.pi * hertz[:, None]) ** 2
    summed = np.einsum("fk,ki,kj->fij", 1.0 / gap, shapes, shapes)
    direct = compliance(point, cables, Undamped(), hertz)
    np.testing.assert_allclose(direct[:, :, :3], summed[:, :, :3], rtol=1e-6, atol=1e-7 * np.abs(summed).max())
    point_modes = np.abs(direct - summed)[:, 3:, 3:].max()  # the modes of a point, cut off: 1 % of a cable's own sag
    assert point_modes < 0.02 * np.abs(summed[:, 3:, 3:]).max()


@pytest.mark.parametrize("model", ["static", "dsm", "exact"])
def test_light_damping_peaks_at_certified_frequencies(point, model):
    """eta = 1e-4: all six driving-point accelerations together show every mode that moves the platform."""
    hertz = np.arange(2.0, 8.0, 0.01)
    ports = tuple(
        platform_port(name, np.eye(3)["xyz".index(name[-1])], len(name) > 1, np.zeros(3))
        for name in ("x", "y", "z", "rx", "ry", "rz")
    )
    sweeps = [sweep_response(point, model, Hysteretic(1e-4), excite, (excite,), hertz) for excite in ports]
    peaks, modes = np.concatenate([sweep.peaks[0].hertz for sweep in sweeps]), sweeps[0].modes
    nearest = np.abs(peaks[:, None] - modes.hertz).min(axis=1)
    assert nearest.max() < 7e-4  # the half-power width of a mode at 7 Hz
    by_platform = [h for h, kind in zip(modes.hertz, modes.kinds, strict=True) if kind == "platform" and h > 2.0]
    assert len(by_platform) >= 4
    assert all(np.abs(peaks - h).min() < 7e-4 for h in by_platform)


def test_a_point_of_the_platform_moves_with_it(point, cables):
    """Displacement of a corner = that of the origin + rotation x arm."""
    names = [platform_port("", axis, turns, np.zeros(3)) for turns in (False, True) for axis in np.eye(3)]
    corner = tuple(platform_port("", axis, False, CORNER) for axis in np.eye(3))
    response = frequency_response(point, cables, LAWS[0], PORTS[0], (*names, *corner), HERTZ).response
    expected = response[:, :3] + np.cross(response[:, 3:6], CORNER)
    np.testing.assert_allclose(response[:, 6:], expected, rtol=1e-9, atol=1e-12 * np.abs(expected).max())


def test_a_cable_point_near_the_platform_moves_with_its_anchor(point, cables):
    anchor = point.rotation @ point.robot.platform_anchors[4]
    on_platform, on_cable = platform_port("", Z, False, anchor), CablePort("", 4, 1.0 - 1e-9, Z)
    response = frequency_response(point, cables, LAWS[0], PORTS[0], (on_platform, on_cable), HERTZ).response
    np.testing.assert_allclose(response[:, 1], response[:, 0], rtol=1e-5, atol=1e-6 * np.abs(response).max())


def test_sweep_brings_the_certified_modes_of_its_band(point):
    sweep = sweep_response(point, "exact", LAWS[0], PORTS[0], PORTS[:2], HERTZ)
    assert sweep.modes.certified
    assert sweep.modes.complete
    cables = cable_dynamics(point, "exact", 2.0 * np.pi * 12.0)
    following = natural_frequencies(point, cables, len(sweep.modes.hertz) + 1).hertz
    np.testing.assert_allclose(sweep.modes.hertz, following[:-1], rtol=1e-9)
    assert following[-1] > HERTZ[-1]
    assert len(sweep.modes.kinds) == len(sweep.modes.hertz)
