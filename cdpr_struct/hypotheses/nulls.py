"""What is fitted before any single cause: nothing wrong beside each error of the sensors, and the noise beside all."""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.hypotheses.alternatives import Offered
from cdpr_struct.hypotheses.correlated import Correlated, may_be_correlated
from cdpr_struct.hypotheses.drift import Drift, drifts
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import Judged, extended, judged, settled
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.inference.evidence import fit
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.residuals.assembled import stacked
from cdpr_struct.residuals.layout import Layout
from cdpr_struct.residuals.linearised import Local
from cdpr_struct.residuals.recorded import Recorded


def nulls_of(data: Recorded, where: Layout) -> list[Judged]:
    """Nothing wrong: with independent noise, and beside each drift and correlation that the sensors may have."""
    first = judged(data, where, Hypothesis())
    local, found = Local.about(data, first.point), [first]
    errors: list[Drift | Correlated] = [*drifts(data), *may_be_correlated(data)]
    for error in errors:
        columns = stacked(where, local.columns(error.term(data)))
        more = extended(data, where, first, Hypothesis(drift=error), columns, first.fit.noise)
        found.append(settled(data, where, more))
    return found


def rich_noise(menu: Sequence[Offered], base: Judged, scale: float, begin: NoiseState) -> NoiseState:
    """Sizes of the noise where all causes act at once at a scale, but those of several ways: what none explains."""
    known = [cause for cause in menu if cause.cause.name != UNKNOWN and not cause.cause.one_of]
    columns = [[part * (scale * cause.patterns[0].prior.max()) for part in cause.columns] for cause in known]
    everything = base.model.with_columns([np.concatenate(parts, axis=-1) for parts in zip(*columns, strict=True)])
    lists = None if base.lists is None else base.lists.copy()
    return fit(everything, begin, lists, base.fit.soft).noise
