"""Disks, streams, file systems and surroundings that are not as they should be: one sentence, and no mixed results."""

import hashlib
import io
import json
import os
import resource
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path
from threading import Thread

import numpy as np
import pytest

from cdpr_struct.cli.checkpoint import Checkpoint
from cdpr_struct.cli.main import run
from cdpr_struct.cli.many_inputs import short_names
from cdpr_struct.cli.output import _print
from cdpr_struct.cli.written_files import RESULT, replace_files
from cdpr_struct.errors import InputError
from cdpr_struct.reports.csv_table import LongTable, csv_text
from cdpr_struct.reports.figures.style import plain_ticks, svg
from tests.robustness.test_bad_input import complaint

ROOT = Path(__file__).parents[2]
TOO_LONG = "a" * 300  # no usual file system takes more than 255


def contents(directory: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in directory.iterdir()}


@contextmanager
def disk_with_room_for(size: int):
    """No file grows beyond this size: writing fails as on a full disk, with another number of the error."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("room", [0, 3000])
def test_a_full_disk_leaves_the_earlier_result_whole(room, tmp_path, capsys):
    cable = ["cable", "--force", "100,-100", "--length", "20", "--EA", "251327", "--rho", "0.067"]
    assert run([*cable, "--out", str(tmp_path), "--quiet"]) == 0
    before = contents(tmp_path)
    with disk_with_room_for(room):
        assert run(["robots", "--out", str(tmp_path), "--quiet"]) == 2
    assert "File too large" in (told := capsys.readouterr().err)
    assert len(told.splitlines()) == 1
    assert contents(tmp_path) == before, "no older report beside a new result, no temporary file"


def test_a_full_disk_keeps_the_parts_that_are_finished(tmp_path, capsys):
    store = Checkpoint(tmp_path, "abc")
    store.keep("000000", {"a": np.arange(3.0)})
    with disk_with_room_for(100), pytest.raises(InputError, match="a directory that can be written"):
        store.keep("000001", {"a": np.arange(3.0)})
    assert list(store.parts(["000000", "000001"])) == [0]


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a file system that takes no files")
@pytest.mark.parametrize("place", ["/proc/results", "/proc/self/results"])
def test_a_directory_that_takes_no_files(place, capsys):
    assert "--out" in complaint(["robots", "--out", place], capsys)


@pytest.mark.parametrize(
    "words",
    [
        ["robots", "--out", TOO_LONG],
        ["modes", TOO_LONG],
        ["diagnose", TOO_LONG],
        ["distribute", "thesis-3-1", "--trajectory", TOO_LONG],
        ["audit", "thesis-3-1", "--trajectory", TOO_LONG],
        ["rerun", TOO_LONG],
        ["new-robot", f"{TOO_LONG}.toml"],
        ["modes", "thesis-3-1", f"--{'x' * 5000}"],
    ],
    ids=range(8),
)
def test_names_that_are_too_long(words, capsys):
    assert len(complaint(words, capsys)) < 1000


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_screen_that_takes_nothing_is_told():
    with Path("/dev/full").open("w") as stream, pytest.raises(InputError, match="standard output"):
        _print("text", stream)


def test_signs_that_the_screen_lacks_are_escaped():
    stream = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    _print("λ² ≥ 1\n", stream)
    assert stream.buffer.getvalue() == rb"\u03bb\xb2 \u2265 1" + b"\n"


def test_a_table_that_was_torn_is_told_without_words_of_pandas(tmp_path, capsys):
    assert run(["robots", "--out", str(tmp_path), "--quiet"]) == 0
    (tmp_path / "robots.csv").write_bytes(b'a,b\n1,"2\n\xff')
    line = complaint(["rerun", str(tmp_path)], capsys)
    assert "robots.csv" in line
    assert "no table that can be read" in line


# ---- two runs at once


def test_two_results_written_at_once_are_never_mixed(tmp_path):
    """Whichever comes last, the list in result.json is that of the files beside it."""

    def slowly(text: str):
        for part in text:
            time.sleep(0.002)
            yield part.encode()

    def write(name: str) -> None:
        for _ in range(3):
            files = {"report.html": name, "map.csv": slowly(name * 5), f"only-{name}.csv": slowly(name)}
            replace_files(tmp_path, {"by": name}, files, False)

    threads = [Thread(target=write, args=(name,)) for name in "ab"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    found = contents(tmp_path)
    result = json.loads(found[RESULT])
    assert set(found) == set(result["files"])
    for name, digest in result["files"].items():
        assert name == RESULT or hashlib.sha256(found[name]).hexdigest() == digest
    assert found["report.html"].decode() == result["by"]


def test_a_run_goes_on_where_the_same_one_beside_it_has_ended(tmp_path):
    one, other = Checkpoint(tmp_path, "abc"), Checkpoint(tmp_path, "abc")
    one.keep("000000", {"a": np.arange(3.0)})
    other.clear()
    one.keep("000001", {"a": np.arange(3.0)})
    assert list(one.parts(["000000", "000001"])) == [1]
    other.clear()
    one.clear()
    assert not list(tmp_path.iterdir())


# ---- names


@pytest.mark.parametrize(
    ("inputs", "why"),
    [
        (("a/x.toml", "a/X.toml"), "macOS takes both for one file"),
        (("a/\u00e9.toml", "a/e\u0301.toml"), "macOS takes both codings of an accent for one"),
        (("a/stra\u00dfe.toml", "b/STRASSE.toml"), "the same letters, in lower case"),
    ],
)
def test_folders_differ_on_every_file_system(inputs, why):
    import unicodedata

    names = {unicodedata.normalize("NFC", name).casefold() for name in short_names(inputs)}
    assert len(names) == len(inputs), why


@pytest.mark.parametrize(
    ("name", "cell"),
    [
        ("=cmd|' /C calc'!A0", "'=cmd|' /C calc'!A0"),
        ("@SUM(1)", "'@SUM(1)"),
        ("+1+cmd|x", "'+1+cmd|x"),
        ("-2+3+cmd|x", "'-2+3+cmd|x"),
        ("\t=1", "'\t=1"),
        ("-z", "-z"),
        ("-1.5", "-1.5"),
        ("+x", "+x"),
        (-1.5, "-1.5"),
    ],
)
def test_a_spreadsheet_runs_no_name(name, cell):
    assert csv_text({"case": [name]}) == f"case\n{cell}\n"
    assert b"".join(LongTable({"case": [name]})).decode() == f"case\n{cell}\n"


def test_names_with_mathematical_signs_are_drawn_as_they_are():
    def draw(figure) -> None:
        axes = figure.subplots()
        axes.loglog([1.0, 1e4], [1.0, 1e4], label=r"$\foo$")
        axes.set_title(r"$\foo$ and $x")
        figure.legend()
        plain_ticks(axes.xaxis)
        plain_ticks(axes.yaxis)

    text = svg("a", (3.0, 3.0), draw)
    assert text.count(r"$\foo$") == 2
    assert "mathdefault" not in text, "ticks of an axis without plain_ticks"


STRANGE = "</title><script>alert(1)</script>\n=cmd|' /C calc'!A0 ../../$\\\\foo$ \u202e \\u0007"


@pytest.fixture(scope="module")
def strange(tmp_path_factory) -> Path:
    place = tmp_path_factory.mktemp("strange") / "a" / "b"
    place.mkdir(parents=True)
    text = (ROOT / "cdpr_struct/robot/builtin/six-cable-8mm.toml").read_text()
    first = next(line for line in text.splitlines() if line.startswith("name"))
    written = STRANGE.replace("\n", "\\n").replace("\u202e", "\\u202e")
    (place / "robot.toml").write_text(text.replace(first, f'name = "{written}"'))
    return place / "robot.toml"


@pytest.mark.parametrize("words", [["modes", "--count", "2"], ["inverse"]], ids=lambda words: words[0])
def test_a_robots_name_is_neither_markup_nor_a_path(words, strange, tmp_path, capsys):
    out = tmp_path / "a" / "b"
    assert run([words[0], str(strange), *words[1:], "--out", str(out)]) == 0
    page = (out / "report.html").read_text()
    assert "<script>alert" not in page
    assert "alert(1)" in page
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
    assert [path.name for path in (tmp_path / "a").iterdir()] == ["b"]
    assert set(contents(out)) == set(json.loads((out / RESULT).read_text())["files"])
    printed = capsys.readouterr().out
    assert "\a" not in printed, "signs that steer a terminal"
    assert "\u202e" not in printed


# ---- surroundings


def test_the_program_needs_no_home_no_locale_no_terminal_and_no_assertions(tmp_path):
    words = ["modes", "six-cable-8mm", "--count", "3", "--model", "static"]
    bare = {
        "HOME": "/nowhere/at/all",
        "LC_ALL": "C",
        "TERM": "dumb",
        "PYTHONIOENCODING": "ascii",
        "PYTHONPATH": str(ROOT),
        "PATH": os.defpath,
    }
    program = [sys.executable, "-O", "-c", "from cdpr_struct.cli.main import main; main()", *words]
    asked = subprocess.run(
        [*program, "--out", str(tmp_path / "out")], env=bare, cwd=tmp_path, capture_output=True, text=True
    )
    assert (asked.returncode, asked.stderr.strip()) == (0, "")
    assert asked.stdout.isascii()
    here = tmp_path / "here"
    assert run([*words, "--out", str(here), "--quiet"]) == 0
    bare_numbers, numbers = (
        json.loads((place / RESULT).read_text())["frequencies_hz"] for place in (tmp_path / "out", here)
    )
    np.testing.assert_allclose(bare_numbers, numbers, rtol=1e-10)  # threads of BLAS may differ
