"""forward, pose-error, map: what they print, what they write, and how a map survives an interruption."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from concurrent.futures import BrokenExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.reports.locked_rest import locked_checks
from cdpr_struct.reports.trust import Trust
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.statics.locked_rest import locked_rest
from cdpr_struct.workspace import quantities, sweep, work_list

GRID = "-3:3:7,-3:3:7,0.5"
MAP = ["map", "thesis-3-1", "--grid=-3:3:9,-3:3:9,0.5", "--quantity", "tension-max", "--chunk", "20"]


def result_of(arguments, capsys) -> dict:
    """result.json on stdout, and nothing else there."""
    assert run([*arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("model", ["sagging", "spring", "ideal"])
def test_forward_undoes_inverse(model, capsys):
    pose = [0.7, -0.4, 0.8, 2.0, -1.0, 3.0]
    held = result_of(["inverse", "cogiro", f"--pose={','.join(map(str, pose))}", "--model", model], capsys)
    lengths = ",".join(repr(v) for v in held["lengths_m"])
    found = result_of(["forward", "cogiro", "--lengths", lengths, "--model", model], capsys)
    ideal = model == "ideal"
    assert found["pose"] == pytest.approx(pose, abs=1e-3 if ideal else 1e-8)
    if not ideal:  # ideal cables of a redundant robot leave the tensions open
        assert found["tensions_N"] == pytest.approx(held["tensions_N"], rel=1e-6)
    assert found["stable"] is True
    assert max(abs(v) for v in found["residual_wrench"]) < (1e-2 if ideal else 1e-6)  # ideal: EA of 2.5e11 N


def test_forward_flags_slack_springs(capsys):
    lengths = ["9.5"] * 7 + ["14.0"]
    found = result_of(["forward", "thesis-3-1", "--lengths", ",".join(lengths), "--model", "spring"], capsys)
    assert found["slack"][7] is True
    assert found["tensions_N"][7] == 0.0


def test_forward_hangs_a_platform_on_four_of_its_cables(tmp_path, capsys):
    """Fewer cables than degrees of freedom: gravity holds the rest."""
    from importlib import resources

    text = resources.files("cdpr_struct.robot.builtin").joinpath("thesis-3-1.toml").read_text("utf-8")
    path = tmp_path / "four.toml"
    path.write_text(text.partition("[[cables]]  # 5")[0])
    found = result_of(["forward", str(path), "--lengths", "10.6,10.6,10.6,10.6"], capsys)
    assert found["stable"] is True
    assert np.abs(found["pose"][:2]).max() < 1e-6


def test_forward_and_inverse_write_whole_reports(tmp_path):
    for arguments in (
        ["inverse", "thesis-3-1", "--model", "spring"],
        ["forward", "thesis-3-1", "--lengths", "9.5,9.5,9.5,9.5,9.5,9.5,9.5,14", "--model", "spring"],
    ):
        out = tmp_path / arguments[0]
        assert run([*arguments, "--out", str(out)]) == 0
        assert {p.name for p in out.iterdir()} == {"result.json", "cables.csv", "robot.svg", "robot.pdf", "report.html"}
        assert "nan" not in (out / "cables.csv").read_text()


def test_pose_error_meets_table_3_2(capsys):
    """4 mm, 30 kg: 5.4, -9.7, -4.3 mm."""
    found = result_of(["pose-error", "thesis-3-1", f"--grid={GRID}", "--mass", "30"], capsys)
    means = [found["mean_mm"][part] for part in ("sag", "axial", "global")]
    assert means == pytest.approx([5.4, -9.7, -4.3], abs=0.07)
    assert found["poses"] == found["held"] == found["stable"] == 49
    assert found["mean_mm"]["global"] == pytest.approx(found["mean_mm"]["sag"] + found["mean_mm"]["axial"], abs=1e-12)


def test_payload_is_added_to_the_mass(capsys):
    grid = "--grid=-1:1:3,0,0.5"
    by_mass = result_of(["pose-error", "thesis-3-1", grid, "--mass", "75"], capsys)["mean_mm"]
    by_load = result_of(["pose-error", "thesis-3-1", grid, "--payload", "15"], capsys)["mean_mm"]
    assert by_mass == pytest.approx(by_load, rel=1e-9)


def test_poses_that_cannot_be_held_do_not_count(tmp_path, capsys):
    arguments = ["pose-error", "thesis-3-1", "--grid=0:20:3,0,0.5", "--out", str(tmp_path)]
    found = result_of(arguments, capsys)
    assert found["poses"] == 3
    assert found["held"] == 1
    rows = (tmp_path / "pose_error.csv").read_text().splitlines()
    assert len(rows) == 4
    centre = result_of(["pose-error", "thesis-3-1", "--grid=0,0,0.5"], capsys)
    assert found["mean_mm"] == pytest.approx(centre["mean_mm"], rel=1e-9)


def test_a_grid_outside_the_workspace_is_refused_with_the_reason(capsys):
    assert run(["pose-error", "thesis-3-1", "--grid=20:30:3,0,0.5"]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "ideal cables hold 0" in captured.err


def test_sufficient_load_keeps_its_promise(capsys):
    """Just below the mass the spring model is off by more than the tolerance, just above by less."""
    found = result_of(["pose-error", "six-cable-4mm", "--sufficient-load", "1"], capsys)["sufficient_load"]
    mass = found["mass_kg"]
    pose = ",".join(str(v) for v in found["pose"][:3])
    for factor, inside in ((0.99, False), (1.01, True)):
        at = result_of(["pose-error", "six-cable-4mm", f"--grid={pose}", "--mass", str(factor * mass)], capsys)
        assert (abs(at["mean_mm"]["sag"]) <= 1.0) is inside


def test_pose_error_writes_every_file(tmp_path):
    arguments = [
        "pose-error",
        "thesis-3-1",
        "--grid=-2:2:5,-2:2:5,0.5",
        "--sufficient-load",
        "1",
        "--out",
        str(tmp_path),
    ]
    assert run(arguments) == 0
    names = {path.name for path in tmp_path.iterdir()}
    tables = {"result.json", "pose_error.csv", "sufficient_load.csv"}
    figures = {f"{name}.{form}" for name in ("pose_error", "sufficient_load") for form in ("svg", "pdf")}
    assert names == tables | figures | {"report.html"}


BODY = '[[bodies]]\nfixed_to = "frame"\nshape = "sphere"\nradius = 0.2\ncenter = [3.0, 0.0, 1.0]\n'
MOST = ["--upper-bound", "20000"]


@pytest.mark.parametrize("name", [*quantities.QUANTITIES, "mode-1"])
def test_every_quantity_can_be_mapped(name, tmp_path):
    out, file = tmp_path / name, tmp_path / "robot.toml"
    file.write_text(robot_toml(load_robot("thesis-3-1"), "thesis-3-1") + BODY)
    assert run(["map", str(file), "--grid=-2:2:3,-2:2:3,0.5", "--quantity", name, "--out", str(out), *MOST]) == 0
    result = json.loads((out / "result.json").read_text())
    assert result["smallest"]["value"] <= result["mean"] <= result["largest"]["value"]
    assert {p.name for p in out.iterdir()} == {"result.json", "map.csv", "map.svg", "map.pdf", "report.html"}


@pytest.mark.parametrize("asked", [["body-distance"], ["workspace", "--require", "body-distance>=0.1"]])
def test_a_robot_without_bodies_has_no_distance_to_them(asked, capsys):
    assert run(["map", "thesis-3-1", "--grid=-2:2:3,-2:2:3,0.5", "--quantity", *asked]) == 2
    assert "bodies: got 'none'; enter `[[bodies]]` in the robot file" in capsys.readouterr().err


def test_cables_without_a_largest_force_have_no_margin_to_it(capsys):
    assert run(["map", "thesis-3-1", "--grid=-2:2:3,-2:2:3,0.5", "--quantity", "force-margin"]) == 2
    assert "--upper-bound is missing; force-margin needs a finite upper bound" in capsys.readouterr().err


def test_smallest_stiffness_is_the_softest_direction(capsys):
    """No direction is softer than the reported one, the vertical among them."""
    least = result_of(["map", "thesis-3-1", "--grid=1,0.5,0.5", "--quantity", "stiffness-min"], capsys)["mean"]
    vertical = result_of(["map", "thesis-3-1", "--grid=1,0.5,0.5", "--quantity", "stiffness-vertical"], capsys)["mean"]
    assert 0.0 < least <= vertical


def test_vertical_stiffness_is_the_slope_of_the_forward_kinematics(capsys):
    """Load steps at locked lengths, central difference."""
    pose = "1,0.5,0.5"
    held = result_of(["inverse", "thesis-3-1", f"--pose={pose}"], capsys)
    lengths = ",".join(repr(v) for v in held["lengths_m"])
    heights = [
        result_of(["forward", "thesis-3-1", "--lengths", lengths, "--mass", str(mass)], capsys)["pose"][2]
        for mass in (59.99, 60.01)
    ]
    slope = 0.02 * 9.81 / (heights[0] - heights[1]) * 1e-3  # N/mm
    mapped = result_of(["map", "thesis-3-1", f"--grid={pose}", "--quantity", "stiffness-vertical"], capsys)["mean"]
    assert mapped == pytest.approx(slope, rel=1e-5)


def test_chunks_and_processes_do_not_change_a_map(tmp_path, capsys):
    one = tmp_path / "one"
    two = tmp_path / "two"
    assert run([*MAP[:-1], "1000", "--out", str(one)]) == 0
    assert run([*MAP, "--workers", "2", "--out", str(two)]) == 0
    assert (one / "map.csv").read_text() == (two / "map.csv").read_text()


def test_an_interrupted_map_continues(tmp_path, capsys, monkeypatch):
    """Stop after two chunks; the second run computes the other three only, and the files are the same."""
    clean, torn = tmp_path / "clean", tmp_path / "torn"
    assert run([*MAP, "--out", str(clean)]) == 0
    computed, allowed = [], 2
    real = quantities.evaluate

    def counted(*arguments):
        if len(computed) == allowed:
            raise KeyboardInterrupt
        computed.append(1)
        return real(*arguments)

    monkeypatch.setattr(sweep, "evaluate", counted)
    assert run([*MAP, "--out", str(torn)]) == 130
    assert "2 of 5 parts are kept" in capsys.readouterr().err
    assert not (torn / "result.json").exists()
    allowed = 10
    assert run([*MAP, "--out", str(torn)]) == 0
    assert len(computed) == 5
    assert json.loads((torn / "result.json").read_text())["resumed_chunks"] == 2
    assert (torn / "map.csv").read_text() == (clean / "map.csv").read_text()
    assert not [p for p in torn.iterdir() if p.name.startswith(".")], "the checkpoint was left behind"


def test_a_checkpoint_of_another_load_is_not_mixed_in(tmp_path, monkeypatch, capsys):
    def interrupted(*arguments):
        raise KeyboardInterrupt

    out = tmp_path / "map"
    real = quantities.evaluate
    calls = iter([real, interrupted])
    monkeypatch.setattr(sweep, "evaluate", lambda *a: next(calls, interrupted)(*a))
    assert run([*MAP, "--out", str(out)]) == 130
    monkeypatch.setattr(sweep, "evaluate", real)
    capsys.readouterr()
    found = result_of([*MAP, "--mass", "30", "--out", str(out)], capsys)
    assert found["resumed_chunks"] == 0


def test_a_torn_checkpoint_file_is_computed_again(tmp_path):
    from cdpr_struct.cli.checkpoint import Checkpoint

    store = Checkpoint(tmp_path, "abc")
    store.keep("000000", {"a": np.arange(3.0)})
    store.keep("000001", {"a": np.arange(3.0)})
    (tmp_path / ".checkpoint-abc" / "chunk-000001.npz").write_bytes(b"PK\x03\x04 torn")
    assert list(store.parts(["000000", "000001", "000002"])) == [0]


LONG = ["map", "six-cable-8mm", "--grid=-3:3:41,-3:3:41,0.5", "--quantity", "tension-max", "--chunk", "16"]


def started(*more: str, command: Sequence[str] = LONG) -> subprocess.Popen[str]:
    """A command, a long map if none is given, in a process of its own."""
    program = [sys.executable, "-c", "from cdpr_struct.cli.main import main; main()"]
    return subprocess.Popen(
        [*program, *command, *more], stderr=subprocess.PIPE, text=True, preexec_fn=_heeds_interrupts
    )


def _heeds_interrupts() -> None:
    """Ctrl-C stops the process, also where the tests run in the background of a shell, which ignores it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def wait_for(condition) -> None:
    deadline = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < deadline, "nothing happened within a minute"
        time.sleep(0.02)


