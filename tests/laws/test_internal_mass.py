"""A part of the platform on an elastic mount: a hand formula, the count, responses, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.damping import Undamped, Viscous
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.modal_basis import modal_basis
from cdpr_struct.dynamics.natural_frequencies import count_below, natural_frequencies, static_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import platform_port
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    inertia_of_platform,
    platform_mass_matrix,
    platform_static_stiffness,
)
from cdpr_struct.dynamics.swept_stiffness import dynamic_stiffness, swept_dynamic_stiffness
from cdpr_struct.dynamics.transient import after_stop
from cdpr_struct.generated.platform import rotation
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.workspace.quantities import stiffnesses

SWINGING = {"swinging_mass": 5.0, "swinging_frequency": 0.9, "swinging_place": [0.1, -0.05, -0.2]}
INNER = {"internal_mass": 5.0, "internal_frequency": 6.5, "internal_direction": [0.0, 0.6, 0.8]}
TURN = rotation(0.05, -0.04, 0.1)


def at_rest(given: dict = INNER, name: str = "thesis-3-1") -> OperatingPoint:
    robot = load_robot(name)
    robot = replace(robot, extensions=Extensions.of(len(robot.cables), given))
    place = robot.home.position + np.array([0.5, -0.4, 0.2])
    return OperatingPoint(robot, place, TURN, inverse(robot, place, TURN).cables)


def by_hand(point: OperatingPoint) -> np.ndarray:
    """Frequencies [Hz] of a rigid body on springs and of a point mass that slides along an axis in it, on a spring.

    The body without the point has the rest of mass, moment and inertia; both are put together by their velocities.
    """
    more, body, turn = point.entered.extensions, point.entered.platform, point.rotation
    m, axis = more.internal_mass, turn @ more.internal_direction
    moved = np.column_stack([np.eye(3), np.zeros((3, 3)), axis])  # velocity of the point at the platform's origin
    carried = np.column_stack([np.eye(3), np.zeros((3, 4))])  # of a point there that does not slide
    whole = np.zeros((7, 7))
    arm = turn @ body.center_of_mass
    of_center = np.column_stack([np.eye(3), np.cross(np.eye(3), arm).T, np.zeros(3)])
    whole += body.mass * of_center.T @ of_center
    whole[3:6, 3:6] += turn @ body.inertia @ turn.T
    mass = whole - m * carried.T @ carried + m * moved.T @ moved
    stiffness = np.zeros((7, 7))
    stiffness[:6, :6] = platform_static_stiffness(point)
    stiffness[6, 6] = m * (2.0 * np.pi * more.internal_frequency) ** 2
    return np.sqrt(eigh(stiffness, mass, eigvals_only=True)) / (2.0 * np.pi)


@pytest.mark.parametrize("hertz", [2.0, 6.5, 40.0])
def test_a_rigid_body_on_springs_with_one_oscillator(hertz):
    point = at_rest({**INNER, "internal_frequency": hertz})
    found = certified_modes(point, "static", 7)
    assert found.frequencies.certified
    np.testing.assert_allclose(found.frequencies.hertz, by_hand(point), rtol=1e-11)
    np.testing.assert_allclose(static_frequencies(point), by_hand(point), rtol=1e-11)


def test_the_apparent_mass_is_that_of_the_mount():
    """Along its direction m w^2 / (w^2 - omega^2) in place of m, across it m."""
    point, omega = at_rest(), 2.0 * np.pi * np.array([3.0, 6.0, 9.0])
    own = 2.0 * np.pi * INNER["internal_frequency"]
    axis = np.append(TURN @ INNER["internal_direction"], np.zeros(3))
    factor = own**2 / (own**2 - omega**2)
    rigid = platform_mass_matrix(point.arrays, TURN)
    expected = rigid + (INNER["internal_mass"] * (factor - 1.0))[:, None, None] * np.outer(axis, axis)
    found = inertia_of_platform(point, omega**2) / (omega**2)[:, None, None]
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)


def test_a_pendulum_by_hand():
    """Lagrange's equations of a rigid body on springs and of a bob on a cord of length l, with eight unknowns.

    With the hook's motion h and the bob's x against it, both horizontal, 2 V has m g / l x^2, and 2 T m (h' + x')^2.
    """
    length, hook, m = 0.3, np.array([0.1, -0.05, -0.2]), 5.0
    hertz = np.sqrt(9.81 / length) / (2.0 * np.pi)
    point = at_rest({"swinging_mass": m, "swinging_frequency": hertz, "swinging_place": hook})
    body, arm = point.entered.platform, TURN @ hook
    of_hook = np.column_stack([np.eye(3), np.cross(np.eye(3), arm).T])
    of_bob = np.column_stack([of_hook, np.eye(3)[:, :2]])
    of_center = np.column_stack([np.eye(3), np.cross(np.eye(3), TURN @ body.center_of_mass).T])
    mass, stiffness = np.zeros((8, 8)), np.zeros((8, 8))
    mass[:6, :6] = body.mass * of_center.T @ of_center - m * of_hook.T @ of_hook
    mass[3:6, 3:6] += TURN @ body.inertia @ TURN.T
    mass += m * of_bob.T @ of_bob
    stiffness[:6, :6] = platform_static_stiffness(point)
    stiffness[[6, 7], [6, 7]] = m * 9.81 / length
    expected = np.sqrt(eigh(stiffness, mass, eigvals_only=True)) / (2.0 * np.pi)
    np.testing.assert_allclose(certified_modes(point, "static", 8).frequencies.hertz, expected, rtol=1e-11)
    np.testing.assert_allclose(static_frequencies(point), expected, rtol=1e-11)


@pytest.mark.parametrize("parts", ["a mount", "both"])
def test_many_poses_are_each_their_own(parts):
    """The map's way: a batch of poses at once; the first mode of each is that of the pose alone."""
    robot = at_rest(PARTS[parts]).entered
    places = robot.home.position + np.array([[0.0, 0.0, 0.0], [0.5, -0.4, 0.2], [-0.3, 0.2, 0.1]])
    found = stiffnesses(robot, places, np.eye(3))["platform_frequency_Hz"]
    expected = []
    for place in places:
        point = OperatingPoint(robot, place, np.eye(3), inverse(robot, place, np.eye(3)).cables)
        expected.append(certified_modes(point, "static", 1).frequencies.hertz[0])
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_far_above_its_frequency_a_pendulum_leaves_its_weight_alone():
    """The apparent mass across gravity is that without it, along gravity that with it."""
    point, fast = at_rest({**SWINGING, "swinging_place": [0.0, 0.0, 0.0]}), np.array(1e8)
    rigid, found = platform_mass_matrix(point.arrays, TURN), inertia_of_platform(point, fast) / fast
    np.testing.assert_allclose(np.diag(rigid - found)[:3], [5.0, 5.0, 0.0], rtol=1e-5, atol=1e-9)


