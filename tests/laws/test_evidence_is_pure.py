"""Evidence depends on what was read and on nothing else: gaps, orders, budgets (crime=True)."""

from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest

from cdpr_struct.diagnosis.whole_sizes import whole_sizes
from cdpr_struct.hypotheses.budget import BUDGETS
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.hypothesis import Hypothesis, Part
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.hypotheses.search import Search
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.written_campaigns import lighter, measured, noisy, plan_of, with_states, written

SETTLED = 0.01  # nats: a point of linearisation within a fifth of a sigma is where it was
SLOW = pytest.mark.slow


@cache
def searched(campaign: Campaign, budget: str = "small") -> Search:
    search = Search(recorded(campaign), BUDGETS[budget])
    search.run()
    return search


@cache
def wrong_mass() -> Campaign:
    """Mass at five detectable sizes, time unknown."""
    campaign = measured(lighter(5.0), 5)
    return with_states(campaign, time=np.full(len(campaign.states.names), np.nan))


def mass_of(search: Search) -> tuple[float, float]:
    best = search.answers()[0].best
    assert best.hypothesis.names == ("platform_mass",)
    (size,) = whole_sizes(search.data, search.seen, best)
    return float(size.mean[0]), float(size.sigma[0])


def without(**gaps: tuple) -> Campaign:
    """Readings struck out, each by an index."""
    campaign = wrong_mass()
    changed = {}
    for name, index in gaps.items():
        changed[name] = getattr(campaign.states, name).copy()
        changed[name][index] = np.nan
    return with_states(campaign, **changed)


@pytest.mark.parametrize(
    "gaps",
    [
        pytest.param({"tension": ([0, 2, 4], [1, 5, 3])}, marks=SLOW),
        pytest.param({"tension": (slice(None), 4)}, marks=SLOW),
        pytest.param({"angles": (3,)}, marks=SLOW),
        pytest.param({"length": (slice(None), 2)}, marks=SLOW),
        {"tension": (2, 1), "angles": (4,), "length": (5, slice(0, 3))},
    ],
    ids=["single cells", "a cable without cell", "a pose without rotation", "lengths of a cable", "some of each"],
)
def test_what_was_not_read_changes_no_verdict(gaps):
    whole, whole_sigma = mass_of(searched(wrong_mass()))
    value, sigma = mass_of(searched(without(**gaps)))
    assert abs(value - whole) < sigma
    assert sigma >= 0.999 * whole_sigma
    assert sigma < 1.5 * whole_sigma


def test_a_state_with_nothing_but_a_pose_adds_nothing():
    """It shifts all evidence by the same constant."""
    campaign = wrong_mass()
    states = {}
    for field in fields(campaign.states):
        value = getattr(campaign.states, field.name)
        states[field.name] = (*value, "bare") if isinstance(value, tuple) else np.concatenate([value, value[1:2]])
    states["tension"][-1] = states["length"][-1] = np.nan
    states["position"][-1] += 0.1
    states["lock"][-1] = -1
    before, after = searched(campaign), searched(with_states(campaign, **states))
    assert mass_of(after) == pytest.approx(mass_of(before), rel=1e-3)
    keys = [key for key in before.found if key[-1] is None and key in after.found]  # a drift goes with the states
    assert len(keys) > 2
    shift = [after.found[key].log_evidence - before.found[key].log_evidence for key in keys]
    assert np.ptp(shift) < SETTLED


def reordered(rows, order: np.ndarray):
    """A table with its rows in another order."""
    picked = {}
    for field in fields(rows):
        value = getattr(rows, field.name)
        if isinstance(value, tuple):
            picked[field.name] = tuple(value[i] for i in order)
        else:
            picked[field.name] = value[order] if len(value) else value
    return replace(rows, **picked)


def test_evidence_does_not_depend_on_the_order_of_states():
    campaign = wrong_mass()
    order = np.array([3, 0, 5, 1, 6, 2, 4])
    first, other = searched(campaign), searched(replace(campaign, states=reordered(campaign.states, order)))
    keys = [key for key in first.found if key[-1] is None]  # a drift goes with the order
    assert len(keys) > 3
    for key in keys:
        assert other.found[key].log_evidence == pytest.approx(first.found[key].log_evidence, abs=SETTLED), key


def test_evidence_does_not_depend_on_the_order_of_causes():
    first = searched(wrong_mass())
    before = dict(LIBRARY)
    try:
        LIBRARY.clear()
        LIBRARY.update(sorted(before.items(), key=lambda item: item[0][::-1]))
        other = Search(recorded(wrong_mass()), BUDGETS["small"])
        other.run()
    finally:
        LIBRARY.clear()
        LIBRARY.update(before)
    assert set(other.found) == set(first.found)
    for key, one in first.found.items():
        assert other.found[key].log_evidence == pytest.approx(one.log_evidence, abs=1e-6), key


def test_evidence_does_not_depend_on_the_order_of_frequencies():
    robot = load_robot("thesis-3-1")
    plan = plan_of(robot, 2, cables_in=(0, 1), robot_in=(0, 1), modes=8)
    campaign = noisy(written(robot, plan), 11)
    generator = np.random.default_rng(1)
    cables, peaks = campaign.cable_frequencies, campaign.robot_frequencies
    order = generator.permutation(len(peaks.hertz))
    kept = {name: getattr(peaks, name)[order] for name in ("state", "hertz", "sigma")}
    mixed = replace(
        campaign,
        cable_frequencies=reordered(cables, generator.permutation(len(cables.hertz))),
        robot_frequencies=replace(peaks, **kept),
    )
    assert evidences(mixed) == pytest.approx(evidences(campaign), abs=1e-5)


def evidences(campaign: Campaign) -> list[float]:
    """Of nothing wrong, and of a wrong EA of all cables."""
    data = recorded(campaign)
    cause = LIBRARY["axial_stiffness"]
    pattern = next(p for p in cause.patterns(seen_in(data)) if p.label == "all alike")
    hypotheses = [Hypothesis(), Hypothesis((Part(cause, pattern, 1.0),))]
    return [judged(data, layout(data), one).log_evidence for one in hypotheses]


def test_a_larger_budget_never_finds_less():
    small, full = searched(wrong_mass()), searched(wrong_mass(), "full")
    assert max(a.score for a in full.answers()) >= max(a.score for a in small.answers()) - 1e-9
    for key, one in small.found.items():
        assert full.found[key].log_evidence >= one.log_evidence - 1e-6, key
