"""What the program says of a robot with tolerances: bands of each level as users get them, and probabilities."""

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

import cdpr_struct as cs
from benchmarks.band_coverage.drawing import FREQUENCIES, Case
from benchmarks.band_coverage.fem_rest import FemRest
from cdpr_struct.bands.frequency_bands import chance_above
from cdpr_struct.bands.mode_rates import mode_rates
from cdpr_struct.interface.bands import AskedBand, Banded
from cdpr_struct.interface.modes import ModesResult

LEVELS = (50, 90, 99)


@dataclass(frozen=True, slots=True, eq=False)
class Prediction:
    """middle, sigma : of pose, tension, hertz;  bands : level to (6 + m + k, 2), in that order
    warned : whether the program doubts them, since a cable may go slack;  margin : least tension in sigmas
    """

    middle: FemRest
    sigma: FemRest
    bands: dict[int, np.ndarray]
    warned: bool
    margin: float
    meeting: list[int]
    modes: ModesResult

    def probability(self, truth: FemRest, frequency: int, component: int, cable: int) -> list[float]:
        """That a frequency, a component of the pose and a tension lie below their true values, as predicted."""
        rest = [
            float(ndtr((getattr(truth, name)[i] - getattr(self.middle, name)[i]) / getattr(self.sigma, name)[i]))
            for name, i in (("pose", component), ("tension", cable))
        ]
        return [self._below(float(truth.hertz[frequency]), frequency), *rest]

    def _below(self, hertz: float, number: int) -> float:
        banded = Banded.at(self.modes.point, AskedBand(0.5), True)
        rates = mode_rates(banded.point, self.middle.hertz, banded.response, banded.spread)
        return 1.0 - chance_above(rates, banded.spread, number, hertz)


def predicted(case: Case, levels: tuple[int, ...] = LEVELS) -> Prediction:
    """Bands of all levels [%].

    Raises
    ------
    CdprError : the robot has no modes there.
    """
    bands = {}
    for level in levels:
        rest = cs.inverse(case.robot, case.pose, band=level)
        modes = cs.modes(case.robot, case.pose, band=level, count=FREQUENCIES)
        told = rest.answer["bands"]
        bands[level] = np.concatenate([told["pose"], told["tensions_N"], modes.answer["bands"]["frequencies_hz"]])
    hertz = modes.answer["bands"]
    tension = np.asarray(rest.answer["tensions_N"])
    spread = FemRest(*map(np.asarray, (told["pose_sigma"], told["tension_sigma_N"], hertz["sigma_hz"])))
    middle = FemRest(np.array(case.pose.in_degrees()), tension, np.asarray(modes.answer["frequencies_hz"]))
    margin = float((tension / spread.tension).min())
    doubted = [check["what"] for check in rest.answer["trust"]["checks"] if not check["holds"]]
    meeting = sorted({number for group in hertz["modes_that_may_meet"] for number in group})
    return Prediction(middle, spread, bands, "least tension in sigmas" in doubted, margin, meeting, modes)
