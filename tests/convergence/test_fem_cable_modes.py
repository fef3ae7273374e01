"""Do the modes and the end stiffness of the bar cable obey the laws, and converge as stated?"""

import numpy as np
import pytest

from cdpr_struct.fem_reference import (
    CableData,
    UnstableEquilibriumError,
    cable_count_below,
    cable_modes,
    end_dynamic_stiffness,
    extrapolate,
    solve_cable,
)
from cdpr_struct.fem_reference.cable_modes import clamped_matrices
from cdpr_struct.fem_reference.eigen_solver import lowest_eigenpairs
from cdpr_struct.fem_reference.sparse_chain import chain_matrix

EA, MU = 251327.4123, 0.067  # N, kg/m
CABLE = CableData(20.0, EA, MU)
START, END = np.zeros(3), np.array([13.696, 0.0, -14.586])
COUNTS = [20, 40, 80, 160]
MASSES = pytest.mark.parametrize("mass", ["lumped", "consistent"])


def first_frequencies(cable, end, elements, each=6, mass="lumped", gravity=(0.0, 0.0, -9.81)):
    """First in-plane, then out-of-plane frequencies [Hz]."""
    modes = cable_modes(solve_cable(cable, START, end, elements, gravity), 4 * each, mass)
    assert np.minimum(modes.in_plane_share, 1.0 - modes.in_plane_share).max() < 1e-9  # no mode is of both planes
    inside = modes.in_plane_share > 0.5
    return np.concatenate([modes.frequencies_hz[inside][:each], modes.frequencies_hz[~inside][:each]])


@MASSES
def test_first_six_frequencies_of_both_kinds_converge_with_order_two(mass):
    values = np.array([first_frequencies(CABLE, END, n, mass=mass) for n in COUNTS])
    result = extrapolate(COUNTS, values)
    assert result.order == pytest.approx(np.full(12, 2.0), abs=0.1)  # measured 1.996 ... 2.0001, lumped
    assert np.abs(values[-1] / result.limit - 1.0).max() < 1e-3


def test_both_mass_models_tend_to_the_same_limit_from_either_side():
    lumped, consistent = (
        np.array([first_frequencies(CABLE, END, n, mass=mass) for n in COUNTS]) for mass in ("lumped", "consistent")
    )
    limits = [extrapolate(COUNTS, values).limit for values in (lumped, consistent)]
    assert limits[0] == pytest.approx(limits[1], rel=2e-6)
    wrong = np.array([first_frequencies(CableData(20.0, 1.02 * EA, MU), END, n) for n in COUNTS])
    assert extrapolate(COUNTS, wrong).limit != pytest.approx(limits[1], rel=2e-6)


@pytest.mark.parametrize(
    "end",
    [(0.0, 0.0, -20.02), (8.0, 2.0, 1.0), (3.0, 0.0, -3.0)],
    ids=["vertical", "sag above half the chord", "chord a fifth of the length"],
)
def test_vertical_and_slack_cables_converge_with_order_two(end):
    counts = [160, 320, 640]
    values = np.array([first_frequencies(CABLE, end, n, each=3) for n in counts])
    assert extrapolate(counts, values).order == pytest.approx(np.full(6, 2.0), abs=0.1)


def string_frequencies_agree(axial_stiffness):
    """Frequencies of a weightless taut cable against n / 2l sqrt(T / mu'), mu' per present length."""
    length, span = 20.0, 20.08
    tension = EA * (span / length - 1.0)
    string = np.arange(1, 6) / (2.0 * span) * np.sqrt(tension / (MU * length / span))
    cable = CableData(length, axial_stiffness, MU)
    values = [first_frequencies(cable, (span, 0.0, 0.0), n, each=5, gravity=np.zeros(3)) for n in COUNTS]
    return np.abs(extrapolate(COUNTS, values).limit / np.tile(string, 2) - 1.0).max() < 1e-6


def test_taut_cable_sounds_like_a_string():
    assert string_frequencies_agree(EA)
    assert not string_frequencies_agree(1.02 * EA)


