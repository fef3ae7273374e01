"""Does a cable round a swivelling pulley obey geometry, virtual work and symmetry, and converge?"""

import dataclasses
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from cdpr_struct.fem_reference import (
    CableData,
    FemError,
    PlatformData,
    PointForce,
    PulleyData,
    PulleysNotSettledError,
    RobotData,
    UndefinedSwivelError,
    cable_modes,
    count_below,
    end_dynamic_stiffness,
    extrapolate,
    platform_dynamic_stiffness,
    robot_modes,
    solve_robot,
)
from cdpr_struct.fem_reference.pulley import Wrap

EA, MU, UP, GRAVITY = 251327.4123, 0.067, np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -9.81])
LEANING = np.array([0.1, 0.3, np.sqrt(0.9)])
ENTRY = np.array([0.4, -0.2, 3.0])
BODY = PlatformData(10.0, np.zeros(3), np.eye(3))
AXES = pytest.mark.parametrize("axis", [UP, LEANING], ids=["upright", "leaning"])


def one_cable(radius, length, axis=UP, axial_stiffness=EA, gravity=GRAVITY, give=0.0):
    cable = CableData(length, axial_stiffness, MU, give)
    pulleys = () if radius is None else (PulleyData(radius, axis),)
    return RobotData([ENTRY], [[0.0, 0.0, 0.0]], (cable,), BODY, gravity, pulleys)


def hung(robot, offset, elements):
    """The cable of a held point at an offset from the entry."""
    return solve_robot(robot, ENTRY + offset, np.eye(3), elements, hold_pose=True).cables[0]


OFFSET = np.array([9.0, 1.0, -3.0])
SLACK = 11.0  # m; the chord is 9.5 m
DEEP = np.array([9.0, 1.0, -4.0])  # under a cable of 14 m


def start_compliance(cable):
    """Compliance (3, 3) [m/N] of the first bar beyond that of a bar with a fixed start; along t, n and o."""
    tension, length, directions = float(cable.tensions[0]), cable.element_length, cable.wrap.directions()
    block = cable.wrap.first_bar_stiffness(tension, length, EA)[3:, 3:]
    turning = length * (1.0 + tension / EA) / tension
    return directions @ np.linalg.inv(block) @ directions.T - np.diag([length / EA, turning, turning])


@AXES
def test_the_cable_lies_on_the_pulley_and_leaves_along_a_tangent(axis):
    robot = one_cable(0.3, SLACK, axis)
    cable = hung(robot, OFFSET, 40)
    wrap, first = cable.wrap, cable.tension_vectors[0] / cable.tensions[0]
    spoke = (cable.nodes[0] - wrap.center) / 0.3
    assert np.linalg.norm(spoke) == pytest.approx(1.0, abs=1e-12)
    assert np.linalg.norm(wrap.center - ENTRY) == pytest.approx(0.3, rel=1e-12)
    assert (wrap.center - ENTRY) @ axis == pytest.approx(0.0, abs=1e-12)
    assert (wrap.center - ENTRY) @ OFFSET > 0.0  # the pulley faces the platform
    assert spoke @ first == pytest.approx(0.0, abs=1e-10)
    assert np.cross(axis, wrap.outward) @ first == pytest.approx(0.0, abs=1e-10)
    assert np.cross(-wrap.outward, spoke) @ np.cross(axis, wrap.outward) > -1.0  # wound from b over the top
    turned = Rotation.from_rotvec(wrap.angle * np.cross(axis, wrap.outward)).apply(axis)
    assert turned == pytest.approx(first, abs=1e-10)
    middle = Rotation.from_rotvec(0.5 * wrap.angle * np.cross(axis, wrap.outward)).apply(-wrap.outward)
    assert middle @ axis > 0.0


