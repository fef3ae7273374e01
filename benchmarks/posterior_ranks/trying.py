"""One seed: where the true size of a cause lies in what the data leave of it, its name and pattern being known."""

import tempfile
from pathlib import Path
from typing import Any

from scipy.special import ndtr

from benchmarks.posterior_ranks.drawing import Drawn, drawn
from cdpr_struct.diagnosis.whole_sizes import WholeSize, whole_sizes
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.hypothesis import SCALES, Hypothesis, Part
from cdpr_struct.hypotheses.judge import converged, judged
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded
from tests.blind.campaign_files import write_case

Told = dict[str, Any]


def tried(seed: int) -> Told:
    """What came of a seed: the true number, mean and sigma of its posterior, and its rank (0 to 1)."""
    one = drawn(seed)
    said = posterior(one)
    k = one.chosen
    place = float((one.theta[k] - said.mean[k]) / said.sigma[k])
    return {
        "seed": seed, "cause": one.cause, "robot": one.case.robot.name, "scale": one.scale,
        "passed_over": one.passed_over, "truth": float(one.theta[k]), "mean": float(said.mean[k]),
        "sigma": float(said.sigma[k]), "rank": float(ndtr(place)),
    }  # fmt: skip


def posterior(one: Drawn) -> WholeSize:
    """What the data of a campaign leave of the size of its cause."""
    with tempfile.TemporaryDirectory() as place:
        file = write_case(one.case, "case", (0,), Path(place) / "campaigns", Path(place) / "sealed")
        data = recorded(load_campaign(file))
    seen, where = seen_in(data), layout(data)
    cause = LIBRARY[one.cause]
    pattern = next(each for each in cause.patterns(seen) if each.label == one.label)
    fits = [judged(data, where, Hypothesis((Part(cause, pattern, scale),))) for scale in SCALES]
    best = converged(data, where, max(fits, key=lambda found: found.score))
    return whole_sizes(data, seen, best)[0]