def chunks_kept(directory: Path) -> int:
    return len(list(directory.glob(".checkpoint-*/chunk-*")))


def workers_of(process: int) -> list[int]:
    """Process numbers of the spawned workers of a process."""
    children = Path(f"/proc/{process}/task/{process}/children")
    found = [int(word) for word in children.read_text().split()] if children.exists() else []
    return [n for n in found if b"spawn_main" in Path(f"/proc/{n}/cmdline").read_bytes()]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_stopped_map_keeps_its_chunks_and_ends_its_workers(tmp_path, number):
    """Ctrl-C, or a request to end as batch systems send it."""
    process = started("--workers", "2", "--out", str(tmp_path))
    wait_for(lambda: chunks_kept(tmp_path) >= 2)
    workers = workers_of(process.pid)
    assert len(workers) == 2
    process.send_signal(number)
    assert "the same command continues" in process.communicate(timeout=60)[1]
    assert process.returncode == 130
    assert not any(Path(f"/proc/{worker}").exists() for worker in workers)


@pytest.mark.slow
def test_a_killed_worker_costs_nothing_but_time(tmp_path):
    clean, torn = tmp_path / "clean", tmp_path / "torn"
    assert run([*LONG, "--out", str(clean)]) == 0
    process = started("--workers", "2", "--out", str(torn))
    wait_for(lambda: chunks_kept(torn) >= 2)
    os.kill(workers_of(process.pid)[0], signal.SIGKILL)
    assert process.communicate(timeout=120)[1].count("Traceback") == 0
    assert process.returncode == 0
    assert (torn / "map.csv").read_text() == (clean / "map.csv").read_text()