@AXES
def test_no_length_is_lost(axis):
    """Free and wrapped unstrained lengths add up, and the wrap obeys Hooke at the tension of the exit."""
    cable = hung(one_cable(0.3, SLACK, axis), OFFSET, 640)
    assert cable.cable.unstrained_length + cable.wrap.unstrained_length == pytest.approx(SLACK, rel=1e-14)
    at_exit = np.linalg.norm(cable.start_force)
    hooke = cable.wrap.arc / (1.0 + at_exit / EA)
    assert cable.wrap.unstrained_length == pytest.approx(hooke, rel=1e-10)
    assert cable.wrap.unstrained_length < cable.wrap.arc


@AXES
def test_a_vanishing_pulley_is_a_plain_anchor(axis):
    plain = hung(one_cable(None, SLACK), OFFSET, 40)
    tiny, small = (hung(one_cable(radius, SLACK, axis), OFFSET, 40) for radius in (1e-9, 1e-3))
    assert tiny.nodes == pytest.approx(plain.nodes, abs=1e-7)
    assert np.abs(small.nodes - plain.nodes).max() > 1e-5
    omegas = np.array([0.0, 5.0])
    stiffness = end_dynamic_stiffness(plain, omegas)
    scale = np.abs(stiffness).max()
    assert np.abs(end_dynamic_stiffness(tiny, omegas) - stiffness).max() < 1e-6 * scale
    assert np.abs(end_dynamic_stiffness(small, omegas) - stiffness).max() > 1e-5 * scale


def stiffness_by_differences(robot, elements, step=1e-4):
    columns = []
    for way in np.eye(3):
        up, down = (hung(robot, OFFSET + sign * step * way, elements).end_force for sign in (1, -1))
        columns.append((up - down) / (2.0 * step))
    return np.array(columns).T


@AXES
def test_static_end_stiffness_tends_to_the_derivative_of_the_end_force(axis):
    """Differences cut the cable anew at every place, so the meshes agree to order two only.

    A weightless wrap gives an upright pulley a symmetric stiffness; of a leaning one the symmetric part is kept.
    """
    misses = []
    for elements in (20, 40, 80):
        robot = one_cable(0.3, SLACK, axis)
        numeric = stiffness_by_differences(robot, elements)
        claimed = end_dynamic_stiffness(hung(robot, OFFSET, elements), 0.0)
        misses.append(np.abs(claimed - 0.5 * (numeric + numeric.T)).max() / np.abs(claimed).max())
        lopsided = np.abs(numeric - numeric.T).max() / np.abs(claimed).max()
        assert lopsided < (1e-5 if axis is UP else 5e-4)
    assert misses[0] < 1e-4  # measured 4e-5
    if axis is UP:
        assert np.log2(misses[0] / misses[2]) / 2.0 == pytest.approx(1.8, abs=0.3)
    else:  # condensing and taking the symmetric part change places but for squares of the lean, here some 2e-6
        assert misses[2] < 6e-6
    wrong = stiffness_by_differences(one_cable(0.306, SLACK, axis), 80)
    assert np.abs(wrong - claimed).max() > 1e-3 * np.abs(claimed).max()


@pytest.mark.parametrize(("axis", "give"), [([0.0, 0.6, 0.8], 0.0), ([0.0, 0.6, 0.8], 0.01), (UP, 0.01)], ids=str)
def test_no_end_at_a_pulley_softens_without_bound_as_bars_shrink(axis, give, monkeypatch):
    """What rolls off couples a turn with motion across it by c on both sides; eliminating the turn costs c^2 l / T."""
    robot = one_cable(0.5, 14.0, np.array(axis), give=give)
    cables = [hung(robot, DEEP, n) for n in (40, 160, 640, 2560)]

    def steps():
        gives = [start_compliance(cable)[np.ix_([0, 2], [0, 2])] for cable in cables]
        changes = [
            np.abs((fine - coarse) / np.sqrt(np.outer(*2 * [np.diag(fine)]))) for coarse, fine in pairwise(gives)
        ]
        return [change.max() for change in changes]

    found = steps()
    assert found[2] < 0.3 * found[1] < 0.1 * found[0]  # order one, of where the first bar leaves
    monkeypatch.setattr(Wrap, "_not_softened", lambda self, block: np.zeros((3, 3)))
    assert steps()[2] > 2.0 * steps()[1]


