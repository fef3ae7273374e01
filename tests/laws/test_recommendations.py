"""What is to be measured next, for causes that a diagnosis leaves open at sizes that it has fitted."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from cdpr_struct.diagnosis.decision import Decision
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.hypotheses.budget import BUDGETS
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.hypothesis import Hypothesis, Part
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.hypotheses.search import Answer, Search
from cdpr_struct.measurement.loss import Loss
from cdpr_struct.planning import recommendations as following
from cdpr_struct.planning.recommendations import Question, questions, recommendations
from cdpr_struct.reports.plan.measurements import recommendation_text
from cdpr_struct.residuals.recorded import recorded
from tests.laws.test_plan import clean_campaign

MASSES = ("platform_mass", "joint_mass")


def heavier(share: float, checked=None):
    """Readings of a robot whose platform is heavier than entered, by a share of its mass."""
    campaign = clean_campaign()
    more = share * campaign.robot.platform.mass
    states = campaign.states
    from cdpr_struct.generated.platform import rotation
    from cdpr_struct.statics.inverse_kinematics import inverse

    held = [
        inverse(campaign.robot.with_load(w + more), p, rotation(*a))
        for w, p, a in zip(states.payload, states.position, states.angles, strict=True)
    ]
    tension, length = (np.array([getattr(h, name) for h in held]) for name in ("tensions", "lengths"))
    return replace(campaign, states=replace(states, tension=tension, length=length), checked=checked or {})


def diagnosis(campaign, classes):
    """As much of a diagnosis as matters here: both masses fitted, and a decision."""
    search = Search(recorded(campaign), BUDGETS["small"])
    answers = [Answer((), judged(search.data, search.where, Hypothesis()), 0.0)]
    for name in MASSES:
        cause = LIBRARY[name]
        pattern = next(p for p in cause.patterns(search.seen) if p.label in ("all alike", ""))
        best = judged(search.data, search.where, Hypothesis((Part(cause, pattern, 1.0),)))
        answers.append(Answer((name,), best, best.score - answers[0].best.score))
    answers = sorted(answers, key=lambda a: -a.score)
    status = "named" if all(len(names) == 1 for names in classes) else "class"
    return SimpleNamespace(
        decision=Decision(status, classes, 0.9),
        fitted=Decision(status, classes, 0.9),
        explained=SimpleNamespace(search=search, answers=tuple(answers)),
        chosen=next(a.best for a in answers if a.names == (classes[0][0],)),
    )


@pytest.fixture(scope="module")
def found():
    return diagnosis(heavier(0.03), (MASSES,))


def test_causes_left_open_are_asked_for_at_their_fitted_sizes(found):
    (asked,) = questions(found)
    assert asked.pairs == [MASSES]
    pattern, size = asked.sized["platform_mass"]
    assert np.exp(size @ pattern.prior) == pytest.approx(1.03, abs=0.003)


def test_the_scales_are_recommended_for_a_class_of_masses(found):
    first, *_ = said = recommendations(found)
    assert first.kind == "check"
    assert first.what.check in MASSES
    assert first.separates == MASSES
    assert first.gain_nats > Loss().nats_of_a_class
    assert recommendation_text(said[0]).startswith("weigh the ")
    assert "expected to separate platform mass from joint mass by" in recommendation_text(said[0])


def test_a_named_cause_is_held_against_its_next_rival(found):
    named = diagnosis(heavier(0.03), (("platform_mass",),))
    assert [q.pairs for q in questions(named)] == [[MASSES]]
    adequate = SimpleNamespace(**{**vars(found), "fitted": Decision("adequate", (), 0.9)})
    assert recommendations(adequate) == ()


def test_what_was_checked_is_not_recommended_again():
    """Weighing the joints, once they have been weighed; the platform still may be."""
    campaign = heavier(0.03, {"joint_mass": 0.2})
    said = recommendations(diagnosis(campaign, (MASSES,)))
    assert "joint_mass" not in {one.what.check for one in said}
    assert said[0].what.check == "platform_mass"


@pytest.mark.slow
def test_what_was_weighed_is_not_blamed_for_more_than_the_scale_leaves():
    """A scale of 0.5 % against a platform 10 % heavier than entered: twenty sigmas are not left."""
    said = [diagnosed(heavier(0.1, checked)) for checked in ({}, {"platform_mass": 5e-3})]
    blamed = [{name for names in one.decision.classes for name in names} for one in said]
    assert "platform_mass" in blamed[0]
    assert "platform_mass" not in blamed[1]
    assert said[1].decision.status != "adequate"


def test_what_a_measurement_adds_grows_with_the_square_of_the_effect(found):
    """Half the size, a quarter of the nats, whichever of the two is true."""
    (asked,) = questions(found)
    half = Question({name: (pattern, 0.5 * size) for name, (pattern, size) in asked.sized.items()}, {})
    numbers, information = following._at_hand(found, [asked])
    data = found.explained.search.data
    possible = [one for one in following.checks(data, numbers) if one[0].check == "joint_mass"]
    (whole,), (part,) = (
        following._answer(q, numbers, information, possible, 1, Loss().nats_of_a_class) for q in (asked, half)
    )
    assert part.gain_nats == pytest.approx(0.25 * whole.gain_nats, rel=0.02)
