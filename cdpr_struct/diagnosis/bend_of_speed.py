"""Are errors of lengths in proportion to speed, as those of a delay are, or do they bend with it?

What changes smoothly with the place (its coordinates, their squares and products) is taken off first. Of what speed
explains then, one part is proportional to the speed v of each cable; v|v|, |v| and the sign of v add the other.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis.all_frames import AllFrames, circular_shifts
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.hypotheses.significant import SIGNIFICANT
from cdpr_struct.measurement.loss import Loss

SPEED_SHARE = Loss().too_wide / Loss().unknown
"""Of the variance of errors: where functions of speed explain more, a law of motion is left that costs, unspoken in
that share, more than one name too many."""
_PLACE = 10  # numbers of a quadratic function of the place
_LEAST = 4 * (_PLACE + 4)  # frames, four times the numbers that are fitted to them


@dataclass(frozen=True, slots=True)
class Bend:
    """Size of the part that bends, rms over that of all that speed explains, and its p-value.

    p : against the same speeds at other times: series shifted in a circle keep their correlation and lose each other's
    """

    size: float
    p: float

    @property
    def matters(self) -> bool:
        """Whether errors bend with speed by so much that they are not those of a delay."""
        return self.size > SPEED_SHARE and self.p < SIGNIFICANT


def bend_of_speed(every: AllFrames, errors: np.ndarray) -> Bend | None:
    """Of errors (F, m) of lengths, all cables together; None with too few frames."""
    straight, bent = 0.0, np.zeros(1)
    shifts = circular_shifts(len(every.frames))
    place, speed = _of_place(every), every.data.known.rate[every.frames, :, 0]
    for own, v in zip(errors.T, speed.T, strict=True):
        read = np.isfinite(own)
        if read.sum() < _LEAST:
            return None
        proportional, more = _parts(own[read], v[read], place[read], shifts)
        straight, bent = straight + proportional, bent + more
    chance = bent[1:].mean()
    above = max(0.0, float(bent[0] - chance))
    whole = straight + above
    p = (1.0 + float((bent[1:] >= bent[0]).sum())) / len(bent)
    return Bend(float(np.sqrt(above / whole)) if whole > 0.0 else 0.0, p)


def bend_of_cause(every: AllFrames, found: Judged, part: int) -> Bend | None:
    """Of the errors that one of the causes of a fit stands for; None with too few frames, or if it moves no length."""
    errors = every.errors_without(found, part)
    return None if np.allclose(errors, every.errors(found), equal_nan=True) else bend_of_speed(every, errors)


def _of_place(every: AllFrames) -> np.ndarray:
    """(F, 10) a constant, coordinates, squares and products."""
    position = every.data.readings.position[every.frames]
    x = (position - position.mean(axis=0)) / np.maximum(position.std(axis=0), 1e-3)
    squares = [x[:, i] * x[:, j] for i in range(3) for j in range(i, 3)]
    return np.column_stack([np.ones(len(x)), x, *squares])


def _parts(errors: np.ndarray, speed: np.ndarray, place: np.ndarray, shifts: Sequence[int]) -> tuple[float, np.ndarray]:
    """Sums of squares of errors (F,) that speed explains, and those (1 + shifts,) that what bends with it adds."""
    proportional = _power(_beside(place, errors), _beside(place, speed))
    known = np.column_stack([place, speed])
    more = _beside(known, np.column_stack([speed * np.abs(speed), np.abs(speed), np.sign(speed)]))
    left = _beside(known, errors)
    return proportional, np.array([_power(left, _beside(known, np.roll(more, k, axis=0))) for k in (0, *shifts)])


def _beside(known: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values (F,) or (F, c) less what columns explain of them."""
    basis = np.linalg.qr(known)[0]
    return np.asarray(values - basis @ (basis.T @ values))


def _power(errors: np.ndarray, columns: np.ndarray) -> float:
    """Sum of squares of errors (F,) that columns (F,) or (F, c) explain."""
    basis = np.linalg.qr(columns.reshape((len(errors), -1)))[0]
    return float(((basis.T @ errors) ** 2).sum())
