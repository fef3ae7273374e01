"""How many causes are looked for: two where both are there, one where nothing more can be gained."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis import ranking, stray_peaks
from cdpr_struct.diagnosis import refit as refitting
from cdpr_struct.diagnosis.evidence import choices
from cdpr_struct.diagnosis.prepared import BUDGETS, prepare
from cdpr_struct.diagnosis.ranking import Search
from cdpr_struct.diagnosis.refit import refit, settled
from cdpr_struct.diagnosis.selection import FURTHER, select
from cdpr_struct.diagnosis.world import World
from tests.laws.crime_campaign import hidden, with_robot_frequencies


def two_causes(world):
    """All cables 6 % softer than entered, and the second load cell 12 N too high."""
    return world.plus(cell_bias=12.0 * np.eye(world.cables)[1], series_compliance=np.full(world.cables, 1.2e-5))


@pytest.fixture(scope="module")
def ground():
    return prepare(hidden(two_causes), BUDGETS["small"]).ground


@pytest.fixture(scope="module")
def selected(ground):
    """Causes selected in that ground, with their rivals."""
    return select(Search(ground), FURTHER, 2)


def test_two_causes_are_found(selected):
    names = selected.fit.names
    assert "load_cell_bias" in names
    assert set(names) & {"joint_compliance", "dead_length", "axial_stiffness"}


def test_rivals_are_those_that_do_the_same(selected):
    """What cables all alike softer do, other softness does as well; what one cell's zero does, only its gain does."""
    soft = {"joint_compliance", "dead_length", "axial_stiffness", "temperature", "drum_scale"}
    for name, rivals in zip(selected.fit.names, selected.rivals, strict=True):
        near = {fit.names[-1] for fit in rivals if fit.gain > selected.fit.gain - 5.0}
        assert near
        assert near <= ({"load_cell_gain"} if name == "load_cell_bias" else soft - {name})


@pytest.mark.parametrize("seen", [(0,), pytest.param((0, 1), marks=pytest.mark.slow)])
def test_second_causes_are_all_held_against_the_same_null(seen):
    """Those too far off to be settled, too: what peaks paired more freely bring the null is none of theirs."""
    campaign = hidden(two_causes)
    truth = two_causes(World.of(campaign.robot, len(campaign.states.names)))
    near = prepare(with_robot_frequencies(campaign, seen, truth), BUDGETS["small"]).ground
    worse = replace(near, level=near.level + 100.0)
    first = Search(near).rank()[0].choices
    gains, against_worse = ({fit.names: fit.gain for fit in Search(one).rank(first)} for one in (near, worse))
    assert len(gains) > 3
    assert against_worse == pytest.approx({names: gain + 100.0 for names, gain in gains.items()})


def test_no_second_cause_is_sought_where_a_law_outside_the_library_is_far_better(ground, selected):
    both = selected.fit
    assert len(select(Search(ground), FURTHER, 2, outside=both.gain + 15.0).fit.names) == 2
    assert len(select(Search(ground), FURTHER, 2, outside=both.gain + 100.0).fit.names) == 1


def test_a_single_candidate_needs_no_second(ground):
    alone = replace(ground, candidates=[c for c in ground.candidates if c.name == "load_cell_bias"])
    assert select(Search(alone), FURTHER, 2).fit.names == ("load_cell_bias",)


@pytest.fixture(scope="module")
def turning():
    """Ground of a platform of one and a half times the entered inertia, seen in its frequencies at two poses."""
    campaign = hidden(lambda world: world)
    world = World.of(campaign.robot, len(campaign.states.names))
    truth = replace(world, inertia=1.5 * world.inertia)
    return prepare(with_robot_frequencies(campaign, (0, 1), truth), BUDGETS["small"]).ground


def test_large_changes_that_leave_more_peaks_are_fitted_only_where_the_best_does_not_explain_everything(
    turning, monkeypatch
):
    search = Search(turning)
    tried = stray_peaks._catching(turning, None)
    best = min(tried, key=lambda trial: trial.strays)
    worse = replace(best, strays=best.strays + 2.0)
    monkeypatch.setattr(stray_peaks, "_catching", lambda ground, before: [worse, best])
    assert turning.strays > 1.5
    assert best.picked.candidate.name == "platform_inertia"
    assert len(stray_peaks.caught(turning, None, search.screened())) == 1
    monkeypatch.setattr(stray_peaks, "clears", lambda fit: False)
    assert len(stray_peaks.caught(turning, None, search.screened())) == 2


def test_no_large_change_is_tried_beside_a_fit_that_explains_everything(turning, monkeypatch):
    tried = []
    monkeypatch.setattr(ranking, "caught", lambda *given: tried.append(given) or [])
    search = Search(turning)
    mass = next(c for c in turning.candidates if c.name == "joint_mass")
    begun = (choices(mass)[0],)
    beside = replace(search.fitted(begun), gain=1e3)
    search.rank(begun, beside)
    assert not tried
    search.rank(begun)
    assert len(tried) == 1


def test_a_fit_keeps_its_tolerances_where_likelier_ones_allow_no_such_world(ground, monkeypatch):
    bias = next(c for c in ground.candidates if c.name == "load_cell_bias")
    fit, anchored, worlds = refit(ground, (choices(bias)[0],)), refitting.anchored, []

    def impossible_at_first(setting, world):
        worlds.append(world)
        if len(worlds) == 1:
            raise ValueError("inertia that no body has")
        return anchored(setting, world)

    monkeypatch.setattr(refitting, "anchored", impossible_at_first)
    kept = settled(ground, fit)
    assert np.isfinite(kept.gain)
    assert len(worlds) == 2
    assert (kept.ground.likeliest == ground.likeliest).all()


def test_a_fit_stands_about_the_tolerances_that_are_likeliest_beside_it():
    """Cables 12 % lighter than entered: the null takes a part for tolerances, the fit gives it back."""
    ground = prepare(hidden(lambda w: w.plus(linear_density=-0.12 * w.linear_density)), BUDGETS["small"]).ground
    density = next(c for c in ground.candidates if c.name == "cable_linear_density")
    alike = next(c for c in choices(density) if c.pattern.label == "all alike" and c.scale == 1.0)
    fit = settled(ground, refit(ground, (alike,)))
    assert np.abs(ground.likeliest).max() > 1.0
    assert np.abs(fit.ground.likeliest).max() < 0.3
    assert np.exp(fit.theta[0] * alike.prior[0]) == pytest.approx(0.88, abs=0.005)
