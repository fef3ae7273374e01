"""What holds for every command: examples run, files can be read again, pages repeat their run, nothing is lost.

Each example of each command's help runs once (`runs`, conftest.py), with its files in a directory of its own; the laws
are then read off. `diagnose` and `plan` are long, and their first examples run with `-m slow`.
"""

import functools
import json
import re
import shlex
import subprocess
import sys
from html import unescape
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cdpr_struct.cli.main import COMMANDS, run
from cdpr_struct.cli.output import repeating
from cdpr_struct.derivations import regenerate
from cdpr_struct.reports.plain_json import SCHEMA_VERSION
from tests.cli.conftest import ENDLESS, EXAMPLES, FAILS, OTHERS, ROOT, words_of
from tests.cli.result_keys import RECORD, keys, missing, recorded_version

NAMES = [command.NAME for command in COMMANDS]
REPORTING = [name for name in NAMES if name not in {*OTHERS, *ENDLESS}]
PYTHON = re.compile(r"\b(np|array|float64|int64|None|nan|inf|True|False)\b|[{}]|^\[.*\]$|^[('\"]|[0-9]j\b")  # no words
CLOCK = {"seconds"}  # of the run, not of the result; pages show it, so digests of `files` differ then
LONG = ("diagnose", "plan")
OF_ALL = [
    pytest.param(name, number, marks=pytest.mark.slow) if name in LONG and number == 0 else (name, number)
    for name, number, _ in EXAMPLES
    if name in REPORTING
]
GONE = "keys that users rely on are gone: see docs/files.md, result.json, before SCHEMA_VERSION grows"
QUICKEST = ("platform", "tension_bound")  # sheets; test_derivations_current.py holds all of them against the files

# Where the numbers of a table stand in result.json: file, column, path.
SAME = {
    "robots": [("robots.csv", "name", "robots.*.name")],
    "inverse": [("cables.csv", "tension_N", "tensions_N")],
    "forward": [("cables.csv", "tension_N", "tensions_N")],
    "modes": [("modes.csv", "frequency_hz", "frequencies_hz"), ("modes.csv", "kind", "kinds")],
    "spectrogram": [("modes.csv", "frequency_hz", "natural_frequencies_hz")],
    "transient": [("modes.csv", "frequency_hz", "natural_frequencies_hz")],
    "verify": [("eigenfrequencies.csv", "fem_hz", "eigenfrequencies.*.fem_hz")],
    "ambient": [("modes.csv", "frequency_hz", "records.*.modes.*.frequency_hz")],
    "plan": [("detectable.csv", "cause", "detectable.*.cause")],
    "derive": [("formulas.csv", "id", "formulas.*.id")],
}


@pytest.fixture(autouse=True)
def from_the_repository(monkeypatch):
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(regenerate, "render", lambda progress: two_sheets())


@functools.cache
def two_sheets() -> regenerate.Rendering:
    """What two of the derivations print, once a process; all of them take ten seconds."""
    sheets = {name: regenerate.SHEETS[name] for name in QUICKEST}
    functions = {name: sheet.functions() for name, sheet in sheets.items()}
    texts = {
        f"{regenerate.GENERATED}/{name}.py": regenerate.module_text(sheet.SOURCE, functions[name])
        for name, sheet in sheets.items()
    }
    formulas = tuple(formula for sheet in sheets.values() for formula in sheet.formulas())
    return regenerate.Rendering(formulas, functions, texts)


def result_of(directory: Path) -> dict:
    return json.loads((directory / "result.json").read_text("utf-8"))


def at(result, path: str) -> list:
    """Values at a path like `modes.*.hz`."""
    found = [result]
    for key in path.split("."):
        found = [inner for item in found for inner in (item if key == "*" else [item[key]])]
    return found[0] if len(found) == 1 and isinstance(found[0], list) else found


def test_every_command_has_two_examples():
    for command in COMMANDS:
        assert len(command.EXAMPLES) == 2, command.NAME
        assert all(line.startswith(f"cdpr-struct {command.NAME}") for line in command.EXAMPLES)


@pytest.mark.parametrize("name", NAMES)
def test_help_by_either_name_ends_with_the_examples(name, capsys):
    texts = []
    for option in ("-h", "--help"):
        assert run([name, option]) == 0
        texts.append(capsys.readouterr().out)
    assert texts[0] == texts[1]
    command = next(c for c in COMMANDS if name == c.NAME)
    assert [line.strip() for line in texts[0].splitlines()[-2:]] == list(command.EXAMPLES)


