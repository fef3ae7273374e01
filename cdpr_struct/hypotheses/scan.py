"""Large changes of single numbers, by the peaks that they would put right: beginnings that small steps do not show.

Where modes move past each other, peaks that a wrong mode explains hold a fit where it is. So amplitudes are tried,
modes solved and peaks assigned anew at each; what stands out is fitted from there.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.hypotheses.alternatives import Offered
from cdpr_struct.hypotheses.hypothesis import PRICE, SCALES, Part
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.inference.screening import Screen
from cdpr_struct.residuals.recorded import Recorded
from cdpr_struct.residuals.vibrations import log_likelihoods
from cdpr_struct.robot.robot_arrays import RobotArrays

AMPLITUDES = (1.0, 2.0, 3.5, 5.5)  # of a cause's prior sigma, both ways where it may be negative
_COARSE = 10.0  # nats by which the grid of amplitudes may miss the best one
_STATES = 6  # those with most peaks: enough to see what stands out
_SPREAD = 0.01  # of ln f: what half a step between amplitudes does to a mode
_OF_A_CAUSE = 2  # amplitudes: the grid may put the best one on either side
_LEFT = 2.0  # peaks that belong to no mode, expected: with fewer there is nothing to put right
_ALONE = "cable"  # first word of patterns that are not tried: statics see a single cable


@dataclass(frozen=True, slots=True, eq=False)
class Beginning:
    """A cause at an amplitude theta (1,), and how much ln of evidence times prior it seems to bring."""

    part: Part
    z: np.ndarray
    gain: float


def beginnings(data: Recorded, menu: Sequence[Offered], about: Judged, most: int) -> list[Beginning]:
    """The best large changes beside a judged hypothesis; none where its modes explain the peaks."""
    if about.lists is None or about.lists.left < _LEFT or data.campaign.model == "static":
        return []
    scan = _Scan(data, about)
    best: list[Beginning] = []
    for cause in menu:
        singles = [i for i, p in enumerate(cause.patterns) if p.basis.shape[1] == 1 and not p.label.startswith(_ALONE)]
        if not cause.laws and "RF" in cause.cause.seen_in and singles:
            found = sorted((b for i in singles for b in scan.of(cause, i)), key=lambda one: -one.gain)
            best += [one for one in found[:_OF_A_CAUSE] if one.gain > -_COARSE]
    return sorted(best, key=lambda one: -one.gain)[:most]


class _Scan:
    """What amplitudes of causes bring beside a judged hypothesis, modes solved for each."""

    def __init__(self, data: Recorded, about: Judged) -> None:
        self.data, self.about = data, about
        self.screen = Screen.of(about.model, about.fit.noise)
        self.arrays, self.readings = about.point.robot(data), about.point.readings(data)
        self.level = self._of_peaks(replace(self.arrays, mass=np.asarray(self.arrays.mass)[None]))[0]

    def of(self, cause: Offered, i: int) -> list[Beginning]:
        """One pattern at all amplitudes."""
        pattern = cause.patterns[i]
        said = self.screen.screened([(part @ pattern.basis) * pattern.prior for part in cause.columns])
        sizes = np.array(AMPLITUDES if pattern.positive[0] else [*AMPLITUDES, *(-a for a in AMPLITUDES)])
        theta = (sizes[:, None, None] * pattern.prior) @ pattern.basis.T
        robots = (cause.cause.apply(self.arrays, one[None]) for one in theta)  # one by one: modes need room
        gains = np.concatenate([self._of_peaks(robot) for robot in robots]) - self.level
        gains += sizes * said.score[0] - 0.5 * sizes**2 * said.gram[0, 0]
        found = []
        for size, gain in zip(sizes, gains, strict=True):
            scale = min(SCALES, key=lambda s: abs(np.log(abs(size) / s)))
            part = cause.part(i, scale)
            whole = float(gain) - 0.5 * (size / scale) ** 2 + part.log_weight - PRICE
            found.append(Beginning(part, np.array([size / scale]), whole))
        return found

    def _of_peaks(self, arrays: RobotArrays) -> np.ndarray:
        data, lists = self.data, self.about.lists
        if data.vibrations is None or lists is None:
            return np.zeros(1)
        noise, measured = lists.association.noise, data.vibrations.richest(_STATES)
        return log_likelihoods(data.campaign, data.known, measured, arrays, self.readings, _SPREAD**2, noise)
