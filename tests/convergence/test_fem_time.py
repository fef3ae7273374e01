"""Do motions in time and under harmonic load obey energy, modes, textbook pendulums and each other?"""

import dataclasses

import numpy as np
import pytest
import scipy.integrate
import scipy.linalg
import scipy.special

from cdpr_struct.fem_reference import (
    CableData,
    FemError,
    PlatformData,
    PointForce,
    PulleyData,
    RobotData,
    StepNotConvergedError,
    cable_modes,
    damping_rates,
    frequency_response,
    integrate,
    platform_dynamic_stiffness,
    robot_modes,
    solve_robot,
)
from cdpr_struct.fem_reference.linear_motion import LinearSystem
from cdpr_struct.fem_reference.motion_problem import motion_problem

FRAME = np.array([[x, y, z] for z in (5.0, 4.0) for x, y in ((-8, 5.5), (-8, -5.5), (8, -5.5), (8, 5.5))])
PLATFORM = 0.4 * np.array(
    [[1, 1, 1], [-1, 1, 1], [-1, -1, 1], [1, -1, 1], [-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1]]
)
EA, MU, PLACE = 251327.4123, 0.067, np.array([0.3, -0.2, 0.5])
BODY = PlatformData(60.0, [0.05, -0.03, 0.08], np.array([[7.1, 0.4, 0.0], [0.4, 11.3, -0.3], [0.0, -0.3, 9.0]]))
CHORDS = np.linalg.norm(PLACE + PLATFORM - FRAME, axis=1)
STOP = np.array([0.5, -0.3, 0.2, 0.3, 0.2, -0.4])  # m/s, rad/s: an emergency stop


def robot_of(axial_stiffness=EA):
    cables = tuple(CableData(chord * (1.0 - 5e-4), axial_stiffness, MU) for chord in CHORDS)
    return RobotData(FRAME, PLATFORM, cables, BODY)


def rest_of(elements, axial_stiffness=EA, force=None):
    return solve_robot(robot_of(axial_stiffness), PLACE, np.eye(3), elements, external_force=force)


@pytest.fixture(scope="module")
def rest():
    return rest_of(4, force=PointForce([20.0, -10.0, 15.0], [0.1, 0.2, -0.1]))


MASSES = pytest.mark.parametrize("mass", ["lumped", "consistent"])


@MASSES
def test_small_motion_keeps_its_energy(rest, mass):
    history = integrate(rest, 0.5, 1e-3, STOP, mass=mass)
    assert len(history.time) == 501
    assert np.abs(history.energy / history.energy[0] - 1.0).max() < 1e-11
    damped = integrate(rest, 0.5, 1e-3, STOP, damping_ratio=0.05, mass=mass)
    assert (np.diff(damped.energy) < 0.0).all()


def superposed(rest, modes, time, step):
    """Platform motion after a stop as a sum of modes, each at the frequency that the time step turns it into."""
    omegas = 2.0 * np.pi * modes.frequencies_hz
    shapes = np.hstack([modes.cable_shapes.reshape(len(omegas), -1), modes.platform_shapes])
    problem = motion_problem(rest, 1.0, step, STOP, None, None, (), "lumped")
    start = np.concatenate([problem.node_velocities().ravel(), STOP])
    amplitudes = shapes @ (LinearSystem.of(problem).mass @ start) / omegas
    turning = 2.0 / step * np.arctan(0.5 * step * omegas)
    return (amplitudes * np.sin(np.outer(time, turning))) @ modes.platform_shapes


def test_small_motion_sounds_in_the_modes_of_the_robot(rest):
    unknowns, step = 8 * 3 * 3 + 6, 2e-3
    history = integrate(rest, 2.0, step, STOP)
    expected = superposed(rest, robot_modes(rest, unknowns), history.time, step)
    scale = np.abs(expected).max()
    assert np.abs(history.platform - expected).max() < 1e-8 * scale
    stiffer = solve_robot(robot_of(1.02 * EA), PLACE, np.eye(3), 4, external_force=rest.external_force)
    wrong = superposed(rest, robot_modes(stiffer, unknowns), history.time, step)
    assert np.abs(history.platform - wrong).max() > 1e-2 * scale


def push(time):
    return np.array([50.0, -20.0, 30.0, 5.0, 10.0, -8.0]) * np.sin(12.0 * time) ** 2


