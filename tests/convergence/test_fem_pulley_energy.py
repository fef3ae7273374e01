"""Are the forces and the stiffness of a cable round a pulley the derivatives of an energy built without them?

The tests find tangents by root finding and the share of length on the pulley by balance, and differentiate.
"""

import numpy as np
import pytest
import scipy.optimize

from cdpr_struct.fem_reference import CableData, PlatformData, PulleyData, RobotData, solve_robot

MU, UP, GRAVITY = 0.067, np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -9.81])
LEANING, ENTRY, OFFSET = np.array([0.1, 0.3, np.sqrt(0.9)]), np.array([0.4, -0.2, 3.0]), np.array([9.0, 1.0, -3.0])


def hung(radius, length, axis, axial_stiffness, gravity, offset, elements):
    """The cable of a held point at an offset from the entry."""
    body = PlatformData(10.0, np.zeros(3), np.eye(3))
    cable = CableData(length, axial_stiffness, MU)
    robot = RobotData([ENTRY], [[0.0, 0.0, 0.0]], (cable,), body, gravity, (PulleyData(radius, axis),))
    return solve_robot(robot, ENTRY + offset, np.eye(3), elements, hold_pose=True).cables[0]


def path_length(radius, point, axis):
    """Length from the origin up along the axis, round the pulley and straight to the point, by root finding."""
    height = point @ axis
    reach = np.linalg.norm(point - height * axis)

    def exit_at(angle):
        return np.array([radius * (1.0 - np.cos(angle)), radius * np.sin(angle)])

    def misses(angle):  # the rest of the way against the spoke at the exit
        rest = np.array([reach, height]) - exit_at(angle)
        return rest @ np.array([-np.cos(angle), np.sin(angle)])

    angles = np.linspace(0.0, np.pi, 200)
    signs = np.sign([misses(angle) for angle in angles])
    first = int(np.flatnonzero(np.diff(signs) > 0)[0]) if (np.diff(signs) > 0).any() else 0
    angle = scipy.optimize.brentq(misses, angles[first], angles[first + 1], xtol=1e-15)
    return radius * angle, float(np.linalg.norm(np.array([reach, height]) - exit_at(angle))), exit_at(angle)


def test_end_force_is_the_gradient_of_the_energy():
    """Without gravity the tension is one number, and the energy that of one spring as long as the path."""
    offset, length = np.array([6.0, 2.0, -1.5]), 6.6

    def energy(point, radius):
        arc, bar, _ = path_length(radius, point, LEANING)
        return 0.5 * 4000.0 * length * ((arc + bar) / length - 1.0) ** 2

    def gradient(radius, step=1e-5):
        ends = [[energy(offset + sign * step * way, radius) for sign in (1, -1)] for way in np.eye(3)]
        return np.array([(up - down) / (2.0 * step) for up, down in ends])

    cable = hung(0.3, length, LEANING, 4000.0, np.zeros(3), offset, 8)
    assert cable.end_force == pytest.approx(gradient(0.3), rel=1e-7)
    assert cable.end_force != pytest.approx(gradient(0.306), rel=1e-4)


def first_bar_energy(cable, radius, axis):
    """Energy of wrap and first bar by the position of its node, with the best share of length on the wrap."""
    stiffness, total = cable.cable.axial_stiffness, cable.wrap.unstrained_length + cable.element_length
    outward, density = cable.wrap.outward, MU * GRAVITY
    drawn = (cable.wrap.tension + stiffness) / stiffness

    def parked(share):  # potential of the cable on the pulley, each piece where it lies
        angle = share * drawn / radius
        along = outward * (angle - np.sin(angle)) + axis * (1.0 - np.cos(angle))
        return -(density @ along) * radius**2 / drawn

    def energy(node):
        arc, bar, (reach, height) = path_length(radius, node - ENTRY, axis)
        aside = node - ENTRY - axis * ((node - ENTRY) @ axis)
        exit_point = ENTRY + reach * aside / np.linalg.norm(aside) + height * axis
        middle = 0.5 * (node + exit_point) - ENTRY

        def slope(share):  # derivative by the share: energies of the two sides, and weight
            wrap, free = arc / share, bar / (total - share)
            weight = density @ middle - density @ _parked_slope(share, drawn, radius, outward, axis)
            return 0.5 * stiffness * (free**2 - wrap**2) + weight

        guess = cable.wrap.unstrained_length
        share = scipy.optimize.brentq(slope, 0.9 * guess, 1.1 * guess, xtol=1e-16, rtol=1e-15)
        springs = share * (arc / share - 1.0) ** 2 + (total - share) * (bar / (total - share) - 1.0) ** 2
        return 0.5 * stiffness * springs - (total - share) * density @ middle + parked(share)

    return energy


def _parked_slope(share, drawn, radius, outward, axis):
    angle = share * drawn / radius
    return radius * ((1.0 - np.cos(angle)) * outward + np.sin(angle) * axis)


def second_difference(function, point, step):
    ways = step * np.eye(3)
    rows = [
        [
            function(point + a + b) - function(point + a - b) - function(point - a + b) + function(point - a - b)
            for b in ways
        ]
        for a in ways
    ]
    return np.array(rows) / (4.0 * step**2)


def test_first_bar_has_the_force_and_stiffness_of_its_energy():
    """Soft and heavy, so that wrap, weight and stretch all show; upright, where the energy is a true one."""
    cable = hung(0.3, 9.5, UP, 600.0, GRAVITY, OFFSET, 30)
    bar = cable.wrap.bar_stiffness(float(cable.tensions[0]), cable.element_length, 600.0)
    pull = cable.tension_vectors[0] - 0.5 * MU * cable.element_length * GRAVITY

    def compared(radius, step=1e-6):
        energy, node = first_bar_energy(cable, radius, UP), np.array(cable.nodes[1])
        slope = [(energy(node + step * way) - energy(node - step * way)) / (2.0 * step) for way in np.eye(3)]
        stiffness_misses = np.abs(second_difference(energy, node, 1e-4) - bar).max() / np.abs(bar).max()
        return np.abs(np.array(slope) - pull).max() / np.linalg.norm(pull), stiffness_misses

    force, stiffness = compared(0.3)
    assert force < 1e-6  # measured 7e-8: the tension step is W . t but for a share of relative size weight / EA
    assert stiffness < 1e-6  # measured 1e-7
    wrong_force, wrong_stiffness = compared(0.306)
    assert wrong_force > 0.1
    assert wrong_stiffness > 0.01
