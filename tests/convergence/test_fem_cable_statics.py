"""Does a cable of bars hang as mechanics demands? Laws first; a second solver agrees; wrong models fail."""

import numpy as np
import pytest
import scipy.optimize

from cdpr_struct.fem_reference import (
    CableData,
    CompressedBarError,
    FemError,
    FoldedCableError,
    extrapolate,
    solve_cable,
)
from cdpr_struct.fem_reference.bar_element import bar_stiffness, internal_forces
from cdpr_struct.fem_reference.sparse_chain import chain_matrix

EA, MU, LENGTH = 251327.4123, 0.067, 20.0  # N, kg/m, m
CABLE = CableData(LENGTH, EA, MU)
START, END = np.zeros(3), np.array([13.696, 0.0, -14.586])
WEIGHT = MU * LENGTH * 9.81
SHAPES = {
    "taut": (CABLE, END),
    "out of the coordinate planes": (CABLE, np.array([8.0, -11.0, -14.7])),
    "sag above half the chord": (CABLE, np.array([8.0, 2.0, 1.0])),
    "chord a fifth of the length": (CABLE, np.array([3.0, 0.0, -3.0])),
    "steep and slack": (CABLE, np.array([0.5, 0.0, -12.0])),
    "vertical, end below": (CABLE, np.array([0.0, 0.0, -20.01])),
    "vertical, end above": (CABLE, np.array([0.0, 0.0, 20.01])),
    "stiff, tiny sag": (CableData(LENGTH, 1e8, MU), np.array([20.0001, 0.0, 0.0])),
    "stiff, a little spare length": (CableData(LENGTH, 1e8, MU), np.array([19.9999, 0.0, 0.0])),
    "stretched threefold": (CableData(LENGTH, 1e3, MU), np.array([60.0, 0.0, 0.0])),
}
CASES = pytest.mark.parametrize("name", SHAPES)


@CASES
def test_nodes_balance_up_to_the_precision_of_their_coordinates(name):
    cable, end = SHAPES[name]
    state = solve_cable(cable, START, end, 200)
    assert state.residual_norm <= 4.0 * state.residual_floor  # measured: below 1.0
    assert np.abs(state.nodes[0] - START).max() == 0.0
    assert np.abs(state.nodes[-1] - end).max() < 1e-12  # m; 200 additions of numbers near 20
    assert state.tensions.min() > 0.0


@CASES
def test_bar_tension_is_hooke_on_the_unstrained_length(name):
    cable, end = SHAPES[name]
    state = solve_cable(cable, START, end, 123)
    lengths = np.linalg.norm(np.diff(state.nodes, axis=0), axis=1)
    hooke = cable.axial_stiffness * (lengths / state.element_length - 1.0)
    assert hooke == pytest.approx(state.tensions, abs=4.0 * state.residual_floor)


@CASES
def test_end_forces_carry_exactly_the_weight(name):
    cable, end = SHAPES[name]
    state = solve_cable(cable, START, end, 50)
    scale = np.abs(state.tensions).max()
    assert state.start_force + state.end_force == pytest.approx([0.0, 0.0, WEIGHT], abs=1e-13 * scale)


@CASES
def test_swapping_the_ends_changes_nothing(name):
    cable, end = SHAPES[name]
    there, back = solve_cable(cable, START, end, 60), solve_cable(cable, end, START, 60)
    tolerance = 1e-10 * there.tensions.max() + 8.0 * there.residual_floor
    assert back.end_force == pytest.approx(there.start_force, abs=tolerance)
    assert back.tensions[::-1] == pytest.approx(there.tensions, abs=tolerance)
    assert back.nodes[::-1] == pytest.approx(there.nodes, abs=1e-8)


