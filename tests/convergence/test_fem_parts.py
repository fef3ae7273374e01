"""Parts of the finite elements against dense matrices, beams of textbooks, and derivatives of an energy."""

import dataclasses

import numpy as np
import pytest
import scipy.optimize

from cdpr_struct.fem_reference import CableData, PlatformData, RobotData
from cdpr_struct.fem_reference.bar_element import internal_forces
from cdpr_struct.fem_reference.cable_statics import solve_cable
from cdpr_struct.fem_reference.cable_wind import pressure
from cdpr_struct.fem_reference.masts import beam_flexibility
from cdpr_struct.fem_reference.sliding_bar import Eyelet, sliding_mass
from cdpr_struct.fem_reference.substructure import condensed_and_counted, condensed_both_ends, condensed_ends
from cdpr_struct.fem_reference.winch import Winch


def chains(count, kind=float):
    """Two chains of `count` symmetric elements each, indefinite, and their dense matrices (2, 3 n + 3, 3 n + 3)."""
    rng = np.random.default_rng(count)
    elements = rng.normal(size=(2, count, 6, 6)).astype(kind)
    if kind is complex:
        elements += 1j * rng.normal(size=elements.shape)
    elements = elements + np.swapaxes(elements, -1, -2)
    whole = np.zeros((2, 3 * count + 3, 3 * count + 3), dtype=kind)
    for element in range(count):
        own = slice(3 * element, 3 * element + 6)
        whole[:, own, own] += elements[:, element]
    return elements, whole


def left(whole, kept):
    """What eliminating all other unknowns leaves of those that are kept, and the eliminated block."""
    other = np.setdiff1d(np.arange(whole.shape[-1]), kept)
    across = whole[:, kept][:, :, other]
    inner = whole[:, other][:, :, other]
    return whole[:, kept][:, :, kept] - across @ np.linalg.solve(inner, np.swapaxes(across, 1, 2)), inner


