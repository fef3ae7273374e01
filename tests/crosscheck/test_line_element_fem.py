"""Elastic parts in line behind the exit: the referee's sliding cable, the product's element at the frame end."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse

ELEMENTS = (20, 40, 80)
GIVE = 5e-5  # m/N, about that of the cables themselves
MODES = 20


def robot_with(give: float, radius: float = 0.0) -> Robot:
    robot = load_robot("thesis-3-1")
    robot = replace(robot, extensions=Extensions.of(8, {"series_compliance": give}))
    if not radius:
        return robot
    return replace(robot, pulleys=tuple(Pulley(radius, np.array([0.0, 0.0, 1.0])) for _ in range(8)))


def at_rest(give: float = GIVE, radius: float = 0.0) -> OperatingPoint:
    robot = robot_with(give, radius)
    place = robot.home.position + np.array([0.5, -0.4, 0.2])
    return OperatingPoint(robot, place, np.eye(3), inverse(robot, place, np.eye(3)).cables)


def frequencies(point: OperatingPoint) -> np.ndarray:
    return np.array(certified_modes(point, "exact", MODES).frequencies.hertz)


def test_over_pulleys_both_rest_and_vibrate_alike():
    point = at_rest(radius=0.06)
    meshes = [solve_in_fem(point, n) for n in ELEMENTS]
    place = fem.extrapolate(ELEMENTS, np.array([mesh.position for mesh in meshes])).limit
    hertz = fem.extrapolate(ELEMENTS, np.array([fem.robot_modes(mesh, MODES).frequencies_hz for mesh in meshes])).limit
    assert np.abs(place - point.position).max() < 2e-9  # m, measured 1.7e-10
    assert np.abs(frequencies(point) / hertz - 1.0).max() < 2e-5  # measured 3.6e-6
    assert np.abs(frequencies(at_rest(1.05 * GIVE, 0.06)) / hertz - 1.0).max() > 1e-3  # twin


@pytest.mark.parametrize("radius", [0.0, 0.06])
def test_forward_kinematics_finds_the_pose_of_the_referee_under_a_load(radius):
    """Another platform mass at the lengths of the empty one; with the line, it sinks by more than without."""
    point = at_rest(radius=radius)
    body = replace(point.robot.platform, mass=2.0 * point.robot.platform.mass)
    lengths, sunk = point.cables.total_length, {}
    for give in (GIVE, 0.0):
        robot = replace(robot_with(give, radius), platform=body)
        found = forward(robot, lengths, point.position, point.rotation)
        loaded = OperatingPoint(robot, found.position, found.rotation, point.cables)
        theirs = [solve_in_fem(loaded, n).position for n in ELEMENTS]
        sunk[give] = fem.extrapolate(ELEMENTS, np.array(theirs)).limit
        assert np.abs(found.position - sunk[give]).max() < 2e-9
    assert abs(sunk[GIVE] - sunk[0.0]).max() > 1e-3


@pytest.mark.parametrize("radius", [0.0, 0.06])
def test_the_referee_s_stiffness_is_the_derivative_of_its_forces(radius):
    """Central differences of the wrench that holds the platform; the line is three fifths of the cables' give here."""
    rest = solve_in_fem(at_rest(radius=radius), 40)
    step, columns = 1e-5, []
    for way in np.eye(3):
        held = [fem.solve_robot(rest.robot, rest.position + s * step * way, rest.rotation, 40, True) for s in (1, -1)]
        columns.append((held[1].residual_wrench - held[0].residual_wrench) / (2.0 * step))
    claimed = fem.platform_dynamic_stiffness(rest, 0.0)[:, :3]
    # bars are cut anew at each pose, so that the weight that slides in is shared out differently: some 1e-6
    assert np.abs(np.array(columns).T - claimed).max() < 1e-5 * np.abs(claimed).max()
    stiff = fem.platform_dynamic_stiffness(solve_in_fem(at_rest(0.0, radius), 40), 0.0)[:, :3]
    assert np.abs(stiff - claimed).max() > 0.1 * np.abs(claimed).max()


def test_a_dead_piece_of_cable_is_a_spring_of_its_compliance():
    """One vertical cable, without weight: a load stretches free and dead length alike."""
    free, dead, stiff, load = 2.0, 3.0, 1e5, 500.0
    anchors = np.array([[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [0.0, 1.0, 5.0]])
    robot = fem.RobotData(
        anchors,
        anchors - [0.0, 0.0, 5.0],
        tuple(fem.CableData(free, stiff, 1e-9, dead / stiff) for _ in anchors),
        fem.PlatformData(3.0 * load / 9.81, np.array([1.0, 1.0, 0.0]) / 3.0, np.eye(3)),
    )
    rest = fem.solve_robot(robot, [0.0, 0.0, 2.99], np.eye(3), 8)
    strain = load / stiff
    let_out = dead * strain / (1.0 + strain)  # unstrained, so that the dead path stays as long as it is
    np.testing.assert_allclose(5.0 - rest.position[2], (free + let_out) * (1.0 + strain), atol=1e-9)
    assert rest.cables[0].cable.unstrained_length == pytest.approx(free + let_out, abs=1e-9)


@pytest.mark.parametrize("linear", [True, False])
def test_small_motion_in_time_has_the_frequency_of_the_modes(linear):
    """Started in the shape of the lowest mode that is the platform's: a quarter of its period later it is at rest."""
    rest = solve_in_fem(at_rest(), 10)
    modes = fem.robot_modes(rest, MODES)
    number = int(np.argmax(modes.platform_energy))
    omega = 2.0 * np.pi * modes.frequencies_hz[number]
    twist = 1e-3 * modes.platform_shapes[number] / np.abs(modes.platform_shapes[number]).max()
    duration = 4.0 * np.pi / omega
    history = fem.integrate(rest, duration, duration / 400, twist, linear=linear)
    along = history.platform_velocity @ twist / (twist @ twist)
    crossed = history.time[np.flatnonzero(np.diff(np.sign(along)))]
    assert crossed[0] == pytest.approx(0.5 * np.pi / omega, rel=0.05)
    np.testing.assert_allclose(history.energy, history.energy[0], rtol=1e-6)


def test_large_and_small_motion_agree_where_motion_is_small():
    rest = solve_in_fem(at_rest(), 10)
    twist = np.array([1e-4, 0.0, 2e-4, 0.0, 1e-4, 0.0])
    small, large = (fem.integrate(rest, 0.1, 5e-4, twist, linear=linear).platform for linear in (True, False))
    rigid = fem.integrate(solve_in_fem(at_rest(0.0), 10), 0.1, 5e-4, twist).platform
    size = np.abs(small).max()
    assert np.abs(large - small).max() < 5e-3 * size  # the half bar that slides has no inertia along the cable there
    assert np.abs(rigid - small).max() > 0.1 * size
