"""Laws the generated functions obey, whatever the derivation did: limits, symmetry, equilibrium, reciprocity."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from cdpr_struct.generated import cable_compliance, cable_dsm, catenary, platform, tension_bound

LENGTH, STIFFNESS, WEIGHT = 20.0, 2.5e5, 0.067 * 9.81  # m, N, N/m: the cable of table 2.1
TAUT = (20.0, 140.0, 2.5e5, 20.05, 0.067, 0.45)  # chord, tension, EA, L_e, density, weight across
RNG = np.random.default_rng(5)


def test_table_2_2_end_point_and_sag() -> None:
    """Third column, with the sign of f_Cz that the printed end point needs.

    rho = 0.067 kg/m is printed with two digits: 0.75 %, which the sag follows once and the stiffness twice.
    """
    cable = (100.0, -100.0, LENGTH, 20e9 * np.pi / 4 * 0.004**2, WEIGHT)
    assert catenary.end_point(*cable) == pytest.approx((13.70, -14.58), abs=1e-2)
    assert catenary.sag(*cable) == pytest.approx(0.153, rel=7.5e-3)  # 0.1540
    assert catenary.elongation(*cable) == pytest.approx(0.0116, abs=6e-5)
    assert cable_compliance.stiffness(*cable) == pytest.approx((3846, -4083, 4350), rel=1.5e-2)  # 3821 ..


def test_profile_ends_in_the_end_point_and_starts_at_b() -> None:
    cable = (40.0, 5.0, LENGTH, STIFFNESS, WEIGHT)
    assert catenary.profile(0.0, *cable) == pytest.approx((0.0, 0.0), abs=1e-15)
    assert catenary.profile(LENGTH, *cable) == pytest.approx(catenary.end_point(*cable), rel=1e-14)


def test_mirror_images() -> None:
    """force_x -> -force_x mirrors x; turning the cable end for end exchanges V0 and -V1 and keeps the sag."""
    cable, mirrored = (40.0, 17.0, LENGTH, STIFFNESS, WEIGHT), (-40.0, 17.0, LENGTH, STIFFNESS, WEIGHT)
    x, z = catenary.end_point(*cable)
    assert catenary.end_point(*mirrored) == pytest.approx((-x, z), rel=1e-15)
    turned = (40.0, WEIGHT * LENGTH - 17.0, LENGTH, STIFFNESS, WEIGHT)
    assert catenary.end_point(*turned) == pytest.approx((x, -z), rel=1e-14)
    assert catenary.sag(*turned) == pytest.approx(catenary.sag(*cable), rel=1e-14)
    s_q = catenary.chord_parallel_coordinate(*cable)
    assert catenary.chord_parallel_coordinate(*turned) == pytest.approx(LENGTH - s_q, rel=1e-14)


def test_stiffness_is_the_inverse_of_the_derivative_of_the_end_point() -> None:
    """Central differences of the end point, step 1e-4 N: error of order 1e-8 relative."""
    force, step = np.array([40.0, 5.0]), 1e-4
    rest = (LENGTH, STIFFNESS, WEIGHT)
    columns = [
        np.subtract(catenary.end_point(*(force + d), *rest), catenary.end_point(*(force - d), *rest)) / (2 * step)
        for d in np.eye(2) * step
    ]
    k_xx, k_xz, k_zz = cable_compliance.stiffness(*force, *rest)
    product = np.array([[k_xx, k_xz], [k_xz, k_zz]]) @ np.array(columns).T
    assert product == pytest.approx(np.eye(2), abs=1e-6)


def test_taut_vertical_cable_is_a_spring_and_a_string() -> None:
    k_xx, k_xz, k_zz = cable_compliance.stiffness(0.0, 500.0, LENGTH, STIFFNESS, 0.0)
    assert k_zz == pytest.approx(STIFFNESS / LENGTH, rel=1e-14)
    assert k_xx == pytest.approx(1 / (LENGTH / STIFFNESS + LENGTH / 500.0), rel=1e-14)
    assert k_xz == 0.0


def test_everything_broadcasts() -> None:
    forces = np.linspace(-50.0, 50.0, 7)[:, None]
    weights = np.array([0.0, 0.5, 1.0])
    for value in (
        *catenary.end_point(forces + 0.1, 30.0, LENGTH, STIFFNESS, weights),
        *cable_compliance.stiffness(forces + 0.1, 30.0, LENGTH, STIFFNESS, weights),
        catenary.sag(forces + 0.1, 30.0, LENGTH, STIFFNESS, weights),
    ):
        assert value.shape == (7, 3)
        assert np.isfinite(value).all()
    assert platform.mass_matrix(1.0, 0.0, 0.0, forces, weights, 1.0, 1.0, 0.0, 0.0, 0.0).shape == (7, 3, 6, 6)
    assert platform.rotation(forces, 0.0, weights).shape == (7, 3, 3, 3)


def test_dynamic_stiffness_at_rest_is_the_static_small_sag_stiffness() -> None:
    chord, tension, stiffness, effective, _, weight = TAUT
    lam = cable_dsm.lambda_squared(chord, tension, stiffness, effective, weight)
    k_xx, k_xz, k_yy, k_zz = cable_dsm.dynamic_stiffness(0.0, *TAUT)
    assert k_xx == pytest.approx(stiffness / effective / (1 + lam / 12), rel=1e-14)
    assert (k_xz, k_yy, k_zz) == pytest.approx((0.0, tension / chord, tension / chord), rel=1e-14)


def test_static_limit_agrees_with_the_catenary_for_a_taut_level_cable() -> None:
    """The parabola leaves terms of order epsilon^2 = (5e-3)^2."""
    length, tension, weight = 20.0, 2000.0, 0.5
    k_xx, _, k_zz = cable_compliance.stiffness(tension, weight * length / 2, length, STIFFNESS, weight)
    chord = catenary.end_point(tension, weight * length / 2, length, STIFFNESS, weight)[0]
    effective = cable_dsm.effective_length_integral(chord, cable_dsm.epsilon(chord, tension, weight))
    dsm = cable_dsm.dynamic_stiffness(0.0, chord, tension, STIFFNESS, effective, 0.05, weight)
    # EA per unstrained length: the chord is longer by tension/EA = 0.8 %
    assert dsm[0] == pytest.approx(k_xx, rel=0.01)
    assert dsm[3] == pytest.approx(k_zz, rel=0.01)


@pytest.mark.parametrize("omega", [4.0, 9.0, 25.0])
def test_dynamic_stiffness_solves_the_boundary_value_problem(omega: float) -> None:
    """Collocation of tau v'' + h z0'' + rho omega^2 v = 0 in z-up axes: decides the sign of K_xz by numbers."""
    chord, tension, stiffness, effective, density, weight = TAUT

    def slope(x: np.ndarray) -> np.ndarray:
        return weight / (2 * tension) * (2 * x - chord)

    def rates(x: np.ndarray, y: np.ndarray, p: np.ndarray) -> np.ndarray:
        v, dv, _ = y
        return np.array([dv, -(p[0] * weight / tension + density * omega**2 * v) / tension, slope(x) * dv])

    def forces(delta_x: float, delta_z: float) -> tuple[float, float]:
        def ends(a: np.ndarray, b: np.ndarray, p: np.ndarray) -> np.ndarray:
            stretch = p[0] * effective / stiffness - delta_x - b[2]
            return np.array([a[0], b[0] - delta_z, a[2], stretch])

        grid = np.linspace(0.0, chord, 41)
        solution = solve_bvp(rates, ends, grid, np.zeros((3, 41)), p=[0.0], tol=1e-10, max_nodes=20000)
        h = solution.p[0]
        return h, tension * solution.y[1, -1] + h * slope(np.array(chord))

    k_xx, k_xz, _, k_zz = cable_dsm.dynamic_stiffness(omega**2, *TAUT)
    assert forces(1.0, 0.0) == pytest.approx((k_xx, k_xz), rel=1e-6)
    assert forces(0.0, 1.0) == pytest.approx((k_xz, k_zz), rel=1e-6)
    assert abs(k_xz) > 1e-3 * k_zz  # so that a wrong sign would have shown


def test_irvine_roots_make_the_denominator_vanish() -> None:
    """tan y = y - (4/lambda^2) y^3 solved on its own; lambda^2 -> 0 gives Omega = pi, lambda^2 = 4 pi^2 gives 2 pi."""
    for lam in (0.5, 6.4, 24.0, 79.1, 400.0):
        for n in range(1, 4):
            low, high = n * np.pi - np.pi / 2 + 1e-9, n * np.pi + np.pi / 2 - 1e-9
            gap = [np.tan(y) - y + 4 / lam * y**3 for y in (low, high)]
            if gap[0] * gap[1] > 0:
                continue
            y = brentq(lambda y, lam=lam: np.sin(y) - np.cos(y) * (y - 4 / lam * y**3), low, high, xtol=1e-14)
            assert cable_dsm.clamped_frequency_function(2 * y, lam) == pytest.approx(0.0, abs=1e-11 * (1 + lam))
    assert cable_dsm.clamped_frequency_function(np.pi, 0.0) == pytest.approx(0.0, abs=1e-15)
    assert cable_dsm.clamped_frequency_function(2 * np.pi, 4 * np.pi**2) == pytest.approx(0.0, abs=1e-14)


def test_clamped_frequency_function_is_finite_and_changes_sign_once_between_antisymmetric_modes() -> None:
    big = np.linspace(0.0, 40.0, 4001)
    values = cable_dsm.clamped_frequency_function(big, 30.0)
    assert np.isfinite(values).all()
    crossings = big[:-1][np.sign(values[:-1]) != np.sign(values[1:])]
    assert len(crossings) == 6  # one in each interval of 2 pi up to 40


def test_damping_shifts_the_square_of_the_frequency_down_the_imaginary_axis() -> None:
    """A damped cable takes energy out: the imaginary part of the driving point stiffness is positive."""
    squared = cable_dsm.damped_omega_squared(np.linspace(1.0, 40.0, 50), 0.01, 7.0)
    k_xx, _, k_yy, k_zz = cable_dsm.dynamic_stiffness(squared, *TAUT)
    for value in (k_xx, k_yy, k_zz):
        assert (value.imag > 0.0).all()


def test_rotation_is_the_usual_product() -> None:
    angles = RNG.uniform(-3.0, 3.0, (20, 3))
    expected = Rotation.from_euler("xyz", angles).as_matrix()
    assert platform.rotation(*angles.T) == pytest.approx(expected, abs=1e-15)


def test_attachment_is_the_displacement_of_a_small_rotation() -> None:
    arm, motion = np.array([0.4, -0.7, 0.3]), RNG.normal(size=6) * 1e-6
    moved = motion[:3] + Rotation.from_rotvec(motion[3:]).apply(arm) - arm
    assert platform.attachment(*arm) @ motion == pytest.approx(moved, abs=1e-11)
    flipped = platform.attachment_printed(*arm) @ (motion * [1, 1, 1, -1, -1, -1])
    assert flipped == pytest.approx(moved, abs=1e-11)


def test_geometric_stiffness_of_a_pendulum() -> None:
    """5 kg hanging 0.8 m below the pivot is pushed back by m g h; turned upside down it falls over."""
    hanging = platform.geometric_stiffness(0.0, 0.0, -5 * 9.81, 0.0, 0.0, -0.8)
    assert hanging == pytest.approx(np.diag([5 * 9.81 * 0.8, 5 * 9.81 * 0.8, 0.0]), rel=1e-15)
    standing = platform.geometric_stiffness(0.0, 0.0, -5 * 9.81, 0.0, 0.0, 0.8)
    assert standing == pytest.approx(-hanging)


def test_geometric_stiffness_is_the_second_derivative_of_the_work() -> None:
    """Finite rotations exp(theta) a; the remainder of the work is of third order in theta."""
    force, arm, theta = RNG.normal(size=3), RNG.normal(size=3), RNG.normal(size=3) * 1e-3
    both = [-force @ (Rotation.from_rotvec(sign * theta).apply(arm) - arm) for sign in (1.0, -1.0)]
    quadratic = theta @ platform.geometric_stiffness(*force, *arm) @ theta
    assert sum(both) == pytest.approx(quadratic, rel=1e-5)


def test_mass_matrix_gives_the_kinetic_energy() -> None:
    centre, velocity = np.array([0.1, -0.2, 0.3]), RNG.normal(size=6)
    inertia = np.array([[7.0, 0.2, -0.1], [0.2, 9.0, 0.4], [-0.1, 0.4, 11.0]])
    entries = (inertia[0, 0], inertia[1, 1], inertia[2, 2], inertia[0, 1], inertia[0, 2], inertia[1, 2])
    matrix = platform.mass_matrix(60.0, *centre, *entries)
    at_centre = velocity[:3] + np.cross(velocity[3:], centre)
    energy = 60.0 * at_centre @ at_centre / 2 + velocity[3:] @ inertia @ velocity[3:] / 2
    assert velocity @ matrix @ velocity / 2 == pytest.approx(energy, rel=1e-14)
    assert (matrix == matrix.T).all()


def test_tension_bounds_agree_at_a_length_of_g_only() -> None:
    b, density, gravity = 2 * np.pi * 5.0, 0.067, 9.81
    exact = tension_bound.lower_bound_frequency(b, density, gravity)
    assert tension_bound.lower_bound_printed(b, density, gravity, gravity) == pytest.approx(exact, rel=1e-14)
    force = tension_bound.lower_bound_frequency(b, density, 15.0)
    assert np.pi / 15.0 * np.sqrt(force / density) == pytest.approx(b, rel=1e-14)
    assert tension_bound.lower_bound_printed(b, density, gravity, 15.0) < force
