"""The printed limits on trial: what is missing, with evidence that anyone can measure again."""

import dataclasses
import json
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import cdpr_struct.crosscheck.limits_errors as errors
import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.limits_causes import candidates, causes_of, rounded_down, sample_groups
from cdpr_struct.crosscheck.limits_closed_form import closed_form_planes
from cdpr_struct.crosscheck.limits_domain import Domain
from cdpr_struct.crosscheck.limits_errors import Samples, measure
from cdpr_struct.crosscheck.limits_groups import CableGroups, inside_printed_limits
from cdpr_struct.crosscheck.limits_referee import hang
from cdpr_struct.crosscheck.limits_reference import EFFECTS, CablePlanes, Effects, Plane
from cdpr_struct.crosscheck.limits_sweep import take
from cdpr_struct.crosscheck.limits_trial import SMALL_EXTENT, Extent, step_count, try_limits
from cdpr_struct.crosscheck.limits_veering import veering
from cdpr_struct.crosscheck.validity_limits import crossover_distance
from cdpr_struct.reports.audit_limits_result import limits_trial_json
from cdpr_struct.reports.audit_limits_text import limits_trial_text
from cdpr_struct.reports.plain_json import plain

TINY_EXTENT = Extent(
    Domain(np.array([0.0, 60.0]), np.array([0.05, 0.1]), np.array([0.5, 4.0, 20.0])), random=8, judged=1, curve=12
)


@pytest.fixture(scope="module")
def trial():
    return try_limits(SMALL_EXTENT)


@pytest.fixture(scope="module")
def result(trial):
    return json.loads(json.dumps(plain(limits_trial_json(trial))))


def rebuilt(evidence) -> CableGroups:
    return CableGroups.of(evidence["alpha_deg"], evidence["epsilon"], evidence["lambda2"])


def test_limits_are_missing_and_their_evidence_is_reproducible(result):
    assert len(result["missing_limits"]) >= 3
    for limit in result["missing_limits"]:
        evidence = limit["evidence"]
        groups = rebuilt(evidence)
        again = measure(groups)[limit["quantity"]].error[0, evidence["sample"]]
        assert again == pytest.approx(evidence["error"], rel=1e-6)
        assert again > result["tolerance"]
        assert inside_printed_limits(groups).all()


def test_the_named_cause_makes_the_error(result):
    """Measured again with the effect switched off, the error is less than half; for another effect it is not."""
    single = [limit for limit in result["missing_limits"] if limit["cause"] in EFFECTS]
    assert single
    for limit in single:
        evidence = limit["evidence"]
        effects = Effects(**{limit["cause"]: False})
        without = measure(rebuilt(evidence), effects)[limit["quantity"]].error[0, evidence["sample"]]
        assert without < 0.5 * evidence["error"]
        others = [e for e in EFFECTS if e != limit["cause"]]
        assert max(evidence["error_with_effect_switched_off"][e] for e in others) > 0.5 * evidence["error"]


def test_further_limits_exclude_every_error_of_the_grid(trial):
    admitted = np.flatnonzero(trial.inside)
    for quantity, samples in take(trial.measured, admitted).items():
        values = sample_groups(trial.groups.take(admitted), samples)
        kept = np.ones(samples.error.shape, dtype=bool)
        for limit in (m.limit for m in trial.missing if m.quantity == quantity):
            kept &= values[limit.parameter] < limit.threshold
        assert not (samples.error[kept] > trial.tolerance).any(), quantity


def test_inside_limits_names_the_worst(result):
    inside = result["inside_limits"]
    worst = inside["worst"]
    again = measure(rebuilt(worst))[worst["quantity"]].error[0, worst["sample"]]
    assert inside["max_relative_error"] == pytest.approx(again, rel=1e-6)
    assert inside["max_relative_error"] == max(
        v["error"] for q, v in inside["by_quantity"].items() if q != "mode_shape"
    )


def test_referee_stands_behind_the_catenary(trial):
    for verdict in trial.verdicts:
        assert verdict.catenary < 2.0 * verdict.uncertainty
        assert verdict.stiffness < 5e-3


def both_ends(plane: Plane) -> Plane:
    fields = {name: np.repeat(getattr(plane, name), 2, axis=1) for name in ("static", "coupling", "end_mass")}
    return dataclasses.replace(plane, **fields)


def closed_form_as_judge(groups, stations, effects=None) -> CablePlanes:
    planes = closed_form_planes(groups, stations)
    return CablePlanes(both_ends(planes.in_plane), both_ends(planes.across))


def stiffness_from_modes(groups, frequency):
    planes = closed_form_planes(groups, np.array([0.5]))
    return planes.in_plane.stiffness(frequency)[:, 0], planes.across.stiffness(frequency)[:, 0, :, 0, 0]


