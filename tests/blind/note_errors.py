"""Mistakes of whoever wrote the files: swapped channels, wrong units, signs or conventions, poses of another state."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from tests.blind.sensors import POSE, Tables

KILOGRAM_FORCE = 9.80665
CLEAR_DIFFERENCE = 30.0  # N rms between two swapped channels
FEWEST_DIFFERENT = 2
ORDERS = ("xzy", "yxz", "yzx", "zxy", "zyx")  # of fixed axes, that the files should have as xyz
FRAMES = {
    "y up": [[1, 0, 0], [0, 0, 1], [0, -1, 0]],  # rows: axes of the writer's frame in the robot's
    "z down": [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
    "x mirrored": [[-1, 0, 0], [0, 1, 0], [0, 0, 1]],
    "y mirrored": [[1, 0, 0], [0, -1, 0], [0, 0, 1]],
    "z mirrored": [[1, 0, 0], [0, 1, 0], [0, 0, -1]],
    "x and y exchanged": [[0, 1, 0], [1, 0, 0], [0, 0, 1]],
}


def mistaken(name: str, tables: Tables, rng: np.random.Generator) -> dict[str, Any]:
    """Put one mistake into the tables (in place); the record of it."""
    return {"cause": name, "multiple": None, "variant": spoiled(name, tables, rng)}


def spoiled(name: str, tables: Tables, rng: np.random.Generator) -> str:
    """Put one mistake into the tables (in place) and say which."""
    return {
        "swapped_channels": swap_channels,
        "unit_error": mistake_unit,
        "sign_error": flip_sign,
        "pose_mismatch": mix_poses,
        "rotation_convention": other_convention,
    }[name](tables, rng)


def swap_channels(tables: Tables, rng: np.random.Generator) -> str:
    """Two load cells are plugged into each other's channel."""
    pairs = tables["static_state"].pivot(index="case", columns="cable", values="tension_N")
    while True:
        first, second = (int(cable) for cable in sorted(rng.choice(pairs.columns, 2, replace=False)))
        if np.sqrt(((pairs[first] - pairs[second]) ** 2).mean()) > CLEAR_DIFFERENCE:
            break
    for kind in ("static_state", "cable_frequency"):
        table = tables[kind]
        other = {(row.case, row.cable): row.tension_N for row in table.itertuples()}
        partner = {first: second, second: first}
        table["tension_N"] = [other[row.case, partner.get(row.cable, row.cable)] for row in table.itertuples()]
    return f"channels {first} and {second}"


def mistake_unit(tables: Tables, rng: np.random.Generator) -> str:
    """Tensions in kilogram-force, cable frequencies in rad/s, or angles in rad."""
    variant = str(rng.choice(["kilogram-force", "rad/s", "rad"]))
    if variant == "kilogram-force":
        for kind in ("static_state", "cable_frequency"):
            tables[kind]["tension_N"] /= KILOGRAM_FORCE
    elif variant == "rad/s":
        tables["cable_frequency"][["frequency_hz", "sigma"]] *= 2.0 * np.pi
    else:
        for table in tables.values():
            table[POSE[3:]] = np.radians(table[POSE[3:]])
    return variant


def flip_sign(tables: Tables, rng: np.random.Generator) -> str:
    """One pose column of all files has the other sign."""
    column = str(rng.choice(["x_m", "y_m", "rx_deg", "ry_deg", "rz_deg"]))
    for table in tables.values():
        table[column] = -table[column]
    return column


def mix_poses(tables: Tables, rng: np.random.Generator) -> str:
    """Two static states carry each other's pose, or all carry that of the state before."""
    cases = sorted(tables["static_state"]["case"].unique())
    if rng.random() < 0.5:
        chosen = [str(case) for case in rng.choice(cases, FEWEST_DIFFERENT, replace=False)]
        source = {chosen[0]: chosen[1], chosen[1]: chosen[0]}
        said = f"{chosen[0]} and {chosen[1]} exchanged"
    else:
        source = dict(zip(cases, [cases[-1], *cases[:-1]], strict=True))
        said = "all shifted by one state"
    poses = tables["static_state"].drop_duplicates("case").set_index("case")[POSE]
    for kind in ("static_state", "cable_frequency", "robot_frequency"):
        table: pd.DataFrame = tables[kind]
        table[POSE] = poses.loc[[source.get(case, case) for case in table["case"]]].to_numpy()
    return said


def other_convention(tables: Tables, rng: np.random.Generator) -> str:
    """All poses are written in another convention than Rz Ry Rx in a right-handed frame whose z points up."""
    way = str(rng.choice([*ORDERS, *FRAMES, "columns", "vectors", "transposed", "wxyz", "xyzw"]))
    for table in tables.values():
        degrees = table[POSE[3:]].to_numpy(dtype=float)
        if way in FRAMES:
            axes = np.array(FRAMES[way], dtype=float)
            turn = Rotation.from_euler("xyz", degrees, degrees=True).as_matrix()
            table[POSE[:3]] = table[POSE[:3]].to_numpy(dtype=float) @ axes.T
            degrees = Rotation.from_matrix(axes @ turn @ axes.T).as_euler("xyz", degrees=True)
        else:
            degrees = _written(way, degrees)
        table[POSE[3:]] = degrees
    return way


def _written(way: str, degrees: np.ndarray) -> np.ndarray:
    """Numbers in the columns of the angles, from angles about fixed axes x, then y, then z."""
    turn = Rotation.from_euler("xyz", degrees, degrees=True)
    if way in ORDERS:
        return turn.as_euler(way, degrees=True)[:, [way.index(axis) for axis in "xyz"]]
    if way == "columns":
        return degrees[:, ::-1]
    if way == "vectors":
        return turn.as_rotvec(degrees=True)
    if way == "transposed":
        return turn.inv().as_euler("xyz", degrees=True)
    x, y, z, w = turn.as_quat().T
    columns = (y, z, w, x) if way == "wxyz" else (w, x, y, z)  # files of w, x, y, z read the other way round, or not
    return Rotation.from_quat(np.stack(columns, axis=1)).as_euler("xyz", degrees=True)