def exact_small_motion(rest, duration, ratio):
    """Matrix exponential of the whole state, with sin^2 = (1 - cos) / 2 as the output of an oscillator."""
    problem = motion_problem(rest, 1.0, 0.5, STOP, ratio, None, (), "lumped")
    system = LinearSystem.of(problem)
    mass, damping, stiffness = (matrix.toarray() for matrix in (system.mass, system.damping, system.stiffness))
    count = len(mass)
    load = np.zeros(count)
    load[-6:] = push(np.pi / 24.0)
    matrix = np.zeros((2 * count + 3, 2 * count + 3))
    matrix[:count, count : 2 * count] = np.eye(count)
    matrix[count : 2 * count, : 2 * count] = -np.linalg.solve(mass, np.hstack([stiffness, damping]))
    matrix[count : 2 * count, -3:] = np.outer(np.linalg.solve(mass, load), [0.5, -0.5, 0.0])
    matrix[-2:, -2:] = 24.0 * np.array([[0.0, -1.0], [1.0, 0.0]])
    start = np.concatenate([np.zeros(count), problem.node_velocities().ravel(), STOP, [1.0, 1.0, 0.0]])
    moved = scipy.linalg.expm(duration * matrix) @ start
    return moved[count - 6 : count], moved[2 * count - 6 : 2 * count]


def test_small_motion_is_of_order_two_in_the_step(rest):
    """Stop, load and damping at once, against the matrix exponential."""
    place, velocity = exact_small_motion(rest, 0.32, 0.08)
    errors = []
    for step in (4e-4, 2e-4, 1e-4):
        history = integrate(rest, 0.32, step, STOP, 0.08, push)
        errors.append(
            [np.abs(history.platform[-1] - place).max(), np.abs(history.platform_velocity[-1] - velocity).max()]
        )
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders[-1] == pytest.approx([2.0, 2.0], abs=0.15)
    assert errors[-1][0] < 1e-4 * np.abs(place).max()
    undamped, _ = exact_small_motion(rest, 0.32, 0.0)
    assert np.abs(history.platform[-1] - undamped).max() > 1e-3 * np.abs(place).max()


@pytest.mark.parametrize("ratio", [None, 0.05], ids=["undamped", "damped"])
def test_large_motion_tends_to_the_small_one(rest, ratio):
    """The difference falls with the square of the amplitude, hence tenfold beside the motion."""
    differences = []
    for scale in (1e-3, 1e-4):
        options = {"damping_ratio": ratio, "external_wrench": lambda time, size=scale: size * push(time)}
        small, large = (
            integrate(rest, 0.2, 1e-3, scale * STOP, linear=linear, record=[(0, 2), (5, 1)], **options)
            for linear in (True, False)
        )
        names = ("platform", "platform_velocity", "platform_acceleration", "cable_nodes")
        pairs = [(getattr(small, name), getattr(large, name)) for name in names]
        differences.append([np.abs(ours - theirs).max() / np.abs(ours).max() for ours, theirs in pairs])
    assert max(differences[1]) < 1e-3
    assert np.array(differences[0]) / np.array(differences[1]) == pytest.approx(np.full(4, 10.0), rel=0.1)


def test_large_motion_with_slack_cables_keeps_its_energy(rest):
    history = integrate(rest, 0.3, 1e-3, STOP, linear=False)
    assert np.abs(history.energy / history.energy[0] - 1.0).max() < 1e-9
    small = integrate(rest, 0.3, 1e-3, STOP)
    assert history.energy[0] == pytest.approx(small.energy[0], rel=1e-9)  # that of the motion alone, rest has none
    assert np.abs(small.platform - history.platform).max() > 0.1 * np.abs(small.platform).max()


def test_large_motion_is_of_order_two_in_the_step():
    """From rest under a smooth push that keeps all cables taut."""
    state = rest_of(3)

    def at_end(step):
        history = integrate(state, 0.128, step, external_wrench=lambda time: 4.0 * push(time), linear=False)
        return np.concatenate([history.platform[-1], history.platform_velocity[-1]])

    coarse, middle, fine = (at_end(step) for step in (2e-3, 1e-3, 5e-4))
    order = np.log2(np.linalg.norm(coarse - middle) / np.linalg.norm(middle - fine))
    assert order == pytest.approx(2.0, abs=0.15)


