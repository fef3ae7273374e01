"""Along and about which axes the platform moves: shares of its energy, and their words."""

import dataclasses
import io

import numpy as np
import pandas as pd
import pytest

import cdpr_struct as cs
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.platform_directions import direction_shares
from cdpr_struct.dynamics.robot_dynamic_stiffness import attachment, platform_mass_matrix
from cdpr_struct.reports.mode_words import STILL, motion_words
from cdpr_struct.robot.pose import Pose


@pytest.fixture(scope="module")
def tilted(thesis_point) -> OperatingPoint:
    """The thesis's robot with its centre of mass off the origin, turned by odd angles."""
    robot = thesis_point.robot
    body = dataclasses.replace(robot.platform, center_of_mass=np.array([0.1, -0.2, 0.3]))
    turned = Pose(np.zeros(3), np.radians([10.0, -20.0, 30.0])).rotation
    return OperatingPoint(dataclasses.replace(robot, platform=body), thesis_point.position, turned, thesis_point.cables)


def test_a_motion_about_an_axis_through_the_centre_of_mass_is_about_it_alone(tilted):
    center = tilted.rotation @ tilted.arrays.center_of_mass
    for axis in range(3):
        turn = np.eye(3)[axis]
        shares = direction_shares(tilted, np.r_[np.cross(center, turn), turn][None])[0]
        np.testing.assert_allclose(shares, np.eye(6)[3 + axis], atol=1e-14)
        shares = direction_shares(tilted, np.eye(6)[[axis]])[0]
        np.testing.assert_allclose(shares, np.eye(6)[axis], atol=1e-14)


def test_shares_times_the_energy_of_the_mass_matrix_are_those_of_the_momentum(tilted):
    """Translations m v_i^2 of the centre of mass; all six together are the energy of the whole."""
    motion = np.random.default_rng(3).normal(size=(5, 6))
    shares = direction_shares(tilted, motion)
    np.testing.assert_allclose(shares.sum(axis=1), 1.0, rtol=1e-13)
    matrix = platform_mass_matrix(tilted.arrays, tilted.rotation)
    energy = np.einsum("ki,ij,kj->k", motion, matrix, motion)
    center = tilted.rotation @ tilted.arrays.center_of_mass
    speed = motion[:, :3] + np.cross(motion[:, 3:], center)
    np.testing.assert_allclose(shares[:, :3] * energy[:, None], tilted.arrays.mass * speed**2, rtol=1e-12)


def test_a_platform_at_rest_has_no_direction(tilted):
    assert (direction_shares(tilted, np.zeros((1, 6))) == 0.0).all()


@pytest.mark.parametrize(
    ("energy", "shares", "words"),
    [
        (0.9, [0.05, 0.0, 0.95, 0.0, 0.0, 0.0], "along z"),
        (0.02, [0.4, 0.0, 0.0, 0.0, 0.6, 0.0], "about y and along x"),
        (0.5, [0.4, 0.0, 0.0, 0.3, 0.3, 0.0], "along x and about x"),
        (0.5, [0.3, 0.0, 0.25, 0.2, 0.15, 0.1], "along x, along z and about x"),
        (0.009, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], STILL),
    ],
)
def test_words_name_the_directions_with_most_of_the_energy(energy, shares, words):
    assert motion_words(np.array([energy]), np.array([shares])) == [words]


def test_modes_say_how_the_platform_moves_in_text_json_and_table():
    found = cs.modes("cogiro", count=22)
    told = found.to_json()
    table = pd.read_csv(io.StringIO(str(found.files()["platform_motion.csv"])))
    assert told["motion_words"][0] == table["platform_motion"][0] == "along z"
    assert "about x" in str(found).splitlines()[20]
    assert np.shape(told["motion"]) == np.shape(told["platform_directions"]) == (22, 6)
    np.testing.assert_allclose(table["share_z"], [row[2] for row in told["platform_directions"]], rtol=1e-6, atol=1e-9)
    ends = np.einsum("mab,kb->kma", attachment(found.point), told["motion"])
    np.testing.assert_allclose(found.motion.cables[:, :, -1], ends, atol=1e-12)
    largest = np.abs(found.motion.cables).reshape(22, -1).max(axis=1)
    assert np.maximum(largest, np.abs(told["motion"]).max(axis=1)) == pytest.approx(np.ones(22), rel=1e-12)
    np.testing.assert_allclose(table["rx_rad"], [row[3] for row in told["motion"]], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(np.sum(told["cable_energy"], axis=1) + told["platform_energy"], 1.0, rtol=1e-9)
