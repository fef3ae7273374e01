"""Does the robot of bar cables and a rigid platform obey mechanics, textbook pendulums and its own counts?"""

import dataclasses

import numpy as np
import pytest
import scipy.optimize
from scipy.spatial.transform import Rotation

from cdpr_struct.fem_reference import (
    CableData,
    FemError,
    PlatformData,
    PointForce,
    RobotData,
    RobotNotConvergedError,
    count_below,
    extrapolate,
    platform_dynamic_stiffness,
    robot_modes,
    solve_robot,
)
from cdpr_struct.fem_reference.robot_modes import node_motion, robot_matrices

FRAME = np.array(
    [
        [-8, 5.5, 5],
        [-8, -5.5, 5],
        [8, -5.5, 5],
        [8, 5.5, 5],
        [-8, 5.5, 4],
        [-8, -5.5, 4],
        [8, -5.5, 4],
        [8, 5.5, 4],
    ]
)  # m, published 8-cable robot
PLATFORM = np.array(
    [
        [0.48, 0.32, 0.32],
        [-0.48, 0.32, 0.32],
        [-0.48, -0.32, 0.32],
        [0.48, -0.32, 0.32],
        [-0.48, -0.32, -0.32],
        [0.48, -0.32, -0.32],
        [0.48, 0.32, -0.32],
        [-0.48, 0.32, -0.32],
    ]
)
EA, MU, POSITION = 251327.4123, 0.067, np.array([0.0, 0.0, 0.5])
BODY = PlatformData(60.0, np.array([0.05, -0.03, 0.08]), np.diag([7.1, 11.3, 11.3]))
CHORDS = np.linalg.norm(POSITION + PLATFORM - FRAME, axis=1)
ROBOT = RobotData(FRAME, PLATFORM, tuple(CableData(chord * (1.0 - 5e-4), EA, MU) for chord in CHORDS), BODY)
MASSES = pytest.mark.parametrize("mass", ["lumped", "consistent"])


def turned_by(degrees, axis):
    return Rotation.from_rotvec(np.radians(degrees) * np.array(axis) / np.linalg.norm(axis)).as_matrix()


@pytest.fixture(scope="module")
def at_rest():
    return solve_robot(ROBOT, POSITION, np.eye(3), 40)


def test_free_platform_is_in_balance_and_the_frame_carries_all_weight(at_rest):
    tensions = sum(cable.tensions.max() for cable in at_rest.cables)
    assert np.abs(at_rest.residual_wrench).max() < 1e-11 * tensions
    frame = sum(cable.start_force for cable in at_rest.cables)
    weight = 9.81 * (60.0 + MU * sum(cable.unstrained_length for cable in ROBOT.cables))
    assert frame == pytest.approx([0.0, 0.0, weight], abs=1e-9)


def test_moments_balance_about_an_arbitrary_point(at_rest):
    """Whole system, every node weight and support taken by hand about (3, -2, 7)."""
    pivot, weight = np.array([3.0, -2.0, 7.0]), np.array([0.0, 0.0, -9.81])
    center = at_rest.position + at_rest.rotation @ BODY.center_of_mass
    moment = np.cross(center - pivot, 60.0 * weight)
    for cable in at_rest.cables:
        lumps = np.full(cable.elements + 1, MU * cable.element_length)
        lumps[[0, -1]] *= 0.5
        moment += np.cross(cable.nodes - pivot, lumps[:, None] * weight).sum(axis=0)
        moment += np.cross(cable.nodes[0] - pivot, cable.start_force)
    assert moment == pytest.approx(np.zeros(3), abs=1e-8)


@pytest.mark.parametrize(
    ("offset", "degrees", "axis"),
    [
        ((0.06, -0.05, 0.06), 5.0, (1, -1, 1)),
        ((-0.1, 0.0, 0.0), 5.0, (0, 0, 1)),
        ((0.3, -0.3, 0.5), 25.0, (1, 1, -1)),
    ],
)
def test_a_guess_far_off_leads_to_the_same_pose(at_rest, offset, degrees, axis):
    found = solve_robot(ROBOT, POSITION + offset, turned_by(degrees, axis), 40)
    assert found.position == pytest.approx(at_rest.position, abs=1e-10)
    assert found.rotation == pytest.approx(at_rest.rotation, abs=1e-10)
    assert found.iterations < 20


