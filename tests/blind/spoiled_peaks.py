"""What spoils lists of natural frequencies: peaks that are missing, merged, somebody else's or of another pose."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from tests.blind.sensors import Picker, Tables
from tests.blind.vibrations import VISIBLE_SHARE

MISSING = 0.15  # share of the visible peaks, of robot and cables, that nobody reads
SPURIOUS = 0.08  # peaks of something else, a visible peak
BEYOND = 1.1  # spurious peaks lie between lowest and highest mode, and by this factor beyond
CLOSE = 0.01  # relative distance below which two modes make one peak
MAINS = 50.0  # Hz
GEARS = (2.0, 12.0)  # reduction of the mains frequency to that of a motor's shaft


@dataclass
class PeakSpoiler:
    """Reads the peaks of robot modes in a spoilt way; one for each campaign, whose steady line is one for all poses.

    line : [Hz], drawn at the first pose so that it lies among the modes
    """

    ways: frozenset[str]
    line: float = 0.0
    said: dict[str, int] = field(default_factory=lambda: {"missing": 0, "spurious": 0, "merged": 0})

    def picker(self) -> Picker:
        """As the sensors want it."""
        return self._read

    def _read(self, modes: np.ndarray, shares: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        visible = shares > VISIBLE_SHARE
        if not visible.any():
            return np.zeros(0)
        peaks, weights = modes[visible], shares[visible]
        low, high = float(peaks.min()) / BEYOND, float(peaks.max()) * BEYOND
        if "merged" in self.ways:
            before = len(peaks)
            peaks = merged(peaks, weights)
            self.said["merged"] += before - len(peaks)
        count = len(peaks)
        if "missing" in self.ways:
            peaks = peaks[rng.random(count) >= MISSING]
            self.said["missing"] += count - len(peaks)
        if "spurious" in self.ways:
            stray = np.exp(rng.uniform(np.log(low), np.log(high), rng.binomial(count, SPURIOUS)))
            self.said["spurious"] += len(stray)
            peaks = np.append(peaks, stray)
        if "line" in self.ways:
            self.line = self.line or _shaft(low, high, rng)
            peaks = np.append(peaks, self.line)
        return np.asarray(peaks)


def merged(peaks: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Peaks (k,) in ascending order; those nearer than 1 % to the one below join it, where their weights balance."""
    groups: list[list[int]] = []
    for index in np.argsort(peaks):
        if groups and peaks[index] < peaks[groups[-1][-1]] * (1.0 + CLOSE):
            groups[-1].append(int(index))
        else:
            groups.append([int(index)])
    return np.array([np.average(peaks[group], weights=weights[group]) for group in groups])


def _shaft(low: float, high: float, rng: np.random.Generator) -> float:
    """Frequency [Hz] of a shaft on the mains, among the modes."""
    while True:
        line = MAINS / rng.uniform(*GEARS)
        if low < line < high:
            return float(line)


def spoil_peak_tables(ways: frozenset[str], tables: Tables, rng: np.random.Generator) -> str:
    """What happens once lists are filed, in place: cable frequencies that are missing, and lists exchanged."""
    said = ""
    if "missing" in ways:
        cables = tables["cable_frequency"]
        tables["cable_frequency"] = cables[rng.random(len(cables)) >= MISSING].reset_index(drop=True)
    if "exchanged" in ways:
        tables["robot_frequency"], said = _exchanged(tables["robot_frequency"], rng)
    return said


def _exchanged(robot: pd.DataFrame, rng: np.random.Generator) -> tuple[pd.DataFrame, str]:
    """Two poses with each other's list."""
    first, second = sorted(rng.choice(robot["case"].unique(), 2, replace=False))
    heads = robot.drop_duplicates("case").set_index("case")
    partner = {first: second, second: first}
    owners = [partner.get(case, case) for case in robot["case"]]
    changed = robot.copy()
    state = [name for name in robot if name not in ("case", "frequency_hz", "sigma")]
    changed["case"], changed[state] = owners, heads.loc[owners, state].to_numpy()
    order = {case: number for number, case in enumerate(heads.index)}
    changed = changed.sort_values("case", key=lambda cases: cases.map(order), kind="stable").reset_index(drop=True)
    return changed, f"{first} and {second}"