def test_workers_that_die_again_and_again_are_told(monkeypatch, capsys):
    def broken(*arguments):
        raise BrokenExecutor

    monkeypatch.setattr(work_list, "run_parts", broken)
    assert run(MAP) == 1
    assert "worker processes were ended from outside 3 times" in capsys.readouterr().err


def test_a_cluster_that_gives_up_is_told_in_one_line(monkeypatch, capsys):
    """As where the scheduler goes away."""
    client = pytest.importorskip("distributed").client

    def failing(*arguments):
        raise client.FutureCancelledError("chunk", "scheduler-connection-lost")

    monkeypatch.setattr(work_list, "run_parts", failing)
    assert run(MAP) == 1
    line = capsys.readouterr().err.strip().splitlines()[-1]
    assert "gave up (FutureCancelledError" in line
    assert "finished parts are kept" in line


@pytest.mark.slow
def test_a_dask_cluster_of_processes_does_the_same_though_a_worker_is_killed(tmp_path):
    """Two worker processes on this machine; the scheduler gives the work of the one that is killed to the other."""
    distributed = pytest.importorskip("distributed")
    here, there = tmp_path / "here", tmp_path / "there"
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as cluster,
        distributed.Client(cluster) as client,
    ):
        process = started("--scheduler", cluster.scheduler_address, "--out", str(there))
        wait_for(lambda: chunks_kept(there) >= 2)
        os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)
        process.communicate(timeout=120)
    assert process.returncode == 0
    assert run([*LONG, "--out", str(here)]) == 0
    assert (there / "map.csv").read_text() == (here / "map.csv").read_text()