@pytest.mark.parametrize("kind", [float, complex])
@pytest.mark.parametrize("count", [2, 3, 5, 8])
def test_condensed_chains_are_schur_complements_and_count_negative_eigenvalues(count, kind):
    elements, whole = chains(count, kind)
    ends, first, last = np.r_[0:3, 3 * count : 3 * count + 3], slice(0, 3), slice(3, 6)
    both, inner = left(whole, ends)
    piece, negative = condensed_both_ends(elements)
    assert len(piece) == 1
    np.testing.assert_allclose(piece.first[:, 0], both[:, first, first], rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(piece.between[:, 0], both[:, first, last], rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(piece.last[:, 0], both[:, last, last], rtol=1e-8, atol=1e-8)
    expected = [0, 0] if kind is complex else (np.linalg.eigvalsh(inner) < 0.0).sum(axis=1).tolist()
    assert negative.tolist() == expected
    end, _ = left(whole[:, 3:, 3:], np.arange(3 * count - 3, 3 * count))
    np.testing.assert_allclose(condensed_ends(elements), end, rtol=1e-8, atol=1e-8)
    if kind is float:
        found, counted = condensed_and_counted(elements)
        np.testing.assert_allclose(found, end, rtol=1e-8, atol=1e-8)
        assert counted.tolist() == expected


def test_an_upright_bends_as_a_cantilever():
    """Deflection at a <= b by a force at b: a^2 (3 b - a) / 6, bending stiffness one."""
    levels = np.array([0.7, 2.0, 3.1])
    low, high = np.minimum.outer(levels, levels), np.maximum.outer(levels, levels)
    np.testing.assert_allclose(beam_flexibility(levels), low**2 * (3.0 * high - low) / 6.0, rtol=1e-12)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_the_mass_of_a_sliding_bar_is_that_of_its_motion(share):
    rng = np.random.default_rng(1)
    mass = rng.normal(size=(6, 6))
    mass = mass @ mass.T
    along = np.array([2.0, -1.0, 2.0]) / 3.0
    start, end = rng.normal(size=(2, 3))
    moved = np.concatenate([start + share * along * (along @ (end - start)), end])
    given = np.concatenate([start, end])
    assert given @ sliding_mass(mass, along, share) @ given == pytest.approx(moved @ mass @ moved)


def test_the_first_bar_of_a_winch_is_the_second_derivative_of_its_energy():
    """U(d, f) of the module, its free length f eliminated in closed form; central differences of the slope dU/dd."""
    stiffness, tension, weight_rate = 5e4, 80.0, np.array([0.3, -0.2, -3.0])  # N, N, N/m
    vector = np.array([0.5, 0.9, -0.4])

    def free_length(d):
        gained = tension + tension**2 / (2.0 * stiffness) - weight_rate @ d
        return np.linalg.norm(d) / np.sqrt(1.0 + 2.0 * gained / stiffness)

    def slope(d):
        f, long = free_length(d), np.linalg.norm(d)
        return stiffness * (long - f) / f * d / long - weight_rate * f

    step = 1e-6
    expected = np.stack([(slope(vector + step * e) - slope(vector - step * e)) / (2.0 * step) for e in np.eye(3)])
    f = free_length(vector)
    winch = Winch.at(np.zeros(3), tension, 0.0, 5.0, vector, weight_rate * f)
    strain = np.linalg.norm(vector) / f - 1.0
    assert winch.bar_tension == pytest.approx(stiffness * strain, rel=1e-5)  # the weight's second order is left out
    found = winch.first_bar_stiffness(stiffness * strain, f, stiffness)
    np.testing.assert_allclose(found[:3, :3], expected, rtol=1e-5, atol=1e-5 * np.abs(expected).max())
    np.testing.assert_array_equal(found, np.block([[found[:3, :3], -found[:3, :3]], [-found[:3, :3], found[:3, :3]]]))
    assert winch.unstrained_length == 500.0


def test_the_first_bar_of_an_eyelet_is_the_second_derivative_of_its_energy():
    """Strain energies of bar and path behind, less the weight at the bar's middle; central differences of the slope.

    What slides out, f - f0, weighs once: against the pull of a soft path that is what shows, and beside a winch.
    """
    stiffness, total, weight_rate = 5e4, 901.0, np.array([0.3, -0.2, -3.0])  # N, m, N/m
    vector, path = np.array([0.5, 0.9, -0.4]), 901.0

    def free_length(d):
        def slope(f):
            return 0.5 * stiffness * ((path / (total - f)) ** 2 - (np.linalg.norm(d) / f) ** 2) - weight_rate @ d

        long = float(np.linalg.norm(d))
        return scipy.optimize.brentq(slope, 0.99 * long, 1.01 * long, xtol=1e-15)

    def slope(d):
        f, long = free_length(d), np.linalg.norm(d)
        return stiffness * (long - f) / f * d / long - weight_rate * f

    step = 1e-4
    expected = np.stack([(slope(vector + step * e) - slope(vector - step * e)) / (2.0 * step) for e in np.eye(3)])
    f = free_length(vector)
    tension = stiffness * (float(np.linalg.norm(vector)) / f - 1.0)
    eyelet = Eyelet.at(np.zeros(3), path, vector, tension, weight_rate * f, stiffness)
    assert eyelet.unstrained_length + f == pytest.approx(total, abs=1e-6)
    found = eyelet.first_bar_stiffness(tension, f, stiffness)[:3, :3]
    np.testing.assert_allclose(found, expected, atol=1e-5 * np.abs(expected).max())
    winch = Winch.at(np.zeros(3), eyelet.tension, 0.0, 5.0, vector, weight_rate * f)
    along = eyelet.direction
    held = along @ (found - winch.first_bar_stiffness(tension, f, stiffness)[:3, :3]) @ along
    assert held == pytest.approx(stiffness / path, rel=2e-2)


def test_held_ends_carry_the_cable_and_every_mass_on_it():
    """Masses on both end nodes, between nodes and beyond the start."""
    lumps = ((0.0, 0.5), (1.23, 0.7), (5.2, 0.9), (6.0, 0.2))
    cable = CableData(5.2, 1e5, 0.06, lumps=lumps)
    state = solve_cable(cable, [0.0, 0.0, 4.0], [3.0, 3.0, 4.5], 8)
    mass = 0.06 * 5.2 + sum(own for _, own in lumps)
    assert state.start_force + state.end_force == pytest.approx([0.0, 0.0, 9.81 * mass], abs=1e-9)
    missing = internal_forces(state.nodes, 0.65, 1e5)[1:-1] + 9.81 * np.outer(
        cable.node_lumps(8)[1:-1] + 0.039, [0, 0, 1]
    )
    assert state.residual_norm == pytest.approx(np.linalg.norm(missing, axis=1).max(), abs=1e-12)
    nodes = cable.node_lumps(8)
    assert nodes.sum() == pytest.approx(2.3)
    arcs = np.linspace(5.2, 0.0, 9)  # from the end
    assert nodes @ arcs == pytest.approx(1.23 * 0.7 + 5.2 * 1.1)  # as on a lever
    assert np.flatnonzero(nodes).tolist() == [0, 6, 7, 8]
    matrices, at_nodes = state.element_mass(), 0.039 * np.array([0.5, *[1.0] * 7, 0.5]) + nodes
    assembled = np.zeros((9, 3, 3))
    assembled[:-1] += matrices[:, :3, :3]
    assembled[1:] += matrices[:, 3:, 3:]
    np.testing.assert_allclose(assembled, at_nodes[:, None, None] * np.eye(3), atol=1e-14)


def test_wind_presses_across_the_cables_by_the_square_of_its_speed_across():
    """5 m/s along x on cables along x, y and at 60 degrees to it: 0, and 15.3125 Pa times 1 and sin^2(60 deg)."""
    away = np.array([[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [1.0, 0.0, np.sqrt(3.0)]])
    cables = tuple(CableData(4.0, 1e5, 0.05, drag_width=width) for width in (0.01, 0.02, 0.02))
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    anchors, place = np.array([[0.1, 0.2, 0.0], [-0.3, 0.0, 0.1], [0.0, 0.0, 0.2]]), np.array([1.0, 2.0, 3.0])
    robot = RobotData(place + anchors @ turn.T - away, anchors, cables, PlatformData(1.0, np.zeros(3), np.eye(3)))
    windy = dataclasses.replace(robot, wind=np.array([5.0, 0.0, 0.0]))
    found = pressure(windy, windy.frame_anchors, place, turn)
    at_sixty = 0.02 * 15.3125 * 0.75 * np.array([np.sqrt(0.75), 0.0, -0.5])
    np.testing.assert_allclose(found, [np.zeros(3), [0.02 * 15.3125, 0.0, 0.0], at_sixty], atol=1e-12)
    assert not pressure(robot, robot.frame_anchors, place, turn).any()
