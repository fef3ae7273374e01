"""What spoils static readings while they are taken: one way a campaign, on tables that are filed already."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from tests.blind.sensors import POSE, Tables

WILD, WILD_SIZE = 0.04, (15.0, 60.0)  # share of tensions that are off, by how much [N]
POSES_OFF, SHIFT, TURN = 2, (0.01, 0.05), (1.0, 4.0)  # number of poses that are off, by how much [m], [deg]
MISSING = 0.15  # share of tensions and lengths that are missing
NO_CELL = 0.5  # share of the campaigns in which one cable has no load cell at all
DRIFT = (2.0, 4.0)  # N, one sigma of what a cell has drifted at the last state
TRACKER_DRIFT = (0.5e-3, 2e-3)  # m, the same of a tracker, which turns about the middle by that over TRACKER_ARM
TRACKER_ARM = 2.0  # m
ENCODER_DRIFT = (0.3e-3, 1.5e-3)  # m, the same of an encoder
STEP = 5.0  # N, to which tensions are rounded
LENGTH = "length_"


def spoil_readings(way: str, tables: Tables, rng: np.random.Generator) -> str:
    """Spoil the tables in place and say how; `clean` and `student` (long tails, in the noise itself) do nothing."""
    ways: dict[str, Callable[[Tables, np.random.Generator], str]] = {
        "outliers": wild_tensions,
        "poses": poses_off,
        "missing": missing_cells,
        "drift": drifting_cells,
        "tracker": drifting_tracker,
        "encoders": drifting_encoders,
        "rounded": rounded_tensions,
    }
    return ways[way](tables, rng) if way in ways else ""


def wild_tensions(tables: Tables, rng: np.random.Generator) -> str:
    """Single tensions that have nothing to do with their cable."""
    static = tables["static_state"]
    wild = rng.random(len(static)) < WILD
    errors = rng.uniform(*WILD_SIZE, len(static)) * rng.choice([-1.0, 1.0], len(static))
    static["tension_N"] += np.where(wild, errors, 0.0)
    return f"{wild.sum()} of {len(static)} tensions"


def poses_off(tables: Tables, rng: np.random.Generator) -> str:
    """Poses of two static states, as if the tracker had lost the platform for a moment."""
    static = tables["static_state"]
    chosen = rng.choice(static["case"].unique(), POSES_OFF, replace=False)
    for case in chosen:
        rows = static["case"] == case
        pose = static.loc[rows, POSE].to_numpy()[0]
        aside = rng.standard_normal((2, 3))
        aside /= np.linalg.norm(aside, axis=1)[:, None]
        turned = Rotation.from_rotvec(np.radians(rng.uniform(*TURN)) * aside[1])
        angles = turned * Rotation.from_euler("xyz", pose[3:], degrees=True)
        wrong = [*(pose[:3] + rng.uniform(*SHIFT) * aside[0]), *angles.as_euler("xyz", degrees=True)]
        for table in tables.values():
            table.loc[table["case"] == case, POSE] = wrong
    return " and ".join(map(str, sorted(chosen)))


def missing_cells(tables: Tables, rng: np.random.Generator) -> str:
    """Tensions and lengths that nobody noted; in half of the campaigns also all tensions of one cable."""
    static, cables = tables["static_state"], sorted(tables["static_state"]["cable"].unique())
    without = int(rng.choice(cables)) if rng.random() < NO_CELL else 0
    gone = (static["cable"] == without).to_numpy()
    left = max(MISSING - gone.mean(), 0.0) / (1.0 - gone.mean())
    static.loc[gone | (rng.random(len(static)) < left), "tension_N"] = np.nan
    static.loc[rng.random(len(static)) < MISSING, "length_m"] = np.nan
    if "loaded_pose" in tables:
        _missing_at_locks(tables["loaded_pose"], rng)
    share = static["tension_N"].isna().mean()
    return f"{share:.0%} of the tensions" + (f", all of cable {without}" if without else "")


def _missing_at_locks(loaded: pd.DataFrame, rng: np.random.Generator) -> None:
    """A length is read once a lock: it is missing in all rows of the lock."""
    lengths = [name for name in loaded if str(name).startswith(LENGTH)]
    for _, rows in loaded.groupby(loaded["case"].str.split("p").str[0]):
        gone = [name for name in lengths if rng.random() < MISSING]
        loaded.loc[rows.index, gone] = np.nan


def drifting_cells(tables: Tables, rng: np.random.Generator) -> str:
    """Every cell wanders from state to state, from nothing at the first."""
    static, scale = tables["static_state"], rng.uniform(*DRIFT)
    cases, cables = list(static["case"].unique()), sorted(static["cable"].unique())
    walk = scale * _walk(len(cases), len(cables), rng)
    static["tension_N"] += [walk[cases.index(row.case), cables.index(row.cable)] for row in static.itertuples()]
    return f"{scale:.2g} N at the last state"


def _walk(states: int, sensors: int, rng: np.random.Generator) -> np.ndarray:
    """(S, n) random walks from zero at the first state to one sigma at the last."""
    steps = rng.standard_normal((states - 1, sensors)) / np.sqrt(max(states - 1, 1))
    return np.vstack([np.zeros(sensors), np.cumsum(steps, axis=0)])


def _cases_in_order(tables: Tables) -> list[str]:
    """Static states, then loaded poses, as they are filed."""
    names = [table["case"] for table in (tables["static_state"], tables.get("loaded_pose")) if table is not None]
    return list(dict.fromkeys(pd.concat(names)))


def drifting_tracker(tables: Tables, rng: np.random.Generator) -> str:
    """The tracker's frame shifts, and turns about the middle of the poses, from state to state."""
    cases, scale = _cases_in_order(tables), rng.uniform(*TRACKER_DRIFT)
    walk = dict(zip(cases, scale * _walk(len(cases), 6, rng), strict=True))
    middle = tables["static_state"][POSE[:3]].to_numpy().mean(axis=0)
    for table in tables.values():
        for case in table["case"].unique():
            rows, move = table["case"] == case, walk[case]
            pose = table.loc[rows, POSE].to_numpy()[0]
            turn = Rotation.from_rotvec(move[3:] / TRACKER_ARM)
            angles = (turn * Rotation.from_euler("xyz", pose[3:], degrees=True)).as_euler("xyz", degrees=True)
            table.loc[rows, POSE] = [*(middle + turn.apply(pose[:3] - middle) + move[:3]), *angles]
    return f"{1e3 * scale:.2g} mm at the last state"


