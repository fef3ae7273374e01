"""Every long command, stopped in mid-run: exit code 130, one sentence, no worker left, finished parts continued."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.cli.main import run
from tests.cli.test_statics_commands import chunks_kept, started, wait_for, workers_of

pytestmark = [pytest.mark.slow, pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="reads /proc")]
ROOT = Path(__file__).parents[2]
BEGUN = 3.0  # s of processor time: after the imports, long before the end
GRID = "-3:3:301,-3:3:301,0.5"
LINES = [f"--trajectory=line:-2,-2,1:2,{y},1:5" for y in range(-2, 3)]
COMMANDS = {
    "map": ["map", "thesis-3-1", "--grid", GRID, "--quantity", "first-frequency", "--workers", "2"],
    "pose-error": ["pose-error", "thesis-3-1", "--grid", GRID, "--workers", "2"],
    "audit": ["audit", "thesis-3-1", "--grid", GRID, "--workers", "2"],
    "audit-limits": ["audit", "--limits", "--workers", "2"],
    "distribute": ["distribute", "thesis-3-1", *LINES, "--instants", "3001", "--workers", "2"],
    "diagnose": ["diagnose", "examples/soft-masts/campaign.toml"],
    "diagnose-many": [
        "diagnose",
        "examples/soft-masts/campaign.toml",
        "examples/table-4-4/campaign.toml",
        "--workers=2",
    ],
    "one-worker": ["distribute", "thesis-3-1", *LINES, "--instants", "3001"],
    "plan": ["plan", "examples/soft-masts/campaign.toml"],
    "verify": ["verify", "thesis-3-1"],
    "transient": ["transient", "thesis-3-1", "--initial-velocity=0.1,0,0", "--duration", "1000", "--highest", "50"],
}


def processor_time(process: int) -> float:
    """Of a process and its workers [s]."""
    total = 0.0
    for number in (process, *workers_of(process)):
        stat = Path(f"/proc/{number}/stat")
        fields = stat.read_text().rpartition(")")[2].split() if stat.exists() else []
        total += sum(map(int, fields[11:13])) / os.sysconf("SC_CLK_TCK")
    return total


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP], ids=lambda number: number.name)
@pytest.mark.parametrize("name", COMMANDS)
def test_a_stopped_command_ends_in_order(name, number, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    process = started("--out", str(tmp_path / "out"), command=COMMANDS[name])
    wait_for(lambda: processor_time(process.pid) > BEGUN or process.poll() is not None)
    workers = workers_of(process.pid)
    process.send_signal(number)
    told = process.communicate(timeout=60)[1]
    assert process.returncode == 130, told
    assert "Traceback" not in told
    assert "interrupted" in told.strip().splitlines()[-1]
    assert not any(Path(f"/proc/{worker}").exists() for worker in workers)
    assert not (tmp_path / "out" / "result.json").exists()


def test_workers_end_where_their_parent_is_killed(tmp_path):
    """Nobody can catch SIGKILL, and the kernel sends it where memory runs out."""
    process = started("--workers", "2", "--out", str(tmp_path))
    wait_for(lambda: chunks_kept(tmp_path) >= 2)
    workers = workers_of(process.pid)
    assert len(workers) == 2
    process.kill()
    process.communicate(timeout=60)
    wait_for(lambda: not any(Path(f"/proc/{worker}/exe").exists() for worker in workers))


def test_the_same_map_twice_at_once_in_one_directory(tmp_path):
    words = ["map", "six-cable-8mm", "--grid=-2:2:9,-2:2:9,0.5", "--quantity", "tension-max", "--chunk", "4"]
    pair = [started("--quiet", "--out", str(tmp_path / "out"), command=words) for _ in range(2)]
    ends = [(process.communicate(timeout=120)[1], process.returncode) for process in pair]
    assert ends == [("", 0), ("", 0)]
    assert run([*words, "--quiet", "--out", str(tmp_path / "alone")]) == 0
    assert (tmp_path / "out" / "map.csv").read_text() == (tmp_path / "alone" / "map.csv").read_text()
    assert not [p for p in (tmp_path / "out").iterdir() if p.name.startswith(".")]


def test_two_different_maps_at_once_in_one_directory(tmp_path):
    """One result stands, whole; which one is not said."""
    words = ["map", "six-cable-8mm", "--grid=-2:2:9,-2:2:9,0.5", "--chunk", "4", "--quiet", "--out", str(tmp_path)]
    pair = [started("--quantity", name, command=words) for name in ("tension-max", "tension-min")]
    ends = [(process.communicate(timeout=120)[1], process.returncode) for process in pair]
    assert ends == [("", 0), ("", 0)]
    result = json.loads((tmp_path / "result.json").read_text())
    assert {p.name for p in tmp_path.iterdir()} == set(result["files"])
    assert result["quantity"].replace("-", "_") in (tmp_path / "map.csv").read_text().splitlines()[0].replace("-", "_")


@pytest.mark.parametrize("words", [["--help"], ["modes", "six-cable-8mm", "--json"], ["robots"]], ids=str)
def test_a_reader_that_wants_one_line_only(words):
    line = f"{sys.executable} -m cdpr_struct {' '.join(words)} | head -1"
    asked = subprocess.run(["bash", "-c", f"set -o pipefail; {line}"], capture_output=True, text=True, cwd=ROOT)
    assert asked.stderr == ""
    assert asked.returncode in (0, 141)  # 128 + SIGPIPE
    assert len(asked.stdout.splitlines()) == 1


def test_numbers_do_not_depend_on_the_threads_of_blas(tmp_path):
    found = []
    for threads in ("1", "2", "3", "4"):
        out = tmp_path / threads
        surroundings = {**os.environ, "OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads}
        words = ["modes", "thesis-3-1", "--count", "12", "--quiet", "--out", str(out)]
        subprocess.run([sys.executable, "-m", "cdpr_struct", *words], check=True, cwd=ROOT, env=surroundings)
        found.append(json.loads((out / "result.json").read_text())["frequencies_hz"])
    np.testing.assert_allclose(found, np.broadcast_to(found[0], np.shape(found)), rtol=1e-10)


def test_a_time_to_be_computed_is_bounded(tmp_path):
    """A robot with hundreds of modes in the band is refused, or answered, within a minute of processor time."""
    begun = time.process_time()
    code = run(
        ["transient", "thesis-5", "--initial-velocity=0.1,0,0", "--duration", "60", "--highest", "100", "--quiet"]
    )
    assert code in (0, 1, 2)
    assert time.process_time() - begun < 60.0