def wrench_tangent(robot, pose, force, step=2e-6):
    """Minus the derivative of the wrench at a pose by displacement and world rotation, by differences."""
    columns = []
    for axis in np.eye(6):
        ends = []
        for sign in (step, -step):
            turn = Rotation.from_rotvec(sign * axis[3:]).as_matrix() @ pose.rotation
            held = solve_robot(robot, pose.position + sign * axis[:3], turn, pose.elements, True, force)
            ends.append(held.residual_wrench)
        columns.append((ends[1] - ends[0]) / (2.0 * step))
    return np.array(columns).T


PUSH = PointForce([150.0, -80.0, -200.0], [0.3, 0.5, -0.4])


@pytest.mark.parametrize("force", [None, PUSH], ids=["free", "pushed"])
def test_static_platform_stiffness_is_the_derivative_of_the_wrench(force):
    """With an offset centre of mass and at a turned pose; exact only if all second-order arm terms are in."""
    robot = dataclasses.replace(ROBOT, platform=PlatformData(60.0, [0.2, -0.1, 0.3], BODY.inertia))
    pose = solve_robot(robot, POSITION, turned_by(3.0, (1, 2, 3)), 20, external_force=force)
    claimed = platform_dynamic_stiffness(pose, 0.0)
    scale = np.abs(claimed).max()
    assert np.abs(wrench_tangent(robot, pose, force) - claimed).max() < 1e-7 * scale
    without = platform_dynamic_stiffness(pose, 0.0, geometric_terms=False)
    assert np.abs(wrench_tangent(robot, pose, force) - without).max() > 1e-4 * scale
    stiffer = tuple(CableData(c.unstrained_length, 1.02 * EA, MU) for c in robot.cables)
    wrong = dataclasses.replace(robot, cables=stiffer)
    assert np.abs(wrench_tangent(wrong, pose, force) - claimed).max() > 1e-3 * scale


def test_an_external_force_moves_the_platform_by_force_over_stiffness(at_rest):
    push = np.array([0.2, -0.1, 0.15])
    point = np.array([0.1, 0.2, -0.3])
    pushed = solve_robot(ROBOT, POSITION, np.eye(3), 40, external_force=PointForce(push, point))
    wrench = np.concatenate([push, np.cross(at_rest.rotation @ point, push)])
    expected = np.linalg.solve(platform_dynamic_stiffness(at_rest, 0.0), wrench)
    turn = Rotation.from_matrix(pushed.rotation @ at_rest.rotation.T).as_rotvec()
    moved, tolerance = pushed.position - at_rest.position, 2e-3 * np.abs(expected).max()  # linear in the push
    assert np.concatenate([moved, turn]) == pytest.approx(expected, abs=tolerance)


@MASSES
def test_counts_shares_shapes_and_symmetry_agree(at_rest, mass):
    modes = robot_modes(at_rest, 60, mass)
    omegas = 2.0 * np.pi * modes.frequencies_hz
    for omega in np.linspace(0.5 * omegas[0], 0.999 * omegas[-1], 60):
        assert count_below(at_rest, omega, mass) == (omegas < omega).sum()
    assert modes.platform_energy + modes.cable_energy.sum(axis=1) == pytest.approx(1.0, abs=1e-12)
    assert modes.cable_energy.min() >= 0.0
    assert modes.cable_shapes.shape == (60, 8, 39, 3)
    stiffness, inertia = robot_matrices(at_rest, mass)
    for matrix in (stiffness, inertia):
        assert abs(matrix - matrix.T).max() < 1e-12 * abs(matrix).max()
    shapes = np.hstack([modes.cable_shapes.reshape(60, -1), modes.platform_shapes])
    left_over = stiffness @ shapes.T - inertia @ shapes.T * omegas**2
    assert np.abs(left_over).max() < 1e-10 * abs(stiffness).max() * np.abs(shapes).max()