PARTS = {"a mount": INNER, "a pendulum": SWINGING, "both": {**INNER, **SWINGING}}


@pytest.mark.parametrize("model", ["dsm", "exact"])
@pytest.mark.parametrize("name", ["thesis-3-1", "cogiro"])
@pytest.mark.parametrize("parts", PARTS)
def test_eigenproblem_and_count_agree(parts, name, model):
    """The count knows the condensed stiffness and the parts' own frequencies; the eigenproblem has unknowns more."""
    point = at_rest(PARTS[parts], name=name)
    found = certified_modes(point, model, 14)
    assert found.frequencies.certified
    counted = natural_frequencies(point, found.cables, 14).hertz
    np.testing.assert_allclose(found.shapes.omega / (2.0 * np.pi), counted, rtol=2e-5)  # dsm: a truncated series
    np.testing.assert_allclose(found.frequencies.hertz, counted, rtol=1e-9)
    energy = found.shapes.platform_energy + found.shapes.cable_energy.sum(axis=1)
    np.testing.assert_allclose(energy, 1.0, atol=1e-9)


def test_there_is_one_mode_more():
    """Below a frequency above the mount's, where the other modes stay away from it."""
    counts = []
    for given in (INNER, {}):
        point = at_rest({**given, "internal_mass": 1e-6} if given else {})
        counts.append(count_below(point, cable_dynamics(point, "exact"), np.array([2.0 * np.pi * 7.5]))[0])
    assert counts[0] == counts[1] + 1


def test_a_stiff_mount_is_rigid():
    stiff, rigid = (
        certified_modes(at_rest(given), "exact", 10) for given in ({**INNER, "internal_frequency": 1e4}, {})
    )
    np.testing.assert_allclose(stiff.frequencies.hertz, rigid.frequencies.hertz, rtol=1e-6)


