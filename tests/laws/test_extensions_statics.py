"""Extensions of a robot in statics: what goes out comes back, and the tangent is the derivative of the wrench."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.robot.extensions import Extensions, masts_of
from cdpr_struct.robot.parameters import EXTENSIONS
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, load_wrench, rotation_from_vector
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.static_stiffness import static_stiffness

SHIFT = np.array([0.5, -0.4, 0.2])  # m from the home pose
ALL = {
    "series_compliance": 1e-5, "frame_compliance": 1e-5, "hose": 20.0, "hose_center": [0.1, 0.0, 1.0],
    "force": [5.0, -3.0, 4.0], "tilt": [0.01, -0.01], "nonlinearity": 0.1, "reference_tension": 200.0,
    "length_offset": 0.003, "length_scale": 1.001, "moment": [3.0, -2.0, 4.0], "temperature_change": 20.0,
}  # fmt: skip
ONE_MAST = {"cogiro": [0.0, 0.0, 5e-5, 5e-5, 0, 0, 0, 0], "thesis-3-1": [5e-5, 0.0, 0, 0, 5e-5, 0, 0, 0]}
SOFT = [(name, {"frame_compliance": give}) for name, give in ONE_MAST.items()]
ALONE = [
    {"series_compliance": 5e-5},
    {"frame_compliance": 5e-5},
    {"mast_bending": 5e-5, "mast_foot": -1.0},
    {"hose": 200.0, "hose_center": [0.3, 0.0, 1.0]},
    {"force": [10.0, 5.0, -3.0]},
    {"tilt": [0.02, -0.01]},
    {"nonlinearity": 0.2, "reference_tension": 300.0},
    {"length_offset": 0.01, "length_scale": 1.002},
    {"moment": [6.0, -4.0, 9.0]},
    {"drag_area": 1.3, "wind": [6.0, -5.0, 1.0]},
    {"temperature_change": 40.0},
    {"drag_width": 0.012, "wind": [12.0, -7.0, 2.0]},
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
@pytest.mark.parametrize(
    "robot",
    [*(("thesis-3-1", g) for g in (*ALONE[:5], {"moment": [60.0, -40.0, 90.0]})), *SOFT],
    ids=lambda r: f"{r[0]}, {next(iter(r[1]))}",
)
def test_stiffness_is_the_derivative_of_the_wrench(robot, model):
    robot = extended(*robot)
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
    turned = np.zeros((6, 6))  # symmetric but for what a constant moment leaves
    turned[3:, 3:] = -np.cross(np.eye(3), robot.extensions.moment)
    np.testing.assert_allclose(matrix - matrix.T, turned, atol=1e-9 * np.abs(matrix).max())


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


def test_uprights_bend_as_cantilevers():
    """Sideways only, l^2 (3 h - l) / 2 H^3 of the compliance at the top, l and h the heights of force and exit."""
    give, foot = 3e-5, -1.0
    robot = extended("thesis-3-1", {"mast_bending": give, "mast_foot": foot})
    held = inverse(robot, robot.home.position + SHIFT, np.eye(3), "spring")
    points = robot.home.position + SHIFT + robot.platform_anchors
    moved = points - held.cables.offset - robot.frame_anchors
    height, pull = robot.frame_anchors[:, 2] - foot, held.cables.force_at_frame
    expected = np.zeros_like(moved)
    for i, j in zip(*np.nonzero(masts_of(robot.frame_anchors)), strict=True):
        low, high = sorted((height[i], height[j]))
        expected[i, :2] += give * low**2 * (3.0 * high - low) / (2.0 * height.max() ** 3) * pull[j, :2]
    np.testing.assert_allclose(moved, expected, atol=1e-13)
    assert np.ptp(np.abs(expected).max(axis=1)) > 1e-3  # two levels: the lower exits move less


@pytest.mark.parametrize("name", ONE_MAST)
def test_one_soft_mast_moves_alone(name):
    """Round trip of statics with rigid masts beside a soft one, and where these stand."""
    given = {"frame_compliance": ONE_MAST[name]}
    test_lengths_that_inverse_gives_lead_forward_to_the_pose(name, given, "sagging")
    robot = extended(name, given)
    held = inverse(robot, robot.home.position + SHIFT, np.eye(3))
    moved = robot.home.position + SHIFT + robot.platform_anchors - held.cables.offset - robot.frame_anchors
    soft = robot.extensions.frame_compliance > 0.0
    assert np.abs(moved[soft]).max() > 1e-3
    assert np.abs(moved[~soft]).max() < 1e-13


@pytest.mark.parametrize("name", ONE_MAST)
def test_equal_numbers_are_the_one_number(name):
    place = load_robot(name).home.position + SHIFT
    one, all_ = (extended(name, {"frame_compliance": give}) for give in (3e-5, [3e-5] * 8))
    first, second = (inverse(robot, place, np.eye(3)) for robot in (one, all_))
    np.testing.assert_array_equal(first.lengths, second.lengths)
    stiffness = [static_stiffness(r, place, np.eye(3), first.cables).matrix for r in (one, all_)]
    np.testing.assert_array_equal(*stiffness)


def test_a_batch_of_mast_compliances_is_each_of_them():
    """Rigid, one soft, all soft: inverse and forward kinematics and stiffness, one by one and together."""
    give = np.array([[0.0] * 8, ONE_MAST["cogiro"], [2e-5] * 8])
    robot = load_robot("cogiro")
    place = robot.home.position + SHIFT
    arrays = replace(RobotArrays.of(robot), frame_compliance=give)
    together = inverse(arrays, place, np.eye(3))
    alone = [inverse(replace(arrays, frame_compliance=g), place, np.eye(3)) for g in give]
    np.testing.assert_allclose(together.lengths, [a.lengths for a in alone], rtol=1e-12)
    matrices = [
        static_stiffness(replace(arrays, frame_compliance=g), place, np.eye(3), a.cables).matrix
        for g, a in zip(give, alone, strict=True)
    ]
    found = static_stiffness(arrays, place, np.eye(3), together.cables).matrix
    np.testing.assert_allclose(found, matrices, rtol=1e-9, atol=1e-6)
    back = forward(arrays, together.lengths, place + 0.01, np.eye(3))
    np.testing.assert_allclose(back.position, np.broadcast_to(place, (3, 3)), atol=1e-9)


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
    with pytest.raises(ValueError, match="series_compliance must be in m/N, not below 0"):
        Extensions.of(8, {"series_compliance": -1e-6})
    with pytest.raises(ValueError, match="length_scale must be in 1, above 0"):
        Extensions.of(8, {"length_scale": 0.0})
    with pytest.raises(ValueError, match=r"no extension is called 'mast'; known: .*frame_compliance"):
        Extensions.of(8, {"mast": 1.0})
    with pytest.raises(ValueError, match=r"tracker must have shape \(6,\)"):
        Extensions.of(8, {"tracker": [0.0, 0.0]})
    assert Extensions.of(3).active == ()
    assert set(Extensions.of(3, {"slip": 1.0}).entered) == {"slip"}
    assert set(EXTENSIONS) >= {"hose", "hose_center"}