def test_frequencies_do_not_depend_on_the_platform_frame(at_rest):
    """Another reference point and other axes in the same body: the same mechanics."""
    turn, origin = turned_by(40.0, (1, -2, 3)), np.array([0.3, -0.2, 0.1])  # new axes and origin, old frame
    center, inertia = (BODY.center_of_mass - origin) @ turn, turn.T @ BODY.inertia @ turn
    robot = RobotData(FRAME, (PLATFORM - origin) @ turn, ROBOT.cables, PlatformData(60.0, center, inertia))
    other = solve_robot(robot, POSITION + origin, turn, 40)
    assert other.position == pytest.approx(at_rest.position + at_rest.rotation @ origin, abs=1e-9)
    assert other.rotation == pytest.approx(at_rest.rotation @ turn, abs=1e-9)
    expected = robot_modes(at_rest, 30)
    found = robot_modes(other, 30)
    assert found.frequencies_hz == pytest.approx(expected.frequencies_hz, rel=1e-8)
    assert found.platform_energy == pytest.approx(expected.platform_energy, abs=1e-6)


def test_rigid_translation_moves_the_whole_mass(at_rest):
    """All nodes but the held frame anchors, hence all but half an element at each start."""
    _, inertia = robot_matrices(at_rest)
    motion = np.tile([1.0, 0.0, 0.0], (inertia.shape[0] - 6) // 3)
    moved = np.concatenate([motion, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]])
    total = sum(c.unstrained_length for c in ROBOT.cables) * MU
    assert moved @ (inertia @ moved) == pytest.approx(60.0 + total * (1.0 - 0.5 / 40), rel=1e-13)
    assert node_motion(at_rest) @ moved == pytest.approx(np.tile([1.0, 0.0, 0.0], 8 * 40))


@MASSES
def test_eigenfrequencies_are_zeros_of_the_platform_determinant(at_rest, mass):
    """Refine a sign change of det K(omega) beside every mode in which the platform moves noticeably."""
    modes = robot_modes(at_rest, 40, mass)

    def determinant(omega):
        return np.linalg.slogdet(platform_dynamic_stiffness(at_rest, omega, mass))[0]

    checked = 0
    for omega in 2.0 * np.pi * modes.frequencies_hz[modes.platform_energy > 0.05]:
        low, high = omega * (1.0 - 1e-6), omega * (1.0 + 1e-6)
        assert determinant(low) * determinant(high) < 0.0
        assert scipy.optimize.bisect(determinant, low, high, xtol=1e-10) == pytest.approx(omega, rel=1e-8)
        checked += 1
    assert checked >= 6


def platform_frequencies(stiffness_factor, elements):
    cables = tuple(CableData(c.unstrained_length, stiffness_factor * EA, MU) for c in ROBOT.cables)
    robot = dataclasses.replace(ROBOT, cables=cables)
    return robot_modes(solve_robot(robot, POSITION, np.eye(3), elements), 10).frequencies_hz


def test_robot_frequencies_converge_with_order_two_and_tell_a_stiffer_cable():
    counts = [20, 40, 80]
    result = extrapolate(counts, [platform_frequencies(1.0, n) for n in counts])
    assert result.order == pytest.approx(np.full(10, 2.0), abs=0.1)
    wrong = extrapolate(counts, [platform_frequencies(1.02, n) for n in counts])
    uncertainty = (result.error_estimate / result.limit).max()
    assert np.abs(wrong.limit / result.limit - 1.0).max() > 100.0 * uncertainty


PENDULUM_LENGTH, PENDULUM_MASS, G = 2.0, 10.0, 9.81  # m, kg, m/s^2
LIGHT_STIFF = CableData(PENDULUM_LENGTH, 1e8, 1e-6)  # stretches by 1e-6, weighs 2e-7 of the body


def test_body_on_one_cable_is_a_textbook_double_pendulum():
    """K = m g diag(l, d), M = m [[l^2, l d], [l d, d^2 + I / m]]: centre of mass d below the attachment."""
    drop, inertia = 0.3, np.diag([0.5, 0.8, 0.3])
    body = PlatformData(PENDULUM_MASS, [0.0, 0.0, -drop], inertia)
    robot = RobotData([[0.0, 0.0, 5.0]], [[0.0, 0.0, 0.0]], (LIGHT_STIFF,), body)
    pose = solve_robot(robot, [0.02, -0.03, 2.9], turned_by(3.0, (1, 2, 0)), 6)
    expected = [0.0]  # spin about the cable
    for moment in (0.5, 0.8):
        mass = np.array(
            [
                [PENDULUM_LENGTH**2, PENDULUM_LENGTH * drop],
                [PENDULUM_LENGTH * drop, drop**2 + moment / PENDULUM_MASS],
            ]
        )
        stiffness = G * np.diag([PENDULUM_LENGTH, drop])
        expected += list(np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real) / (2.0 * np.pi))
    found = robot_modes(pose, 5).frequencies_hz
    assert found == pytest.approx(sorted(expected), rel=1e-5, abs=1e-4)
    geometric = platform_dynamic_stiffness(pose, 0.0)[3, 3]
    assert geometric == pytest.approx(PENDULUM_MASS * G * drop, rel=1e-5)
    assert abs(platform_dynamic_stiffness(pose, 0.0, geometric_terms=False)[3, 3]) < 1e-6


