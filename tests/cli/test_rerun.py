"""A result can be computed again from what it records, and a difference is named."""

import hashlib
import json
from pathlib import Path

import pytest

from cdpr_struct.cli.compared_results import compared
from cdpr_struct.cli.main import run
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.robot_writing import robot_toml

CABLE = ["cable", "--force", "100,-100", "--length", "20", "--EA", "251327", "--rho", "0.067", "--quiet"]


@pytest.fixture
def earlier(tmp_path) -> Path:
    """Results of a quick command on a robot file."""
    robot = load_robot("thesis-3-1")
    (tmp_path / "robot.toml").write_text(robot_toml(robot, "mine"))
    found = tmp_path / "first"
    assert run(["inverse", str(tmp_path / "robot.toml"), "--pose", "0,0,0.5", "--out", str(found), "--quiet"]) == 0
    return found


def answered(words: list[str], capsys) -> tuple[int, dict]:
    capsys.readouterr()
    code = run([*words, "--json"])
    return code, json.loads(capsys.readouterr().out)


def test_the_same_command_gives_the_same_numbers(earlier, tmp_path, capsys):
    code, told = answered(["rerun", str(earlier / "result.json"), "--out", str(tmp_path / "again")], capsys)
    assert code == 0
    assert told["same"]
    assert told["compared"] > 50
    assert told["warnings"] == []
    assert (tmp_path / "again" / "report.html").exists()


def test_an_input_that_changed_is_named_and_so_are_the_numbers(earlier, tmp_path, capsys):
    file = tmp_path / "robot.toml"
    file.write_text(file.read_text().replace("mass = 60.0", "mass = 66.0"))
    code, told = answered(["rerun", str(earlier)], capsys)
    assert code == 1
    assert told["warnings"] == [f"The input {file.as_posix()} changed since the earlier run."]
    tension = next(d for d in told["differences"] if (d["file"], d["key"]) == ("cables.csv", "tension_N"))
    assert tension["count"] == 8
    assert 0.05 < tension["relative"] < 0.15  # a tenth more mass
    assert {d["key"] for d in told["differences"]} >= {"tensions_N", "lengths_m", "mass_kg"}


def test_a_comment_changes_the_file_but_no_number(earlier, tmp_path, capsys):
    file = tmp_path / "robot.toml"
    file.write_text(file.read_text() + "# seen\n")
    code, told = answered(["rerun", str(earlier)], capsys)
    assert (code, told["same"], len(told["warnings"])) == (0, True, 1)


def test_tolerance_is_of_the_largest_number_of_a_key(tmp_path):
    for name, values in (("a", [100.0, 1.0]), ("b", [100.0, 1.0005])):
        (tmp_path / name).mkdir()
        (tmp_path / name / "result.json").write_text(json.dumps({"tensions_N": values, "seconds": len(name)}))
    (one,), count = compared(tmp_path / "a", tmp_path / "b", 1e-6)
    assert (one.key, one.was, one.now, one.count, count) == ("tensions_N", 1.0, 1.0005, 1, 2)
    assert one.relative == pytest.approx(5e-6)
    assert compared(tmp_path / "a", tmp_path / "b", 1e-5)[0] == []


@pytest.mark.parametrize("other", [[1.0], ["one"], [None], {"deeper": [1.0]}])
def test_other_shapes_and_words_are_differences(other, tmp_path):
    for name, values in (("a", [1.0, 2.0]), ("b", other)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "result.json").write_text(json.dumps({"x": values}))
    assert compared(tmp_path / "a", tmp_path / "b", 0.5)[0]


def test_what_cannot_be_run_again_is_refused(earlier, tmp_path, capsys):
    (tmp_path / "robot.toml").rename(tmp_path / "elsewhere.toml")
    old = tmp_path / "old"
    old.mkdir()
    (old / "result.json").write_text("{}")
    cases = {
        (str(earlier),): ["robot.toml", "not here"],
        (str(tmp_path / "none"),): ["none", "result.json"],
        (str(old),): ["run", "records its command"],
        (str(earlier), "--out", str(earlier)): ["--out", "another directory"],
        (str(earlier), "--tolerance", "2"): ["--tolerance", "2"],
    }
    for words, said in cases.items():
        capsys.readouterr()
        assert run(["rerun", *words]) == 2
        line = capsys.readouterr().err.strip()
        assert len(line.splitlines()) == 1
        assert all(word in line for word in said), line


def test_a_campaigns_files_are_inputs(tmp_path):
    from cdpr_struct.cli.run_record import digests

    root = Path(__file__).parents[2] / "examples" / "table-4-4"
    found = digests(("cdpr-struct", "diagnose", str(root / "campaign.toml"), "--budget", "small"))
    named = {
        line.split('"')[1] for line in (root / "campaign.toml").read_text().splitlines() if line.startswith("file")
    }
    assert {Path(path).name for path in found} >= {"campaign.toml", *named} - {""}
    assert named
    assert all(len(digest) == 64 for digest in found.values())


def test_a_result_of_another_schema_is_told(earlier, capsys):
    file = earlier / "result.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | {"schema_version": 99}))
    code, told = answered(["rerun", str(earlier)], capsys)
    assert (code, told["same"]) == (0, True)
    assert told["warnings"] == ["The earlier result has schema_version 99, this one 1: keys may differ in meaning."]


def test_a_result_of_a_program_without_schema_versions_may_be_replaced(earlier):
    """Its own digest is of its text, to which nothing may be added."""
    file = earlier / "result.json"
    older = json.loads(file.read_text())
    del older["schema_version"]
    digests = older.pop("files")
    digests["result.json"] = hashlib.sha256((json.dumps(older, indent=2) + "\n").encode()).hexdigest()
    file.write_text(json.dumps({**older, "files": digests}, indent=2) + "\n")
    again = ["inverse", str(earlier.parent / "robot.toml"), "--pose", "0,0,0.6", "--out", str(earlier), "--quiet"]
    assert run(again) == 0
