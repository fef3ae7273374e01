"""Recorded free motions of a three-cable platform become a campaign that `cdpr-struct diagnose` reads.

    python examples/free_motion_campaign.py RECORDINGS CAMPAIGN_DIR [--only p_33_01,p_33_06]
    cdpr-struct diagnose CAMPAIGN_DIR/campaign.toml --out DIR

RECORDINGS is a folder with `Grab_prototype_33.json` (geometry; IRMA-LAB/cdpr_matlab, GPL-3) and
`free_motion_poses_100Hz_33.npz` (motions; fzoffoli/OCDPR_SelfCalibration): per key (6, n) x, y, z [m] and angles [rad],
R = Rx Ry Rz. They are not part of this package, and the campaign must lie outside it.

What is measured is the pose, at 100 Hz. Encoders were not recorded: the lengths are those that the mean pose means over
the pulleys, so they say nothing of their own, and the file gives them 1 mm of sigma. The mass is not known either; for
stiff light cables frequencies and poses do not depend on it, and 1 kg is entered with the inertia per unit mass.
"""

import argparse
import json
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.pose_error import reference_lengths

STEP = 0.01  # s
STIFF, LIGHT = 1e5, 1e-4  # N and kg/m: cables as the recordings' authors take them
CAMPAIGN = """robot = "three_cables.toml"
model = "exact"
[tolerances]
anchor_m = 0.001
length_m = 0.001
platform_mass_kg = 0.01
center_of_mass_m = 0.002
platform_inertia = 0.03
pulley_radius_m = 0.0002
"""
MEASUREMENT = """[[measurement]]
kind = "platform_motion"
file = "{file}"
sigma = {{ position_m = 0.001, rotation_deg = 0.1, length_m = 0.001 }}
"""


def column(nested: object) -> np.ndarray:
    return np.array(nested, dtype=float).ravel()


def upright(axis: np.ndarray) -> np.ndarray:
    """Rotation that turns the recorded vertical into z."""
    return Rotation.from_rotvec(np.cross(axis / np.linalg.norm(axis), [0.0, 0.0, 1.0])).as_matrix()


def robot_text(config: dict, turn: np.ndarray) -> str:
    """The recorded robot as a robot file with 1 kg of platform mass."""
    body = config["platform"]
    lines = ['name = "three-cables"', "[platform]", "mass = 1.0"]
    lines += [f"center_of_mass = {column(body['pos_PG_loc']).tolist()}", f"inertia = {body['inertia_mat_G_loc']}"]
    lines += ["[cable]", f"axial_stiffness = {STIFF}", f"linear_density = {LIGHT}"]
    for actuator in (a for a in config["actuator"] if a["active"]):
        pulley = actuator["pulley"]
        entry, axis = (turn @ column(pulley[name]) for name in ("pos_OD_glob", "vers_k"))
        lines += ["[[cables]]", f"platform_anchor = {column(actuator['winch']['pos_PA_loc']).tolist()}"]
        lines += [f"frame_anchor = {entry.tolist()}"]
        lines += [f"pulley = {{ radius = {pulley['radius']}, axis = {axis.tolist()} }}"]
    return "\n".join(lines) + "\n"


def motion_table(name: str, motion: np.ndarray, robot: Robot, turn: np.ndarray) -> pd.DataFrame:
    """One recording (6, n) in world axes with z upwards, in the columns of a platform_motion file."""
    position = (turn @ motion[:3]).T
    rotation = Rotation.from_matrix(turn) * Rotation.from_euler("XYZ", motion[3:].T)
    angles = rotation.as_euler("ZYX", degrees=True)[:, ::-1]
    table = pd.DataFrame({"case": name, "time_s": STEP * np.arange(len(position))})
    table[["x_m", "y_m", "z_m"]] = position
    table[["rx_deg", "ry_deg", "rz_deg"]] = angles
    lengths = reference_lengths(robot, position.mean(axis=0), rotation.mean().as_matrix())
    for i, length in enumerate(lengths, start=1):
        table[f"length_{i}_m"] = length
    return table


def write_campaign(recordings: Path, directory: Path, only: list[str]) -> Path:
    """Robot file, one CSV a recording and the campaign file; returns the latter."""
    config = json.loads((recordings / "Grab_prototype_33.json").read_text("utf-8"))
    turn = upright(column(config["platform"]["gravity_axis"]))
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "three_cables.toml").write_text(robot_text(config, turn), encoding="utf-8")
    robot, text = load_robot(directory / "three_cables.toml"), CAMPAIGN
    with np.load(recordings / "free_motion_poses_100Hz_33.npz") as motions:
        for name in only or sorted(motions.files):
            table = motion_table(name, motions[name].astype(float), robot, turn)
            table.to_csv(directory / f"{name}.csv", index=False, float_format="%.9g")
            text += MEASUREMENT.format(file=f"{name}.csv")
    path = directory / "campaign.toml"
    path.write_text(text, encoding="utf-8")
    return path


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recordings", type=Path)
    parser.add_argument("directory", type=Path)
    parser.add_argument("--only", default="", help="names of recordings, separated by commas; default all")
    given = parser.parse_args()
    for name in ("Grab_prototype_33.json", "free_motion_poses_100Hz_33.npz"):
        if not (given.recordings / name).is_file():
            parser.error(f"{given.recordings / name}: no such file; RECORDINGS is the folder that holds it")
    print(write_campaign(given.recordings, given.directory, [n for n in given.only.split(",") if n]))


if __name__ == "__main__":
    main()
