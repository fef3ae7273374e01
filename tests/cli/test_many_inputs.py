"""One command for many inputs: as if each had been answered by itself, on any worker."""

import json
import os
import shlex
import signal
import sys
from concurrent.futures import BrokenExecutor
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.cli import distribute
from cdpr_struct.cli.main import run
from cdpr_struct.cli.many_inputs import short_names
from cdpr_struct.interface import limits
from tests.blind.running import diagnose_all
from tests.cli.conftest import ROOT
from tests.cli.test_statics_commands import started, wait_for

LEVEL = "examples/table-4-4/level.toml"


def written(path: Path, width: float, instants: int = 21) -> Path:
    """A trajectory file."""
    time = np.linspace(0.0, 4.0, instants)
    rows = [f"{t},{width * np.sin(t)},{0.2 * t},{2.0 + 0.1 * t}" for t in time]
    path.write_text("\n".join(["time_s,x_m,y_m,z_m", *rows]) + "\n")
    return path


@pytest.fixture
def paths(tmp_path) -> Path:
    """A directory with three trajectories."""
    folder = tmp_path / "paths"
    folder.mkdir()
    for number in (1, 2, 3):
        written(folder / f"path{number}.csv", 0.3 * number)
    return folder


def words(paths: Path, out: Path, *more: str) -> list[str]:
    return ["distribute", "thesis-5", "--trajectory", str(paths), "--out", str(out), "--quiet", *more]


def results(out: Path) -> dict[str, dict]:
    """result.json of every input, less the digests of its files."""
    found = {path.parent.name: json.loads(path.read_text()) for path in out.glob("*/result.json")}
    return {name: {k: v for k, v in result.items() if k != "files"} for name, result in found.items()}


@pytest.mark.parametrize(
    ("inputs", "names"),
    [
        (["a.csv", "b.csv"], ["a", "b"]),
        (["runs/a/campaign.toml", "runs/b/campaign.toml"], ["a", "b"]),
        (["x/a.csv", "y/a.csv", "y/b.csv"], ["x-a", "y-a", "y-b"]),
        (["1/x/a.csv", "2/x/a.csv", "b.csv"], ["0001-x-a", "0002-x-a", "0003-b"]),
        (["line:0,0,2:1,0,2.5:4", "../a b.csv"], ["line_0_0_2_1_0_2", "a_b"]),
    ],
)
def test_folders_have_short_and_different_names(inputs, names):
    assert short_names(inputs) == names


@pytest.mark.slow
def test_each_trajectory_is_answered_as_if_alone(paths, tmp_path):
    out, alone = tmp_path / "out", tmp_path / "alone"
    assert run(words(paths, out, "--workers", "2")) == 0
    table = json.loads((out / "result.json").read_text())["trajectories"]
    assert [row["folder"] for row in table] == ["path1", "path2", "path3"]
    for row in table:
        page = (out / row["folder"] / "report.html").read_text()
        typed = page.split("<pre>cdpr-struct ")[1].split("</pre>")[0]
        assert run([*shlex.split(typed)[:-1], "--out", str(alone / row["folder"]), "--quiet"]) == 0
    assert results(out) == results(alone)
    first = results(out)["path1"]
    assert table[0]["max_force_N"] == max(first["max_force_N"])
    assert table[0]["min_cable_frequency_hz"] == first["min_cable_frequency_hz"]
    assert len((out / "trajectories.csv").read_text().splitlines()) == 4


def test_an_input_that_cannot_be_used_does_not_stop_the_others(paths, tmp_path, capsys):
    (paths / "bad.csv").write_text("time_s,x_m\n0,1\n")
    out = tmp_path / "out"
    assert run([w for w in words(paths, out) if w != "--quiet"]) == 2
    said = capsys.readouterr().out
    assert "1 without an answer" in said
    assert "column y_m is missing" in said
    assert sorted(results(out)) == ["path1", "path2", "path3"]
    row = json.loads((out / "result.json").read_text())["trajectories"][0]
    assert (row["exit_code"], row["folder"]) == (2, "bad")


@pytest.mark.slow
def test_interrupted_work_continues_and_a_changed_input_is_answered_anew(paths, tmp_path, monkeypatch, capsys):
    out, asked, real = tmp_path / "out", [], distribute.answer

    def stopping(text, *given):
        if len(asked) == 2:
            raise KeyboardInterrupt
        asked.append(Path(text).name)
        return real(text, *given)

    monkeypatch.setattr(distribute, "answer", stopping)
    assert run(words(paths, out)) == 130
    assert "2 of 3 parts are kept" in capsys.readouterr().err
    assert not (out / "result.json").exists()
    changed = asked[0]
    written(paths / changed, 0.05)
    asked.clear()
    monkeypatch.setattr(
        distribute, "answer", lambda text, *given: (asked.append(Path(text).name), real(text, *given))[1]
    )
    assert run(words(paths, out)) == 0
    assert len(asked) == 2
    assert changed in asked
    assert not list(out.glob(".checkpoint*"))
    clean = tmp_path / "clean"
    monkeypatch.setattr(distribute, "answer", real)
    assert run(words(paths, clean)) == 0
    assert results(out) == results(clean)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--trajectory", "EMPTY"], "a directory with CSV files"),
        (["--trajectory", "helix", "--trajectory", "helix"], "given twice"),
        (["--trajectory", "PATHS", "--instants", "7"], "have their own instants"),
        (["--trajectory", "PATHS", "--workers", "0"], "--workers"),
    ],
)
def test_unusable_lists_are_refused(paths, tmp_path, capsys, arguments, told):
    (tmp_path / "empty").mkdir()
    places = {"EMPTY": str(tmp_path / "empty"), "PATHS": str(paths)}
    assert run(["distribute", "thesis-5", *(places.get(word, word) for word in arguments)]) == 2
    assert told in capsys.readouterr().err


