"""Are force and stiffness of a cable round a pulley derivatives of an energy and of a force built without them?

The tests find tangents by root finding and the share of length on the pulley by balance, and differentiate.
"""

import numpy as np
import pytest
import scipy.optimize

from cdpr_struct.fem_reference import CableData, PlatformData, PulleyData, RobotData, solve_robot

MU, UP, GRAVITY = 0.067, np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -9.81])
LEANING, ENTRY, OFFSET = np.array([0.1, 0.3, np.sqrt(0.9)]), np.array([0.4, -0.2, 3.0]), np.array([9.0, 1.0, -3.0])


def hung(radius, length, axis, axial_stiffness, gravity, offset, elements, line_give=0.0):
    """The cable of a held point at an offset from the entry."""
    body = PlatformData(10.0, np.zeros(3), np.eye(3))
    cable = CableData(length, axial_stiffness, MU, line_give)
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


def first_bar_pull(cable, radius, axis):
    """Force (3,) on wrap and first bar by the position of its node: the bar's pull, less the weight at either end.

    Half the bar's present weight is at its node, and half at the exit. From there it adds to the tension of the wrap
    and swings about the axis. The exit is where the cable leaves at present, so that this force has no potential.
    """
    stiffness, total = cable.cable.axial_stiffness, cable.wrap.unstrained_length + cable.element_length
    density, behind = MU * GRAVITY, cable.wrap.behind

    def pull(node):
        arc, bar, (reach, height) = path_length(radius, node - ENTRY, axis)
        aside = node - ENTRY - axis * ((node - ENTRY) @ axis)
        distance = np.linalg.norm(aside)
        across = np.cross(axis, aside / distance)
        way = node - (ENTRY + reach * aside / distance + height * axis)

        def step(share):  # strain energies by the share, and the weight between the bar's middle and the exit
            wrap, free = (arc + behind) / share, bar / (total - share)
            return 0.5 * stiffness * (wrap**2 - free**2) - 0.5 * density @ way

        guess = cable.wrap.unstrained_length
        free = total - scipy.optimize.brentq(step, guess - 0.1, guess + 0.1, xtol=1e-16, rtol=1e-15)
        half = 0.5 * density * free
        return stiffness * (bar / free - 1.0) * way / bar - half - reach / distance * (half @ across) * across

    return pull


@pytest.mark.parametrize("axis", [UP, LEANING], ids=["upright", "leaning"])
@pytest.mark.parametrize("give", [0.0, 2e-2], ids=["bare", "in line"])
def test_first_bar_has_the_symmetric_stiffness_of_its_force(axis, give):
    """Soft and heavy, so that wrap, weight and stretch all show."""
    cable = hung(0.3, 9.5, axis, 600.0, GRAVITY, OFFSET, 30, give)
    claimed = cable.wrap.bar_stiffness(float(cable.tensions[0]), cable.element_length, 600.0)
    beyond = cable.tension_vectors[1] + 0.5 * MU * cable.element_length * GRAVITY

    def compared(radius, step=1e-5):
        pull, node = first_bar_pull(cable, radius, axis), np.array(cable.nodes[1])
        rates = np.array([(pull(node + step * way) - pull(node - step * way)) / (2.0 * step) for way in np.eye(3)])
        miss = np.abs(0.5 * (rates + rates.T) - claimed).max() / np.abs(claimed).max()
        return np.linalg.norm(pull(node) - beyond) / np.linalg.norm(beyond), miss

    force, stiffness = compared(0.3)
    assert force < 1e-6
    assert stiffness < 5e-6  # measured 9e-8 (bare), 1.9e-6 (in line)
    wrong_force, wrong_stiffness = compared(0.306)
    assert wrong_force > 0.02
    assert wrong_stiffness > 0.01