COGIRO_LENGTHS = "10.1013,9.8141,6.562,6.1095,12.6744,11.9695,14.4796,14.6593"


def test_forward_says_how_it_got_there_and_which_other_poses_exist(tmp_path, capsys):
    words = ["forward", "cogiro", "--lengths", COGIRO_LENGTHS, "--equilibria", "--out", str(tmp_path)]
    assert run(words) == 0
    said = capsys.readouterr().out
    assert "followed from the home pose (0.012, 0.0697, 1.219) m" in said
    assert "4 other stable poses exist" in said
    found = json.loads((tmp_path / "result.json").read_text())
    assert found["pose"] == pytest.approx([-3.8688, 2.9127, 0.7823, 5.326, -2.136, -8.608], abs=1e-3)
    assert found["locked"]["way"] == "continued"
    assert len(found["locked"]["other_equilibria"]) == 4
    assert len(list(tmp_path.glob("equilibrium_*.svg"))) == 4
    assert "followed from the home pose" in (tmp_path / "report.html").read_text()
    assert found["warnings"] == []


@pytest.mark.parametrize(
    ("command", "more"),
    [
        ("forward", []),
        ("modes", ["--count", "2"]),
        ("frf", ["--excite", "fz", "--respond", "z", "--band", "1:3:0.1"]),
        ("transient", ["--initial-velocity", "0,0,0.1", "--duration", "1", "--highest", "5"]),
        ("audit", []),
    ],
)
def test_start_chooses_among_equilibria_and_a_tumbled_one_is_warned_of(command, more, capsys):
    start = ["--start=-3.769,2.688,0.983,-22,68,73"]
    run([command, "cogiro", "--lengths", COGIRO_LENGTHS, *start, *more, "--json"])
    found = json.loads(capsys.readouterr().out)
    assert found["locked"]["pose"] == pytest.approx([-3.7686, 2.6881, 0.9833, -22.408, 67.759, 72.919], abs=1e-3)
    assert found["locked"]["start"] == [-3.769, 2.688, 0.983, -22, 68, 73]
    assert any("230 J less energy" in sentence for sentence in found["warnings"])


