"""Extensions of a robot in statics: what goes out comes back, and the tangent is the derivative of the wrench."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.robot.extensions import KEYS, Extensions, masts_of
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, load_wrench, rotation_from_vector
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.robot_arrays import RobotArrays
from cdpr_struct.statics.static_stiffness import static_stiffness

SHIFT = np.array([0.5, -0.4, 0.2])  # m from the home pose
ALL = {
    "series_compliance": 1e-5, "frame_compliance": 1e-5, "hose": 20.0, "hose_center": [0.1, 0.0, 1.0],
    "force": [5.0, -3.0, 4.0], "tilt": [0.01, -0.01], "nonlinearity": 0.1, "reference_tension": 200.0,
    "length_offset": 0.003, "length_scale": 1.001,
}  # fmt: skip
ALONE = [
    {"series_compliance": 5e-5},
    {"frame_compliance": 5e-5},
    {"hose": 200.0, "hose_center": [0.3, 0.0, 1.0]},
    {"force": [10.0, 5.0, -3.0]},
    {"tilt": [0.02, -0.01]},
    {"nonlinearity": 0.2, "reference_tension": 300.0},
    {"length_offset": 0.01, "length_scale": 1.002},
    ALL,
]


def extended(name: str, given: dict) -> Robot:
    robot = load_robot(name)
    return replace(robot, extensions=Extensions.of(len(robot.cables), given))


@pytest.mark.parametrize("model", ["sagging", "spring"])
@pytest.mark.parametrize("given", ALONE, ids=lambda g: "all" if g is ALL else next(iter(g)))
@pytest.mark.parametrize("name", ["cogiro", "thesis-3-1"])
def test_lengths_that_inverse_gives_lead_forward_to_the_pose(name, given, model):
    robot = extended(name, given)
    place = robot.home.position + SHIFT
    held = inverse(robot, place, np.eye(3), model)
    found = forward(robot, held.lengths, place + np.array([0.02, 0.01, -0.02]), np.eye(3), model)
    assert found.stable
    np.testing.assert_allclose(found.position, place, atol=1e-10)  # measured: below 2e-12
    np.testing.assert_allclose(found.tensions, held.tensions, rtol=1e-8)


@pytest.mark.parametrize("given", ALONE[:-1], ids=lambda g: next(iter(g)))
def test_every_extension_changes_lengths_or_tensions(given):
    """Twin: the round trip above would also hold for extensions that do nothing."""
    place = load_robot("cogiro").home.position + SHIFT
    bare, with_it = (inverse(extended("cogiro", g), place, np.eye(3)) for g in ({}, given))
    moved = np.abs(with_it.lengths - bare.lengths).max() + 1e-3 * np.abs(with_it.tensions - bare.tensions).max()
    assert moved > 1e-4


@pytest.mark.parametrize("model", ["sagging", "spring"])
@pytest.mark.parametrize("given", ALONE[:5], ids=lambda g: next(iter(g)))
def test_stiffness_is_the_derivative_of_the_wrench(given, model):
    robot = extended("thesis-3-1", given)
    place = robot.home.position + SHIFT
    arrays, held = RobotArrays.of(robot), inverse(robot, place, np.eye(3), model)
    matrix = static_stiffness(robot, place, np.eye(3), held.cables).matrix

    def wrench(motion: np.ndarray) -> np.ndarray:
        arms = PlatformArms.at(arrays, place + motion[:3], rotation_from_vector(motion[3:]))
        states = cable_model(model).states(arrays, arms.points, arrays.paid_out(held.lengths))
        return cable_wrench(states, arms) + load_wrench(arrays, arms)

    steps = 1e-6 * np.eye(6)
    differences = np.array([wrench(-step) - wrench(step) for step in steps]).T / 2e-6
    np.testing.assert_allclose(matrix, differences, atol=2e-8 * np.abs(matrix).max())  # measured: 3e-9
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-9 * np.abs(matrix).max())


def test_an_element_in_line_takes_its_stretch_off_the_length():
    """Straight spring cables: distance = c T + L (1 + T / EA), whatever the free length."""
    give = 4e-5
    robot = extended("thesis-3-1", {"series_compliance": give})
    held = inverse(robot, robot.home.position + SHIFT, np.eye(3), "spring")
    tension = held.tensions
    reach = give * tension + held.lengths * (1.0 + tension / robot.axial_stiffness)
    np.testing.assert_allclose(reach, held.cables.chord, rtol=1e-13)


def test_cables_of_one_mast_share_its_compliance():
    """Each mast of the spring model moves by c times the pull of both its cables."""
    give = 3e-5
    robot = extended("cogiro", {"frame_compliance": give})
    held = inverse(robot, robot.home.position + SHIFT, np.eye(3), "spring")
    points = robot.home.position + SHIFT + robot.platform_anchors
    moved = points - held.cables.offset - robot.frame_anchors
    together = masts_of(robot.frame_anchors) > 0.0
    assert (together.sum(axis=1) == 2).all()
    np.testing.assert_allclose(moved, give * (together @ held.cables.force_at_frame), atol=1e-13)


def test_modulus_is_that_at_the_tension():
    robot = extended("thesis-3-1", {"nonlinearity": 0.3, "reference_tension": 150.0})
    held = inverse(robot, robot.home.position + SHIFT, np.eye(3), "spring")
    stiff = robot.axial_stiffness * (1.0 + 0.3 * (held.tensions / 150.0 - 1.0))
    np.testing.assert_allclose(held.lengths * (1.0 + held.tensions / stiff), held.cables.chord, rtol=1e-12)


def test_ideal_cables_know_nothing_elastic():
    place = load_robot("cogiro").home.position + SHIFT
    bare, soft = (
        inverse(extended("cogiro", g), place, np.eye(3), "ideal")
        for g in ({}, {"series_compliance": 1e-4, "frame_compliance": 1e-4})
    )
    np.testing.assert_array_equal(bare.lengths, soft.lengths)


def test_values_are_checked_at_birth():
    with pytest.raises(ValueError, match="series_compliance must be >= 0 m/N"):
        Extensions.of(8, {"series_compliance": -1e-6})
    with pytest.raises(ValueError, match="length_scale must be > 0"):
        Extensions.of(8, {"length_scale": 0.0})
    with pytest.raises(ValueError, match=r"no extension is called 'mast'; known: .*frame_compliance"):
        Extensions.of(8, {"mast": 1.0})
    with pytest.raises(ValueError, match=r"tracker must have shape \(6,\)"):
        Extensions.of(8, {"tracker": [0.0, 0.0]})
    assert Extensions.of(3).active == ()
    assert set(Extensions.of(3, {"slip": 1.0}).entered) == {"slip"}
    assert set(KEYS) >= {"hose", "hose_center"}