@MASSES
def test_rigid_translation_moves_the_whole_mass(mass):
    state = solve_cable(CABLE, START, END, 33)
    for axis in np.eye(3):
        motion = np.tile(axis, 2)
        moved = np.einsum("a,nab,b->", motion, state.element_mass(mass), motion)
        assert moved == pytest.approx(MU * 20.0, rel=1e-14)


def test_rigid_translation_costs_nothing():
    state = solve_cable(CABLE, START, END, 33)
    forces = state.element_stiffness() @ np.tile([0.3, -0.2, 0.9], 2)
    assert np.abs(forces).max() < 1e-12 * EA / state.element_length


@MASSES
def test_matrices_are_symmetric_and_shapes_have_unit_modal_mass(mass):
    state = solve_cable(CABLE, START, END, 40)
    stiffness, inertia = clamped_matrices(state, mass)
    assert abs(stiffness - stiffness.T).max() < 1e-14 * abs(stiffness).max()
    modes = cable_modes(state, 20, mass)
    shapes = modes.shapes.reshape(20, -1)
    assert shapes @ (inertia @ shapes.T) == pytest.approx(np.eye(20), abs=1e-8)
    omega = 2.0 * np.pi * modes.frequencies_hz
    assert np.diag(shapes @ (stiffness @ shapes.T)) == pytest.approx(omega**2, rel=1e-8)


def test_swapping_the_ends_keeps_the_frequencies():
    there, back = (cable_modes(solve_cable(CABLE, *ends, 50), 12) for ends in ((START, END), (END, START)))
    assert back.frequencies_hz == pytest.approx(there.frequencies_hz, rel=1e-8)
    assert back.in_plane_share == pytest.approx(there.in_plane_share)


@MASSES
def test_sign_count_agrees_with_the_eigenvalues(mass):
    state = solve_cable(CABLE, START, END, 61)
    omegas = 2.0 * np.pi * cable_modes(state, 180, mass).frequencies_hz
    for omega in np.geomspace(0.5 * omegas[0], 2.0 * omegas[-1], 60):
        assert cable_count_below(state, omega, mass) == (omegas < omega).sum()


def condensed_densely(state, square, mass):
    stiffness = chain_matrix(state.element_stiffness()[None]).toarray()
    matrix = stiffness - square * chain_matrix(state.element_mass(mass)[None]).toarray()
    inner, end = slice(0, -3), slice(-3, None)
    return matrix[end, end] - matrix[end, inner] @ np.linalg.solve(matrix[inner, inner], matrix[inner, end])


@MASSES
@pytest.mark.parametrize("elements", [2, 3, 7, 64])
def test_end_stiffness_is_the_schur_complement(mass, elements):
    state = solve_cable(CABLE, START, END, elements)
    omegas = np.array([[0.0, 3.0], [11.0, 25.0]])
    ends = end_dynamic_stiffness(state, omegas, mass)
    assert ends.shape == (2, 2, 3, 3)
    assert ends.dtype == float
    for index, omega in np.ndenumerate(omegas):
        dense = condensed_densely(state, omega**2, mass)
        assert ends[index] == pytest.approx(dense, abs=1e-9 * np.abs(dense).max())


def test_damping_takes_the_place_of_omega_squared():
    state, omega, ratio, reference = solve_cable(CABLE, START, END, 20), 5.0, 0.02, 7.3
    damped = end_dynamic_stiffness(state, omega, damping_ratio=ratio, reference_omega=reference)
    dense = condensed_densely(state, omega**2 - 2.0j * ratio * reference * omega, "lumped")
    assert damped == pytest.approx(dense, abs=1e-9 * np.abs(dense).max())
    assert np.linalg.eigvalsh(damped.imag).min() > 0.0  # a dashpot takes energy at positive omega
    complex_omega = end_dynamic_stiffness(state, 5.0 + 0.1j)
    assert complex_omega == pytest.approx(condensed_densely(state, (5.0 + 0.1j) ** 2, "lumped"), abs=1e-4)
    with pytest.raises(ValueError, match=r"damping_ratio 0\.02 needs reference_omega"):
        end_dynamic_stiffness(state, omega, damping_ratio=ratio)


