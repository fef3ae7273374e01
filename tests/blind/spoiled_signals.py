"""Frequency responses, decays and tracked motions of the real robot, and what spoils them.

Signals are sums over the modes of the referee, of unit modal mass and one damping ratio. Nothing of the modes that the
tool computes is in them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from tests.blind.observation import Observation
from tests.blind.sensors import POSE, TAILS

FRF, DECAY, MOTION = "frf", "free_decay", "platform_motion"
SIGNALS = ("clean", "student", "channel", "mains", "dropped", "blank", "gain", "sigma", "exchanged", "drift")
DAMPING = 0.01
SIGNAL_HZ = 0.01  # Hz, by which a mode is somewhere else when the pose is approached again, as the campaign states
TOO_SMALL = 2.5  # by this factor is every stated sigma too small
LINES, SAMPLES = {FRF: 500}, {DECAY: (128.0, 1536), MOTION: (90.0, 1080)}  # lines; 1/s and samples
HIGHEST = 12.0  # Hz of a frequency response
NOISE = {FRF: (0.03, 0.01), DECAY: (0.0, 0.02), MOTION: (0.0, 0.01)}  # of each value, and of all (rms)
GAIN = {FRF: 1.3, DECAY: 1.3, MOTION: 1.1}  # of the sensor along z
MAINS, MAINS_SIZE = 50.0, 0.3  # Hz, of the signal (rms)
GEARED = 8.0  # slower than the mains turns the shaft that is in the band of a frequency response
GAPS, GAP = 3, 0.01  # stretches that were lost, and how long each is, of the record
WILD = 1.0  # noise of a broken channel, of the signal (rms)
WANDER = 2.0  # drift of a rest, of the signal (rms); of a gain between records, a quarter of it
DAMPED = ("hysteretic_damping",)  # alike in all modes, as a constant loss factor does: may be said beside anything
RESPOND, EXCITE = ("x", "y", "z"), (("fx", 0), ("fz", 2))
MOVED = np.array([0.01, 0.01, 0.01, 0.01, 0.01, 0.01])  # m/s and rad/s of the platform as a motion begins


def may_be_said(kind: str, way: str) -> list[str]:
    """Names that are true of the records beside what is hidden in the robot."""
    gain = ("accelerometer_gain",) if kind == FRF and way in ("gain", "drift") else ()
    return [*DAMPED, *gain, *(("pose_mismatch",) if way == "exchanged" else ())]


@dataclass(frozen=True)
class SignalSpoiler:
    """Records the signals of a campaign of one kind in one way."""

    kind: str
    way: str
    rng: np.random.Generator

    def table(self, seen: Observation, static: pd.DataFrame) -> pd.DataFrame:
        """Rows of the file, at the poses that were read."""
        heads = static.drop_duplicates("case").set_index("case")
        cases = [f"s{number:02d}" for number in range(1, len(seen.robot_hz) + 1)]
        axes, values = zip(*(self._record(seen, number) for number in range(len(cases))), strict=True)
        owners = list(range(len(cases)))
        if self.way == "exchanged":
            first, second = sorted(self.rng.choice(len(cases), 2, replace=False))
            owners[first], owners[second] = second, first
        pairs = [(axes[owner], values[owner]) for owner in owners]
        rows = zip(cases, pairs, strict=True)
        return pd.concat([self._filed(case, heads.loc[case], *pair) for case, pair in rows], ignore_index=True)

    def _record(self, seen: Observation, number: int) -> tuple[np.ndarray, np.ndarray]:
        """Axis (n,) and channels (n, c) of one record, spoilt."""
        hertz, shapes = seen.robot_hz[number], seen.robot_shapes[number]
        off = SIGNAL_HZ * (TOO_SMALL if self.way == "sigma" else 1.0)
        hertz = hertz + off * self.rng.standard_normal(len(hertz))
        kept = hertz > 0.0
        make = {FRF: self._responses, DECAY: self._decay, MOTION: self._motion}[self.kind]
        axis, signal = make(hertz[kept], shapes[kept], seen.shares[number][kept])
        return axis, self._noisy(axis, signal, number / (len(seen.robot_hz) - 1.0))

    def _responses(self, hertz: np.ndarray, shapes: np.ndarray, shares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        seen = hertz[shares > 0.3]
        top = min(1.1 * float(seen.max()), 0.95 * float(hertz.max()), HIGHEST)
        lines = np.linspace(0.6 * float(seen.min()), top, LINES[FRF])
        own, omega = 2.0 * np.pi * hertz, 2.0 * np.pi * lines[:, None]
        single = -(omega**2) / (own**2 - omega**2 + 2j * DAMPING * own * omega)
        columns = [(shapes[:, i] * shapes[:, j]) for i in range(3) for _, j in EXCITE]
        return lines, single @ np.stack(columns, axis=1)

    def _decay(self, hertz: np.ndarray, shapes: np.ndarray, shares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        time, poles, pushed = self._released(DECAY, hertz, shapes)
        return time, ((pushed * poles) * np.exp(poles * time[:, None])).real @ shapes[:, :3]

    def _motion(self, hertz: np.ndarray, shapes: np.ndarray, shares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        time, poles, pushed = self._released(MOTION, hertz, shapes)
        return time, ((pushed / poles) * np.exp(poles * time[:, None])).real @ shapes

    def _released(self, kind: str, hertz: np.ndarray, shapes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Time (n,), poles (k,) and complex velocities of the modes (k,) after a push of the platform."""
        rate, samples = SAMPLES[kind]
        own = 2.0 * np.pi * hertz
        poles = own * (-DAMPING + 1j * np.sqrt(1.0 - DAMPING**2))
        begun = shapes / (shapes**2).sum(axis=0).clip(1e-12) @ (MOVED * self.rng.standard_normal(6))
        return np.arange(samples) / rate, poles, begun.astype(complex)

    def _noisy(self, axis: np.ndarray, signal: np.ndarray, late: float) -> np.ndarray:
        share, floor = NOISE[self.kind]
        rms = np.sqrt((np.abs(signal) ** 2).mean(axis=0))
        size = np.hypot(share * np.abs(signal), floor * rms)
        noisy = signal + size * self._drawn(signal)
        if self.way == "channel":
            noisy[:, 1] += WILD * rms[1] * self._drawn(signal)[:, 1]
        if self.way == "gain":
            along = [4, 5] if self.kind == FRF else [2]
            noisy[:, along] *= GAIN[self.kind]
        if self.way == "mains":
            noisy = noisy + self._line(axis, rms)
        if self.way == "drift":
            noisy = self._drifting(noisy, axis, rms, late)
        return noisy

    def _drawn(self, like: np.ndarray) -> np.ndarray:
        """Noise of unit scale, complex where the signal is."""
        draw = self.rng.standard_normal if self.way != "student" else lambda size: self.rng.standard_t(TAILS, size)
        if not np.iscomplexobj(like):
            return np.asarray(draw(like.shape))
        return np.asarray((draw(like.shape) + 1j * draw(like.shape)) / np.sqrt(2.0))

    def _line(self, axis: np.ndarray, rms: np.ndarray) -> np.ndarray:
        """The mains in every channel; of a frequency response a shaft on it, in two lines."""
        if self.kind != FRF:
            turns = self.rng.uniform(0.0, 2.0 * np.pi, len(rms))
            return MAINS_SIZE * np.sqrt(2.0) * rms * np.sin(2.0 * np.pi * MAINS * axis[:, None] + turns)
        near = np.argsort(np.abs(axis - MAINS / GEARED))[:2]
        line = np.zeros((len(axis), len(rms)), dtype=complex)
        line[near] = 3.0 * rms * np.exp(1j * self.rng.uniform(0.0, 2.0 * np.pi, (2, len(rms))))
        return line

    def _drifting(self, signal: np.ndarray, axis: np.ndarray, rms: np.ndarray, late: float) -> np.ndarray:
        """A rest that creeps; of a frequency response the gain of a sensor that grows from record to record."""
        changed = signal.copy()
        if self.kind == FRF:
            changed[:, 4:6] *= 1.0 + 0.25 * WANDER * late
        else:
            changed[:, 1] += WANDER * rms[1] * (1.0 - np.exp(-3.0 * axis / axis[-1]))
        return changed

    def _filed(self, case: str, head: pd.Series, axis: np.ndarray, signal: np.ndarray) -> pd.DataFrame:
        """Rows of one record as somebody files them."""
        at = {name: float(head[name]) for name in (*POSE, "payload_kg")}
        if self.kind == FRF:
            names = [(respond, excite) for respond in RESPOND for excite, _ in EXCITE]
            parts = [
                pd.DataFrame({"respond": r, "excite": e, "frequency_hz": axis, "real": own.real, "imag": own.imag})
                for (r, e), own in zip(names, signal.T, strict=True)
            ]
            table, read = pd.concat(parts, ignore_index=True), ["real", "imag"]
        else:
            table, read = pd.DataFrame({"time_s": axis}), ["ax", "ay", "az"] if self.kind == DECAY else POSE
            table[read] = signal * ([1.0] * 3 + [180.0 / np.pi] * 3)[: len(read)]
        rest = {name: value for name, value in at.items() if name not in read}
        table = table.assign(case=case, **rest)
        if self.kind == MOTION:
            table[POSE] += [at[name] for name in POSE]
        return self._lossy(table, read)

    def _lossy(self, table: pd.DataFrame, read: list[str]) -> pd.DataFrame:
        """Stretches that were not recorded: rows that are not there, or empty cells."""
        if self.way not in ("dropped", "blank"):
            return table
        lost, length = np.zeros(len(table), dtype=bool), max(round(GAP * len(table)), 1)
        for start in self.rng.integers(1, len(table) - length, GAPS):
            lost[start : start + length] = True
        if self.way == "dropped":
            return table[~lost].reset_index(drop=True)
        table.loc[lost, read] = np.nan
        return table
