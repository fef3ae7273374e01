"""Sensors and note-taking: readings with cell errors, tracker errors, noise, and rows as they would be filed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from tests.blind.deviations import Deviations
from tests.blind.measuring_plan import Plan, angles_deg
from tests.blind.observation import Observation, Rest
from tests.blind.true_robot import HOURS, Command
from tests.blind.vibrations import VISIBLE_SHARE

SIGMA = {"tension_N": 2.0, "position_m": 0.0003, "rotation_deg": 0.0115, "length_m": 0.0001}
CABLE_HZ = 0.003  # relative
ROBOT_HZ = 0.004  # relative
PICKED = 0.8  # share of the visible peaks that somebody picks
POSE = ["x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg"]
POSE_READ, INCLINATION_READ, NOTHING_READ = slice(0, 6), slice(3, 5), slice(0, 0)  # by tracker, inclinometer, nobody
COLOUR = 0.7  # correlation of one reading with the next in coloured noise
OUTLIER = 7.0  # sigma
PICTURE = 3.0  # m, from the middle of the tracker's picture, where its lens error is given
BEARING_ROUNDS = 40
TILT = 0.1  # rad, where the cells' error with the platform's tilt is given
TAILS = 3.0  # degrees of freedom of `student` noise

Tables = dict[str, pd.DataFrame]
Picker = Callable[[np.ndarray, np.ndarray, np.random.Generator], np.ndarray]
"""Peaks read of modes (k,) [Hz] with shares (k,) of their energy in the platform."""


@dataclass
class Noise:
    """Draws noise of unit variance: `white`, `coloured` (a slow wander over the day), or white with an `outlier`.

    `student` noise has long tails: Student's t with three degrees of freedom, of unit scale and so of variance 3.
    """

    rng: np.random.Generator
    kind: str = "white"
    scale: float = 1.0

    def __post_init__(self) -> None:
        self._last: dict[tuple[str, int], np.ndarray] = {}

    def draw(self, name: str, size: int) -> np.ndarray:
        """Next (size,) numbers of the sensor `name`."""
        if self.kind == "student":
            return np.asarray(self.scale * self.rng.standard_t(TAILS, size))
        fresh = self.scale * self.rng.standard_normal(size)
        if self.kind != "coloured":
            return fresh
        last = self._last.get((name, size))
        mixed = fresh if last is None else COLOUR * last + np.sqrt(1.0 - COLOUR**2) * fresh
        self._last[name, size] = mixed
        return np.asarray(mixed)


def cell_readings(deviations: Deviations, command: Command, rest: Rest) -> np.ndarray:
    """What the cells would show (m,) [N] without noise."""
    drag = deviations["pulley_friction"] * command.approach * rest.exit_angles / (0.5 * np.pi)
    pulled = before_wheels(deviations, command, rest, rest.tensions * np.exp(drag))
    pulled = pulled + deviations["cell_crosstalk"] * np.roll(pulled, -1)
    pulled = pulled + deviations["cell_quadratic"] * (pulled / 300.0) ** 2
    turns = np.where(np.arange(len(pulled)) % 2, -1.0, 1.0)
    pulled = pulled + deviations["cell_tilt"] * turns * rest.rotation[2, 0] / TILT
    pulled = pulled * (1.0 + deviations["cell_fading"] * command.day)
    return np.asarray(pulled * (1.0 + deviations["load_cell_gain"]) + deviations["load_cell_bias"])


def before_wheels(deviations: Deviations, command: Command, rest: Rest, pulled: np.ndarray) -> np.ndarray:
    """Tensions (m,) [N] on the winch's side of wheels whose bearings carry what both ends of the cable pull.

    Moments about the axle, (T1 - T2) R = mu r F, solved by repetition: each round is mu r / R of the one before.
    """
    before = pulled
    for _ in range(BEARING_ROUNDS):
        pulls = before**2 + pulled**2 - 2.0 * before * pulled * np.cos(rest.exit_angles)
        before = pulled + command.approach * deviations["bearing_friction"] * np.sqrt(pulls)
    return np.asarray(before)


def settled_readings(plan: Plan, seen: Observation, deviations: Deviations) -> list[np.ndarray]:
    """What the cells would show at every static state, (m,) [N] each, without noise; each keeps some of the last."""
    pairs = zip(plan.statics, seen.statics, strict=True)
    shown = [cell_readings(deviations, command, rest) for command, rest in pairs]
    for number in range(1, len(shown)):
        shown[number] = shown[number] + deviations["cell_settling"] * (shown[number - 1] - shown[number])
    return shown


def pose_readings(deviations: Deviations, rest: Rest) -> np.ndarray:
    """What the tracker would show (6,) [m, deg] without noise; its camera looks down on the world's origin."""
    shift, turn = deviations["tracker_frame"][:3], Rotation.from_rotvec(deviations["tracker_frame"][3:]).as_matrix()
    aside = np.array([*rest.position[:2], 0.0]) / PICTURE
    bent = rest.position + deviations["tracker_lens"] * float(aside @ aside) * aside
    bent = bent + deviations["tracker_shear"] * aside[1] * np.array([1.0, 0.0, 0.0])
    added = Rotation.from_rotvec([0.0, 0.0, float(deviations["tracker_heading"][0]) * aside[0]]).as_matrix()
    return np.concatenate([turn @ bent + shift, angles_deg(turn @ added @ rest.rotation)])


def noisy_pose(deviations: Deviations, rest: Rest, noise: Noise) -> np.ndarray:
    """One pose reading (6,) [m, deg]."""
    sigma = np.repeat([SIGMA["position_m"], SIGMA["rotation_deg"]], 3)
    return np.asarray(pose_readings(deviations, rest) + sigma * noise.draw("pose", 6))