@pytest.mark.parametrize("parts", ["a mount", "both"])
def test_a_swept_stiffness_is_the_full_one(parts):
    point, law = at_rest(PARTS[parts]), Viscous(0.02)
    omega = np.sort(np.append(2.0 * np.pi * np.linspace(0.1, 20.0, 997), 2.0 * np.pi * INNER["internal_frequency"]))
    for model in ("dsm", "exact"):
        cables = cable_dynamics(point, model, omega[-1])
        full = dynamic_stiffness(point, cables, law, omega)
        swept = swept_dynamic_stiffness(point, cables, law, omega)
        size = np.abs(full).max(axis=(1, 2))
        assert (np.abs(swept - full).max(axis=(1, 2)) < 1e-8 * size).all()


@pytest.mark.parametrize("parts", PARTS)
def test_a_response_is_the_sum_over_the_modes(parts):
    """Statics included: far below the first mode, all modes of an expansion together."""
    point, hertz = at_rest(PARTS[parts]), np.array([0.5, 2.2, 5.9, 6.4, 7.9])
    port = platform_port("p", TURN @ np.array([0.0, 0.6, 0.8]), False, np.array([0.1, 0.0, 0.2]))
    top = 2.0 * np.pi * 60.0
    cables = cable_dynamics(point, "exact", top)
    direct = frequency_response(point, cables, Undamped(), port, (port,), hertz, "displacement").response[:, 0]
    every = {"a mount": 7, "a pendulum": 8, "both": 9}[parts] + cables.expansion(top).omega_squared.size
    basis = modal_basis(point, cables, Undamped(), every, top)
    shape = basis.shape_at(port)
    summed = (shape**2 / (basis.omega**2 - (2.0 * np.pi * hertz[:, None]) ** 2)).sum(axis=1)
    np.testing.assert_allclose(direct.real, summed, rtol=1e-6)


@pytest.mark.parametrize(("parts", "modes"), [("a mount", 7), ("both", 9)])
def test_a_stop_excites_the_internal_mass(parts, modes):
    """All of the kinetic energy before the stop is in the modes, the parts that move included."""
    point = at_rest(PARTS[parts])
    top = 2.0 * np.pi * 300.0
    cables = cable_dynamics(point, "static")
    basis = modal_basis(point, cables, Undamped(), modes, top)
    port, twist = (
        platform_port("p", np.array([0.0, 0.0, 1.0]), False, np.zeros(3)),
        np.array([0.1, 0.2, 0.3, 0.0, 0.1, 0.0]),
    )
    found = after_stop(basis, twist, (port,), np.linspace(0.0, 1.0, 50))
    assert found.energy_share == pytest.approx(1.0, abs=1e-12)
    assert found.velocity[0, 0] == pytest.approx(0.3, rel=1e-12)
    assert found.energy[0] == pytest.approx(0.5 * twist @ platform_mass_matrix(point.arrays, TURN) @ twist, rel=1e-12)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"internal_mass": 5.0}, "internal_mass = 5 kg needs internal_frequency, in Hz, above 0"),
        ({"internal_mass": 500.0, "internal_frequency": 3.0}, "must be a part of the platform's mass: below"),
        ({"internal_mass": -1.0, "internal_frequency": 3.0}, "internal_mass must be in kg, not below 0"),
        ({"swinging_mass": 5.0}, "swinging_mass = 5 kg needs swinging_frequency, in Hz, above 0"),
        ({**SWINGING, "swinging_mass": 110.0}, "swinging_mass = 110 kg must be a part of the platform's mass: below"),
        ({**INNER, "internal_direction": [0.0, 0.0, 0.0]}, "internal_direction must not be the zero vector"),
    ],
)
def test_what_is_no_internal_mass_is_refused(given, said):
    robot = load_robot("cogiro")
    with pytest.raises(ValueError, match=said):
        replace(robot, extensions=Extensions.of(8, given))


def test_the_direction_is_a_unit_vector():
    found = Extensions.of(8, {**INNER, "internal_direction": [0.0, 3.0, 4.0]}).internal_direction
    np.testing.assert_allclose(found, [0.0, 0.6, 0.8], rtol=1e-15)