@pytest.mark.parametrize(("name", "number"), OF_ALL)
def test_examples_run_and_every_cell_can_be_read(name, number, runs):
    directory = runs(name, number)
    assert {path.name for path in directory.iterdir()} == set(result_of(directory)["files"])
    assert (directory / "report.html").exists()
    assert next(iter(result_of(directory).items())) == ("schema_version", SCHEMA_VERSION)
    assert missing(name, number, result_of(directory)) == [], GONE
    for path in directory.glob("*.csv"):
        table = pd.read_csv(path, dtype=str, keep_default_na=False)
        assert len(table), path.name
        for column in table:
            for cell in table[column]:
                assert plain_cell(cell), f"{path.name}, {column}: {cell!r}"
    for file, column, place in SAME.get(name, ()):
        read, told = pd.read_csv(directory / file)[column], at(result_of(directory), place)
        if read.dtype.kind == "f":
            np.testing.assert_allclose(read, told, rtol=1e-12)
        else:
            assert list(read) == told


def test_the_record_of_keys_is_of_this_version_and_a_lost_key_is_seen():
    assert recorded_version() == SCHEMA_VERSION
    record = json.loads(RECORD.read_text("utf-8"))["keys"]
    assert set(record) == {f"{name} {number}" for name, number, _ in EXAMPLES if name in REPORTING}
    kept = {"name": [{"a": 1}, {"b": {"c": None}}], "files": {"x.csv": "0"}}
    assert list(keys(kept)) == ["name", "name.a", "name.b", "name.b.c", "files"]
    assert "schema_version" in missing("robots", 0, {"robots": []})


