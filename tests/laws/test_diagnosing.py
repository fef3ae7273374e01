"""From small campaigns to a decision, every day. The same model writes and judges (crime=True), noise is drawn here.

These hold laws of the arithmetic and catch what breaks; what a diagnosis is worth is measured in `tests/blind`.
"""

from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.diagnosis.hypotheses.library import LIBRARY
from cdpr_struct.diagnosis.hypothesis import Hypothesis, Part
from cdpr_struct.diagnosis.judge import judged
from cdpr_struct.diagnosis.layout import layout
from cdpr_struct.diagnosis.recorded import recorded
from cdpr_struct.diagnosis.search import BUDGETS, Search
from cdpr_struct.diagnosis.seen import seen_in
from cdpr_struct.diagnosis.whole_sizes import whole_sizes
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.written_campaigns import SIGMA_LENGTH, SIGMA_TENSION, extended, noisy, plan_of, written

OFFSETS = 8e-3 * np.array([1.0, -1.0, 0.5, -0.5, 1.0, 0.3, -0.7, 0.2])
MASS = 0.0092  # relative: the platform's smallest detectable error in these campaigns, as the diagnosis itself says
SETTLED = 0.01  # nats: a point of linearisation within a fifth of a sigma is where it was

SLOW = pytest.mark.slow


@cache
def cogiro() -> Robot:
    return load_robot("cogiro")


def measured(robot: Robot, seed: int) -> Campaign:
    """Six poses and one more load at the first one's lengths; CoGiRo is entered."""
    return noisy(written(robot, plan_of(cogiro(), 6, loads=(40.0,)), cogiro()), seed)


def lighter(times_detectable: float) -> Robot:
    return cogiro().with_load(mass=cogiro().platform.mass * (1.0 - MASS * times_detectable))


def softer(robot: Robot, cable: int, factor: float) -> Robot:
    """One cable has another EA."""
    cables = list(robot.cables)
    cables[cable] = replace(cables[cable], axial_stiffness=factor * cables[cable].axial_stiffness)
    return replace(robot, cables=tuple(cables))


def with_states(campaign: Campaign, **changed: np.ndarray) -> Campaign:
    return replace(campaign, states=replace(campaign.states, **changed))


def assert_named(said: Diagnosis, *causes: str) -> None:
    assert said.decision.status == "named", said.decision
    assert sorted(said.decision.classes) == sorted((name,) for name in causes)
    assert sorted(said.chosen.hypothesis.names) == sorted(causes)


def value_of(said: Diagnosis, parameter: str) -> tuple[float, float]:
    """Value and sigma of the best candidate."""
    rows = {name: row for size in said.candidates[0].sizes for name, row in size.parameters.items()}
    return rows[parameter]["value"], rows[parameter]["sigma"]


def exchanged(campaign: Campaign, i: int, j: int) -> Campaign:
    order = np.arange(len(campaign.robot.cables))
    order[[i, j]] = j, i
    return with_states(campaign, tension=campaign.states.tension[:, order])


NAMED_IN_DOUBT = pytest.mark.xfail(strict=True, reason="a cause is named that is there with probability 0.66")


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=SLOW), pytest.param(3, marks=NAMED_IN_DOUBT)])
def test_clean_readings_give_no_cause(seed):
    said = diagnosed(measured(cogiro(), seed))
    assert said.decision.status == "adequate"
    assert said.p_value > 0.05
    assert not said.set_aside
    assert said.correction is None
    assert all(one.gain < 0.0 for one in said.candidates)


@pytest.mark.parametrize(("poses", "modes"), [(3, 8), (2, 7)], ids=["as many modes", "one mode more"])
def test_clean_readings_with_frequencies_give_no_cause(poses, modes):
    robot = load_robot("thesis-3-1")
    plan = plan_of(robot, poses, cables_in=(0,), robot_in=(1,), modes=modes)
    said = diagnosed(noisy(written(robot, plan), 4))
    assert said.decision.status == "adequate"
    assert not said.set_aside


@pytest.mark.xfail(strict=True, reason="tensions set aside as outliers hide the exchange: handling is not even tried")
@pytest.mark.parametrize("pair", [(0, 1), pytest.param((3, 7), marks=SLOW)])
def test_exchanged_load_cells_are_found(pair):
    said = diagnosed(exchanged(measured(cogiro(), 4), *pair))
    assert said.decision.classes == (("swapped_channels",),)
    assert said.correction.parameters == {"first": pair[0] + 1, "second": pair[1] + 1}
    assert not said.set_aside