def picked(modes: np.ndarray, shares: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Peaks somebody picks among those that show on the platform."""
    visible = modes[shares > VISIBLE_SHARE]
    return np.asarray(visible[rng.random(len(visible)) < PICKED])


def filed(
    plan: Plan,
    seen: Observation,
    deviations: Deviations,
    noise: Noise,
    with_lengths: bool = True,
    picker: Picker = picked,
) -> Tables:
    """Rows of all files, by kind of measurement; no frequencies if none were observed."""
    static = static_rows(plan, seen, deviations, noise)
    tables = {"static_state": static, "loaded_pose": loaded_rows(plan, seen, deviations, noise)}
    if noise.kind == "outlier":
        row = int(noise.rng.integers(len(static)))
        static.loc[row, "tension_N"] += OUTLIER * SIGMA["tension_N"] * noise.rng.choice([-1.0, 1.0])
    if not with_lengths:
        del static["length_m"], tables["loaded_pose"]
    if not len(seen.cable_hz):
        return tables
    states = static.drop_duplicates("case").set_index("case")
    tables["cable_frequency"] = cable_rows(seen, static, states, noise)
    tables["robot_frequency"] = robot_rows(seen, states, noise, picker)
    return tables


def static_rows(plan: Plan, seen: Observation, deviations: Deviations, noise: Noise) -> pd.DataFrame:
    """A row for every cable at every static state."""
    rows = []
    states = zip(plan.statics, seen.statics, settled_readings(plan, seen, deviations), strict=True)
    for number, (command, rest, cells) in enumerate(states, start=1):
        pose = noisy_pose(deviations, rest, noise)
        tensions = cells + SIGMA["tension_N"] * noise.draw("tension", len(cells))
        lengths = command.lengths + SIGMA["length_m"] * noise.draw("length", len(cells))
        for cable in range(len(cells)):
            row = {"case": f"s{number:02d}", **dict(zip(POSE, pose, strict=True)), "payload_kg": command.payload}
            row |= {"cable": cable + 1, "tension_N": tensions[cable], "length_m": lengths[cable]}
            rows.append(row | {"approach": int(command.approach[cable])})
    return pd.DataFrame(rows)


def loaded_rows(plan: Plan, seen: Observation, deviations: Deviations, noise: Noise) -> pd.DataFrame:
    """A row for every payload at every lock."""
    rows = []
    for lock, (commands, rests) in enumerate(zip(plan.locks, seen.locks, strict=True), start=1):
        lengths = commands[0].lengths + SIGMA["length_m"] * noise.draw("length", len(commands[0].lengths))
        for number, (command, rest) in enumerate(zip(commands, rests, strict=True), start=1):
            pose = noisy_pose(deviations, rest, noise)
            row = {"case": f"l{lock}p{number}", **dict(zip(POSE, pose, strict=True)), "payload_kg": command.payload}
            rows.append(row | {f"length_{cable}_m": value for cable, value in enumerate(lengths, start=1)})
    return pd.DataFrame(rows)


def cable_rows(seen: Observation, static: pd.DataFrame, states: pd.DataFrame, noise: Noise) -> pd.DataFrame:
    """A row for every mode of every cable at the states where frequencies were measured."""
    rows = []
    tension = static.set_index(["case", "cable"])["tension_N"]
    for number, cables in enumerate(seen.cable_hz, start=1):
        case = f"s{number:02d}"
        for cable, modes in enumerate(cables, start=1):
            readings = modes * (1.0 + CABLE_HZ * noise.draw("cable frequency", len(modes)))
            for mode, reading in enumerate(readings, start=1):
                row = {"case": case, **_state(states, case), "cable": cable, "mode": mode, "plane": "in"}
                row |= {"frequency_hz": reading, "sigma": CABLE_HZ * reading, "tension_N": tension[case, cable]}
                rows.append(row)
    return pd.DataFrame(rows)


def robot_rows(seen: Observation, states: pd.DataFrame, noise: Noise, picker: Picker) -> pd.DataFrame:
    """Peaks read, without labels."""
    rows = []
    for number, (modes, shares) in enumerate(zip(seen.robot_hz, seen.shares, strict=True), start=1):
        case, peaks = f"s{number:02d}", picker(modes, shares, noise.rng)
        for reading in np.sort(peaks * (1.0 + ROBOT_HZ * noise.draw("robot frequency", len(peaks)))):
            row = {"case": case, **_state(states, case), "frequency_hz": reading, "sigma": ROBOT_HZ * reading}
            rows.append(row)
    return pd.DataFrame(rows)


def _state(states: pd.DataFrame, case: str) -> Mapping[str, float]:
    """Pose and payload of a case, with the same readings as in the file of the static states."""
    return {str(key): value for key, value in states.loc[case, [*POSE, "payload_kg"]].items()}


def timed(tables: Tables, plan: Plan) -> Tables:
    """The same files with the time of every state."""
    days = {f"s{number:02d}": command.day for number, command in enumerate(plan.statics, start=1)}
    for lock, commands in enumerate(plan.locks, start=1):
        days |= {f"l{lock}p{number}": command.day for number, command in enumerate(commands, start=1)}
    return {
        kind: table.assign(time_s=[round(3600.0 * HOURS * days[case]) for case in table["case"]])
        for kind, table in tables.items()
    }


def unplaced(tables: Tables, read: slice) -> Tables:
    """The same files of a robot of whose pose only some numbers are read: rx and ry by an inclinometer, or nothing."""
    gone = [name for name in POSE if name not in POSE[read]]
    return {kind: table.drop(columns=gone) for kind, table in tables.items()}