@pytest.mark.parametrize("name", sorted(OTHERS))
def test_what_the_other_commands_print_has_a_version_too(name, tmp_path, capsys):
    words = {
        "import-caspr": ["examples/caspr/bodies.xml", "examples/caspr/cables.xml", "--out", str(tmp_path / "r.toml")],
        "import-recording": [
            "examples/recordings/log.csv",
            "examples/recordings/log.toml",
            "--out",
            str(tmp_path / "mine"),
        ],
        "new-robot": ["crane", "--cables", "6", "--size", "12,12,8", "--out", str(tmp_path / "r.toml")],
        "new-campaign": ["cogiro", "--kinds", "tensions", "--poses", "0,0,1", "--out", str(tmp_path / "mine")],
        "export": ["cogiro", "--to", "moorpy", "--out", str(tmp_path / "cogiro.txt")],
        "rerun": [str(tmp_path / "first")],
    }
    if name == "rerun":
        assert run(["robots", "--out", str(tmp_path / "first"), "--quiet"]) == 0
    capsys.readouterr()
    assert run([name, *words[name], "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["schema_version"] == SCHEMA_VERSION


def test_json_is_written_in_one_place():
    """Others write no results: data inside report pages, a glTF file, a part of interrupted work."""
    inside = {"reports/mode_viewer.py", "reports/html.py", "reports/gltf_file.py", "cli/many_inputs.py"}
    source = ROOT / "cdpr_struct"
    writing = {p.relative_to(source).as_posix() for p in source.rglob("*.py") if "json.dump" in p.read_text("utf-8")}
    assert writing == {"reports/plain_json.py", *inside}


def plain_cell(cell: str) -> bool:
    """A number, words, or nothing; not how Python writes a value."""
    return PYTHON.search(cell) is None


@pytest.mark.parametrize("cell", ["np.float64(2.48)", "[1, 2]", "array([1.0])", "(1+2j)", "{'a': 1}", "nan", "True"])
def test_cells_that_no_spreadsheet_reads_are_seen(cell):
    assert not plain_cell(cell)


def test_tables_are_compared_for_every_command_that_writes_lists():
    assert set(SAME) <= set(REPORTING)


@pytest.mark.parametrize("name", REPORTING)
def test_the_command_on_a_page_gives_the_same_result(name, runs, tmp_path):
    first_run = runs(name, 1 if name in LONG else 0)
    page = (first_run / "report.html").read_text("utf-8")
    shown = re.search(r"<h2>Reproduce</h2>\s*<pre>(.*?)</pre>", page, re.DOTALL)[1]
    line = unescape(re.sub(r"<[^>]+>", "", shown))  # words that no screen breaks are marked up
    words = [word.replace("--out=DIR", f"--out={tmp_path}") for word in shlex.split(line)[1:]]
    assert f"--out={tmp_path}" in words
    assert run([*words, "--quiet"]) == FAILS.get(name, 0)
    first, again = result_of(first_run), result_of(tmp_path)
    clocked = CLOCK | {"files"} if CLOCK & set(first) else set()
    assert {k: v for k, v in first.items() if k not in clocked} == {k: v for k, v in again.items() if k not in clocked}


def test_repeating_leaves_out_where_results_go_and_nothing_else():
    typed = ["map", "r.toml", "--lower-bound", "60", "--out", "d", "--json", "--quiet", "--overwrite", "--mass=3"]
    assert repeating(typed) == ("cdpr-struct", "map", "r.toml", "--lower-bound", "60", "--mass=3", "--out=DIR")
    assert repeating(["modes", "r.toml", "-q", "--out=d", "--scheduler", "tcp://a:1"])[1:-1] == ("modes", "r.toml")


def test_nothing_older_stays_beside_a_new_result(tmp_path):
    assert run(["cable", "--force", "100,-100", "--length", "20", "--EA", "251327", "--rho", "0.067",
                "--out", str(tmp_path), "--quiet"]) == 0  # fmt: skip
    older = {path.name for path in tmp_path.iterdir()}
    assert run(["robots", "--out", str(tmp_path), "--quiet"]) == 0
    now = {path.name for path in tmp_path.iterdir()}
    assert "profile.csv" in older
    assert not (older - {"result.json", "report.html"}) & now
    assert now == set(result_of(tmp_path)["files"])


@pytest.mark.parametrize("mine", ["result.json", "robots.csv"])
def test_what_a_user_wrote_is_not_overwritten_without_being_told(mine, tmp_path, capsys):
    (tmp_path / mine).write_text("my own")
    words = ["robots", "--out", str(tmp_path), "--quiet"]
    assert run(words) == 2
    assert f"{mine}: got" not in (told := capsys.readouterr().err)
    assert mine in told
    assert "--overwrite" in told
    assert {path.name for path in tmp_path.iterdir()} == {mine}
    assert (tmp_path / mine).read_text() == "my own"
    assert run([*words, "--overwrite"]) == 0
    assert (tmp_path / mine).read_text() != "my own"


def test_a_result_that_the_user_edited_is_not_overwritten(tmp_path, capsys):
    words = ["robots", "--out", str(tmp_path), "--quiet"]
    assert run(words) == 0
    assert run(words) == 0
    (tmp_path / "report.html").write_text("with my notes")
    assert run(words) == 2
    assert "report.html" in capsys.readouterr().err


def test_a_screen_that_is_closed_loses_no_file(tmp_path):
    """`| head` closes the pipe before anything is printed."""
    words = [sys.executable, "-m", "cdpr_struct", "robots", "--out", str(tmp_path / "d")]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=ROOT)
    process.stdout.close()
    told = process.stderr.read().decode()
    process.stderr.close()
    assert process.wait() == 0, told
    assert "Traceback" not in told
    assert (tmp_path / "d" / "report.html").exists()


@pytest.mark.parametrize("name", ["robots", "map"])
def test_quiet_prints_nothing_but_json(name, capfd):
    line = next(command.EXAMPLES[0] for command in COMMANDS if name == command.NAME)
    assert run([*words_of(line), "--quiet"]) == 0
    assert capfd.readouterr() == ("", "")
    assert run([*words_of(line), "--quiet", "--json"]) == 0
    out, err = capfd.readouterr()
    assert json.loads(out)
    assert err == ""


def test_the_program_runs_as_a_module_and_tells_its_version():
    import cdpr_struct

    asked = subprocess.run([sys.executable, "-m", "cdpr_struct", "--version"], capture_output=True, text=True, cwd=ROOT)
    assert asked.stdout.strip() == f"cdpr-struct {cdpr_struct.__version__}"
    assert (ROOT / "LICENSE").read_text().startswith("BSD 3-Clause")
    assert f"version: {cdpr_struct.__version__}" in (ROOT / "CITATION.cff").read_text()
    assert (ROOT / "cdpr_struct" / "py.typed").exists()


def test_import_caspr_asks_before_it_overwrites(tmp_path, capsys):
    robot = tmp_path / "lift.toml"
    words = ["import-caspr", "examples/caspr/bodies.xml", "examples/caspr/cables.xml", "--out", str(robot)]
    assert run(words) == 0
    assert run(words) == 0  # the same text again harms nobody
    robot.write_text(robot.read_text() + "# mine\n")
    assert run(words) == 2
    assert "--overwrite" in capsys.readouterr().err
    assert "# mine" in robot.read_text()
    assert run([*words, "--overwrite"]) == 0
    assert "# mine" not in robot.read_text()