@pytest.mark.parametrize("times_detectable", [2.0, 4.0, 8.0, 16.0])
def test_a_mass_stays_right_however_wrong_it_is(times_detectable):
    """At twice the detectable size among others, from four times on by its name; held-out states are predicted."""
    robot = lighter(times_detectable)
    said = diagnosed(measured(robot, 5))
    assert any("platform_mass" in names for names in said.decision.classes)
    assert said.decision.probability > 0.9
    value, sigma = value_of(said, "platform_mass")
    assert abs(value - robot.platform.mass / cogiro().platform.mass) < 3.0 * sigma
    assert sigma < 0.003
    assert said.left_out.ratio(said.left_out.concerned) > 2.0
    if times_detectable >= 4.0:
        assert_named(said, "platform_mass")


def test_the_elasticity_of_one_cable_is_named_with_its_cable_and_size():
    said = diagnosed(measured(softer(cogiro(), 2, 0.6), 6))
    assert_named(said, "axial_stiffness")
    assert said.chosen.hypothesis.parts[0].pattern.label == "cable 3 alone"
    value, sigma = value_of(said, "axial_stiffness_3")
    assert abs(value - 0.6) < 3.0 * sigma
    assert said.left_out.ratio(said.left_out.concerned) > 2.0


def test_two_causes_together_are_both_named():
    said = diagnosed(measured(extended(lighter(5.0), length_offset=OFFSETS), 7))
    assert_named(said, "platform_mass", "unstrained_length_offset")
    value, sigma = value_of(said, "platform_mass")
    assert abs(value - (1.0 - 5.0 * MASS)) < 3.0 * sigma
    found = [value_of(said, f"length_offset_{i}") for i in range(1, 9)]
    assert all(abs(v - true) < 4.0 * s for (v, s), true in zip(found, OFFSETS, strict=True))


@pytest.mark.xfail(strict=True, reason="a second cause with a rival is not spoken of, and the fit chosen lacks it")
def test_a_second_cause_that_is_sure_is_in_the_fit_that_is_chosen():
    """Mass, and the elasticity of a cable that compliance in line may be in 5 of 100: 33 nats against mass alone."""
    said = diagnosed(measured(softer(lighter(5.0), 2, 0.6), 7))
    assert len(said.decision.classes) == 2
    assert said.chosen.score > said.candidates[0].best.score - 3.0


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=SLOW)])
def test_a_drift_of_load_cells_is_no_cause(seed):
    """A random walk, six newtons wide at the end."""
    campaign = measured(cogiro(), seed + 8)
    tension = campaign.states.tension
    steps = np.random.default_rng(seed).normal(size=tension.shape)
    walk = 3.0 * SIGMA_TENSION * np.cumsum(steps, axis=0) / np.sqrt(len(steps))
    said = diagnosed(with_states(campaign, tension=tension + walk - walk[0]))
    assert said.decision.status == "adequate"
    assert said.null.hypothesis.drift > 0.0


@pytest.mark.parametrize(
    ("kind", "row", "cable", "error"),
    [
        ("tension", 3, 4, 20.0 * SIGMA_TENSION),
        pytest.param("length", 2, 5, -20.0 * SIGMA_LENGTH, marks=SLOW),
    ],
)
def test_an_outlier_is_set_aside_and_said_to_be_one(kind, row, cable, error):
    campaign = measured(cogiro(), 9)
    values = getattr(campaign.states, kind).copy()
    values[row, cable] += error
    said = diagnosed(with_states(campaign, **{kind: values}))
    assert said.decision.status == "adequate"
    (one,) = said.set_aside
    assert (one.kind, one.case, one.cable) == (kind, f"s{row}", cable)
    assert one.sigmas == pytest.approx(20.0, abs=4.0)
    assert one.gain > 50.0


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
        {"tension": ([0, 2, 4], [1, 5, 3])},
        {"tension": (slice(None), 4)},
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


def test_lengths_of_some_cables_at_a_loaded_pose_can_be_diagnosed_to_the_end():
    assert_named(diagnosed(without(length=(slice(None), 2))), "platform_mass")


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
    keys = [key for key in before.found if key[-1] == 0.0 and key in after.found]  # a drift goes with the states
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
    keys = [key for key in first.found if key[-1] == 0.0]  # a drift goes with the order
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
