"""The generator of blind campaigns: precise, sealed, reproducible, and readable."""

import ast
import csv
import json
import tomllib
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.fem_reference import robot_modes
from tests.blind import case_drawing
from tests.blind.__main__ import main
from tests.blind.campaign_files import opened_truth, write_case
from tests.blind.case_drawing import Case, CaseKind, drawn_case, without_effect
from tests.blind.catalogue import EQUIVALENT, HANDLING, LIBRARY, OUTSIDE, drawn_pattern
from tests.blind.detectability import reference_size
from tests.blind.deviations import TOLERANCES, Deviations, field_sizes
from tests.blind.entered_robot import entered_robot
from tests.blind.measuring_plan import PlanSize, drawn_plan
from tests.blind.mesh_error import LIMIT, mesh_error
from tests.blind.note_errors import spoiled
from tests.blind.sensors import POSE
from tests.blind.suite import FULL, composed, record_final_use, set_seed
from tests.blind.true_robot import at_rest
from tests.blind.vibrations import robot_frequencies, whole_matrices

SMALL = PlanSize(static_states=3, locks=1, loads_per_lock=2, frequency_states=1)
TINY = PlanSize(static_states=1, locks=1, loads_per_lock=2, frequency_states=1)
SEED = (7, 1)
STATE = [*POSE, "payload_kg"]
COLUMNS = {
    "static_state": ["case", *STATE, "cable", "tension_N", "length_m", "approach"],
    "loaded_pose": ["case", *STATE, *[f"length_{n}_m" for n in range(1, 9)]],
    "cable_frequency": ["case", *STATE, "cable", "mode", "plane", "frequency_hz", "sigma", "tension_N"],
    "robot_frequency": ["case", *STATE, "frequency_hz", "sigma"],
}


def written(kind: CaseKind, seed: tuple[int, ...], place: Path) -> Path:
    return write_case(drawn_case(kind, seed), "c001", seed, place / "campaigns", place / "sealed").parent


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture(scope="module")
def null_case() -> Case:
    return drawn_case(CaseKind("null", size=SMALL), SEED)


@pytest.fixture(scope="module")
def null_folder(null_case, tmp_path_factory) -> Path:
    place = tmp_path_factory.mktemp("null")
    return write_case(null_case, "c001", SEED, place / "campaigns", place / "sealed").parent


@pytest.mark.parametrize("name", ["thesis-3-1", "cogiro", "thesis-5", "thesis-5-pulleys"])
def test_mesh_error_is_small_beside_the_noise(name):
    errors = mesh_error(name, seed=3, size=TINY)
    assert max(errors.values()) < LIMIT, errors


def test_a_coarse_mesh_would_be_seen():
    """The twin: twelve bars a cable are too few, or the test above proves nothing."""
    assert max(mesh_error("thesis-3-1", seed=3, size=TINY, elements=12).values()) > LIMIT


def test_truth_is_not_in_the_campaign_directory(null_folder):
    sealed = null_folder.parents[1] / "sealed" / "c001.json"
    secret = json.loads(sealed.read_text("utf-8"))
    handed_out = b"".join(contents(null_folder).values())
    assert secret["salt"].encode() not in handed_out
    assert b"truth" not in handed_out.replace(b"truth_sha256", b"")
    assert not {b"deviations", b"effects", b"seed", b"null"} & {word.strip(b'":,') for word in handed_out.split()}
    assert not any("truth" in path.name or "sealed" in path.name for path in null_folder.iterdir())


def test_a_truth_that_was_changed_is_refused(null_case, tmp_path):
    folder = write_case(null_case, "c001", SEED, tmp_path / "campaigns", tmp_path / "sealed").parent
    sealed = tmp_path / "sealed"
    assert opened_truth("c001", folder.parent, sealed)["kind"] == "null"
    path = sealed / "c001.json"
    path.write_text(path.read_text("utf-8").replace('"null"', '"single"'), "utf-8")
    with pytest.raises(ValueError, match="does not match the hash"):
        opened_truth("c001", folder.parent, sealed)


def test_campaign_has_the_files_and_columns_of_the_interface(null_folder):
    campaign = tomllib.loads((null_folder / "campaign.toml").read_text("utf-8"))
    assert set(campaign["tolerances"]) <= set(TOLERANCES)
    for entry in campaign["measurement"]:
        with (null_folder / entry["file"]).open() as file:
            rows = list(csv.DictReader(file))
        assert list(rows[0]) == COLUMNS[entry["kind"]]
        assert all(np.isfinite(float(row[key])) for row in rows for key in STATE)
        assert entry["sigma"]["position_m"] == 0.0003


