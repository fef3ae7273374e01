"""Cable states, their stiffness and the pulley: symmetric, conservative, and the derivative of what they claim."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.cable_response import cable_response
from cdpr_struct.statics.cable_state import cable_stiffness
from cdpr_struct.statics.catenary import CableStatus
from cdpr_struct.statics.equilibrium import PlatformArms
from cdpr_struct.statics.pulley import pulley_exit, straight_exit

ROBOT = load_robot("thesis-3-1")
UP = np.array([0.0, 0.0, 1.0])


def arrays_with_pulleys(radius: float, tilt: float = 0.2) -> RobotArrays:
    axes = [np.array([tilt * (-1) ** i, 0.5 * tilt, 1.0]) for i in range(8)]
    return RobotArrays.of(replace(ROBOT, pulleys=tuple(Pulley(radius, axis) for axis in axes)))


def points_and_lengths(seed: int, count: int, arrays: RobotArrays, slack: float) -> tuple[np.ndarray, np.ndarray]:
    """Platform anchors at random poses, and lengths around those of straight cables."""
    rng = np.random.default_rng(seed)
    position = rng.uniform([-3, -3, 0.2], [3, 3, 1.5], (count, 3))
    points = PlatformArms.at(arrays, position, np.broadcast_to(np.eye(3), (count, 3, 3))).points
    straight = cable_model("ideal").hold(arrays, points, np.zeros((count, 8))).states.total_length
    return points, straight * (1.0 + slack * rng.uniform(-0.2, 1.0, (count, 8)))


def difference(function, points: np.ndarray, step: float) -> np.ndarray:
    """Central differences of a function of points (..., m, 3): (..., m, 3, 3), columns are directions."""
    columns = [(function(points + step * e) - function(points - step * e)) / (2.0 * step) for e in np.eye(3)]
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize("model", ["sagging", "spring"])
@pytest.mark.parametrize("radius", [0.0, 0.05, 0.4])
def test_stiffness_is_the_derivative_of_the_force(model, radius):
    arrays = arrays_with_pulleys(radius) if radius else RobotArrays.of(ROBOT)
    points, length = points_and_lengths(1, 20, arrays, 0.01)
    solver = cable_model(model)
    states = solver.states(arrays, points, length)
    numeric = difference(lambda p: -solver.states(arrays, p, length).force_on_platform, points, 1e-6)
    exact = cable_response(arrays, states).stiffness
    assert np.abs(numeric - exact).max() < 1e-7 * np.abs(exact).max()  # measured 2e-9
    soft = arrays.axial_stiffness * 0.98
    wrong = solver.states(replace(arrays, axial_stiffness=soft), points, length)
    twin = cable_response(replace(arrays, axial_stiffness=soft), wrong).stiffness
    assert np.abs(numeric - twin).max() > 1e-3 * np.abs(exact).max()


@pytest.mark.parametrize("model", ["sagging", "spring"])
@pytest.mark.parametrize("radius", [0.0, 0.05, 0.4])
def test_length_rate_is_the_derivative_of_the_force(model, radius):
    arrays = arrays_with_pulleys(radius) if radius else RobotArrays.of(ROBOT)
    points, length = points_and_lengths(2, 20, arrays, 0.01)
    solver = cable_model(model)
    step = 1e-6
    high, low = (-solver.states(arrays, points, length + d).force_on_platform for d in (step, -step))
    numeric = (high - low) / (2.0 * step)
    exact = cable_response(arrays, solver.states(arrays, points, length)).length_rate
    assert np.abs(numeric - exact).max() < 1e-7 * np.abs(exact).max()


def test_stiffness_is_symmetric_and_never_negative():
    arrays = RobotArrays.of(ROBOT)
    points, length = points_and_lengths(3, 200, arrays, 0.5)
    for model in ("sagging", "spring"):
        matrix = cable_stiffness(cable_model(model).states(arrays, points, length))
        assert np.abs(matrix - np.swapaxes(matrix, -1, -2)).max() <= 1e-12 * np.abs(matrix).max()
        assert np.linalg.eigvalsh(matrix).min() >= -1e-9 * np.abs(matrix).max()


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 10_000), radius=st.sampled_from([0.0, 0.1]), model=st.sampled_from(["sagging", "spring"]))
def test_no_work_around_a_closed_path(seed, radius, model):
    """Virtual work: the force of a cable of fixed length is conservative, so a lap around a circle costs nothing.

    The trapezoidal rule is spectrally accurate on a smooth closed path; the neglected weight of the cable on the
    pulley leaves about w R / T of the work of a half lap.
    """
    arrays = arrays_with_pulleys(radius) if radius else RobotArrays.of(ROBOT)
    points, length = points_and_lengths(seed, 1, arrays, 0.0)
    length = length * 0.999
    rng = np.random.default_rng(seed)
    first, second = np.linalg.qr(rng.normal(size=(3, 3)))[0][:2]
    angle = np.linspace(0.0, 2.0 * np.pi, 65)[:-1, None, None]
    size = 5e-4 * points[..., :1] * 0.0 + 5e-3
    path = points + size * (np.cos(angle) * first + np.sin(angle) * second)
    speed = size * (np.cos(angle) * second - np.sin(angle) * first)
    force = cable_model(model).states(arrays, path, np.broadcast_to(length, (64, 8))).force_on_platform
    power = (force * speed).sum(axis=-1)
    assert np.abs(power.mean(axis=0)).max() < 1e-7 * np.abs(power).max()
    twin = force + 1e-3 * np.abs(force).max() * np.cross(first, second) * np.cos(angle)  # a swirl would do work
    twin = twin + 1e-3 * np.abs(force).max() * (np.cos(angle) * second - np.sin(angle) * first)
    assert np.abs((twin * speed).sum(axis=-1).mean(axis=0)).max() > 1e-5 * np.abs(power).max()


@pytest.mark.parametrize("model", ["sagging", "spring"])
def test_hold_and_states_are_inverse_of_each_other(model):
    for arrays in (RobotArrays.of(ROBOT), arrays_with_pulleys(0.1)):
        points, _ = points_and_lengths(4, 30, arrays, 0.0)
        tension = np.random.default_rng(5).uniform(50.0, 500.0, points.shape[:-1])
        held = cable_model(model).hold(arrays, points, tension).states
        again = cable_model(model).states(arrays, points, held.total_length)
        assert np.abs(again.force_on_platform - held.force_on_platform).max() < 1e-9 * 500.0


@pytest.mark.parametrize("radius", [0.0, 0.1])
def test_rate_with_tension_is_the_derivative(radius):
    arrays = arrays_with_pulleys(radius) if radius else RobotArrays.of(ROBOT)
    points, _ = points_and_lengths(6, 10, arrays, 0.0)
    tension = np.full(points.shape[:-1], 100.0)
    for model in ("sagging", "spring"):
        solver = cable_model(model)
        high, low = (solver.hold(arrays, points, tension + d).states.force_on_platform for d in (0.1, -0.1))
        numeric, exact = (high - low) / 0.2, solver.hold(arrays, points, tension).force_rate
        sine = np.linalg.norm(np.cross(numeric, exact), axis=-1) / np.linalg.norm(exact, axis=-1) ** 2
        assert sine.max() < 1e-6  # its direction is what decides the optimum
        assert np.abs(numeric - exact).max() < (0.02 if radius else 1e-5)  # its size only paces the Newton steps


def test_compliance_split_adds_up_to_the_inverse_of_the_plane_stiffness():
    arrays = RobotArrays.of(ROBOT)
    points, length = points_and_lengths(7, 20, arrays, 0.01)
    states = cable_model("sagging").states(arrays, points, length)
    matrix = cable_stiffness(states)
    h = states.heading
    k_xx, k_xz = (np.einsum("...i,...ij,j->...", h, matrix, UP), matrix[..., 2, 2])
    plane = np.stack([np.einsum("...i,...ij,...j->...", h, matrix, h), k_xx, k_xx, k_xz], axis=-1)
    axial, sag = states.compliance_split()
    product = plane.reshape((*k_xx.shape, 2, 2)) @ (axial + sag)
    assert np.abs(product - np.eye(2)).max() < 1e-7


def test_vertical_cables_are_alike_in_all_horizontal_directions():
    """Below its anchor a loaded cable is a pendulum of stiffness about T / l; a folded one pushes nowhere."""
    arrays = RobotArrays.of(ROBOT)
    points = np.array(ROBOT.frame_anchors) - 3.0 * UP
    taut = cable_model("sagging").states(arrays, points, np.full(8, 2.99))
    matrix = cable_stiffness(taut)
    assert taut.status.tolist() == [CableStatus.CONVERGED] * 8
    assert matrix[:, 0, 0] == pytest.approx(matrix[:, 1, 1], rel=1e-12)
    assert matrix[:, 0, 0] == pytest.approx(taut.tension / 3.0, rel=1e-3)
    assert taut.inclination == pytest.approx(-np.pi / 2)
    folded = cable_model("sagging").states(arrays, points, np.full(8, 4.0))
    assert folded.status.tolist() == [CableStatus.FOLDED] * 8
    assert np.isfinite(cable_stiffness(folded)).all()
    assert np.abs(cable_stiffness(folded)[:, :2]).max() < 1.0


@pytest.mark.parametrize("lean", [1e-6, 1e-9, 1e-12, 1e-15])
def test_a_cable_that_hardly_leans_is_as_stiff_as_a_vertical_one(lean):
    """Held at a tension; a span that was raised to 1e-9 of the chord gave wrong stiffness below."""
    arrays, model = RobotArrays.of(ROBOT), cable_model("sagging")
    points, tension = np.array(ROBOT.frame_anchors) - 3.0 * UP, np.full(8, 300.0)
    upright = cable_stiffness(model.hold(arrays, points, tension).states)
    leaning = cable_stiffness(model.hold(arrays, points + 3.0 * lean * np.array([0.6, 0.8, 0.0]), tension).states)
    # a span of 1e-15 m is a few roundings of the anchors: its direction is lost, its pull over its span is not
    for axis in range(3):
        assert leaning[:, axis, axis] == pytest.approx(upright[:, axis, axis], rel=1e-5)


def test_states_name_what_others_read():
    arrays = RobotArrays.of(ROBOT)
    points, length = points_and_lengths(8, 5, arrays, 0.0)
    states = cable_model("sagging").states(arrays, points, 0.999 * length)
    assert states.chord == pytest.approx(np.linalg.norm(points - ROBOT.frame_anchors, axis=-1))
    assert (states.inclination < 0.0).all()  # suspended: the platform hangs below
    assert states.tension == pytest.approx(states.force_x * states.chord / states.span)
    balance = -states.force_on_platform - states.force_at_frame - (states.weight * states.length)[..., None] * UP
    assert np.abs(balance).max() < 1e-10
    assert (states.tension_at_frame > states.tension_at_platform).all()
    assert states.sag == pytest.approx(states.weight * states.chord * states.span / (8 * states.tension), rel=0.05)
    assert (states.elongation > 0.0).all()
    assert not states.slack.any()


def test_a_long_spring_is_slack_and_pulls_nothing():
    arrays = RobotArrays.of(ROBOT)
    points, length = points_and_lengths(9, 2, arrays, 0.0)
    states = cable_model("spring").states(arrays, points, 1.01 * length)
    assert states.slack.all()
    assert np.abs(states.force_on_platform).max() == 0.0
    assert np.abs(cable_stiffness(states)).max() == 0.0
    assert (states.tension == 0.0).all()
    assert np.isnan(states.sag).all()


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 10_000), radius=st.floats(0.01, 0.5))
def test_straight_exit_is_tangent_and_its_length_grows_along_the_cable(seed, radius):
    """The free piece leaves along the tangent, and moving the far end by d takes t . d of cable.

    Points are at least two radii from the swivel axis: nearer, the cable would wrap by more than half a turn, of which
    an exit direction does not tell the side.
    """
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3) + 3.0 * UP
    axis /= np.linalg.norm(axis)
    offset = rng.uniform(-5.0, 5.0, 3) + np.array([8.0, 0.0, 0.0])
    assume(np.linalg.norm(offset - (offset @ axis) * axis) > 2.0 * radius + 1e-3)

    def path(where: np.ndarray) -> tuple[float, np.ndarray]:
        t = straight_exit(where, axis, np.array(radius))
        leave = pulley_exit(t, axis, np.array(radius))
        free = where - leave.point
        assert np.linalg.norm(np.cross(free, t)) < 1e-12 * 15.0
        assert free @ t > 0.0
        return float(np.linalg.norm(free) + radius * leave.wrap_angle), t

    step = rng.normal(size=3) * 1e-5
    change = path(offset + step)[0] - path(offset - step)[0]
    assert change == pytest.approx(2.0 * step @ path(offset)[1], abs=1e-13)


def test_a_vanishing_pulley_is_a_fixed_point():
    fixed, tiny = RobotArrays.of(ROBOT), arrays_with_pulleys(1e-9)
    points, length = points_and_lengths(10, 5, fixed, 0.01)
    one, other = (cable_model("sagging").states(a, points, length).force_on_platform for a in (fixed, tiny))
    assert np.abs(one - other).max() < 1e-4


def test_unknown_model_is_refused():
    with pytest.raises(ValueError, match="model must be one of sagging, spring, ideal, got 'wire'"):
        cable_model("wire")
