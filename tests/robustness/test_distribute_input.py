"""Unusable input of `distribute`: one line that names place and value, exit 2, nothing written."""

import pytest

from cdpr_struct.cli.main import run

HEADER = "time_s,x_m,y_m,z_m\n"
GOOD = HEADER + "0,0,0,1\n1,0,0,1.1\n2,0,0,1.2\n"


def complaint(arguments, capsys, tmp_path) -> str:
    out = tmp_path / "out"
    assert run([*arguments, "--out", str(out)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    (line,) = captured.err.strip().splitlines()
    assert not out.exists()
    return line


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (GOOD.replace("1.1", "nan"), ["line 3", "z_m", "nan", "finite"]),
        (GOOD.replace("1.1", "inf"), ["line 3", "z_m", "inf"]),
        (GOOD.replace("1.1", "high"), ["line 3", "z_m", "high"]),
        (GOOD.replace(",1.1", ""), ["line 3", "z_m"]),
        (GOOD.replace("2,0,0,1.2", "1,0,0,1.2"), ["line 4", "time_s", "1.0", "ascend"]),
        (GOOD.replace("y_m", "y"), ["header", "y_m is missing"]),
        (GOOD.replace("z_m", "z_m,rx_deg"), ["line 2", "rx_deg"]),
        (HEADER, ["no rows"]),
        ("", ["empty file"]),
        ("\x00\xff", ["header"]),
    ],
    ids=range(10),
)
def test_bad_trajectory_files(text, words, tmp_path, capsys):
    path = tmp_path / "path.csv"
    path.write_text(text, encoding="utf-8")
    line = complaint(["distribute", "thesis-5", "--trajectory", str(path)], capsys, tmp_path)
    assert all(word in line for word in [*words, "path.csv"]), line


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--trajectory", "no-such-file.csv"], ["--trajectory", "no-such-file.csv", "helix"]),
        (["--trajectory", "."], ["--trajectory"]),
        (["--trajectory", "line:0,0,1:1,1,2"], ["--trajectory", "SECONDS"]),
        (["--trajectory", "line:0,0:1,1,2:5"], ["--trajectory", "line:0,0:1,1,2:5"]),
        (["--trajectory", "line:0,0,1:1,1,2:0"], ["duration"]),
        (["--trajectory", "line:0,0,nan:1,1,2:5"], ["--trajectory", "nan"]),
        (["--trajectory", "helix", "--instants", "1"], ["--instants", "1"]),
        (["--trajectory", "helix", "--instants", "few"], ["--instants", "few"]),
        (["--trajectory", "helix", "--bound", "loose"], ["--bound", "loose", "pose-dependent"]),
        (["--trajectory", "helix", "--compare", "fixed,loose"], ["--compare", "loose"]),
        (["--trajectory", "helix", "--b", "0"], ["--b", "0"]),
        (["--trajectory", "helix", "--b", "nan"], ["--b", "nan"]),
        (["--trajectory", "helix", "--b", "inf"], ["--b", "inf"]),
        (["--trajectory", "helix", "--upper-bound", "-5"], ["--upper-bound", "-5"]),
        (["--trajectory", "helix", "--longest", "0"], ["--longest", "0"]),
        (["--trajectory", "helix", "--max-speed", "nan"], ["--max-speed", "nan"]),
        (["--trajectory", "helix", "--cost", "beauty"], ["--cost", "beauty", "p-norm"]),
        (["--trajectory", "helix", "--cost", "p-norm", "--power", "1"], ["--power", "1"]),
        (["--trajectory", "helix", "--cost", "centre"], ["--upper-bound", "finite"]),
        (["--trajectory", "helix", "--weights", "1,2"], ["--weights", "1,2", "8"]),
        (["--trajectory", "helix", "--weights", "1,1,1,1,1,1,1,0"], ["--weights", "above zero"]),
        (["--trajectory", "helix", "--cost", "middle", "--weights", "1"], ["--weights", "--cost norm"]),
        (["--trajectory", "helix", "--model", "rubber"], ["--model", "rubber"]),
        ([], ["--trajectory"]),
    ],
    ids=lambda value: " ".join(value)[:60] if isinstance(value, list) else None,
)
def test_bad_options(arguments, words, capsys, tmp_path):
    line = complaint(["distribute", "thesis-5", *arguments], capsys, tmp_path)
    assert all(word in line for word in words), line


def test_a_byte_order_mark_and_blank_lines_do_no_harm(tmp_path, capsys):
    path = tmp_path / "path.csv"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode() + b"\r\n")
    assert run(["distribute", "thesis-5", "--trajectory", str(path), "--json"]) == 0


def test_a_single_pose_is_a_trajectory_at_rest(tmp_path, capsys):
    path = tmp_path / "path.csv"
    path.write_text(HEADER + "0,0,0,1\n")
    assert run(["distribute", "thesis-5", "--trajectory", str(path)]) == 0
    assert "1 instants" in capsys.readouterr().out