def test_a_platform_that_turned_over_is_warned_of():
    lengths = [float(value) for value in COGIRO_LENGTHS.split(",")]
    tumbled = locked_rest(load_robot("cogiro"), lengths, Pose.from_degrees([-3.769, 2.688, 1, -22, 68, 73]))
    assert "less energy" in Trust(tuple(locked_checks(tumbled))).warnings[0]
    fallen = replace(tumbled, start=load_robot("cogiro").home, way="continued", steps=9, jumps=1)
    jumped, turned = Trust(tuple(locked_checks(fallen))).warnings
    assert "ended once" in jumped
    assert "turned by 108 deg" in turned


def test_start_without_lengths_is_refused(capsys):
    assert run(["modes", "cogiro", "--start", "0,0,1"]) == 2
    assert "--start: got '0,0,1'; it belongs to --lengths" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["load-on-one-rope", "planar-four-cables"])
def test_free_and_guided_platforms_are_told_on_screen_in_json_and_on_the_page(name, tmp_path, capsys):
    path = str(Path(__file__).parents[2] / "examples" / "robots" / name / "robot.toml")
    assert run(["modes", path, "--count", "3", "--out", str(tmp_path / "modes")]) == 0
    said = "Nothing pushes the platform back in one direction (0 Hz)" if "rope" in name else "A guide holds y, rx, rz"
    assert said in capsys.readouterr().out
    told = json.loads((tmp_path / "modes" / "result.json").read_text("utf-8"))
    assert ("guide" in told, len(told["neutral_freedoms"])) == ((False, 1) if "rope" in name else (True, 0))
    assert said in (tmp_path / "modes" / "report.html").read_text("utf-8")