@pytest.mark.parametrize("give", [0.0, 0.01])
@pytest.mark.parametrize("axis", [[0.3, 0.5, 0.8], [0.0, 0.95, 0.3], UP], ids=str)
def test_a_fine_start_gives_way_as_that_of_a_continuous_cable(axis, give):
    """Of a cable in any shape, whose pulls at the fixed exit change by N: tension, wrap angle and swivel follow.

    Length x comes off the pulley, weight w per length. Along t: dT = N.t + w.t x, (1 + T/EA) x = B dT/EA - R d(theta),
    T d(theta) = N.n + w.n x, B the length behind; the cable there has moved by B dT/EA along t, not along n, and by
    R tan(theta / 2) (N.o + w.o x) / T along o.
    """
    robot = one_cable(0.5, 14.0, np.array(axis) / np.linalg.norm(axis), give=give)
    cable = hung(robot, DEEP, 2560)
    tension, weight = cable.wrap.tension, cable.wrap.directions() @ (MU * GRAVITY)
    along = cable.wrap.unstrained_length / EA
    leverage = 0.5 * np.tan(0.5 * cable.wrap.angle) / tension
    rolled = np.array([along, -0.5 / tension, 0.0])
    rolled /= 1.0 + tension / EA - along * weight[0] + 0.5 * weight[1] / tension
    expected = np.diag([along, 0.0, leverage]) + np.outer([along * weight[0], 0.0, leverage * weight[2]], rolled)
    scale = np.sqrt(np.outer(*2 * [[along, leverage, leverage]]))
    miss = np.abs(start_compliance(cable) - 0.5 * (expected + expected.T)) / scale
    assert miss.max() < 6e-4  # measured 3.5e-4, of which squares of the couplings; these are 0.03 to 0.09


@AXES
def test_forces_wrap_stiffness_and_frequencies_converge_with_order_two(axis):
    counts, values = [20, 40, 80], []
    for elements in counts:
        cable = hung(one_cable(0.3, SLACK, axis), OFFSET, elements)
        matrix = end_dynamic_stiffness(cable, 5.0)
        modes = cable_modes(cable, 6).frequencies_hz
        values.append([*cable.end_force, cable.wrap_angle, *np.diag(matrix), *modes])
    order = extrapolate(counts, values).order
    assert order == pytest.approx(np.full(13, 2.0), abs=0.15)  # measured 1.91 ... 2.02


def test_turning_everything_about_the_axis_turns_the_forces():
    robot = one_cable(0.3, SLACK)
    turn = Rotation.from_rotvec([0.0, 0.0, 2.1]).as_matrix()
    here, there = hung(robot, OFFSET, 30), hung(robot, turn @ OFFSET, 30)
    assert there.end_force == pytest.approx(turn @ here.end_force, abs=1e-9)
    assert there.wrap_angle == pytest.approx(here.wrap_angle, abs=1e-11)
    stiffness = end_dynamic_stiffness(here, 7.0)
    turned = end_dynamic_stiffness(there, 7.0)
    assert np.abs(turned - turn @ stiffness @ turn.T).max() < 1e-8 * np.abs(stiffness).max()
    aside = np.cross(UP, OFFSET)
    assert here.end_force @ aside == pytest.approx(0.0, abs=1e-9)  # no moment about a frictionless axis
    swing = np.linalg.norm(here.end_force[:2]) / np.linalg.norm(OFFSET[:2])
    unit = aside / np.linalg.norm(aside)
    assert unit @ end_dynamic_stiffness(here, 0.0) @ unit == pytest.approx(swing, rel=1e-8)


