"""Recordings to import: a wide CSV file, SIMULATED, and a ROS 2 bag of a REAL machine.

    python examples/recordings/make.py [DIR]                     # log.csv
    python examples/recordings/make.py DIR --bag FRAMES.csv      # flight, the bag, from recorded frames

log.csv: CoGiRo stops at five poses, a logger writes ten rows a second in mm and kN. The robot is the finite-element
model of `fem_reference` with anchors and stiffness a little off, as drawings and data sheets allow; load cell 3 reads
8 % too much. Nothing of the diagnosis is used.

The bag holds the first 160 frames of a suspended robot with four cables, recorded by the ARAS group (repository
ARASFactorSLAC, MIT licence, see LICENSE beside): PoseStamped of an optical tracker, JointState of the encoders.
"""

import argparse
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

POSES = [(0.0, 0.0, 1.2), (2.0, 1.0, 1.5), (-2.0, -1.0, 1.0), (3.0, -2.0, 1.2), (-3.0, 2.0, 1.8)]
GAIN, CELL = 1.08, 2  # of the load cell of cable 3
STEP, STOP, MOVE = 0.1, 4.0, 3.0  # s
SEED, ELEMENTS = 7, 40
NOISE = (5e-4, 2e-4, 2.0, 2e-4)  # m, rad, N, m: tracker, its rotation, load cells, encoders, each sample
FRAMES, BEGIN = 160, 1_700_000_000_000_000_000  # frames of the bag, and its first instant [ns since 1970]


def real_robot(entered: Robot, noise: np.random.Generator) -> Robot:
    """The robot as it was built: within tolerances of what was entered."""
    cables = tuple(
        replace(cable, axial_stiffness=cable.axial_stiffness * (1.0 + 0.01 * noise.normal()))
        for cable in entered.cables
    )
    off = [noise.normal(0.0, 5e-4, anchors.shape) for anchors in (entered.frame_anchors, entered.platform_anchors)]
    return replace(
        entered, cables=cables, frame_anchors=entered.frame_anchors + off[0],
        platform_anchors=entered.platform_anchors + off[1],
    )  # fmt: skip


def stops(noise: np.random.Generator) -> np.ndarray:
    """(5, 22) position, rotation vector, tensions and lengths at rest in SI units."""
    entered = load_robot("cogiro")
    real, found = real_robot(entered, noise), []
    for pose in POSES:
        lengths = inverse(entered, np.array(pose), np.eye(3)).lengths
        rest = fem.solve_robot(to_fem(real, lengths), np.array(pose), np.eye(3), ELEMENTS)
        pulls = np.linalg.norm([cable.end_force for cable in rest.cables], axis=1)
        pulls[CELL] *= GAIN
        found.append(np.concatenate([rest.position, Rotation.from_matrix(rest.rotation).as_rotvec(), pulls, lengths]))
    return np.array(found)


def samples(rest: np.ndarray, noise: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) and readings (n, 22) of stops with moves between them."""
    instants = [time for i in range(len(rest)) for time in (i * (STOP + MOVE), i * (STOP + MOVE) + STOP)]
    time = np.arange(0.0, instants[-1], STEP)
    place = np.interp(time, instants, np.repeat(np.arange(len(rest)), 2))
    part = place - np.floor(place)
    place = np.floor(place) + 0.5 - 0.5 * np.cos(np.pi * part)  # without a jerk at the begin and end of a move
    readings = np.stack([np.interp(place, np.arange(len(rest)), column) for column in rest.T], axis=1)
    sigma = np.repeat(NOISE, (3, 3, 8, 8))
    return time, readings + sigma * noise.normal(size=readings.shape)


def table() -> pd.DataFrame:
    """log.csv: time in ms, positions and lengths in mm, a quaternion with its real part last, tensions in kN."""
    noise = np.random.default_rng(SEED)
    time, readings = samples(stops(noise), noise)
    turns = Rotation.from_rotvec(readings[:, 3:6]).as_quat()
    columns = {"t [ms]": 1e3 * time}
    columns |= {f"tracker {axis} [mm]": 1e3 * readings[:, i] for i, axis in enumerate("xyz")}
    columns |= {f"tracker q{part}": turns[:, i] for i, part in enumerate("xyzw")}
    columns |= {f"F{i + 1} [kN]": 1e-3 * readings[:, 6 + i] for i in range(8)}
    columns |= {f"L{i + 1} [mm]": 1e3 * readings[:, 14 + i] for i in range(8)}
    return pd.DataFrame(columns).round(6)


def bag(frames: pd.DataFrame, folder: Path) -> None:
    """Write a ROS 2 bag of recorded frames: /tracker/pose and /winches, stamped; the recorder hears of them later."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    pose, joints, header, stamp, where, point, turn = (
        store.types[name] for name in (
            "geometry_msgs/msg/PoseStamped", "sensor_msgs/msg/JointState", "std_msgs/msg/Header",
            "builtin_interfaces/msg/Time", "geometry_msgs/msg/Pose", "geometry_msgs/msg/Point",
            "geometry_msgs/msg/Quaternion",
        )
    )  # fmt: skip
    shutil.rmtree(folder, ignore_errors=True)
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        topics = [
            writer.add_connection(t, c.__msgtype__, typestore=store)
            for t, c in (("/tracker/pose", pose), ("/winches", joints))
        ]
        for row in frames.itertuples():
            now = BEGIN + round(row.time_s * 1e9)
            head = header(stamp=stamp(sec=now // 10**9, nanosec=now % 10**9), frame_id="world")
            seen = where(point(row.x_m, row.y_m, row.z_m), turn(row.qx, row.qy, row.qz, row.qw))
            wound = np.array([row.length_1_m, row.length_2_m, row.length_3_m, row.length_4_m])
            names, none = [f"winch_{i}" for i in range(1, 5)], np.zeros(0)
            for topic, message, late in (
                (topics[0], pose(head, seen), 3),
                (topics[1], joints(head, names, wound, none, none), 9),
            ):
                writer.write(topic, now + late * 10**6, store.serialize_cdr(message, message.__msgtype__))


def main() -> None:
    """Write the files."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", nargs="?", type=Path, default=Path(__file__).parent)
    parser.add_argument("--bag", type=Path, help="recorded frames, CSV")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    if given.bag is not None:
        bag(pd.read_csv(given.bag).head(FRAMES), given.folder / "flight")
        return
    table().to_csv(given.folder / "log.csv", index=False, lineterminator="\n")


if __name__ == "__main__":
    main()
