"""A pair whose members are tried against their rivals, each beside the other."""

from types import SimpleNamespace

import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.diagnosis.recording import moving_parts
from cdpr_struct.hypotheses import search
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.search import Search
from cdpr_struct.measurement.campaign_file import load_campaign
from tests.blind.campaign_files import write_case
from tests.blind.moving_sets import moving_case, moving_kinds
from tests.blind.suite import set_seed


def part(name: str, tuned: bool = False):
    return SimpleNamespace(cause=SimpleNamespace(name=name, tuned=tuned), law=None)


@pytest.mark.parametrize(
    ("parts", "tried"),
    [
        ((part("frame"), part("delay")), [("frame",), ("delay",)]),
        ((part("frame"), part("swing", True)), [("frame",)]),
        ((part("frame"),), []),
    ],
)
def test_each_cause_of_the_best_pair_is_a_base_for_the_rivals_of_the_other(parts, tried, monkeypatch):
    """A cause that adds a mode is fitted near peaks, and is none; a single cause has no other."""
    bases = []
    best = SimpleNamespace(hypothesis=Hypothesis(parts), fit=SimpleNamespace(noise="noise of the pair"))

    def alone(data, where, hypothesis, noise):
        assert noise == "noise of the pair"
        return hypothesis

    monkeypatch.setattr(search, "judged", alone)
    held = SimpleNamespace(
        data=None, where=None, _ranked=lambda: [best], keep=lambda found: found,
        _pairs=lambda base, noise: bases.append(tuple(one.cause.name for one in base.parts)),
    )  # fmt: skip
    Search._exchange(held)
    assert bases == tried


@pytest.mark.parametrize(
    ("names", "first"), [(("sensor_delay", "clock_drift"), 0), (("clock_drift", "sensor_delay"), 1)]
)
def test_what_is_asked_of_a_delay_beside_a_drift_does_not_depend_on_which_was_found_first(names, first):
    """The exchange may find the same pair the other way round; a drift's errors are no function of speed."""
    parts = tuple(SimpleNamespace(cause=LIBRARY[name]) for name in names)
    assert moving_parts(Hypothesis(parts), list(LIBRARY))[0] == first
    assert moving_parts(Hypothesis(), list(LIBRARY)) == []


@pytest.mark.slow
def test_a_delay_hides_behind_a_neighbour_of_the_anchor_no_longer(tmp_path):
    """Case c001 of the set `delays`: the frame anchor of cable 2 and all poses late. Without the exchange the platform
    anchor is named with 0.99, since beside it alone the delay was tried."""
    base = set_seed("delays")
    case = moving_case(moving_kinds(60, base)[0], (base, 1))
    write_case(case, "c001", (base, 1), tmp_path / "campaigns", tmp_path / "sealed")
    said = diagnosed(load_campaign(tmp_path / "campaigns" / "c001" / "campaign.toml"))
    assert {effect["cause"] for effect in case.truth["effects"]} == {"sensor_delay", "frame_anchor_position"}
    assert {names[0] for names in said.decision.classes} == {"sensor_delay", "frame_anchor_position"}
