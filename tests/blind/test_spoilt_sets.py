"""Sets of spoilt campaigns: each way does what it says and nothing else, on the same reality."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from tests.blind.answers import Answer
from tests.blind.campaign_files import write_case
from tests.blind.case_drawing import Case, CaseKind
from tests.blind.catalogue import HANDLING, LAWS, LIBRARY, RARE
from tests.blind.measuring_plan import PlanSize
from tests.blind.scoring import Scored
from tests.blind.sensors import POSE, SIGMA, Noise
from tests.blind.spoiled_peaks import PeakSpoiler, merged
from tests.blind.spoilt_scoring import condition, spoilt_figures, spoilt_page, spoilt_right
from tests.blind.spoilt_sets import (
    IN_SERIES,
    MESSY,
    PEAKS,
    SIZES,
    SpoiltKind,
    group_realities,
    read_case,
    spoilt_kinds,
)
from tests.blind.suite import SET_SEEDS

SMALL = PlanSize(static_states=6, locks=2, loads_per_lock=2, frequency_states=2)
SEED = (11, 4)


def cases_of(ways: tuple[str, ...], statics: bool) -> dict[str, Case]:
    """One null read in all ways by the same sensors."""
    kinds = [SpoiltKind(0, CaseKind("null", statics=statics, size=SMALL), way) for way in ways]
    real = group_realities(kinds, SEED)[kinds[0].reality]
    return {kind.way: read_case(kind, real, (5, 7)) for kind in kinds}


@pytest.fixture(scope="module")
def messy() -> dict[str, Case]:
    return cases_of(MESSY, True)


@pytest.fixture(scope="module")
def peaks() -> dict[str, Case]:
    return cases_of(PEAKS[:-1], False)


def changed(cases: dict[str, Case], way: str, file: str = "static_state") -> pd.Series:
    """Share of changed cells by column."""
    before, after = cases["clean"].tables[file], cases[way].tables[file]
    assert list(before) == list(after)
    assert len(before) == len(after)
    same = (before == after) | (before.isna() & after.isna())
    return (~same).mean()


def test_every_way_changes_its_own_columns_and_no_other(messy):
    columns = {"outliers": {"tension_N"}, "drift": {"tension_N"}, "rounded": {"tension_N"}, "poses": set(POSE)}
    columns |= {"missing": {"tension_N", "length_m"}, "tracker": set(POSE), "encoders": {"length_m"}}
    for way, expected in columns.items():
        share = changed(messy, way)
        assert set(share.index[share > 0.0]) == expected, way
        assert set(messy[way].tables) == {"static_state", "loaded_pose"}


def test_wild_tensions_are_few_and_far(messy):
    tables = [messy[way].tables["static_state"]["tension_N"] for way in ("clean", "outliers")]
    off = (tables[1] - tables[0]).abs()
    assert 0.0 < (off > 0.0).mean() < 0.15  # 4 % of 48
    assert off[off > 0.0].between(15.0, 60.0).all()


def test_two_poses_are_off_by_centimetres_and_degrees(messy):
    before, after = (messy[way].tables["static_state"].groupby("case")[POSE].first() for way in ("clean", "poses"))
    apart = np.linalg.norm((after - before).to_numpy()[:, :3], axis=1)
    assert sorted(apart > 0.0) == [False] * 4 + [True] * 2
    assert ((apart[apart > 0.0] > 0.01) & (apart[apart > 0.0] < 0.05)).all()


def test_a_drift_begins_with_nothing(messy):
    walk = messy["drift"].tables["static_state"]["tension_N"] - messy["clean"].tables["static_state"]["tension_N"]
    by_state = walk.to_numpy().reshape(6, 8)
    assert not by_state[0].any()
    assert (np.abs(by_state[1:]) > 0.0).all()
    assert 0.5 < by_state[-1].std() < 8.0


def test_a_drift_of_the_tracker_moves_all_poses_a_little_more_each_time(messy):
    before, after = (messy[way].tables["static_state"].groupby("case")[POSE].first() for way in ("clean", "tracker"))
    shift = np.linalg.norm((after - before)[POSE[:3]].to_numpy(), axis=1)
    assert shift[0] == pytest.approx(0.0, abs=1e-12)
    assert 1e-4 < shift.max() < 10e-3
    assert np.degrees(1e-5) < np.abs((after - before)[POSE[3:]].to_numpy()).max() < np.degrees(10e-3)


def test_a_drift_of_the_encoders_is_the_same_within_a_lock(messy):
    before, after = (messy[way].tables["static_state"]["length_m"] for way in ("clean", "encoders"))
    change = (after - before).to_numpy().reshape((SMALL.static_states, -1))
    assert (change[0] == 0.0).all()
    assert 1e-4 < np.abs(change).max() < 8e-3
    loaded = [
        messy[way].tables["loaded_pose"].groupby(lambda i: i // SMALL.loads_per_lock) for way in ("clean", "encoders")
    ]
    one, other = (table["length_1_m"].agg(["min", "max"]) for table in loaded)
    assert (other["min"] == other["max"]).all()
    assert (other["min"] != one["min"]).all()


def test_rounded_tensions_are_steps_and_missing_ones_are_blank(messy, tmp_path):
    assert (messy["rounded"].tables["static_state"]["tension_N"] % 5.0 == 0.0).all()
    gone = messy["missing"].tables["static_state"]
    assert 0.03 < gone["tension_N"].isna().mean() < 0.35
    folder = write_case(messy["missing"], "c1", SEED, tmp_path / "campaigns", tmp_path / "sealed").parent
    read = pd.read_csv(folder / "static_state.csv")
    pd.testing.assert_series_equal(read["tension_N"].isna(), gone["tension_N"].isna())


def test_a_length_missing_at_a_lock_is_missing_in_all_its_rows(messy):
    loaded = messy["missing"].tables["loaded_pose"]
    blank = loaded.filter(like="length_").isna().groupby(loaded["case"].str[:2]).mean()
    assert blank.isin([0.0, 1.0]).all(axis=None)


def test_student_noise_has_tails_that_gaussian_noise_has_not():
    drawn = {kind: Noise(np.random.default_rng(1), kind).draw("x", 20_000) for kind in ("student", "white")}
    assert np.median(np.abs(drawn["student"])) == pytest.approx(0.765, rel=0.03)  # of t with 3 degrees of freedom
    assert (np.abs(drawn["student"]) > 5.0).mean() == pytest.approx(0.0154, rel=0.2)
    assert not (np.abs(drawn["white"]) > 5.0).any()


def counts(case: Case) -> list[int]:
    return case.tables["robot_frequency"].groupby("case").size().tolist()


def test_peaks_are_missing_and_spurious_as_often_as_said():
    modes, shares, rng = np.geomspace(3.0, 30.0, 4000), np.full(4000, 0.9), np.random.default_rng(3)
    kept = PeakSpoiler(frozenset(["missing"])).picker()(modes, shares, rng)
    more = PeakSpoiler(frozenset(["spurious"])).picker()(modes, shares, rng)
    assert len(kept) / len(modes) == pytest.approx(0.85, abs=0.02)
    assert set(kept) < set(modes)
    assert len(more) / len(modes) == pytest.approx(1.08, abs=0.015)
    assert not len(PeakSpoiler(frozenset()).picker()(modes, 0.2 * shares, rng))  # none that shows on the platform


def test_lists_lose_gain_and_exchange_peaks(peaks):
    clean = peaks["clean"]
    assert len(peaks["missing"].tables["cable_frequency"]) < len(clean.tables["cable_frequency"])
    assert counts(peaks["line"]) == [number + 1 for number in counts(clean)]
    pd.testing.assert_frame_equal(peaks["exchanged"].tables["static_state"], clean.tables["static_state"])
    lists = [case.tables["robot_frequency"].groupby("case")["frequency_hz"].apply(list) for case in peaks.values()]
    own, other = (dict(zip(peaks, lists, strict=True))[way] for way in ("clean", "exchanged"))
    moved = [case for case in own.index if own[case] != other[case]]
    assert [other[case] for case in moved] == [own[case] for case in reversed(moved)]
    assert len(moved) == 2


def test_an_exchanged_list_is_filed_under_the_pose_it_does_not_belong_to(peaks):
    states = peaks["exchanged"].tables["static_state"].groupby("case")[POSE].first()
    rows = peaks["exchanged"].tables["robot_frequency"]
    np.testing.assert_array_equal(rows[POSE].to_numpy(), states.loc[rows["case"]].to_numpy())


def test_a_steady_line_is_the_same_at_every_pose():
    rng, spoiler = np.random.default_rng(2), PeakSpoiler(frozenset(["line"]))
    lists = [spoiler.picker()(hertz * np.array([4.0, 5.0, 20.0]), np.ones(3), rng) for hertz in (1.0, 1.1, 1.2)]
    assert len({peaks[-1] for peaks in lists}) == 1
    assert lists[0][-1] == spoiler.line
    assert 50.0 / 12.0 < spoiler.line < 50.0 / 2.0


def test_near_doubles_become_one_peak_between_them():
    found = merged(np.array([3.0, 10.0, 10.05, 10.2, 20.0]), np.array([1.0, 1.0, 3.0, 1.0, 1.0]))
    np.testing.assert_allclose(found, [3.0, 10.0375, 10.2, 20.0])


def test_the_same_cause_in_four_sizes_on_the_same_robot():
    realities = [CaseKind("single", (("drum_scale", size),), statics=True, size=SMALL) for size in SIZES]
    kinds = [SpoiltKind(0, kind, "static", SIZES[-1]) for kind in realities]
    real = group_realities(kinds, SEED)
    found = sorted((kind.effects[0][1], real[kind]) for kind in (k.reality for k in kinds))
    changes = [np.array(one.effects[0]["change"]) for _, one in found]
    assert [size for size, _ in found] == list(SIZES)
    assert len({one.robot.name for _, one in found}) == 1
    for change, size in zip(changes[1:], SIZES[1:], strict=True):
        np.testing.assert_allclose(
            change / changes[0], np.broadcast_to(size / 2.0, change.shape)[change != 0.0], rtol=0.21
        )


def test_sets_have_their_composition_and_seeds_of_their_own():
    messy, peaks, sizes = (
        spoilt_kinds(name, count, 5) for name, count in (("messy", 270), ("peaks", 180), ("sizes", 224))
    )
    assert Counter(kind.way for kind in messy) == dict.fromkeys(MESSY, 30)
    assert Counter(kind.way for kind in peaks) == {way: 20 * PEAKS.count(way) for way in PEAKS}
    for kinds in (messy, peaks):
        assert sum(kind.reality.kind == "null" for kind in kinds) / len(kinds) == pytest.approx(1.0 / 3.0, abs=0.02)
        assert {size for kind in kinds for _, size in kind.reality.effects} == {4.0}
    assert Counter((kind.way, kind.reality.effects[0][1]) for kind in sizes).most_common()[-1][1] == 28
    assert not any(kind.reality.statics for kind in peaks)
    assert len(set(SET_SEEDS.values())) == len(SET_SEEDS)


def test_every_cause_of_a_campaign_is_hidden_as_often_and_a_third_of_them_in_spoilt_readings():
    kinds = spoilt_kinds("causes", 62, 5)
    hidden = Counter(kind.reality.effects[0][0] for kind in kinds)
    assert set(hidden.values()) == {2}
    assert set(hidden) == {*LIBRARY, *IN_SERIES, *HANDLING, *LAWS} - set(RARE)
    assert sum(kind.way not in ("static", "with frequencies") for kind in kinds) / 62 == pytest.approx(
        1.0 / 3.0, abs=0.01
    )
    for kind in kinds:
        assert kind.way in ("static", *MESSY) if kind.reality.statics else kind.way in ("with frequencies", *PEAKS)
        assert kind.reality.effects[0][1] == (1.0 if kind.reality.kind == "law" else 4.0)


def test_a_mistake_of_the_note_taker_comes_after_what_spoils_the_peaks():
    kind = CaseKind("handling", (("unit_error", 4.0),), size=SMALL)
    real = group_realities([SpoiltKind(0, kind, "line")], SEED)[kind]
    case = read_case(SpoiltKind(0, kind, "line", by_cause=True), real, (5, 7))
    assert case.truth["effects"][0]["variant"] in ("kilogram-force", "rad/s", "rad")
    assert condition(Scored("c1", case.truth, Answer("adequate", (), (), 0.5, 1.0, {}))) == "unit_error"


def scored(kind: str, way: str, status: str, names: tuple[str, ...], probability: float = 0.95) -> Scored:
    hidden = [{"cause": "drum_scale", "multiple": 4.0}] if kind == "single" else []
    truth = {"kind": kind, "effects": hidden, "way": way, "asked": 4.0, "by_size": False, "robot": "cogiro"}
    causes, groups = (names, ()) if status == "named" else ((), (names,))
    return Scored("c1", truth, Answer(status, causes, groups if status == "class" else (), probability, 1.0, {}))


def test_right_is_the_name_or_a_class_of_four_that_holds_it():
    four = ("drum_scale", "temperature", "a", "b")
    assert spoilt_right(scored("null", "drift", "adequate", ()))
    assert spoilt_right(scored("single", "drift", "named", ("drum_scale",)))
    assert spoilt_right(scored("single", "drift", "class", four))
    wrong = [
        ("class", (*four, "c")),
        ("class", four[1:]),
        ("named", ("temperature",)),
        ("adequate", ()),
        ("unknown", ()),
    ]
    assert not any(spoilt_right(scored("single", "drift", *answer)) for answer in wrong)


def test_exchanged_lists_may_be_said_where_they_are_and_only_there():
    def both(way):
        case = scored("single", way, "named", ("drum_scale", "pose_mismatch"))
        return replace(case, answer=replace(case.answer, groups=(("drum_scale",), ("pose_mismatch",))))

    assert [spoilt_right(both(way)) for way in ("exchanged", "all", "line")] == [True, True, False]
    mixed = scored("single", "all", "named", ("pose_mismatch",))
    mixed = replace(mixed, truth={**mixed.truth, "effects": [{"cause": "pose_mismatch", "multiple": None}]})
    assert spoilt_right(mixed)
    counts = [spoilt_figures([both(way)])["whole set"]["wrong_confident_name"]["successes"] for way in ("all", "line")]
    assert counts == [0, 1]


def test_the_table_counts_each_way_by_itself():
    cases = [scored("null", "clean", "adequate", ()), scored("single", "drift", "named", ("temperature",))]
    found = spoilt_figures(cases)
    assert list(found) == ["clean", "drift", "whole set"]
    assert found["drift"]["wrong_confident_name"]["successes"] == 1
    assert found["clean"]["nulls_right"]["successes"] == found["whole set"]["right"]["successes"] == 1
    page = spoilt_page({"run": {"set": "messy", "budget": "small", "date": "-"}, "figures": found, "rows": []})
    assert "| drift | 0 of 1 | 0 of 0 | 0 of 1 | 1 of 1 | 0 of 1 | 0 of 1 | 0 | 1.0 |" in page


def test_noise_of_the_sensors_stays_as_certified(messy):
    """Student's t is scaled by the certificate, so that most readings are as good as it says."""
    lengths = [messy[way].tables["static_state"]["length_m"].to_numpy() for way in ("clean", "student")]
    assert np.median(np.abs(lengths[1] - lengths[0])) < 3.0 * SIGMA["length_m"]
