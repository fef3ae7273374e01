"""The baselines of the diagnosis find what is plain, stay quiet where they promise to, and write before they score."""

import csv
import json

import numpy as np
import pytest

from benchmarks.diagnosis_baselines import material as material_module
from benchmarks.diagnosis_baselines.__main__ import main
from benchmarks.diagnosis_baselines.answering import METHODS, answer, verdict
from benchmarks.diagnosis_baselines.evidence_methods import linear_evidence, noise_evidence
from benchmarks.diagnosis_baselines.material import _noise_alone, kept_material, single_parameters
from benchmarks.diagnosis_baselines.page import TITLES, figure_table, write_page
from benchmarks.diagnosis_baselines.parameter_methods import largest_drop, ridge
from benchmarks.diagnosis_baselines.scores import FIGURES, method_figures, without_classes
from cdpr_struct.diagnosis.null_model import reading_count, tolerance_count
from cdpr_struct.diagnosis.prepared import BUDGETS, prepare
from cdpr_struct.measurement.campaign_file import load_campaign
from tests.blind.answers import Answer
from tests.blind.campaign_files import write_case
from tests.blind.case_drawing import CaseKind, drawn_case
from tests.blind.measuring_plan import PlanSize
from tests.blind.scoring import Scored
from tests.laws.baseline_material import material

CALIBRATED = {"largest_drop": largest_drop, "ridge": ridge, "linear_evidence": linear_evidence}
NEEDS = {"lasso": "sklearn", "matching_pursuit": "sklearn", "stepwise_bic": "lmfit", "stepwise_extended_bic": "lmfit"}


def method(name):
    if name in NEEDS:
        pytest.importorskip(NEEDS[name])
    return METHODS[name]


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("cause", ["own", "lone", "bounded"])
def test_a_plain_effect_is_named(name, cause):
    theta = np.full(4, 0.6) if cause == "own" else np.array([1.2])
    assert method(name)(material({cause: theta}, seed=3)) == (cause,)


@pytest.mark.parametrize("name", ["matching_pursuit", "stepwise_bic", "stepwise_extended_bic"])
def test_two_plain_effects_are_both_named(name):
    found = method(name)(material({"lone": np.array([1.5]), "own": np.full(4, 0.6)}, seed=3))
    assert sorted(found) == ["lone", "own"]


@pytest.mark.parametrize("name", CALIBRATED)
def test_false_alarms_are_those_asked_for(name):
    """4 of 100, within the binomial band of 100 cases."""
    alarms = sum(bool(CALIBRATED[name](material({}, seed))) for seed in range(100))
    assert 1 <= alarms <= 10


def test_noise_alone_is_what_the_tolerances_are_left_out_of():
    """The residuals are twice their sigma then, so that nothing looks like an effect."""
    assert sum(bool(noise_evidence(material({}, seed))) for seed in range(20)) > 10
    assert sum(bool(linear_evidence(material({}, seed))) for seed in range(20)) < 4


def test_the_extended_criterion_is_the_stricter_one():
    bic, extended = method("stepwise_bic"), method("stepwise_extended_bic")
    quiet = [(bic(material({}, seed)), extended(material({}, seed))) for seed in range(30)]
    assert sum(bool(a) for a, _ in quiet) > sum(bool(b) for _, b in quiet)


def test_sizes_that_cannot_be_negative_are_not():
    assert method("stepwise_bic")(material({"bounded": np.array([-1.5])}, seed=3)) == ()
    assert method("stepwise_bic")(material({"bounded": np.array([1.5])}, seed=3)) == ("bounded",)


def test_the_criterion_is_the_one_of_lmfit():
    pytest.importorskip("lmfit")
    from benchmarks.diagnosis_baselines.stepwise_bic import _bic, fitted

    found = material({"lone": np.array([1.2])}, seed=3)
    signature = found.candidates[1].signature
    fit = fitted(signature, np.full(1, -np.inf), found.z)
    left = found.z - signature @ np.linalg.lstsq(signature, found.z, rcond=None)[0]
    assert fit.bic == pytest.approx(_bic(left @ left, len(found.z), 1), abs=1e-6)


def test_parameters_are_those_of_each_cable_and_of_all_alike_in_prior_sigmas():
    found = material({}).candidates
    columns = single_parameters(found)
    assert list(columns.cause) == ["own"] * 5 + ["lone", "bounded"]
    np.testing.assert_allclose(columns.signature[:, :4], 0.5 * found[0].signature)
    np.testing.assert_allclose(columns.signature[:, 4], 0.5 * found[0].signature.sum(axis=1))


def test_several_names_are_not_said_with_confidence():
    assert verdict(())["status"] == "adequate"
    assert verdict(("a",))["probability"] > 0.9 > verdict(("a", "b"))["probability"]


@pytest.fixture(scope="module")
def one_case(tmp_path_factory):
    """Campaigns, sealed truths and the case's name."""
    root = tmp_path_factory.mktemp("baselines")
    size = PlanSize(static_states=1, locks=1, loads_per_lock=2, frequency_states=1)
    write_case(drawn_case(CaseKind("null", size=size), (7, 3)), "c001", (7, 3), root / "campaigns", root / "sealed")
    return root / "campaigns", root / "sealed", "c001"


def test_noise_and_tolerances_make_the_covariance(one_case):
    ground = prepare(load_campaign(one_case[0] / "c001" / "campaign.toml"), BUDGETS["small"]).ground
    lower, noise = _noise_alone(ground), reading_count(ground.setting)
    tolerance = ground.null.columns[:, noise : noise + tolerance_count(ground.setting)]
    whole = lower @ lower.T + tolerance @ tolerance.T + np.diag(ground.extra**2)
    np.testing.assert_allclose(whole, ground.null.covariance, rtol=1e-8, atol=1e-9)


