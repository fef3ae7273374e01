"""A suspended platform on three locked cables: computed eigenfrequencies against recordings made by others.

Twelve free motions of a small platform, tracked at 100 Hz for 10 s (IRMA-LAB, see the folder's licence). Pulleys and
inertia per unit mass are given; the cables are taken as stiff and light. The recordings stay outside the repository:
CDPR_EXTERNAL_DATA names the folder that holds them, and without it these tests are skipped.
"""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment
from scipy.spatial.transform import Rotation

from cdpr_struct.cli.main import run
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.pose_error import reference_lengths

DEFAULT = Path(__file__).parents[3] / "shared" / "external"
FOLDER = Path(os.environ.get("CDPR_EXTERNAL_DATA", DEFAULT)) / "irma_free_motion"
pytestmark = pytest.mark.skipif(not FOLDER.exists(), reason=f"no recordings in {FOLDER}")
PARTNER = 0.1  # a measured frequency farther off than this is another mode, or a weakly excited one


def vector(nested) -> np.ndarray:
    return np.array(nested, dtype=float).ravel()


def upright(axis: np.ndarray) -> np.ndarray:
    """Rotation that turns the recorded vertical into z."""
    sideways = np.cross(axis / np.linalg.norm(axis), [0.0, 0.0, 1.0])
    return Rotation.from_rotvec(sideways).as_matrix()


@pytest.fixture(scope="module")
def setup():
    config = json.loads((FOLDER / "Grab_prototype_33.json").read_text())
    return config, upright(vector(config["platform"]["gravity_axis"]))


def robot_file(config, turn, path, pulleys=True) -> Path:
    """The recorded robot as a robot file with 1 kg of platform mass."""
    body = config["platform"]
    lines = ['name = "three-cables"', "[platform]", "mass = 1.0"]
    lines += [f"center_of_mass = {vector(body['pos_PG_loc']).tolist()}", f"inertia = {body['inertia_mat_G_loc']}"]
    lines += ["[cable]", "axial_stiffness = 1e5", "linear_density = 1e-4"]
    for actuator in (a for a in config["actuator"] if a["active"]):
        pulley = actuator["pulley"]
        lines += ["[[cables]]", f"platform_anchor = {vector(actuator['winch']['pos_PA_loc']).tolist()}"]
        lines += [f"frame_anchor = {(turn @ vector(pulley['pos_OD_glob'])).tolist()}"]
        axis = (turn @ vector(pulley["vers_k"])).tolist()
        lines += [f"pulley = {{ radius = {pulley['radius']}, axis = {axis} }}"] * pulleys
    path.write_text("\n".join(lines))
    return path


def measured_frequencies(motion: np.ndarray, step: float = 0.01, rows: int = 300) -> np.ndarray:
    """Three frequencies [Hz] of a free motion (6, n): eigensystem realisation from one Hankel matrix."""
    signal = motion - motion.mean(axis=1, keepdims=True)
    signal /= signal.std(axis=1, keepdims=True)
    columns = signal.shape[1] - rows
    hankel = np.concatenate([signal[:, i : i + columns] for i in range(rows)])
    basis = np.linalg.svd(hankel, full_matrices=False)[0][:, :6]
    transition = np.linalg.lstsq(basis[:-6], basis[6:], rcond=None)[0]
    poles = np.log(np.linalg.eigvals(transition)) / step
    return np.sort(poles.imag[poles.imag > 0.0]) / (2.0 * np.pi)


def computed_frequencies(path, motion, turn, assembly, capsys) -> np.ndarray:
    """First three eigenfrequencies [Hz] at the lengths that the mean pose means, through the command line."""
    mean = motion.mean(axis=1)
    rotation = turn @ Rotation.from_euler("XYZ", mean[3:]).as_matrix()
    lengths = reference_lengths(load_robot(path), turn @ mean[:3], rotation)
    text = ",".join(f"{length:.9f}" for length in lengths)
    assert run(["modes", str(path), "--lengths", text, "--count", "3", "--assembly", assembly, "--json"]) == 0
    return np.array(json.loads(capsys.readouterr().out)["frequencies_hz"])


def deviations(setup, tmp_path, capsys, pulleys=True, assembly="consistent") -> tuple[np.ndarray, int]:
    """Relative deviations of the pairs found, and how many of 36 computed frequencies have no measured partner."""
    config, turn = setup
    path = robot_file(config, turn, tmp_path / "robot.toml", pulleys)
    found, alone = [], 0
    for motion in np.load(FOLDER / "free_motion_poses_100Hz_33.npz").values():
        measured = measured_frequencies(motion.astype(float))
        computed = computed_frequencies(path, motion.astype(float), turn, assembly, capsys)
        ratio = computed[None, :] / measured[:, None]
        rows, columns = linear_sum_assignment(np.minimum(np.abs(np.log(ratio)), 1.5 * PARTNER))
        near = np.abs(np.log(ratio[rows, columns])) < PARTNER
        found += (ratio[rows, columns] - 1.0)[near].tolist()
        alone += 3 - int(near.sum())
    return np.array(found), alone


def test_eigenfrequencies_meet_the_recordings(setup, tmp_path, capsys):
    """Measured: median |deviation| 0.75 %, median deviation -0.1 %; four weakly excited modes are not identified."""
    found, alone = deviations(setup, tmp_path, capsys)
    assert alone <= 4
    assert np.median(np.abs(found)) < 0.010
    assert abs(np.median(found)) < 0.003


def test_pulleys_are_seen_in_the_recordings(setup, tmp_path, capsys):
    """With the cables fixed where they enter the pulleys the frequencies come out 1.6 % too low."""
    found, _ = deviations(setup, tmp_path, capsys, pulleys=False)
    assert np.median(found) < -0.012


def test_geometric_term_decides_on_three_cables(setup, tmp_path, capsys):
    """Without the work of the static cable forces on the rotating arms 32 of the 36 frequencies have no partner."""
    _, alone = deviations(setup, tmp_path, capsys, assembly="thesis")
    assert alone >= 30