def displacement_newton(cable, start, end, elements, sag):
    """Textbook finite elements: unknown node positions, from a parabola, tangent stiffness, line search."""
    fraction = np.linspace(0.0, 1.0, elements + 1)[:, None]
    nodes = start + fraction * (end - start) - 4.0 * sag * fraction * (1.0 - fraction) * [0.0, 0.0, 1.0]
    length = cable.unstrained_length / elements
    load = np.array([0.0, 0.0, -9.81 * cable.linear_density * length])

    def out_of_balance(points):
        return (load - internal_forces(points, length, cable.axial_stiffness)[1:-1]).ravel()

    residual = out_of_balance(nodes)
    for _ in range(400):
        if np.abs(residual).max() < 1e-8:
            return nodes
        steps = np.diff(nodes, axis=0)
        spans = np.linalg.norm(steps, axis=1)
        tensions = np.maximum(cable.axial_stiffness * (spans / length - 1.0), 1e-3)
        bars = bar_stiffness(steps / spans[:, None], tensions, np.array(length), np.array(cable.axial_stiffness))
        tangent = chain_matrix(bars[None]).toarray()[:-3, :-3]
        move = np.linalg.solve(tangent, residual).reshape(-1, 3)
        scale = 1.0
        while scale > 1e-4:
            trial = nodes.copy()
            trial[1:-1] += scale * move
            if np.linalg.norm(out_of_balance(trial)) < np.linalg.norm(residual):
                break
            scale *= 0.5
        nodes, residual = trial, out_of_balance(trial)
    raise AssertionError(f"displacement Newton stopped at {np.abs(residual).max():.3g} N")


@pytest.mark.parametrize(
    ("end", "sag"), [((13.696, 0.0, -14.586), 0.05), ((19.0, 3.0, 1.0), 3.0), ((12.0, 0.0, -5.0), 7.0)]
)
def test_a_displacement_newton_from_a_parabola_finds_the_same_cable(end, sag):
    """The solver works in forces; the same bars solved for node positions must hang in the same place."""
    nodes = displacement_newton(CABLE, START, np.array(end), 24, sag)
    assert nodes == pytest.approx(solve_cable(CABLE, START, end, 24).nodes, abs=1e-8)


def stiffness_agrees(claimed, nodes, element_length, axial_stiffness):
    numeric = np.empty((nodes.size, nodes.size))
    for column in range(nodes.size):
        ends = []
        for sign in (1.0, -1.0):
            moved = nodes.copy()
            moved.flat[column] += sign * 1e-5
            ends.append(internal_forces(moved, element_length, axial_stiffness).ravel())
        numeric[:, column] = (ends[0] - ends[1]) / 2e-5
    return np.abs(numeric[3:, 3:] - claimed).max() < 1e-6 * np.abs(claimed).max()


@pytest.mark.parametrize("name", ["taut", "sag above half the chord", "stretched threefold"])
def test_tangent_is_the_derivative_of_the_internal_forces(name):
    cable, end = SHAPES[name]
    state = solve_cable(cable, START, end, 8)
    claimed = chain_matrix(state.element_stiffness()[None]).toarray()
    nodes = np.array(state.nodes)
    assert stiffness_agrees(claimed, nodes, state.element_length, cable.axial_stiffness)
    assert not stiffness_agrees(claimed, nodes, state.element_length, 1.02 * cable.axial_stiffness)


@pytest.mark.parametrize(
    "name",
    [
        "taut",
        "sag above half the chord",
        "chord a fifth of the length",
        "vertical, end below",
        "vertical, end above",
    ],
)
def test_end_force_converges_with_order_two(name):
    cable, end = SHAPES[name]
    counts = [80, 160, 320, 640]
    forces = np.array([np.linalg.norm(solve_cable(cable, START, end, n).end_force) for n in counts])
    if name.startswith("vertical"):
        # bars of a straight cable stretch under their mean tension, as a continuum does: exact at every count
        assert forces == pytest.approx(forces[-1], rel=1e-9)
        return
    result = extrapolate(counts, forces)
    assert result.order == pytest.approx(2.0, abs=0.1)
    assert abs(result.limit - forces[-1]) < 1e-3 * forces[-1]


