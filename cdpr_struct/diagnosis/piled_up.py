"""Do outliers pile up in one sensor? By assumption they are independent; many of one sensor are an error of its own."""

from collections import Counter

import numpy as np
from scipy.special import betainc

from cdpr_struct.diagnosis.diagnosis import Pile
from cdpr_struct.diagnosis.set_aside import readings_by_group
from cdpr_struct.hypotheses.detectable import FALSE_ALARMS
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.inference.scale_mixture import KAPPA, OUTLIER, PSEUDO_COUNTS
from cdpr_struct.residuals.layout import Layout
from cdpr_struct.residuals.recorded import Recorded

_KINDS = ("tension", "length", "swivel")


def piled_up(data: Recorded, where: Layout, found: Judged) -> Pile | None:
    """The sensor whose outliers are least likely by chance; None if they may all be independent."""
    odd = found.fit.noise.outlying & np.isnan(where.groups.fixed_variance)
    read, outlying = Counter[tuple[str, int]](), Counter[tuple[str, int]]()
    for group, kind, _, cable, _ in readings_by_group(data, where, found):
        if kind in _KINDS and np.isnan(where.groups.fixed_variance[group]):
            read[kind, cable] += 1
            outlying[kind, cable] += int(odd[group])
    piles = [_pile(sensor, read, outlying) for sensor in read]
    return min((one for one in piles if one.p < FALSE_ALARMS), key=lambda one: one.p, default=None)


def _pile(sensor: tuple[str, int], read: Counter[tuple[str, int]], outlying: Counter[tuple[str, int]]) -> Pile:
    """Outliers of a sensor beside those of the others of its kind."""
    kind, cable = sensor
    others = [other for other in read if other[0] == kind and other != sensor]
    expected = float(PSEUDO_COUNTS[KAPPA >= OUTLIER].sum()) + sum(outlying[other] for other in others)
    share = expected / (float(PSEUDO_COUNTS.sum()) + sum(read[other] for other in others))
    p = len(read) * _at_least(outlying[sensor], read[sensor], share)
    return Pile(kind, cable, outlying[sensor], read[sensor], min(1.0, p))


def _at_least(successes: int, trials: int, share: float) -> float:
    """Probability of so many or more successes; of a binomial distribution, without the slow import of scipy.stats."""
    return float(betainc(successes, trials - successes + 1, share)) if successes else 1.0
