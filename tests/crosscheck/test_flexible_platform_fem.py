"""A mode inside the platform, in the FEM: a mass on a spring, of which the robot that is entered knows nothing."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.sparse import block_array, csc_array

from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.fem_reference.eigen_solver import frequencies_hz, lowest_eigenpairs
from cdpr_struct.fem_reference.rigid_platform import platform_mass_matrix, point_motion
from cdpr_struct.fem_reference.robot_modes import robot_matrices
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.reports.diagnose.sentences import sentence
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.statics.inverse_kinematics import inverse

ROBOT = "cogiro"  # 118.5 kg; modes of its platform between 2.4 and 7.3 Hz, which move with the pose
POSES = np.array([[0.76, 0.29, 1.22], [2.24, 1.38, 1.62], [-2.67, 1.16, 2.02], [1.8, -1.56, 2.22]])
ARM, ALONG = np.array([0.10, 0.05, 0.10]), np.array([0.0, 0.6, 0.8])  # m, -: where the mass sits, how it moves
ELEMENTS, MODES, SHARE = 20, 110, 0.3
NOISE = {"tension": 2.0, "position": 3e-4, "length": 1e-4, "hertz": 0.002}
CAMPAIGN = f"""robot = "{ROBOT}"
model = "dsm"
[checked]  # of what moves modes only the body is left as a rival, which takes half the time
axial_stiffness = 0.02
joint_compliance = 5e-8
dead_length = 0.05
frame_compliance = 1e-8
cable_linear_density = 0.01
[[measurement]]
kind = "static_state"
file = "states.csv"
sigma = {{ tension_N = 2.0, position_m = 0.0003, rotation_deg = 0.01, length_m = 0.0001 }}
[[measurement]]
kind = "robot_frequency"
file = "peaks.csv"
"""


def peaks_of(rest, mass, hertz):
    """Frequencies [Hz] whose motion is the platform's, and of the one that is mostly the mass's, in the FEM.

    The mass [kg], part of the platform's, moves along `ALONG` on a spring, with the platform held at `hertz`.
    """
    stiffness, inertia = robot_matrices(rest)
    held = platform_mass_matrix(rest.robot.platform, rest.rotation)
    coupled = np.zeros((stiffness.shape[0], 1))
    coupled[-6:, 0] = mass * point_motion(rest.rotation @ ARM).T @ (rest.rotation @ ALONG)
    if mass:
        spring = csc_array([[mass * (2.0 * np.pi * hertz) ** 2]])
        stiffness = csc_array(block_array([[stiffness, None], [None, spring]]))
        inertia = csc_array(block_array([[inertia, csc_array(coupled)], [csc_array(coupled.T), csc_array([[mass]])]]))
        held = np.block([[held, coupled[-6:]], [coupled[-6:].T, np.array([[mass]])]])
    values, vectors = lowest_eigenpairs(stiffness, inertia, MODES, -1.0)
    body, found = vectors[-len(held) :], frequencies_hz(values)
    seen = np.einsum("ak,ab,bk->k", body, held, body) > SHARE
    inner = float(found[(body[-1] ** 2).argmax()]) if mass else np.nan
    return found[seen], inner


def built(generator, inertia):
    """The robot as it was built, off by its tolerances, and with a factor of its inertia (3, 3)."""
    robot, draw = load_robot(ROBOT), generator.normal
    body = replace(
        robot.platform,
        mass=robot.platform.mass + 0.1 * draw(),
        center_of_mass=2e-3 * draw(size=3),
        inertia=inertia * robot.platform.inertia * np.exp(0.03 * draw()),
    )
    cables = tuple(
        replace(
            cable,
            axial_stiffness=cable.axial_stiffness * np.exp(0.02 * draw()),
            linear_density=cable.linear_density * np.exp(0.007 * draw()),
        )
        for cable in robot.cables
    )
    shift = 1e-3 * draw(size=(2, len(cables), 3))
    return replace(
        robot, platform=body, cables=cables, frame_anchors=robot.frame_anchors + shift[0],
        platform_anchors=robot.platform_anchors + shift[1],
    )  # fmt: skip


def written(folder, seed, mass=0.0, hertz=0.0, inertia=1.0, missed=(), peaks_of=peaks_of):
    """Campaign of the FEM's states and peaks with noise, and the internal mode's true frequency at each pose.

    missed : poses at which the peak of the mass was not picked
    peaks_of : frequencies of a state with such a mass, and that of the mass
    """
    generator = np.random.default_rng(seed)
    robot, states, peaks, inner = built(generator, inertia), [], [], []
    for number, pose in enumerate(POSES):
        held = inverse(robot, pose, np.eye(3))
        rest = solve_in_fem(OperatingPoint(robot, pose, np.eye(3), held.cables), ELEMENTS)
        found, own = peaks_of(rest, mass, hertz)
        found = found[found != own] if number in missed else found
        read = rest.position + NOISE["position"] * generator.normal(size=3)
        place = {"case": f"s{number}", **dict(zip(("x_m", "y_m", "z_m"), read, strict=True))}
        for i, cable in enumerate(rest.cables):
            tension = float(np.linalg.norm(cable.end_force)) + NOISE["tension"] * generator.normal()
            length = rest.robot.cables[i].unstrained_length + NOISE["length"] * generator.normal()
            states.append(place | {"cable": i + 1, "tension_N": tension, "length_m": length})
        noisy = found * (1.0 + NOISE["hertz"] * generator.normal(size=len(found)))
        peaks += [place | {"frequency_hz": f} for f in noisy]
        inner.append(own)
    pd.DataFrame(states).to_csv(folder / "states.csv", index=False)
    pd.DataFrame(peaks).to_csv(folder / "peaks.csv", index=False)
    (folder / "campaign.toml").write_text(CAMPAIGN)
    return load_campaign(folder / "campaign.toml"), np.array(inner)


@pytest.mark.slow
def test_a_light_part_is_told_from_no_line_of_the_mains(tmp_path):
    """6 kg of 118.5 on a spring move no other mode enough: the peaks are spoken of, and nothing is named."""
    campaign, _ = written(tmp_path, seed=3, mass=6.0, hertz=7.8)
    said = diagnosed(campaign)
    assert said.decision.status != "named"
    assert "or a light part of the platform on an elastic mount" in sentence(said)


@pytest.mark.slow
def test_a_heavy_part_is_named_and_its_mode_is_in_the_extended_robot(tmp_path):
    """A quarter of the platform, off its origin and along no axis, which no robot file can say: so it is found too
    light, but its mode changes with the pose as the FEM's does."""
    campaign, inner = written(tmp_path, seed=6, mass=30.0, hertz=5.0)
    said = diagnosed(campaign)
    assert said.decision.classes == (("flexible_platform",),)
    (tmp_path / "extended.toml").write_text(robot_toml(said.extended, "extended"))
    robot = load_robot(tmp_path / "extended.toml")
    found = []
    for pose in POSES:
        point = OperatingPoint(robot, pose, np.eye(3), inverse(robot, pose, np.eye(3)).cables)
        modes = certified_modes(point, "exact", MODES)
        found.append(modes.frequencies.hertz[(modes.shapes.internal**2).sum(axis=1).argmax()])
    apart = np.log(found / inner)
    assert np.abs(apart).max() < 0.02
    assert np.ptp(apart) < 0.5 * np.ptp(np.log(inner))


@pytest.mark.slow
def test_a_rigid_platform_is_adequate(tmp_path):
    campaign, _ = written(tmp_path, seed=1)
    assert diagnosed(campaign).decision.status == "adequate"


@pytest.mark.slow
def test_peaks_of_a_wrong_inertia_are_called_so(tmp_path):
    """A body of 0.6 of the entered inertia about z."""
    about_z = np.sqrt([1.0, 1.0, 0.6])
    campaign, _ = written(tmp_path, seed=12, inertia=np.outer(about_z, about_z))
    assert diagnosed(campaign).decision.classes == (("platform_inertia",),)
