"""How far are the lengths of all frames of a motion off, condensed ones among them, and is that a function of speed?

Poses and tensions stand as they were read. A function of speed is any combination of v, v|v|, |v| and the sign of v of
each cable, fitted to all blocks of frames but one and held against that one. The acceleration is asked on its own.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.observation.motion import STILL
from cdpr_struct.observation.rest import static_residuals
from cdpr_struct.residuals.recorded import Recorded

SHIFTS = 99  # of speeds against errors: the least p-value is 1/100
_NEAR = 20  # parts of a series, one of which it is shifted by at least
LEAST_FRAMES = 12  # frames of a block, twice the features of speed: fewer say nothing of them


@dataclass(frozen=True, slots=True, eq=False)
class AllFrames:
    """Frames (F,) of a campaign with measured poses and lengths that are no state at rest, in order of time.

    data : of the campaign with all its frames
    """

    data: Recorded
    frames: np.ndarray

    @classmethod
    def read(cls, data: Recorded) -> "AllFrames":
        """All states with measured poses and lengths, moving or not."""
        return cls(data, np.flatnonzero(data.read[:, :6].all(axis=1) & data.read[:, 6 + data.cables :].any(axis=1)))

    @classmethod
    def of(cls, data: Recorded) -> "AllFrames | None":
        """None where nothing moves."""
        frames = cls.read(data).frames
        frames = frames[np.abs(data.known.rate[frames, :, 0]).max(axis=1, initial=0.0) > STILL]
        order = np.argsort(data.campaign.states.time[frames], kind="stable")
        return cls(data, frames[order]) if len(frames) else None

    @property
    def time(self) -> np.ndarray:
        """(F,) [s]."""
        return np.asarray(self.data.campaign.states.time[self.frames])

    def errors(self, found: Judged | None, z: np.ndarray | None = None) -> np.ndarray:
        """(F, m) measured less predicted lengths [m], nan where not read; less their mean where encoders are relative.

        found : whose tolerances and causes the prediction has, at its likeliest numbers or at z (t,); None as entered.
        Drift and what belongs to single states or sits outside the model are no part of it.
        """
        arrays = self.data.arrays
        if found is not None:
            values = found.split(found.fit.z_mean if z is None else z)
            parts = len(found.hypothesis.parts)
            common = [True, *[False] * (len(values) - 1 - parts)]
            common += [part.law is None and part.cause.carrier != "state" for part in found.hypothesis.parts]
            for term, own, used in zip(found.point.terms, values, common, strict=True):
                arrays = term.applied(arrays, own[None]) if used else arrays
        gap = static_residuals(arrays, self.data.readings, self.data.known, self.data.radius)[:, 6:]
        gap = np.where(self.data.read[:, 6 + self.data.cables :], gap, np.nan)[self.frames]
        return gap - np.nanmean(gap, axis=0) if self.data.campaign.relative_lengths else gap

    def errors_without(self, found: Judged, part: int) -> np.ndarray:
        """The same with one of the causes of a fit taken out of the prediction, all other numbers as they are."""
        values = found.split(found.fit.z_mean)
        at = len(values) - len(found.hypothesis.parts) + part
        values = [0.0 * own if i == at else own for i, own in enumerate(values)]
        return self.errors(found, np.concatenate(values))

    def share_of_speed(self, errors: np.ndarray, blocks: Sequence[np.ndarray]) -> float | None:
        """Share of errors (F, m) that functions of speed explain in blocks of frames that they were not fitted to.

        Negative where such functions predict worse than none. None where blocks have too few frames.
        """
        return _share(errors, self._of_speed(), blocks)

    def p_of_speed(self, errors: np.ndarray, blocks: Sequence[np.ndarray]) -> float:
        """p-value of such a share, against the same speeds at other times: series shifted in a circle keep their
        correlation and lose each other's. One where blocks have too few frames."""
        features, count = self._of_speed(), len(self.frames)
        own = _share(errors, features, blocks)
        if own is None:
            return 1.0
        others = [_share(errors, np.roll(features, shift, axis=0), blocks) for shift in circular_shifts(count)]
        return (1.0 + sum(one is not None and one >= own for one in others)) / (len(others) + 1.0)

    def _of_speed(self) -> np.ndarray:
        """(F, m, 4)."""
        speed = self.data.known.rate[self.frames, :, 0]
        return np.stack([speed, speed * np.abs(speed), np.abs(speed), np.sign(speed)], axis=-1)

    def share_of_acceleration(self, errors: np.ndarray, blocks: Sequence[np.ndarray]) -> float | None:
        """The same of each cable's acceleration."""
        return _share(errors, self.data.known.rate[self.frames, :, 1:], blocks)


def circular_shifts(frames: int) -> list[int]:
    """By how many frames a series is shifted against another: at least by a twentieth of it, to lose correlation."""
    least = -(-frames // _NEAR)
    return np.unique(np.linspace(least, frames - least, SHIFTS).astype(int)).tolist()


def _share(errors: np.ndarray, features: np.ndarray, blocks: Sequence[np.ndarray]) -> float | None:
    """Share of errors (F, m) that features (F, m, f) of each cable explain in blocks that they were not fitted to."""
    if len(blocks) < 2 or min(map(len, blocks)) < LEAST_FRAMES:
        return None
    before = after = 0.0
    for own, columns in zip(errors.T, np.moveaxis(features, 1, 0), strict=True):
        read = np.isfinite(own)
        for block in blocks:
            inside = np.zeros(len(own), dtype=bool)
            inside[block] = True
            fitted, kept = read & ~inside, read & inside
            if fitted.sum() < LEAST_FRAMES:
                continue
            middle, origin = own[fitted].mean(), columns[fitted].mean(axis=0)
            z = np.linalg.lstsq(columns[fitted] - origin, own[fitted] - middle, rcond=None)[0]
            before += float(((own[kept] - middle) ** 2).sum())
            after += float(((own[kept] - middle - (columns[kept] - origin) @ z) ** 2).sum())
    return 1.0 - after / before if before > 0.0 else 0.0