def test_a_weight_pulled_aside_hangs_and_swings_as_a_textbook_says():
    """The cable leaves along the pull; the bob's stiffness is T / l in the pulley's plane, T sin / rho about it."""
    radius, length, light, aside = 0.2, 3.0, CableData(3.0, 1e6, 1e-5), np.array([40.0, 0.0, 0.0])
    robot = RobotData([ENTRY], [[0.0] * 3], (light,), BODY, GRAVITY, (PulleyData(radius, UP),))
    pull = aside + 10.0 * GRAVITY
    tension, angle = np.linalg.norm(pull), np.arctan2(pull[0], pull[2])
    straight = length * (1.0 + tension / 1e6) - radius * angle
    bob = np.array([radius * (1.0 - np.cos(angle)), 0.0, radius * np.sin(angle)]) + straight * pull / tension
    rest = solve_robot(robot, ENTRY + bob + 1e-5, np.eye(3), 6, external_force=PointForce(aside))
    assert rest.position - ENTRY == pytest.approx(bob, abs=1e-5)
    assert rest.cables[0].wrap_angle == pytest.approx(angle, abs=1e-5)
    stiffness = platform_dynamic_stiffness(rest, 0.0)[:3, :3]
    normal = np.array([np.cos(angle), 0.0, -np.sin(angle)])
    assert normal @ stiffness @ normal == pytest.approx(tension / straight, rel=1e-3)
    assert stiffness[1, 1] == pytest.approx(tension * np.sin(angle) / bob[0], rel=1e-3)
    assert tension / (straight + radius * angle) != pytest.approx(tension / straight, rel=1e-2)


def test_a_stretching_cable_slides_over_its_pulley():
    """Slowly pulled along, every piece moves in proportion to its distance s from the entry, the wrap without mass.

    The end then feels the mass of mu s^2 / L^2 beyond the wrap: mu (L^3 - w^3) / 3 L^2.
    """
    radius, counts, felt = 2.0, [10, 20, 40], []
    for elements in counts:
        cable = hung(one_cable(radius, 10.0, axial_stiffness=4000.0, gravity=np.zeros(3)), OFFSET, elements)
        along = cable.tension_vectors[-1] / cable.tensions[-1]
        stiffness = end_dynamic_stiffness(cable, np.array([0.0, 0.1]))
        felt.append(-along @ (stiffness[1] - stiffness[0]) @ along / 0.01)
    wound = cable.wrap.unstrained_length
    assert wound > 0.2 * 10.0
    result = extrapolate(counts, felt)
    assert result.limit == pytest.approx(MU * (10.0**3 - wound**3) / (3.0 * 10.0**2), rel=1e-4)
    assert result.order == pytest.approx(2.0, abs=0.05)


FRAME = np.array([[x, y, z] for z in (5.0, 4.0) for x, y in ((-8, 5.5), (-8, -5.5), (8, -5.5), (8, 5.5))])
PLATFORM = 0.4 * np.array(
    [[1, 1, 1], [-1, 1, 1], [-1, -1, 1], [1, -1, 1], [-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1]]
)
PLACE = np.array([0.3, -0.2, 0.5])


def robot_with(radius):
    """Upright pulleys; straight cables would be stretched by 5e-4."""
    chords = PLACE + PLATFORM - FRAME
    reach, height = np.linalg.norm(chords[:, :2], axis=1) - radius, chords[:, 2]
    bars = np.sqrt(reach**2 + height**2 - radius**2)
    angles = np.arctan2(reach, height) + np.arctan(radius / bars)
    cables = tuple(CableData(length * (1.0 - 5e-4), EA, MU) for length in bars + radius * angles)
    body = PlatformData(60.0, [0.05, -0.03, 0.08], np.diag([7.1, 11.3, 11.3]))
    return RobotData(FRAME, PLATFORM, cables, body, GRAVITY, (PulleyData(radius, UP),) * 8)


def wrench_tangent(robot, pose, step=1e-5):
    columns = []
    for way in np.eye(6):
        ends = []
        for sign in (step, -step):
            turn = Rotation.from_rotvec(sign * way[3:]).as_matrix() @ pose.rotation
            held = solve_robot(robot, pose.position + sign * way[:3], turn, pose.elements, hold_pose=True)
            ends.append(held.residual_wrench)
        columns.append((ends[1] - ends[0]) / (2.0 * step))
    return np.array(columns).T