def test_a_body_that_is_held_off_its_rest_stays_there():
    """The holding wrench acts on in the motion; without it the body springs back."""
    state = solve_robot(robot_of(), PLACE + np.array([0.0, 0.0, -0.002]), np.eye(3), 3, hold_pose=True)
    assert np.abs(state.residual_wrench).max() > 10.0
    history = integrate(state, 0.02, 1e-3, linear=False)
    assert np.abs(history.platform).max() < 1e-9


def test_a_pendulum_swings_as_slowly_as_the_elliptic_integral_says():
    """Light stiff cable, body hung at its centre of mass, up to 35 degrees, so always taut."""
    length, top = 2.0, np.radians(35.0)
    body = PlatformData(10.0, [0.0, 0.0, 0.0], np.diag([0.5, 0.8, 0.3]))
    robot = RobotData([[0.0, 0.0, 5.0]], [[0.0, 0.0, 0.0]], (CableData(length, 1e6, 1e-4),), body)
    state = solve_robot(robot, [0.0, 0.0, 3.0 - 1e-4], np.eye(3), 3)
    present = 5.0 - state.position[2]
    speed = np.sqrt(2.0 * 9.81 * present * (1.0 - np.cos(top)))
    period = 4.0 * np.sqrt(present / 9.81) * scipy.special.ellipk(np.sin(0.5 * top) ** 2)
    history = integrate(state, 0.55 * period, 4e-3, [speed, 0.0, 0.0, 0.0, 0.0, 0.0], linear=False)
    sideways = history.platform[:, 0]
    crossing = np.flatnonzero((sideways[:-1] > 0.0) & (sideways[1:] <= 0.0))[-1]
    part = sideways[crossing] / (sideways[crossing] - sideways[crossing + 1])
    found = 2.0 * (history.time[crossing] + 4e-3 * part)
    assert found == pytest.approx(period, rel=2e-4)  # the stretch changes by 1e-4 on the way
    assert sideways.max() == pytest.approx(present * np.sin(top), rel=1e-3)
    assert 2.0 * np.pi * np.sqrt(present / 9.81) != pytest.approx(found, rel=1e-2)


def test_a_free_body_tumbles_as_euler_says():
    """Cables of next to no stiffness, no gravity; reference point off the centre of mass."""
    soft = tuple(CableData(0.9 * chord, 1e-6, 1e-9) for chord in CHORDS)
    robot = RobotData(FRAME, PLATFORM, soft, BODY, np.zeros(3))
    state = solve_robot(robot, PLACE, np.eye(3), 2, hold_pose=True)
    spin = np.array([3.0, 0.4, 1.0])
    speed = -np.cross(spin, BODY.center_of_mass)  # the centre of mass stands still
    history = integrate(state, 0.5, 2e-3, [*speed, *spin], linear=False)

    def euler(_, now):
        return np.linalg.solve(BODY.inertia, -np.cross(now, BODY.inertia @ now))

    exact = scipy.integrate.solve_ivp(euler, (0.0, 0.5), spin, rtol=1e-10, atol=1e-12).y[:, -1]
    assert np.linalg.norm(history.platform_velocity[-1, 3:]) == pytest.approx(np.linalg.norm(exact), rel=1e-5)
    arms = history.platform[:, :3] + BODY.center_of_mass  # displacement of the reference point as the body turns
    assert np.linalg.norm(arms - 2.0 * BODY.center_of_mass, axis=1) == pytest.approx(
        np.full(251, np.linalg.norm(BODY.center_of_mass)), rel=1e-6
    )
    assert np.abs(history.energy / history.energy[0] - 1.0).max() < 1e-8  # the holding wrench, 3e-7 N, does work
    differences = np.gradient(history.platform_velocity, 2e-3, axis=0)[2:-2]
    assert np.abs(differences - history.platform_acceleration[2:-2]).max() < 1e-4 * np.abs(differences).max()


def test_cables_start_with_a_speed_that_falls_to_the_frame(rest):
    problem = motion_problem(rest, 1.0, 0.1, STOP, None, None, (), "lumped")
    anchor = STOP[:3] + np.cross(STOP[3:], rest.arms[2])
    assert problem.node_velocities()[2] == pytest.approx(np.outer([0.25, 0.5, 0.75], anchor))
    history = integrate(rest, 1e-3, 1e-4, STOP, record=[(2, 1), (2, 3)])
    assert history.cable_nodes.shape == (11, 2, 3)
    assert history.cable_nodes[1] / 1e-4 == pytest.approx(np.outer([0.25, 0.75], anchor), rel=0.1, abs=1e-2)