def test_numbers_are_in_the_units_of_their_columns(null_folder):
    with (null_folder / "static_state.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert all(10.0 < float(row["tension_N"]) < 5000.0 for row in rows)
    assert all(3.0 < float(row["length_m"]) < 20.0 for row in rows)
    assert all(abs(float(row["x_m"])) < 5.0 and abs(float(row["rx_deg"])) < 15.0 for row in rows)


def test_same_seed_is_the_same_bit_by_bit_and_another_is_not(null_folder, tmp_path):
    again = written(CaseKind("null", size=SMALL), SEED, tmp_path / "again")
    other = written(CaseKind("null", size=SMALL), (7, 2), tmp_path / "other")
    assert contents(again) == contents(null_folder)
    assert contents(other)["static_state.csv"] != contents(null_folder)["static_state.csv"]


def test_an_effect_of_size_zero_is_the_null(null_folder, tmp_path):
    kind = without_effect(CaseKind("single", (("axial_stiffness", 4.0),), size=SMALL))
    folder = written(kind, SEED, tmp_path)
    for name, data in contents(null_folder).items():
        assert name == "manifest.json" or contents(folder)[name] == data, name


def test_an_effect_changes_the_data(null_folder, tmp_path):
    folder = written(CaseKind("single", (("axial_stiffness", 4.0),), size=SMALL), SEED, tmp_path)
    assert contents(folder)["loaded_pose.csv"] != contents(null_folder)["loaded_pose.csv"]


@pytest.mark.parametrize("name", HANDLING)
def test_a_mistake_of_the_note_taker_changes_values_and_nothing_else(null_case, name):
    tables = {kind: table.copy() for kind, table in null_case.tables.items()}
    assert spoiled(name, tables, np.random.default_rng(1))
    for kind, table in null_case.tables.items():
        assert list(tables[kind]) == list(table)
        assert len(tables[kind]) == len(table)
    assert any(not tables[kind].equals(table) for kind, table in null_case.tables.items())


def test_every_effect_has_a_field():
    fields = field_sizes(8)
    for name in (*LIBRARY, *EQUIVALENT, *OUTSIDE):
        assert name in fields


@pytest.mark.parametrize("name", [*LIBRARY, *EQUIVALENT, *OUTSIDE])
def test_every_effect_has_a_smallest_detectable_size(name):
    if name == "pulley_radius":
        pytest.skip("needs the robot with pulleys, which the full suite draws")
    robot = entered_robot("cogiro")
    pattern = drawn_pattern({**LIBRARY, **EQUIVALENT, **OUTSIDE}[name], robot.cables, np.random.default_rng(1))[1]
    assert 0.0 < reference_size(robot.name, name, pattern) < np.inf


def test_whole_robot_vibrates_as_the_referee_says():
    """Without hose and soft masts: between lumped and consistent mass, and where the lumped ones converge to."""
    robot, rng = entered_robot("thesis-3-1"), np.random.default_rng(2)
    exact, plan = Deviations.none(8), drawn_plan(robot, rng, size=TINY)
    coarse, fine = (at_rest(robot, exact, plan.statics[0], bars) for bars in (20, 40))
    ours = robot_frequencies(robot, exact, coarse)[0]
    lumped, consistent = (robot_modes(coarse, len(ours), mass).frequencies_hz for mass in ("lumped", "consistent"))
    assert ((lumped < ours) & (ours < consistent)).all()
    limit = (4.0 * robot_modes(fine, 12).frequencies_hz - lumped[:12]) / 3.0
    np.testing.assert_allclose(ours[:12], limit, rtol=1e-4)  # of 4e-3 noise; extrapolation itself errs near veering


def test_masts_that_are_nearly_rigid_change_nothing_and_soft_ones_do():
    robot, rng = entered_robot("cogiro"), np.random.default_rng(2)
    plan = drawn_plan(robot, rng, size=SMALL)
    rest = at_rest(robot, Deviations.none(8), plan.statics[0], 10)
    found = {}
    for compliance in (0.0, 1e-11, 1e-5):
        yielding = Deviations.none(8).plus("frame_compliance", np.full(4, compliance))
        found[compliance] = robot_frequencies(robot, yielding, rest)[0]
        stiffness, mass = whole_matrices(robot, yielding, rest)
        assert abs(stiffness - stiffness.T).max() < 1e-9 * abs(stiffness).max()
        assert stiffness.shape == mass.shape
    np.testing.assert_allclose(found[1e-11], found[0.0], rtol=1e-5)
    assert (found[1e-5] < found[0.0] * (1.0 + 1e-9)).all()
    assert found[1e-5][0] < 0.999 * found[0.0][0]


def test_a_platform_that_cannot_exist_is_not_drawn():
    """One moment of inertia larger than the sum of the others: no body has that."""
    robot, exact = entered_robot("thesis-3-1"), Deviations.none(8)
    case_drawing._refuse_impossible(robot, exact.plus("platform_inertia", np.array([0.3, 0.3, 0.3])))
    moments = np.diagonal(robot.inertia)
    too_large = np.log(1.01 * (moments[0] + moments[1]) / moments[2])
    with pytest.raises(case_drawing.RejectedDrawError):
        case_drawing._refuse_impossible(robot, exact.plus("platform_inertia", np.array([0.0, 0.0, too_large])))


def test_full_suite_has_its_composition_and_an_order_that_tells_nothing():
    kinds = composed("dev", 200, 5)
    assert {key: sum(kind.kind == key for kind in kinds) for key in FULL} == FULL
    assert [kind.kind for kind in kinds] != sorted(kind.kind for kind in kinds)
    sizes = [kind.effects[0][1] for kind in kinds if kind.kind == "single"]
    assert {size: sizes.count(size) for size in set(sizes)} == {0.5: 20, 1.0: 20, 2.0: 20, 4.0: 20}
    assert composed("dev", 200, 5) == kinds


def test_a_set_of_rates_holds_nulls_and_what_is_just_detectable():
    kinds = composed("rates", 100, 5)
    assert Counter(kind.kind for kind in kinds) == {"null": 60, "single": 40}
    hidden = [effect for kind in kinds for effect in kind.effects]
    assert {multiple for _, multiple in hidden} == {1.0}
    assert {name for name, _ in hidden} == set(LIBRARY)
    more = composed("final-rates", 266, 5)
    assert Counter(kind.kind for kind in more) == {"null": 60, "single": 150, "pair": 56}
    assert {kind.effects[0][1] for kind in more if kind.kind == "single"} == {1.0}


def test_the_rates_of_a_final_set_have_seeds_of_their_own_and_of_the_release():
    seeds = {set_seed(name, release) for name in ("final", "final-rates") for release in ("1.0", "1.1")}
    assert len(seeds) == 4
    with pytest.raises(ValueError, match="--release NAME"):
        set_seed("final-rates")


def test_any_set_has_new_seeds_for_a_release():
    assert len({set_seed("unseen"), set_seed("unseen", "1.0"), set_seed("unseen", "1.1")}) == 3


def test_the_final_set_of_a_release_is_used_once(tmp_path):
    record_final_use("1.0", tmp_path / "uses.json")
    with pytest.raises(ValueError, match="already used"):
        record_final_use("1.0", tmp_path / "uses.json")


def test_a_directory_keeps_its_set(tmp_path, capsys):
    held = '{"set": "ci", "release": "", "count": 12}\n'
    (tmp_path / "run.json").write_text(held)
    assert main(["make", "--set", "unseen", "--out", str(tmp_path)]) == 2
    assert "holds the set ci" in capsys.readouterr().err
    assert (tmp_path / "run.json").read_text() == held


def test_generator_imports_nothing_of_the_package_under_test():
    for path in Path(__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [str(node.module)] if isinstance(node, ast.ImportFrom) else []
            ours = [name for name in names if f"{name}.".startswith("cdpr_struct.")]
            assert all(f"{name}.".startswith("cdpr_struct.fem_reference.") for name in ours), path.name


def test_the_package_knows_nothing_of_the_blind_tests():
    for path in (Path(__file__).parents[2] / "cdpr_struct").rglob("*.py"):
        text = path.read_text("utf-8")
        assert "tests.blind" not in text, path
        assert "truth_sha256" not in text, path


def test_small_static_sets_hide_nothing_that_rests_do_not_show():
    kinds = composed("no-conventions", 200, set_seed("no-conventions"))
    hidden = [name for kind in kinds for name, _ in kind.effects]
    assert "platform_inertia" not in hidden
    assert "platform_mass" in hidden
    assert len(kinds) == 200
    assert "platform_inertia" in [n for kind in composed("dev", 200, 1) for n, _ in kind.effects]
