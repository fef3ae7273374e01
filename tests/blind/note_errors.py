"""Mistakes of whoever wrote the files: swapped channels, wrong units, wrong signs, poses of another state."""

from __future__ import annotations

import numpy as np
import pandas as pd

from tests.blind.sensors import POSE, Tables

KILOGRAM_FORCE = 9.80665
CLEAR_DIFFERENCE = 30.0  # N rms between two swapped channels
FEWEST_DIFFERENT = 2


def spoiled(name: str, tables: Tables, rng: np.random.Generator) -> str:
    """Put one mistake into the tables (in place) and say which."""
    return {
        "swapped_channels": swap_channels,
        "unit_error": mistake_unit,
        "sign_error": flip_sign,
        "pose_mismatch": mix_poses,
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