def receptance(rest, omega, ratio):
    """The platform's corner of the inverse of the whole matrix, cables not condensed."""
    system = LinearSystem.of(motion_problem(rest, 1.0, 0.5, None, ratio, None, (), "lumped"))
    whole = system.stiffness - omega**2 * system.mass + 1.0j * omega * system.damping
    return np.linalg.inv(whole.toarray())[-6:, -6:]


@pytest.mark.parametrize("ratio", [0.02, np.linspace(0.0, 0.1, 8)], ids=["one ratio", "one a cable"])
def test_condensed_response_is_that_of_the_whole_matrix(rest, ratio):
    omegas = np.array([[0.0, 5.0], [13.0, 40.0]])
    found = frequency_response(rest, omegas, ratio)
    assert found.shape == (2, 2, 6, 6)
    for index, omega in np.ndenumerate(omegas):
        expected = receptance(rest, omega, ratio)
        assert np.abs(found[index] - expected).max() < 1e-8 * np.abs(expected).max()
    wrong = receptance(rest, 13.0, 1.02 * np.asarray(ratio))
    assert np.abs(found[1, 0] - wrong).max() > 1e-6 * np.abs(wrong).max()
    losses = np.linalg.eigvalsh(-found[1, 0].imag)
    assert losses.min() > -1e-15  # damping takes energy
    assert np.abs(found[1, 0] - found[1, 0].T).max() < 1e-12 * np.abs(found).max()


def test_undamped_response_is_the_inverse_of_the_dynamic_stiffness(rest):
    found = frequency_response(rest, 7.0)
    assert found.dtype == float
    assert found @ platform_dynamic_stiffness(rest, 7.0) == pytest.approx(np.eye(6), abs=1e-9)
    assert frequency_response(rest, 7.0, 0.0) == pytest.approx(found, rel=1e-12)


def test_damping_follows_the_first_frequency_of_each_cable(rest):
    first = [cable_modes(cable, 1).frequencies_hz[0] for cable in rest.cables]
    assert damping_rates(rest, 0.03) == pytest.approx(0.06 * 2.0 * np.pi * np.array(first), rel=1e-9)
    assert damping_rates(rest, None) == pytest.approx(np.zeros(8))


def test_pulleys_join_in_small_motion_and_response():
    robot = dataclasses.replace(robot_of(), pulleys=(PulleyData(0.1, [0.0, 0.0, 1.0]),) * 8)
    longer = tuple(dataclasses.replace(c, unstrained_length=c.unstrained_length + 0.12) for c in robot.cables)
    state = solve_robot(dataclasses.replace(robot, cables=longer), PLACE, np.eye(3), 4)
    history = integrate(state, 1.0, 2e-3, STOP)
    assert np.abs(history.energy / history.energy[0] - 1.0).max() < 1e-11
    expected = superposed(state, robot_modes(state, 78), history.time, 2e-3)
    assert np.abs(history.platform - expected).max() < 1e-7 * np.abs(expected).max()
    response, whole = frequency_response(state, 9.0, 0.02), receptance(state, 9.0, 0.02)
    assert np.abs(response - whole).max() < 1e-8 * np.abs(whole).max()
    with pytest.raises(ValueError, match="linear must be True for a robot with pulleys"):
        integrate(state, 1.0, 1e-3, linear=False)


def test_arguments_are_checked(rest):
    with pytest.raises(ValueError, match=r"time_step must lie between 0 and duration, got 2\.0 and 1\.0"):
        integrate(rest, 1.0, 2.0)
    with pytest.raises(ValueError, match=r"nodes 1 \.\.\. 3, got \(0, 4\)"):
        integrate(rest, 1.0, 0.1, record=[(0, 4)])
    with pytest.raises(ValueError, match=r"initial_velocity must have shape \(6,\)"):
        integrate(rest, 1.0, 0.1, [1.0, 2.0])
    with pytest.raises(ValueError, match=r"damping_ratio must be one or 8 numbers of at least 0, got -0\.1"):
        integrate(rest, 1.0, 0.1, damping_ratio=-0.1)
    with pytest.raises(ValueError, match="mass must be 'lumped' with linear=False, got 'consistent'"):
        integrate(rest, 1.0, 0.1, linear=False, mass="consistent")
    assert issubclass(StepNotConvergedError, FemError)