@pytest.mark.slow
def test_many_campaigns_give_one_table(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    broken = tmp_path / "broken.toml"
    broken.write_text('robot = "cogiro"\n')
    out, alone = tmp_path / "out", tmp_path / "alone"
    assert run(["diagnose", LEVEL, str(broken), "--workers", "2", "--out", str(out), "--quiet"]) == 2
    assert run(["diagnose", LEVEL, "--out", str(alone / "level"), "--quiet"]) == 0
    rows = json.loads((out / "result.json").read_text())["campaigns"]
    verdict, same = (results(place)["level"]["verdict"] for place in (alone, out))
    assert same["probability"] == pytest.approx(verdict["probability"], rel=1e-6)  # rounding depends on the process
    assert {**same, "probability": 0.0} == {**verdict, "probability": 0.0}
    assert (rows[0]["status"], rows[0]["probability"]) == (same["status"], same["probability"])
    assert "measurement" in rows[1]["message"]
    assert (out / "verdicts.svg").exists()


@pytest.fixture(scope="module")
def cluster():
    """Two worker processes on this machine, with their scheduler."""
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": ":0"}
    with distributed.LocalCluster(**options) as local, distributed.Client(local) as client:
        yield client


GRID = "--grid=-3:3:9,-3:3:9,0.5"


@pytest.mark.parametrize(
    ("command", "table"),
    [
        (["pose-error", "thesis-3-1", GRID], "pose_error.csv"),
        (["audit", "thesis-3-1", GRID], "audit.csv"),
        pytest.param(["audit", "--limits", "--small"], "cables.csv", marks=pytest.mark.slow),
    ],
)
def test_a_cluster_gives_the_same_numbers(cluster, tmp_path, command, table):
    here, there = tmp_path / "here", tmp_path / "there"
    code = run([*command, "--out", str(here), "--quiet"])
    address = cluster.scheduler.address
    assert run([*command, "--scheduler", address, "--out", str(there), "--quiet"]) == code
    assert (there / table).read_text() == (here / table).read_text()


@pytest.mark.slow
def test_trajectories_survive_a_killed_worker_of_a_cluster(cluster, tmp_path):
    folder = tmp_path / "paths"
    folder.mkdir()
    for number in range(4):
        written(folder / f"path{number:02d}.csv", 0.05 * number)
    here, there = tmp_path / "here", tmp_path / "there"
    process = started("--scheduler", cluster.scheduler.address, command=words(folder, there))
    wait_for(lambda: len(list(there.glob("*/result.json"))) >= 1)
    os.kill(next(iter(cluster.run(os.getpid).values())), signal.SIGKILL)
    said = process.communicate(timeout=120)[1]
    assert process.returncode == 0, said
    assert run(words(folder, here)) == 0
    assert results(there) == results(here)
    assert (there / "trajectories.csv").read_text() == (here / "trajectories.csv").read_text()


@pytest.mark.slow
def test_limits_whose_workers_are_killed_say_so(monkeypatch, capsys):
    def broken(*arguments):
        raise BrokenExecutor

    monkeypatch.setattr(limits, "try_limits", broken)
    assert run(["audit", "--limits", "--small"]) == 1
    assert "a worker process was ended from outside" in capsys.readouterr().err


@pytest.mark.slow
def test_blind_campaigns_are_diagnosed_by_a_cluster(cluster, tmp_path):
    """With a command that only says which campaign it was given: the harness is on trial here."""
    for name in ("c001", "c002"):
        (tmp_path / "campaigns" / name).mkdir(parents=True)
        (tmp_path / "campaigns" / name / "campaign.toml").write_text(name)
    program = "import pathlib, sys; d = pathlib.Path(sys.argv[3]); d.mkdir(); "
    program += "(d / 'result.json').write_text(pathlib.Path(sys.argv[1]).read_text())"
    given = (tmp_path / "campaigns", tmp_path / "answers", "small", 1, [sys.executable, "-c", program])
    assert diagnose_all(*given, scheduler=cluster.scheduler.address) == 2
    assert [(tmp_path / "answers" / n / "result.json").read_text() for n in ("c001", "c002")] == ["c001", "c002"]
    assert diagnose_all(*given, scheduler=cluster.scheduler.address) == 0