def test_hanging_cable_stretches_by_half_its_weight():
    """Vertical cable: EA times stretch = T_mid L, and T_mid is the bottom pull plus half the weight."""
    state = solve_cable(CABLE, START, [0.0, 0.0, -20.01], 100)
    mid_tension = EA * 0.01 / LENGTH
    assert state.end_force[2] == pytest.approx(-(mid_tension - 0.5 * WEIGHT), rel=1e-9)
    assert state.start_force[2] == pytest.approx(mid_tension + 0.5 * WEIGHT, rel=1e-9)


def test_shallow_cable_sags_like_a_parabola():
    """Horizontal chord l, tension H: sag = w l^2 / 8 H up to relative (w l / H)^2 / 48 or so."""
    state = solve_cable(CABLE, START, [20.01, 0.0, 0.0], 200)
    horizontal = state.end_force[0]
    sag = (WEIGHT / 20.01) * 20.01**2 / (8.0 * horizontal)
    assert -state.nodes[:, 2].min() == pytest.approx(sag, rel=1e-3)


def test_result_is_the_minimum_of_potential_energy():
    """Minimised blindly over node positions, the energy of bars and weights leads to the same nodes."""
    cable, end, count = CableData(4.0, 50.0, 0.5), np.array([2.0, 1.0, 0.5]), 6
    length = cable.unstrained_length / count

    def energy(interior):
        nodes = np.vstack([START, interior.reshape(-1, 3), end])
        spans = np.linalg.norm(np.diff(nodes, axis=0), axis=1)
        springs = 0.5 * cable.axial_stiffness * length * (spans / length - 1.0) ** 2
        return springs.sum() + 9.81 * cable.linear_density * length * nodes[1:-1, 2].sum()

    state = solve_cable(cable, START, end, count)
    first = np.linspace(START, end, count + 1)[1:-1] - np.array([0.0, 0.0, 1.0])
    found = scipy.optimize.minimize(energy, first.ravel(), method="BFGS", options={"gtol": 1e-6})
    assert found.x.reshape(-1, 3) == pytest.approx(state.nodes[1:-1], abs=1e-4)
    assert energy(state.nodes[1:-1].ravel()) <= found.fun + 1e-9


def test_gravity_may_point_anywhere():
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    plain = solve_cable(CABLE, START, END, 30)
    turned = solve_cable(CABLE, START, turn @ END, 30, gravity=turn @ [0.0, 0.0, -9.81])
    assert turned.nodes == pytest.approx(plain.nodes @ turn.T, abs=1e-10)
    straight = solve_cable(CABLE, START, [20.1, 0.0, 0.0], 30, gravity=(0.0, 0.0, 0.0))
    assert straight.tensions == pytest.approx(EA * 0.1 / 20.0, rel=1e-10)


def test_a_vertical_slack_cable_says_that_it_folds():
    with pytest.raises(FoldedCableError, match=r"element \d+ carries .* folds there\. Move the ends"):
        solve_cable(CABLE, START, [0.0, 0.0, -10.03], 200)
    with pytest.raises(FoldedCableError, match="folds there"):
        solve_cable(CABLE, START, [19.0, 0.0, 0.0], 200, gravity=(0.0, 0.0, 0.0))


@pytest.mark.parametrize("field", ["unstrained_length", "axial_stiffness", "linear_density"])
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf")])
def test_cable_data_are_checked_at_birth(field, value):
    data = {"unstrained_length": 1.0, "axial_stiffness": 1.0, "linear_density": 1.0, field: value}
    with pytest.raises(ValueError, match=f"CableData.{field} must be positive"):
        CableData(**data)


def test_arguments_are_checked():
    with pytest.raises(ValueError, match=r"end must have shape \(3,\), got \(2,\)"):
        solve_cable(CABLE, START, [1.0, 2.0], 10)
    with pytest.raises(ValueError, match="start must be finite"):
        solve_cable(CABLE, [0.0, np.nan, 0.0], END, 10)
    with pytest.raises(ValueError, match="elements must be an integer of at least 2, got 1"):
        solve_cable(CABLE, START, END, 1)
    assert issubclass(CompressedBarError, FemError)
