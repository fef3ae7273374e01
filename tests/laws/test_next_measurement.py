"""What a diagnosis says is to be measured next: simulated for the causes it leaves open, at their fitted sizes."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis import next_measurement as following
from cdpr_struct.diagnosis.diagnose import diagnose
from cdpr_struct.diagnosis.verdict import verdict
from tests.laws.crime_campaign import hidden

MASSES = ("platform_mass", "joint_mass")


@pytest.fixture(scope="module")
def found():
    """A platform that is too heavy, without robot frequencies: its joints may be."""
    return diagnose(hidden(lambda world: world.times(mass=np.asarray(1.03))))


@pytest.fixture(scope="module")
def question(found):
    (asked,) = following._questions(found, (MASSES,))
    return asked


def test_causes_left_open_are_asked_for_at_their_fitted_sizes(found, question):
    assert question.pairs == [MASSES]
    for name, (choice, theta) in question.sized.items():
        assert choice.candidate.name == name
        moved = choice.signature @ theta
        assert 0.5 < -(moved @ found.ground.z) / (moved @ moved) < 2.0  # the size that explains the data


def test_the_scales_are_proposed_for_a_class_of_masses(found):
    said = verdict(found)
    assert set(MASSES) <= {name for names in said.classes for name in names}
    first = said.next_measurement.split(";")[0]
    assert first.startswith("weigh the ")
    assert "expected to separate platform mass from" in first
    assert first.endswith(" nats")


def test_what_a_measurement_adds_grows_with_the_square_of_the_effect(found, question):
    """Half the size, a quarter of the nats, whichever of the two is true."""
    half = replace(question, sized={n: (choice, 0.5 * theta) for n, (choice, theta) in question.sized.items()})
    rows = dict((text, rows) for text, _, rows in following._measurements(found.ground, [question]))[
        "weigh the joints (+-0.01 kg)"
    ]
    whole, part = (following._Both(found.ground, q).gains(rows)[MASSES] for q in (question, half))
    assert whole > following.APART
    assert part == pytest.approx(0.25 * whole, rel=0.02)


def test_where_nothing_simulated_separates_the_hint_is_what_is_left(found, question, monkeypatch):
    monkeypatch.setattr(following, "_measurements", lambda *_: [])
    said = following.next_measurement(found, (MASSES,))
    assert said.startswith("no measurement that was simulated tells platform mass from joint mass (perhaps ")
    assert found.ground.candidates
    assert said.endswith("weighing it or a payload series)")


def test_a_second_measurement_is_for_what_the_first_leaves_open(found):
    def worth(text, aside, *nats):
        return following.Worth(text, aside, dict(zip([("a", "b"), ("a", "c")], nats, strict=True)))

    pairs = [("a", "b"), ("a", "c")]
    scales, tilts = worth("scales", True, 14.0, 0.1), worth("tilts", False, 1.0, 6.0)
    assert scales.on(pairs) == following.ENOUGH
    assert following._words(scales, pairs) == "scales: expected to separate a from b by 14 nats"
    assert following._words(tilts, pairs) == "tilts: expected to separate a from c by 6 nats"


def test_what_nothing_tells_apart_is_listed_once():
    """Three pairs of three causes are three causes; two of them are pairs."""
    pairs = [("a_a", "b"), ("a_a", "c"), ("b", "c")]
    assert following._told(pairs) == "a a, b and c apart"
    assert following._told(pairs[:2]) == "a a from b nor a a from c"
    assert following._told(pairs[:1]) == "a a from b"


def test_what_was_checked_is_not_proposed_again(found, question):
    """Weighing the joints, once they have been weighed; the platform still may be."""
    campaign = replace(found.ground.setting.campaign, checked={"joint_mass": 0.01})
    ground = replace(found.ground, setting=replace(found.ground.setting, campaign=campaign))
    texts = {text for text, _, _ in following._measurements(ground, [question])}
    assert "weigh the platform (+-0.1 kg)" in texts
    assert "weigh the joints (+-0.01 kg)" not in texts


def test_measurements_are_added_until_every_pair_is_told_apart_or_named():
    """Three at most; one that adds a little to several pairs and tells none of them apart is none."""
    pairs = [("a", "b"), ("a", "c"), ("a", "d"), ("a", "e")]

    def worth(text, *nats):
        return following.Worth(text, False, dict(zip(pairs, nats, strict=True)))

    some = [worth("scales", 9.0, 0.0, 0.0, 0.0), worth("tilts", 0.0, 6.0, 0.0, 0.0), worth("a bit", 1.9, 1.9, 1.9, 1.9)]
    gauges, survey = worth("gauges", 0.0, 0.0, 5.0, 0.0), worth("survey", 0.0, 0.0, 0.0, 4.0)
    assert following._proposed([*some, gauges, survey], pairs) == [
        "scales: expected to separate a from b by 9 nats",
        "and tilts: expected to separate a from c by 6 nats",
        "and gauges: expected to separate a from d by 5 nats",
        "these do not tell a from e",
    ]
    assert following._proposed(some, pairs[:2])[1:] == ["and tilts: expected to separate a from c by 6 nats"]
    assert following._proposed(some[:1], pairs[:1]) == ["scales: expected to separate a from b by 9 nats"]
