"""A payload that swings below the platform against the referee, whose bob hangs on a bar element of its own."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.fem_reference.eigen_solver import frequencies_hz, lowest_eigenpairs
from cdpr_struct.fem_reference.pendulum import PendulumData, with_pendulum
from cdpr_struct.fem_reference.rigid_platform import platform_mass_matrix, point_motion
from cdpr_struct.fem_reference.robot_modes import robot_matrices
from cdpr_struct.generated.platform import rotation
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse
from tests.crosscheck.test_flexible_platform_fem import MODES as MANY
from tests.crosscheck.test_flexible_platform_fem import SHARE, written

MASS, LENGTH, HOOK = 20.0, 0.4, np.array([0.15, -0.1, -0.3])  # kg, m: 0.79 Hz, below the platform's modes
ELEMENTS, MODES = (20, 40), 16
AGREED = 1e-5  # relative, of the extrapolated FEM


def point(mass: float = MASS, length: float = LENGTH, hook: np.ndarray = HOOK) -> OperatingPoint:
    robot, turn = load_robot("cogiro"), rotation(0.08, -0.05, 0.12)
    body = replace(robot.platform, mass=robot.platform.mass - MASS).with_masses_at(np.array([MASS]), HOOK[None])
    hertz = np.sqrt(robot.gravity / length) / (2.0 * np.pi)
    given = {"swinging_mass": mass, "swinging_frequency": hertz, "swinging_place": hook}
    robot = replace(robot, platform=body, extensions=Extensions.of(8, given))
    place = robot.home.position + np.array([0.6, -0.4, 0.3])
    return OperatingPoint(robot, place, turn, inverse(robot, place, turn).cables)


def in_fem() -> np.ndarray:
    """First frequencies [Hz] of the referee with the bob on its bar, extrapolated with order two."""
    found, hung = [], PendulumData(MASS, LENGTH, HOOK)
    for elements in ELEMENTS:
        rest = solve_in_fem(point(), elements)
        matrices = with_pendulum(*robot_matrices(rest), rest.rotation, np.array([0.0, 0.0, -9.81]), hung)
        found.append(frequencies_hz(lowest_eigenpairs(*matrices, MODES, -1.0)[0]))
    return found[1] + (found[1] - found[0]) / 3.0


@pytest.fixture(scope="module")
def referee() -> np.ndarray:
    return in_fem()


def test_modes_are_the_referees(referee):
    found = certified_modes(point(), "exact", MODES)
    assert found.frequencies.certified
    np.testing.assert_allclose(found.frequencies.hertz, referee, rtol=AGREED)


@pytest.mark.parametrize(
    "wrong", [{"mass": 0.98 * MASS}, {"length": 1.02 * LENGTH}, {"hook": HOOK + np.array([0, 0, 0.02])}]
)
def test_another_pendulum_is_seen(referee, wrong):
    """The twins that must fail: 2 % of mass or length, 2 cm of the hook's height."""
    with pytest.raises(AssertionError):
        np.testing.assert_allclose(
            certified_modes(point(**wrong), "exact", MODES).frequencies.hertz, referee, rtol=AGREED
        )


BOB, SLOW, BELOW = 30.0, 0.9, np.array([0.1, 0.0, -0.15])  # kg of 118.5, Hz, m: the payload of the campaigns below


def swinging_peaks(lowest):
    """Peaks [Hz] of the platform in the FEM with a bob on a bar, from a lowest one on, and the bob's own."""

    def peaks_of(rest, mass, hertz):
        hung = PendulumData(mass, 9.81 / (2.0 * np.pi * hertz) ** 2, BELOW)
        matrices = with_pendulum(*robot_matrices(rest), rest.rotation, np.array([0.0, 0.0, -9.81]), hung)
        values, vectors = lowest_eigenpairs(*matrices, MANY, -1.0)
        hook = point_motion(rest.rotation @ BELOW)
        rigid = platform_mass_matrix(rest.robot.platform, rest.rotation) - mass * hook.T @ hook
        body, bob, found = vectors[-9:-3], vectors[-3:], frequencies_hz(values)
        energy = np.einsum("ak,ab,bk->k", body, rigid, body) + mass * (bob**2).sum(axis=0)
        return found[(energy > SHARE) & (found > lowest)], float(found[(bob**2).sum(axis=0).argmax()])

    return peaks_of


@pytest.mark.slow
@pytest.mark.parametrize(("lowest", "seed"), [(0.0, 3), (1.5, 5)])
def test_a_payload_that_swings_is_named_whether_its_own_peaks_were_picked_or_not(tmp_path, lowest, seed):
    campaign, _ = written(tmp_path, seed=seed, mass=BOB, hertz=SLOW, peaks_of=swinging_peaks(lowest))
    said = diagnosed(campaign)
    assert said.decision.classes == (("swinging_payload",),)
    mass = said.sizes[0].parameters["swinging_mass"]
    assert abs(mass["value"] - BOB) < 3.0 * mass["sigma"] < BOB
