"""Vibration in time and in frequency on trial before the FEM, which shares no formula with it."""

import numpy as np
import pytest

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.damping import Undamped, Viscous
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.modal_basis import modal_basis
from cdpr_struct.dynamics.ports import CablePort, platform_port
from cdpr_struct.dynamics.swept_stiffness import dynamic_stiffness
from cdpr_struct.dynamics.transient import along_path
from cdpr_struct.dynamics.vibration_record import VibratingRobot
from tests.conftest import at_rest

TWIST = np.array([0.3, -0.2, 0.1, 0.0, 0.1, 0.0])
ELEMENTS = (20, 40, 80)
STEPS, DURATION = 12, 0.6  # of the FEM's Newmark per sample of ours: its error is then below the mesh's; [s]
PORTS = tuple(
    platform_port(name, np.eye(3)["xyz".index(name[-1])], len(name) > 1, np.zeros(3))
    for name in ("x", "y", "z", "rx", "ry", "rz")
)


@pytest.fixture(scope="module")
def point():
    return at_rest("thesis-3-1", np.array([1.3, -0.8, 0.9]))


@pytest.fixture(scope="module")
def meshes(point):
    return [solve_in_fem(point, n) for n in ELEMENTS]


def limit(coarse, fine, ratio=2.0):
    """Richardson's extrapolation of a second-order mesh."""
    return fine + (fine - coarse) / (ratio**2 - 1.0)


@pytest.mark.parametrize("ratio", [0.0, 0.02], ids=["undamped", "damped"])
def test_exact_stiffness_is_the_fem_limit(point, meshes, ratio):
    """D(omega) at frequencies between the clamped ones; the FEM with its own damping and its own omega_1."""
    omega = 2.0 * np.pi * np.array([0.7, 1.9, 3.1, 4.1, 6.1])
    law = Viscous(np.full(8, ratio)) if ratio else Undamped()
    ours = dynamic_stiffness(point, cable_dynamics(point, "exact", omega[-1]), law, omega)
    theirs = [np.linalg.inv(fem.frequency_response(mesh, omega, ratio or None)) for mesh in meshes]
    size = np.sqrt(np.abs(np.einsum("kii->ki", ours)))
    errors = [(np.abs(k - ours) / (size[:, :, None] * size[:, None, :])).max() for k in theirs]
    extrapolated = np.abs(limit(*theirs[1:]) - ours) / (size[:, :, None] * size[:, None, :])
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.25)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.1)
    assert extrapolated.max() < 2e-4


def responses(point, model, law, hertz):
    cables = cable_dynamics(point, model, 2.0 * np.pi * hertz[-1])
    columns = [frequency_response(point, cables, law, port, PORTS, hertz, "displacement").response for port in PORTS]
    return np.stack(columns, axis=-1)


def deviation(ours, theirs):
    """Largest error relative to the diagonal entries of row and column."""
    size = np.sqrt(np.abs(np.einsum("kii->ki", theirs)))
    return (np.abs(ours - theirs) / (size[:, :, None] * size[:, None, :])).max()


def test_damped_response_is_the_fem_limit_and_a_wrong_damping_is_not(point, meshes):
    """Through the resonances, where damping decides: 1 % of critical in the cables; the twin has 1.1 %."""
    hertz = np.arange(2.0, 8.0, 0.05)
    finer = [meshes[-1], solve_in_fem(point, 160)]
    coarse, fine = (fem.frequency_response(mesh, 2.0 * np.pi * hertz, 0.01) for mesh in finer)
    right = responses(point, "exact", Viscous(np.full(8, 0.01)), hertz)
    wrong = responses(point, "exact", Viscous(np.full(8, 0.011)), hertz)
    reference = limit(coarse, fine)
    assert deviation(right, reference) < 0.3 * deviation(wrong, reference)
    assert deviation(right, reference) < 0.02


WATCHED = (*PORTS, CablePort("cable5@0.25:z", 4, 0.25, np.array([0.0, 0.0, 1.0])))


def in_time(mesh, time, ratio=None):
    """Platform (n, 6) and cable point (n,) as the FEM integrates them."""
    step = float(time[1]) / STEPS
    theirs = fem.integrate(mesh, float(time[-1]), step, TWIST, ratio, record=[(4, mesh.elements // 4)])
    return theirs.platform[::STEPS], theirs.cable_nodes[::STEPS, 0, 2]


def worst(ours, theirs):
    """Largest error of each, relative to its largest motion."""
    return np.abs(ours - theirs).max(axis=0) / np.abs(theirs).max(axis=0)


def test_platform_after_a_stop_moves_as_the_fem(point, meshes):
    """Exact model against the FEM's integration over 0.6 s (two to six periods), undamped; error of order h^2."""
    ours = VibratingRobot(point, "exact", Undamped(), 25.0).after_stop(TWIST, WATCHED, DURATION).vibration
    assert ours.energy_share > 0.9999
    coarse, fine = (in_time(mesh, ours.time) for mesh in meshes[1:])
    before, after = (worst(ours.displacement[:, :6], fem_motion[0]).max() for fem_motion in (coarse, fine))
    assert np.log2(before / after) == pytest.approx(2.0, abs=0.3)
    assert after < 0.006
    assert worst(ours.displacement[:, 6], fine[1]) < 0.02


def test_damped_motion_after_a_stop_moves_as_the_fem_and_undamped_motion_does_not(point, meshes):
    damped, undamped = (
        VibratingRobot(point, "exact", law, 25.0).after_stop(TWIST, WATCHED, DURATION).vibration
        for law in (Viscous(np.full(8, 0.05)), Undamped())
    )
    platform, cable = in_time(meshes[1], damped.time, 0.05)
    assert worst(damped.displacement[:, :6], platform).max() < 0.02
    assert worst(damped.displacement[:, 6], cable) < 0.04
    assert worst(undamped.displacement[:, 6], cable) > 0.2


def test_forced_motion_is_the_fem_under_the_same_wrench(point, meshes):
    """A wrench on the platform at rest: the FEM integrates it, the modes sum it.

    The model's drive is the inertia of a nominal motion, which also acts along the cables (1.3 kg of 61 kg here); the
    wrench lumps that share at the platform.
    """
    time = np.arange(0.0, 1.5, 0.005)
    pulse = 2.0 * np.sin(np.pi * np.clip(time, 0.0, 0.5) / 0.5)
    acceleration = np.zeros((len(time), 6))
    acceleration[:, 0] = pulse
    highest = 2.0 * np.pi * 25.0
    cables = cable_dynamics(point, "exact", highest)
    basis = modal_basis(point, cables, Undamped(), 144, highest)
    ours = along_path(basis, acceleration, np.zeros(6), len(time) - 1, PORTS, time)
    _, mass = basis.rigid_motion()

    def wrench(t):
        return -mass[:, 0] * np.interp(t, time, pulse)

    theirs = fem.integrate(meshes[-1], float(time[-1]), 0.0025, external_wrench=wrench)
    platform = theirs.platform[::2]
    error = np.abs(ours.displacement - platform).max(axis=0) / np.abs(platform).max()
    assert error[0] < 0.05  # the cables' share acts along them, not at the platform