def test_platform_stiffness_is_the_derivative_of_the_wrench():
    robot = robot_with(0.1)
    pose = solve_robot(robot, PLACE, np.eye(3), 20)
    claimed = platform_dynamic_stiffness(pose, 0.0)
    scale = np.abs(claimed).max()
    assert np.abs(wrench_tangent(robot, pose) - claimed).max() < 2e-6 * scale
    wrong = dataclasses.replace(robot, pulleys=(PulleyData(0.102, UP),) * 8)
    assert np.abs(wrench_tangent(wrong, pose) - claimed).max() > 1e-4 * scale


def test_robot_modes_with_pulleys_are_certified_and_converge():
    counts, values = [20, 40, 80], []
    for elements in counts:
        rest = solve_robot(robot_with(0.1), PLACE, np.eye(3), elements)
        assert np.abs(rest.residual_wrench).max() < 1e-7
        modes = robot_modes(rest, 10)
        omegas = 2.0 * np.pi * modes.frequencies_hz
        for omega in np.linspace(0.9 * omegas[0], 0.999 * omegas[-1], 7):
            assert count_below(rest, omega) == (omegas < omega).sum()
        values.append(modes.frequencies_hz)
    assert extrapolate(counts, values).order == pytest.approx(np.full(10, 2.0), abs=0.1)
    plain = dataclasses.replace(robot_with(1e-9), pulleys=())
    without = robot_modes(solve_robot(plain, PLACE, np.eye(3), 80), 10).frequencies_hz
    assert np.abs(values[-1] / without - 1.0).max() > 1e-3


def test_a_mixed_robot_keeps_its_plain_anchors():
    robot = robot_with(0.1)
    mixed = dataclasses.replace(robot, pulleys=(None, *robot.pulleys[1:]))
    held = solve_robot(mixed, PLACE, np.eye(3), 10, hold_pose=True)
    assert held.cables[0].wrap is None
    assert held.cables[0].wrap_angle == 0.0
    assert np.abs(held.cables[0].nodes[0] - FRAME[0]).max() == 0.0
    assert held.cables[1].wrap_angle > 1.5


def test_errors_carry_numbers():
    with pytest.raises(ValueError, match=r"PulleyData\.radius must be positive and finite, got 0\.0"):
        PulleyData(0.0, UP)
    with pytest.raises(ValueError, match=r"PulleyData\.axis must be a unit vector"):
        PulleyData(0.1, [0.0, 0.0, 2.0])
    with pytest.raises(ValueError, match=r"RobotData\.pulleys must be empty or hold 8 entries, got 1"):
        dataclasses.replace(robot_with(0.1), pulleys=(None,))
    with pytest.raises(UndefinedSwivelError, match="comes back along its swivel axis"):
        hung(one_cable(0.1, 3.0), np.array([0.0, 0.0, -2.99]), 10)
    assert isinstance(PulleysNotSettledError(1e-3, 100), FemError)


def test_modes_over_an_upright_pulley_are_of_one_plane_and_over_a_leaning_one_of_both():
    # solved at once, while modes of a plain cable are solved plane by plane
    plain = cable_modes(hung(one_cable(None, SLACK), OFFSET, 40), 12)
    upright, leaning = (cable_modes(hung(one_cable(0.05, SLACK, axis), OFFSET, 40), 12) for axis in (UP, LEANING))
    assert np.minimum(upright.in_plane_share, 1.0 - upright.in_plane_share).max() < 1e-6
    assert (upright.in_plane_share > 0.5).tolist() == (plain.in_plane_share > 0.5).tolist()
    assert np.minimum(leaning.in_plane_share, 1.0 - leaning.in_plane_share).max() > 1e-6
    cable = hung(one_cable(0.05, SLACK, LEANING), OFFSET, 40)
    across = np.cross(cable.nodes[-1] - cable.nodes[0], UP)
    out = (leaning.shapes @ (across / np.linalg.norm(across))) ** 2
    expected = 1.0 - out.sum(axis=1) / (leaning.shapes**2).sum(axis=(1, 2))
    assert leaning.in_plane_share == pytest.approx(expected, abs=1e-9)
