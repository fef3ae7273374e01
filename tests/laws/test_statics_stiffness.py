"""Static stiffness of the robot: symmetric at equilibrium, the derivative of the wrench, the inverse of the give."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.equilibrium import (
    PlatformArms,
    cable_geometric_stiffness,
    cable_wrench,
    rotation_from_vector,
    weight_wrench,
)
from cdpr_struct.statics.forward_kinematics import ForwardSolution, forward
from cdpr_struct.statics.pose_error import reference_lengths
from cdpr_struct.statics.static_stiffness import RobotStiffness, static_stiffness

BASE = load_robot("thesis-3-1")
OFFSET = replace(BASE, platform=replace(BASE.platform, center_of_mass=np.array([0.05, -0.03, -0.2])))
PULLEYS = replace(OFFSET, pulleys=tuple(Pulley(0.08, np.array([0.1 * (-1) ** i, 0.05, 1.0])) for i in range(8)))
ROBOTS = {"fixed": BASE, "offset centre": OFFSET, "pulleys": PULLEYS}
PLACES = st.tuples(st.floats(-2.5, 2.5), st.floats(-2.0, 2.0), st.floats(0.2, 1.2))
TURNS = st.tuples(*[st.floats(-0.15, 0.15)] * 3)


def settled(robot, place, turn, model, wrench=None) -> tuple[ForwardSolution, RobotStiffness, np.ndarray]:
    start = rotation_from_vector(np.array(turn))
    lengths = reference_lengths(robot, place, start)
    solution = forward(robot, lengths, place, start, model, wrench)
    stiffness = static_stiffness(robot, solution.position, solution.rotation, solution.cables)
    return solution, stiffness, lengths


def numeric_stiffness(robot, solution: ForwardSolution, lengths: np.ndarray, model: str, step: float) -> np.ndarray:
    """-d(wrench of cables and weight)/d(pose) by central differences, moments about the moving origin."""
    arrays = RobotArrays.of(robot)

    def wrench(twist: np.ndarray) -> np.ndarray:
        arms = PlatformArms.at(
            arrays, solution.position + twist[:3], rotation_from_vector(twist[3:]) @ solution.rotation
        )
        return cable_wrench(cable_model(model).states(arrays, arms.points, lengths), arms) + weight_wrench(arrays, arms)

    return -np.stack([(wrench(step * e) - wrench(-step * e)) / (2.0 * step) for e in np.eye(6)], axis=-1)


@settings(max_examples=20, deadline=None)
@given(
    name=st.sampled_from(list(ROBOTS)), place=PLACES, turn=TURNS, model=st.sampled_from(["sagging", "spring"]),
    load=st.tuples(*[st.floats(-20.0, 20.0)] * 6),
)  # fmt: skip
def test_stiffness_is_minus_the_derivative_of_the_wrench(name, place, turn, model, load):
    """Any pose, any load, with an applied moment too, where the stiffness is not symmetric."""
    solution, stiffness, lengths = settled(ROBOTS[name], place, turn, model, load)
    numeric = numeric_stiffness(ROBOTS[name], solution, lengths, model, 1e-6)
    size = np.abs(numeric).max()
    assert np.abs(numeric - stiffness.matrix).max() < 1e-6 * size  # measured 2e-9; a slackening spring costs digits
    arms = PlatformArms.at(RobotArrays.of(ROBOTS[name]), solution.position, solution.rotation)
    without = stiffness.matrix.copy()  # twin: eq. (3.8) as printed lacks the geometric term of the lever arms
    without[3:, 3:] -= cable_geometric_stiffness(solution.cables, arms)
    assert np.abs(numeric - without).max() > 1e-4 * size


@settings(max_examples=20, deadline=None)
@given(place=PLACES, turn=TURNS, name=st.sampled_from(list(ROBOTS)))
def test_stiffness_is_symmetric_at_rest(place, turn, name):
    _, stiffness, _ = settled(ROBOTS[name], place, turn, "sagging")
    skew = np.abs(stiffness.matrix - stiffness.matrix.T).max()
    tolerance = 1e-6 if name == "pulleys" else 1e-9  # the weight of the cable on the wheel is left out
    assert skew < tolerance * np.abs(stiffness.matrix).max()
    pushed, under_moment, _ = settled(ROBOTS[name], place, turn, "sagging", [0, 0, 0, 8.0, 0, 0])
    assert pushed.stable
    assert under_moment.matrix[4, 5] - under_moment.matrix[5, 4] == pytest.approx(8.0, rel=1e-3)  # twin: not symmetric
    assert np.abs(under_moment.symmetric - under_moment.symmetric.T).max() == 0.0


@pytest.mark.parametrize("name", list(ROBOTS))
@pytest.mark.parametrize("model", ["sagging", "spring"])
def test_compliance_is_the_derivative_of_the_pose_with_the_load(name, model):
    """Central differences of the forward kinematics itself."""
    robot = ROBOTS[name]
    solution, stiffness, lengths = settled(robot, (1.0, 0.7, 0.5), (0.0, 0.0, 0.05), model)
    step = np.diag([0.05, 0.05, 0.05, 0.01, 0.01, 0.01])
    loads = np.stack([step, -step])
    moved = forward(robot, lengths, solution.position, solution.rotation, model, loads)
    turn = moved.rotation[0] @ np.swapaxes(moved.rotation[1], -1, -2)
    vector = 0.5 * np.stack(
        [turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]], -1
    )
    change = np.concatenate([moved.position[0] - moved.position[1], vector], axis=-1)
    numeric = (change / (2.0 * np.diag(step)[:, None])).T
    assert np.abs(numeric - stiffness.compliance).max() < 1e-4 * np.abs(stiffness.compliance).max()
    softer = replace(robot, cables=tuple(replace(c, axial_stiffness=0.98 * c.axial_stiffness) for c in robot.cables))
    _, twin, _ = settled(softer, (1.0, 0.7, 0.5), (0.0, 0.0, 0.05), model)
    assert np.abs(numeric - twin.compliance).max() > 1e-3 * np.abs(numeric).max()


def test_compliance_parts_add_up_and_have_their_causes():
    light, heavy = (settled(BASE.with_load(mass=m), (0.5, 0.3, 0.5), (0, 0, 0), "sagging")[1] for m in (10.0, 200.0))
    for stiffness in (light, heavy):
        total = stiffness.axial + stiffness.sag + stiffness.geometric
        assert np.abs(total - stiffness.compliance).max() < 1e-12 * np.abs(stiffness.compliance).max()
        for part in (stiffness.axial, stiffness.sag):
            assert np.linalg.eigvalsh(0.5 * (part + part.T)).min() > -1e-12
    assert light.sag[2, 2] > 5.0 * light.axial[2, 2]  # light platform: sag gives way
    assert heavy.sag[2, 2] < 0.2 * heavy.axial[2, 2]  # heavy platform: elasticity does


def test_platform_axes_turn_the_matrix_back():
    solution, stiffness, _ = settled(BASE, (0.5, 0.3, 0.5), (0.1, -0.05, 0.3), "sagging")
    turn = np.kron(np.eye(2), solution.rotation)
    assert (
        np.abs(turn @ stiffness.in_platform @ turn.T - stiffness.matrix).max() < 1e-9 * np.abs(stiffness.matrix).max()
    )
    whole = replace(BASE, frame_anchors=BASE.frame_anchors @ rotation_from_vector(np.array([0, 0, 0.7])).T)
    spin = rotation_from_vector(np.array([0, 0, 0.7]))
    other = settled(whole, spin @ np.array([0.5, 0.3, 0.5]), (0.0, 0.0, 0.7), "sagging")[1]
    plain = settled(BASE, (0.5, 0.3, 0.5), (0.0, 0.0, 0.0), "sagging")[1]
    assert np.abs(other.in_platform - plain.in_platform).max() < 1e-7 * np.abs(plain.matrix).max()


def test_stability_is_the_sign_of_the_tangent():
    """What forward kinematics calls stable has a positive definite stiffness, and small pushes come back."""
    solution, stiffness, _ = settled(OFFSET, (0.5, 0.3, 0.5), (0, 0, 0), "sagging")
    assert solution.stable
    assert np.linalg.eigvalsh(stiffness.symmetric).min() > 0.0
    unit = np.array([1, 1, 1, *[np.sqrt((OFFSET.platform_anchors**2).sum(1).mean())] * 3])
    least = np.linalg.eigvalsh(stiffness.symmetric / unit / unit[:, None]).min()
    assert solution.least_stiffness == pytest.approx(least, rel=1e-6)