def test_real_material_can_be_kept(one_case, tmp_path):
    """Signatures and patterns survive the file, and the causes in it can no longer be applied."""
    campaign, file = one_case[0] / "c001" / "campaign.toml", tmp_path / "c001.pickle"
    first, again = (kept_material(campaign, file) for _ in range(2))
    assert noise_evidence(first) == noise_evidence(again)
    np.testing.assert_array_equal(
        single_parameters(first.visible).signature, single_parameters(again.visible).signature
    )
    with pytest.raises(NotImplementedError, match="linearised"):
        again.candidates[0].cause.apply(None, None)


def test_material_is_prepared_once_and_anew_for_another_campaign(one_case, tmp_path, monkeypatch):
    folder, calls = tmp_path / "c001", []
    folder.mkdir()
    for file in (one_case[0] / "c001").iterdir():
        (folder / file.name).write_bytes(file.read_bytes())
    monkeypatch.setattr(material_module, "material_of", lambda path: calls.append(path) or material({}))
    first, again = (kept_material(folder / "campaign.toml", tmp_path / "kept" / "c001.pickle") for _ in range(2))
    assert len(calls) == 1
    np.testing.assert_array_equal(first.z, again.z)
    assert linear_evidence(first) == linear_evidence(again)
    (folder / "manifest.json").write_text("{}\n", "utf-8")
    kept_material(folder / "campaign.toml", tmp_path / "kept" / "c001.pickle")
    assert len(calls) == 2
    assert [path.name for path in (tmp_path / "kept").iterdir()] == ["c001.pickle"]


def test_answers_come_first_and_are_kept(one_case, tmp_path, capsys):
    for needed in set(NEEDS.values()):
        pytest.importorskip(needed)
    campaigns, sealed, name = one_case
    words = ["--campaigns", str(campaigns), "--out", str(tmp_path)]
    assert main(words) == 0
    assert not (tmp_path / "figures.csv").exists()
    records = sorted(tmp_path.glob(f"answers/*/{name}/run.json"))
    assert len(records) == len(METHODS)
    before = [record.stat().st_mtime_ns for record in records]
    tool = tmp_path / "answers" / "ridge"
    assert main([*words, "--sealed", str(sealed), "--answers", str(tool)]) == 0
    assert [record.stat().st_mtime_ns for record in records] == before
    rows = list(csv.DictReader((tmp_path / "figures.csv").read_text("utf-8").splitlines()))
    assert {row["method"] for row in rows} == {*TITLES}
    assert all(row["cases"] == "1" for row in rows if row["figure"] == "false_alarms")
    assert all(row["successes"] == "0" for row in rows if row["figure"] == "failed_runs")
    assert "| false alarms |" in capsys.readouterr().out


def test_a_method_that_breaks_has_failed(one_case, tmp_path, monkeypatch):
    monkeypatch.setattr("benchmarks.diagnosis_baselines.answering.METHODS", {"bad": lambda found: found.nothing})
    answer(one_case[0] / "c001" / "campaign.toml", tmp_path, "c001")
    record = json.loads((tmp_path / "answers" / "bad" / "c001" / "run.json").read_text("utf-8"))
    assert record["exit_code"] == 1
    assert "AttributeError" in record["stderr"]
    assert not (tmp_path / "answers" / "bad" / "c001" / "result.json").exists()


def scored(name: str, kind: str, hidden: str, status: str, *causes: str, groups=(), probability=0.95) -> Scored:
    effects = [{"cause": hidden, "multiple": 2.0, "total": [0.1], "shape": "common"}] if hidden else []
    truth = {"kind": kind, "robot": "cogiro", "effects": effects}
    return Scored(name, truth, Answer(status, causes, groups, probability, 1.0, {}))


CASES = [
    scored("c1", "null", "", "named", "temperature"),
    scored("c2", "single", "drum_scale", "named", "drum_scale"),
    scored("c3", "handling", "unit_error", "named", "drum_scale"),
    scored("c4", "single", "drum_scale", "named", "temperature", "platform_mass", probability=0.5),
]


def test_wrong_names_are_counted_alone_among_parameters_and_in_any_company():
    found = method_figures(CASES)
    assert {key for _, key in FIGURES} == found.keys()
    counts = {key: (entry["successes"], entry["cases"]) for key, entry in found.items()}
    assert counts["wrong_confident_name"] == (2, 4)
    assert counts["wrong_confident_name_parametric"] == (1, 3)
    assert counts["any_wrong_name"] == (3, 4)
    assert counts["right_name_at_2x"] == (1, 3)
    assert counts["right_name_of_singles"] == (1, 2)
    assert counts["false_alarms"] == (1, 1)


def test_without_classes_the_best_cause_is_named():
    classed = scored("c1", "single", "a", "class", "a", groups=(("a", "b"),), probability=0.99).answer
    assert without_classes(classed).status == "named"
    assert without_classes(classed).causes == ("a",)
    unknown = scored("c1", "single", "a", "unknown").answer
    assert without_classes(unknown) is unknown


def test_the_page_gets_table_and_figure(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("kept\n<!-- run -->\n<!-- end -->\n<!-- figures -->\n<!-- end -->\n", "utf-8")
    scores = {"ridge": method_figures(CASES), "diagnosis": method_figures(CASES[:2])}
    write_page(scores, "4 cases.", page)
    assert (
        page.read_text("utf-8")
        == f"kept\n<!-- run -->\n4 cases.\n<!-- end -->\n<!-- figures -->\n{figure_table(scores)}\n<!-- end -->\n"
    )
    assert "| false alarms | 100 % (1/1) | 100 % (1/1) |" in figure_table(scores)
    assert "<svg" in page.with_suffix(".svg").read_text("utf-8")
