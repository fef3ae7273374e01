"""The pose at locked lengths against the finite-element referee, which shares no formula with the catenary."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.pose_error import reference_lengths

ELEMENTS = (16, 32, 64, 128)
ROBOTS = ("thesis-3-1", "thesis-3-1-8mm", "six-cable-4mm", "six-cable-8mm", "cogiro", "thesis-5")
LOADS = (15.0, 40.0, 86.0)  # kg
TOLERANCE = 1e-6  # m, of the issue; measured: 5e-9 m and less
SPREAD = np.array([3.0, 3.0, 0.4])  # m about the home pose


def reference_positions(name: str, count: int) -> np.ndarray:
    """Positions that ideal cables hold; the same ones on every run."""
    robot = load_robot(name)
    drawn = robot.home.position + SPREAD * np.random.default_rng(7).uniform(-1.0, 1.0, (40 * count, 3))
    held = inverse(robot, drawn, np.eye(3), model="ideal", allow_unheld=True).held
    assert held.sum() >= count
    return drawn[held][:count]


def referee_position(robot, lengths, start) -> tuple[np.ndarray, float]:
    """Limit of ever finer meshes (3,) [m] and how sure it is [m]; the FEM starts from the reference pose."""
    data = to_fem(robot, lengths)
    meshes = [fem.solve_robot(data, start, np.eye(3), count).position for count in ELEMENTS]
    limit = fem.extrapolate(ELEMENTS, np.array(meshes))
    return limit.limit, float(limit.error_estimate.max())


def deviations(name: str, positions: np.ndarray, loads, stiffening: float = 1.0) -> np.ndarray:
    """Distance [m] of our pose from the referee's for each position and load; EA of ours times `stiffening`."""
    found = []
    for load in loads:
        robot = load_robot(name).with_load(mass=load)
        arrays = RobotArrays.of(robot)
        lengths = reference_lengths(arrays, positions, np.eye(3))
        model = replace(arrays, axial_stiffness=stiffening * arrays.axial_stiffness)
        ours = forward(model, lengths, positions, np.eye(3))
        assert ours.stable.all()
        for place, length, mine in zip(positions, lengths, ours.position, strict=True):
            limit, uncertainty = referee_position(robot, length, place)
            assert uncertainty < 0.1 * TOLERANCE
            found.append(np.linalg.norm(mine - limit))
    return np.array(found)


@pytest.mark.parametrize("name", ROBOTS)
def test_pose_error_agrees_with_the_referee(name):
    assert deviations(name, reference_positions(name, 2), LOADS[:1]).max() < TOLERANCE


@pytest.mark.slow
@pytest.mark.parametrize("name", ROBOTS)
def test_pose_error_agrees_with_the_referee_at_ten_poses_and_three_loads(name):
    assert deviations(name, reference_positions(name, 10), LOADS).max() < TOLERANCE


@pytest.mark.parametrize("name", ROBOTS)
def test_a_wrong_model_is_found_out(name):
    """EA off by 2 %: the referee must disagree at every pose."""
    assert deviations(name, reference_positions(name, 2), LOADS[1:2], stiffening=1.02).min() > TOLERANCE


def test_rotation_agrees_with_the_referee():
    """A pose off the plane of symmetry, where sag and stretch also turn the platform."""
    robot = load_robot("cogiro").with_load(mass=40.0)
    place = np.array([1.5, -1.0, 1.0])
    lengths = reference_lengths(robot, place, np.eye(3))
    ours = forward(robot, lengths, place, np.eye(3))
    meshes = [fem.solve_robot(to_fem(robot, lengths), place, np.eye(3), n).rotation for n in ELEMENTS]
    assert np.abs(fem.extrapolate(ELEMENTS, np.array(meshes)).limit - ours.rotation).max() < 1e-7
    assert np.abs(ours.rotation - np.eye(3)).max() > 1e-4