def end_stiffness_agrees(claimed, axial_stiffness, end, elements=40, step=1e-5):
    cable, columns = CableData(20.0, axial_stiffness, MU), []
    for axis in np.eye(3):
        forces = [solve_cable(cable, START, end + sign * step * axis, elements).end_force for sign in (1, -1)]
        columns.append((forces[0] - forces[1]) / (2.0 * step))
    return np.abs(np.array(columns).T - claimed).max() < 1e-5 * np.abs(claimed).max()


@pytest.mark.parametrize(
    "end", [END, np.array([8.0, 2.0, 1.0]), np.array([0.0, 0.0, -20.01])], ids=["taut", "slack", "vertical"]
)
def test_static_end_stiffness_is_the_derivative_of_the_end_force(end):
    claimed = end_dynamic_stiffness(solve_cable(CABLE, START, end, 40), 0.0)
    assert end_stiffness_agrees(claimed, EA, end)


def test_static_end_stiffness_of_a_stiffer_cable_is_told_apart():
    claimed = end_dynamic_stiffness(solve_cable(CABLE, START, END, 40), 0.0)
    assert not end_stiffness_agrees(claimed, 1.02 * EA, END)


def test_end_stiffness_has_poles_at_the_clamped_frequencies():
    state = solve_cable(CABLE, START, END, 40)
    omega = 2.0 * np.pi * cable_modes(state, 1).frequencies_hz[0]
    near, far = end_dynamic_stiffness(state, np.array([omega * (1.0 + 1e-7), 0.7 * omega]))
    assert np.abs(near[1, 1]) > 1e4 * np.abs(far[1, 1])


def test_a_large_cable_is_solved_like_a_small_one():
    """Shift-invert Lanczos (large) against dense algebra (small) on the same matrices."""
    state = solve_cable(CABLE, START, END, 60)
    stiffness, inertia = clamped_matrices(state)
    sparse, _ = lowest_eigenpairs(stiffness, inertia, 12, -1e-3)
    dense = np.linalg.eigvalsh(stiffness.toarray() / inertia.diagonal()[0])[:12]
    assert sparse == pytest.approx(dense, rel=1e-8)


@pytest.mark.parametrize("end", [END, np.array([3.0, 0.0, -3.0])], ids=["taut", "slack"])
def test_frequencies_keep_their_digits(end):
    """Against singular values of the factor G of K = G^T G: no rounding of EA / L0 against T / L0 there."""
    state = solve_cable(CABLE, START, end, 60)
    pulls, tensions = state.tension_vectors, state.tensions[:, None]
    along = pulls / tensions
    across = np.cross(along, np.array([0.0, 1.0, 0.0]))
    across /= np.linalg.norm(across, axis=1)[:, None]
    root = np.sqrt(tensions / (state.element_length * (1.0 + tensions / EA)))
    rows = [np.sqrt(EA / state.element_length) * along, root * across, root * np.cross(along, across)]
    factor = np.zeros((60, 3, 61, 3))
    bars = np.arange(60)
    factor[bars, :, bars], factor[bars, :, bars + 1] = -np.stack(rows, axis=1), np.stack(rows, axis=1)
    matrix = factor[:, :, 1:-1].reshape(180, 177) / np.sqrt(MU * state.element_length)
    omegas = np.sort(np.linalg.svd(matrix, compute_uv=False))[:12]
    assert 2.0 * np.pi * cable_modes(state, 12).frequencies_hz == pytest.approx(omegas, rel=3e-9)


def test_errors_name_the_number():
    state = solve_cable(CABLE, START, END, 4)
    with pytest.raises(ValueError, match="count must be between 1 and 9, got 10"):
        cable_modes(state, 10)
    with pytest.raises(ValueError, match="mass must be 'lumped' or 'consistent', got 'diagonal'"):
        cable_modes(state, 1, "diagonal")
    stiffness, inertia = clamped_matrices(state)
    with pytest.raises(UnstableEquilibriumError, match="is negative: the state is unstable"):
        lowest_eigenpairs(-1.0 * stiffness, inertia, 2, -1e-3)