def test_body_on_two_parallel_cables_is_a_bifilar_pendulum():
    """Swing g / l both ways, twist m g a^2 / (I_z l), and a sway about the anchor line."""
    half, vertical_inertia = 0.4, 0.9
    body = PlatformData(PENDULUM_MASS, [0.0, 0.0, -0.25], np.diag([0.6, 0.7, vertical_inertia]))
    anchors = np.array([[half, 0.0, 0.0], [-half, 0.0, 0.0]])
    robot = RobotData(anchors + np.array([0.0, 0.0, 5.0]), anchors, (LIGHT_STIFF, LIGHT_STIFF), body)
    pose = solve_robot(robot, [0.01, 0.02, 3.0], turned_by(2.0, (1, 0, 1)), 6)
    found = robot_modes(pose, 4).frequencies_hz
    swing = np.sqrt(G / PENDULUM_LENGTH) / (2.0 * np.pi)
    twist = np.sqrt(PENDULUM_MASS * G * half**2 / (vertical_inertia * PENDULUM_LENGTH)) / (2.0 * np.pi)
    for textbook in (swing, twist):
        assert np.abs(found / textbook - 1.0).min() < 1e-5
    assert found[0] < 0.999 * swing  # the double pendulum across the anchor line is slower


def test_a_held_pose_reports_what_is_out_of_balance():
    held = solve_robot(ROBOT, POSITION + np.array([0.0, 0.0, 0.02]), np.eye(3), 20, hold_pose=True)
    assert held.position == pytest.approx([0.0, 0.0, 0.52])
    assert held.iterations == 0
    pulls = -sum(cable.end_force for cable in held.cables)
    assert held.residual_wrench[:3] == pytest.approx(pulls + 60.0 * ROBOT.gravity, abs=1e-9)
    assert np.abs(held.residual_wrench).max() > 1.0


def test_shapes_follow_the_frequencies_asked_for(at_rest):
    omegas = np.array([[0.0, 3.0 + 0.1j], [7.0, 20.0]])
    matrices = platform_dynamic_stiffness(at_rest, omegas)
    assert matrices.shape == (2, 2, 6, 6)
    assert matrices[0, 1] == pytest.approx(platform_dynamic_stiffness(at_rest, 3.0 + 0.1j), rel=1e-12)
    assert matrices[1, 1].real == pytest.approx(platform_dynamic_stiffness(at_rest, 20.0), rel=1e-9, abs=1e-6)


def test_errors_carry_numbers_and_the_next_step():
    with pytest.raises(ValueError, match="rotation must be a proper rotation matrix"):
        solve_robot(ROBOT, POSITION, -np.eye(3), 10)
    with pytest.raises(ValueError, match=r"RobotData\.frame_anchors must have shape \(8, 3\), got \(7, 3\)"):
        RobotData(FRAME[:7], PLATFORM, ROBOT.cables, BODY)
    with pytest.raises(ValueError, match="external_force must be a PointForce or None"):
        solve_robot(ROBOT, POSITION, np.eye(3), 10, external_force=np.ones(3))
    with pytest.raises(ValueError, match=r"PlatformData\.inertia must be symmetric and positive"):
        PlatformData(1.0, np.zeros(3), np.diag([1.0, -1.0, 1.0]))
    error = RobotNotConvergedError(np.ones(6), 1e-9, 100, POSITION, np.eye(3))
    assert isinstance(error, FemError)
    assert "out of balance by 1.73 N and 1.73 N m after 100 iterations" in str(error)
