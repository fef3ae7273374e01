"""A larger error gets no worse an answer: one cause at 2 to 32 times the detectable size, and large starts.

The same model writes and judges (crime=True); rates with truth from the FEM: `docs/diagnosis_limits.md`.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.detectable_sizes import smallest
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.diagnosis.whole_sizes import _averaged
from cdpr_struct.hypotheses.alternatives import Offered, offered
from cdpr_struct.hypotheses.budget import BUDGETS
from cdpr_struct.hypotheses.causes.cause import Pattern
from cdpr_struct.hypotheses.hypothesis import SCALES, Hypothesis
from cdpr_struct.hypotheses.judge import Judged, judged
from cdpr_struct.hypotheses.scan import carriers
from cdpr_struct.hypotheses.search import Search
from cdpr_struct.inference.screening import Screen
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.robot import Robot
from tests.laws.written_campaigns import cogiro, extended, noisy, plan_of, written

MULTIPLES = (2.0, 4.0, 8.0, 16.0, 32.0)
CABLE = 2


def stiffer(size: float) -> Robot:
    """One cable has another EA, by `size` of ln EA."""
    cables = list(cogiro().cables)
    cables[CABLE] = replace(cables[CABLE], axial_stiffness=np.exp(size) * cables[CABLE].axial_stiffness)
    return replace(cogiro(), cables=tuple(cables))


def heavier(size: float) -> Robot:
    return cogiro().with_load(mass=cogiro().platform.mass * np.exp(size))


def biased(size: float) -> Robot:
    return extended(cogiro(), cell_bias=size * np.eye(8)[CABLE])


def longer(size: float) -> Robot:
    return extended(cogiro(), length_offset=size * np.eye(8)[CABLE])


CAUSES: dict[str, tuple[Callable[[float], Robot], str, float]] = {
    "axial_stiffness": (stiffer, "cable 3 alone", 1.4),
    "platform_mass": (heavier, "", 1.0),
    "load_cell_bias": (biased, "cable 3 alone", 400.0),
    "unstrained_length_offset": (longer, "cable 3 alone", 0.3),
}
"""Robot with an error of a size, pattern, and the largest size that a robot can have: ratios of 4 and 2.7, N, m."""


def campaign_of(robot: Robot, vibrating: tuple[int, ...] = ()) -> Campaign:
    return noisy(written(robot, plan_of(cogiro(), 6, robot_in=vibrating, modes=16), cogiro()), 11)


def menu_of(campaign: Campaign) -> tuple[Search, list[Offered], Judged]:
    """A search with the menu of its causes about nothing wrong."""
    search = Search(recorded(campaign), BUDGETS["small"])
    null = judged(search.data, search.where, Hypothesis())
    return search, offered(search.data, search.where, search.seen, search.causes, null), null


def detectable(name: str, vibrating: tuple[int, ...] = ()) -> float:
    """The smallest size of a cause in its pattern that a sound campaign of this plan would show, in theta."""
    _, menu, null = menu_of(campaign_of(cogiro(), vibrating))
    cause = next(one for one in menu if one.cause.name == name)
    pattern: Pattern = next(p for p in cause.patterns if p.label == CAUSES[name][1])
    columns = [part @ pattern.basis * pattern.prior for part in cause.columns]
    found = smallest(pattern, Screen.of(null.model, null.fit.noise, null.fit.soft).screened(columns).gram)
    value = float(found["value"])
    return float(np.log1p(value)) if pattern.parameters[0].ratio else value


def grade(said: Diagnosis, name: str) -> int:
    """3 named alone in its pattern, 2 named, 1 in a class, 0 else."""
    if not any(name in names for names in said.decision.classes):
        return 0
    if said.decision.classes != ((name,),) or said.decision.status != "named":
        return 1
    return 2 + (said.chosen.hypothesis.parts[0].pattern.label == CAUSES[name][1])


def test_an_error_of_32_times_the_detectable_size_has_the_best_answer():
    """Every day, statics alone. Outliers of all readings of a cell, of 345 N, could stand for its bias."""
    size = 32.0 * detectable("load_cell_bias")
    large = diagnosed(campaign_of(biased(size)))
    assert grade(large, "load_cell_bias") == 3
    (value,) = large.sizes[0].parameters.values()
    assert abs(value["value"] - size) < 3.0 * value["sigma"]


@pytest.mark.slow
@pytest.mark.parametrize("vibrating", [(), (0, 1, 2)], ids=["statics", "with frequencies"])
@pytest.mark.parametrize("name", CAUSES)
def test_the_answer_does_not_get_worse_with_the_size(name, vibrating):
    make, _, largest = CAUSES[name]
    sizes = [multiple * detectable(name, vibrating) for multiple in MULTIPLES]
    sizes = [size for size in sizes if size < largest]
    grades = [grade(diagnosed(campaign_of(make(size), vibrating)), name) for size in sizes]
    assert grades == sorted(grades), dict(zip(sizes, grades, strict=True))


def test_a_large_change_of_one_cable_is_begun_at_that_cable():
    """EA of one cable +40 %: peaks near wrong modes do not hide which cable it is, as frequencies are solved anew."""
    search, menu, null = menu_of(campaign_of(stiffer(np.log(1.4)), (0, 1, 2)))
    own = [one for one in menu if one.cause.name == "axial_stiffness"]
    best = carriers(search.data, own, null)[0]
    assert best.part.pattern.label == "cable 3 alone"
    assert float(best.part.scale * best.z[0] * best.part.pattern.prior[0]) == pytest.approx(np.log(1.4), abs=0.1)


def test_a_size_is_averaged_over_the_scales():
    """Against quadrature of the mixture of priors. A scale too small draws a size towards nothing, the mean less."""
    said, spread, scale = 2.6, 0.25, 0.5
    scales = np.array(SCALES) / scale
    z = np.linspace(-10.0, 30.0, 200_001)
    density = sum(np.exp(-0.5 * (z / s) ** 2) / s for s in scales) * np.exp(-0.5 * ((z - said) / spread) ** 2)
    mean = (density @ z) / density.sum()
    variance = (density @ (z - mean) ** 2) / density.sum()
    under_one = 1.0 / (1.0 + 1.0 / spread**2)
    found = _averaged(said / spread**2 * under_one, under_one, scales)
    assert found == pytest.approx((mean, variance), rel=1e-9)
    assert said > found[0] > said / spread**2 * under_one