def test_a_closed_form_that_were_exact_would_be_acquitted(monkeypatch):
    """Twin: with the closed form as its own judge nothing is missing."""
    monkeypatch.setattr(errors, "reference_planes", closed_form_as_judge)
    monkeypatch.setattr(errors, "closed_form_stiffness", stiffness_from_modes)
    acquitted = try_limits(TINY_EXTENT)
    assert acquitted.holds
    assert "NOT SUFFICE" not in limits_trial_text(acquitted)


def test_search_finds_the_planted_limit():
    random = np.random.default_rng(1)
    values = {"strain": random.uniform(0, 1, (500, 1)), "epsilon": random.uniform(0, 1, (500, 1))}
    bad = values["strain"] > 0.7
    found = candidates(values, bad, ~bad, np.ones(500))
    assert found[0].parameter == "strain"
    assert found[0].threshold == pytest.approx(0.7, abs=0.01)
    assert found[0].cost < 0.03
    assert found[1].cost > 0.5


def test_cause_is_the_effect_whose_removal_helps():
    error = np.array([[0.02, 0.02, 0.02, 0.005]])
    samples = Samples("q", error, error, np.full(4, np.nan), np.full(4, -1), ("a",) * 4)
    without = {name: error.copy() for name in EFFECTS} | {"all": np.full((1, 4), 1e-4)}
    without["axial_inertia"][0, 0] = 0.001
    without["all"][0, 2] = 0.019
    assert causes_of(samples, without, error > 0.01).tolist() == [[1, 4, 3, -1]]


def test_thresholds_are_rounded_to_the_safe_side():
    values = [0.01299, 0.1, 3.27, 0.0, np.nextafter(0.2, 0.0)]
    assert [rounded_down(v) for v in values] == pytest.approx([0.012, 0.1, 3.2, 0.0, 0.19])
    assert all(rounded_down(v) <= v for v in np.random.default_rng(0).lognormal(0.0, 4.0, 1000))


def test_frequencies_cross_when_horizontal_and_veer_when_inclined():
    flat, steep = veering(0.0, 0.1, 60), veering(60.0, 0.1, 60)
    assert flat.gap < 2e-3
    assert steep.gap == pytest.approx(0.057, abs=1e-3)
    assert flat.mode_shape_error.max() < 1e-3
    assert steep.mode_shape_error.max() > 0.4


def test_fem_sees_the_gap_of_the_inclined_cable():
    steep = veering(60.0, 0.1, 60)
    groups = CableGroups.of(60.0, 0.1, steep.gap_at)
    first = []
    for elements in (40, 80, 160):
        modes = fem.cable_modes(hang(groups, elements, upwards=True), 6)
        in_plane = modes.frequencies_hz[modes.in_plane_share > 0.5]
        first.append(in_plane[1] / in_plane[0] - 1.0)
    assert fem.extrapolate((40, 80, 160), first).limit == pytest.approx(steep.gap, rel=1e-4)


def test_strictness_knows_that_lambda_alone_costs_no_frequency(trial):
    """Away from the crossovers no refused cable is off by 1 %, up to lambda^2 = 100."""
    row = next(s for s in trial.strict if (s.parameter, s.quantity) == ("lambda2", "in_plane_frequency"))
    assert row.refused > 0
    assert row.good == pytest.approx(1.0)
    assert row.instead is None
    shapes = next(s for s in trial.strict if (s.parameter, s.quantity) == ("crossover_distance", "mode_shape"))
    assert shapes.good < 0.7


def test_threads_change_nothing_and_the_bar_never_overruns():
    calls = []
    with ThreadPoolExecutor(2) as pool:
        threaded = try_limits(TINY_EXTENT, 0.01, pool, calls.append)
    alone = try_limits(TINY_EXTENT)
    assert not alone.holds
    assert all((threaded.measured[q].error == s.error).all() for q, s in alone.measured.items())
    assert 0 < len(calls) <= step_count(TINY_EXTENT)


def test_rule_of_the_docs_keeps_frequencies_and_shapes():
    """docs/limits.md: strain, epsilon tan(alpha) and crossovers in place of the print, any lambda^2 and inclination."""
    random = np.random.default_rng(4)
    drawn = CableGroups.of(
        random.uniform(0.0, 87.0, 4000),
        np.exp(random.uniform(np.log(0.003), np.log(0.24), 4000)),
        np.exp(random.uniform(np.log(0.05), np.log(500.0), 4000)),
    )
    kept = (drawn.strain < 0.02) & (drawn.along < 0.05) & (crossover_distance(drawn.lambda_squared) > 0.2)
    found = measure(drawn.take(np.flatnonzero(kept)[:150]))
    assert max(found[q].error.max() for q in ("in_plane_frequency", "across_frequency")) < 0.01
    assert (found["mode_shape"].error.max(axis=1) > 0.01).mean() < 0.02
    refused = measure(drawn.take(np.flatnonzero((drawn.strain > 0.025) & (drawn.strain < 0.1))[:50]))
    assert (refused["across_frequency"].error.max(axis=1) > 0.01).all(), "the limit on strain is not idle"