def drifting_encoders(tables: Tables, rng: np.random.Generator) -> str:
    """Every encoder's zero wanders from one reading to the next; states of a lock share a reading."""
    static, scale = tables["static_state"], rng.uniform(*ENCODER_DRIFT)
    cables = sorted(static["cable"].unique())
    locks = list(dict.fromkeys(case.split("p")[0] for case in _cases_in_order(tables)))
    walk = dict(zip(locks, scale * _walk(len(locks), len(cables), rng), strict=True))
    static["length_m"] += [walk[row.case.split("p")[0]][cables.index(row.cable)] for row in static.itertuples()]
    if "loaded_pose" in tables:
        loaded = tables["loaded_pose"]
        for i, cable in enumerate(cables):
            if f"{LENGTH}{cable}_m" in loaded:
                loaded[f"{LENGTH}{cable}_m"] += [walk[case.split("p")[0]][i] for case in loaded["case"]]
    return f"{1e3 * scale:.2g} mm at the last state"


def rounded_tensions(tables: Tables, rng: np.random.Generator) -> str:
    """Tensions noted in steps."""
    del rng
    static = tables["static_state"]
    static["tension_N"] = np.maximum(STEP * np.round(static["tension_N"] / STEP), STEP)
    return f"steps of {STEP:g} N"
