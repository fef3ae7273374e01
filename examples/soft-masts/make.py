"""SIMULATED measurements: CoGiRo's cables hang on masts that give way, which the entered robot does not know.

    python examples/soft-masts/make.py [DIR]

Writes the CSV files of this example (to its own folder, or DIR). The measured robot is the finite-element model of
`fem_reference`, with every anchor, stiffness and mass a little off as drawings and data sheets allow, and with noise of
the sensors; nothing of the diagnosis is used. The winches pay out what the entered robot asks for. `later.csv` is no
part of the campaign: frequencies at a further pose, to see who predicts them.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

MASTS = 1e-5  # m/N, of each mast: the hidden effect
POSES = [
    (0.0, 0.0, 1.2), (2.0, 1.0, 1.5), (-2.0, -1.0, 1.0), (3.0, -2.0, 1.2), (-3.0, 2.0, 1.8), (0.0, 2.5, 1.3),
]  # fmt: skip
PAYLOADS = (0.0, 20.0, 40.0)  # kg, winches locked
VIBRATED = 1  # poses, from the first, at which frequencies are measured and payloads hung on
SEED = 20
ELEMENTS = 40  # bars a cable
SEEN = 0.3  # share of the kinetic energy in the platform from which an accelerometer on it shows a mode
POSE = ["x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg"]


def real_robot(entered: Robot, noise: np.random.Generator) -> Robot:
    """The robot as it was built: within tolerances of what was entered, on masts that give way."""
    one_reel = noise.normal()
    cables = tuple(
        replace(c, axial_stiffness=c.axial_stiffness * (1.0 + 0.02 * (0.7 * one_reel + 0.7 * noise.normal())))
        for c in entered.cables
    )
    give = Extensions.of(len(cables), {"frame_compliance": np.full(len(cables), MASTS)})
    off = [noise.normal(0.0, 5e-4, anchors.shape) for anchors in (entered.frame_anchors, entered.platform_anchors)]
    return replace(
        entered, cables=cables, extensions=give, frame_anchors=entered.frame_anchors + off[0],
        platform_anchors=entered.platform_anchors + off[1],
    )  # fmt: skip


def at_rest(
    real: Robot, entered: Robot, pose: tuple[float, ...], payload: float
) -> tuple[fem.RobotEquilibrium, np.ndarray]:
    """Where the real robot comes to rest, and the lengths (m,) [m] that the entered one commanded for the pose."""
    lengths = inverse(entered, np.array(pose), np.eye(3)).lengths
    data = to_fem(real.with_load(payload), lengths)
    return fem.solve_robot(data, np.array(pose), np.eye(3), ELEMENTS), lengths


def seen_pose(rest: fem.RobotEquilibrium, noise: np.random.Generator) -> list[float]:
    """What the tracker reads, 0.5 mm and 0.02 deg."""
    angles = Rotation.from_matrix(rest.rotation).as_euler("ZYX", degrees=True)[::-1]
    return [*(rest.position + noise.normal(0.0, 5e-4, 3)), *(angles + noise.normal(0.0, 0.02, 3))]


def cable_modes(rest: fem.RobotEquilibrium, noise: np.random.Generator) -> list[tuple[int, int, float]]:
    """Cable, mode and frequency [Hz] of the first two modes in the plane of each cable, read to 3 per mille."""
    found = []
    for i, cable in enumerate(rest.cables, start=1):
        modes = fem.cable_modes(cable, 6)
        in_plane = modes.frequencies_hz[modes.in_plane_share > 0.5]
        found += [(i, n, hertz * (1.0 + noise.normal(0.0, 0.003))) for n, hertz in enumerate(in_plane[:2], start=1)]
    return found


def platform_modes(rest: fem.RobotEquilibrium, noise: np.random.Generator) -> np.ndarray:
    """Frequencies [Hz] of the modes that an accelerometer on the platform shows, read to 3 per mille."""
    modes = fem.robot_modes(rest, 40)
    seen = modes.frequencies_hz[modes.platform_energy > SEEN]
    return np.asarray(seen * (1.0 + noise.normal(0.0, 0.003, len(seen))))


def tables(noise: np.random.Generator) -> dict[str, pd.DataFrame]:
    """All readings, by file name."""
    entered = load_robot("cogiro")
    real, m = real_robot(entered, noise), len(entered.cables)
    static, loaded, cable, robot, later = [], [], [], [], []
    for number, pose in enumerate(POSES, start=1):
        rest, lengths = at_rest(real, entered, pose, 0.0)
        case, where = f"pose {number}", seen_pose(rest, noise)
        pulls = np.linalg.norm([c.end_force for c in rest.cables], axis=1) + noise.normal(0.0, 2.0, m)
        if number == len(POSES):
            later += [[case, *where, hertz] for hertz in platform_modes(rest, noise)]
            break
        read = lengths + noise.normal(0.0, 5e-4, m)
        static += [[case, *where, i + 1, pulls[i], read[i]] for i in range(m)]
        if number > VIBRATED:
            continue
        cable += [[case, *where, *row] for row in cable_modes(rest, noise)]
        robot += [[case, *where, hertz] for hertz in platform_modes(rest, noise)]
        for payload in PAYLOADS:
            under, _ = at_rest(real, entered, pose, payload)
            loaded.append([f"{case}, {payload:g} kg", *seen_pose(under, noise), payload, *read])
    columns = {
        "static.csv": (static, ["cable", "tension_N", "length_m"]),
        "loaded.csv": (loaded, ["payload_kg", *(f"length_{i}_m" for i in range(1, m + 1))]),
        "cables.csv": (cable, ["cable", "mode", "frequency_hz"]),
        "robot.csv": (robot, ["frequency_hz"]),
        "later.csv": (later, ["frequency_hz"]),
    }
    return {name: pd.DataFrame(rows, columns=["case", *POSE, *more]) for name, (rows, more) in columns.items()}


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    folder.mkdir(parents=True, exist_ok=True)
    for name, table in tables(np.random.default_rng(SEED)).items():
        table.round(6).to_csv(folder / name, index=False, lineterminator="\n")
        print(f"wrote {folder / name}, {len(table)} rows")
