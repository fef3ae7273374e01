"""Unusable recordings and mappings: one sentence with file, field, value and what would be right; no file written."""

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.cli.main import run
from tests.recordings.written import COLUMNS, FORMS, PLAIN

MAPPING = """robot = "cogiro"
[time]
channel = "t"
unit = "s"
[position]
channels = ["x", "y", "z"]
unit = "m"
[lengths]
channels = ["L1", "L2", "L3", "L4", "L5", "L6", "L7", "L8"]
unit = "m"
[sampling]
mode = "motion"
"""
TURNING = "[rotation]\nform = 'quaternion'\norder = 'wxyz'\nchannels = ['qw', 'qx', 'qy', 'qz']\n"


@pytest.fixture
def refused(tmp_path, capsys) -> Callable[[Path, str], str]:
    """(recording, mapping) -> the sentence of the refusal; the directory is left as it was."""

    def refusal(path: Path, mapping: str = MAPPING) -> str:
        (tmp_path / "map.toml").write_text(mapping)
        before = sorted(tmp_path.rglob("*"))
        assert (
            run(["import-recording", str(path), str(tmp_path / "map.toml"), "--out", str(tmp_path / "campaign")]) == 2
        )
        captured = capsys.readouterr()
        assert captured.out == ""
        (line,) = captured.err.splitlines()
        assert sorted(tmp_path.rglob("*")) == before
        return line

    return refusal


@pytest.fixture
def log(tmp_path) -> Callable[..., Path]:
    """Writes log.csv, with some columns changed."""

    def write(**changed: np.ndarray) -> Path:
        columns = {name: changed.get(name, values) for name, (values, _) in COLUMNS.items()}
        rows = [",".join(columns), *(",".join(map(str, row)) for row in zip(*columns.values(), strict=True))]
        (tmp_path / "log.csv").write_text("\n".join(rows) + "\n")
        return tmp_path / "log.csv"

    return write


def altered(name: str, place: int, value: object) -> dict[str, list]:
    values = [*COLUMNS[name][0]]
    values[place] = value
    return {name: values}


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"L1"', '"L_1"', ["map.toml", "channels", "'L_1'", "L1 is perhaps meant", "known are t, x,"]),
        ('channel = "t"', 'channel = "T"', ["'T'", "a channel of log.csv", "t is perhaps meant"]),
        ('channel = "t"\nunit = "s"', "", ["time.channel is missing", "t is perhaps meant"]),
        ('channel = "t"', 'chanel = "t"', ["time.chanel", "channel is perhaps meant"]),
        ('"z"]\nunit = "m"', '"z"]\nunit = "mtr"', ["position.unit", "'mtr'", "known are m, mm"]),
        ('"z"]\nunit = "m"', '"z"]\nunit = "kN"', ["position.unit", "'kN'", "a unit of length"]),
        ('"z"]\nunit = "m"', '"z"]', ["position.unit is missing", "m, mm"]),
        ('"L8"]\nunit = "m"\n', '"L8"]\nunit = "mm"\n' + TURNING, ["campaign/campaign.toml", "length_m", "0.0103"]),
        ('unit = "s"', 'unit = "sec0nd"', ["time.unit", "'sec0nd'"]),
        ('["x", "y", "z"]', '["x", "y"]', ["position.channels", "at least 3 entries"]),
        ('["x", "y", "z"]', '["x", "y", "x"]', ["position.channels", "'x'", "twice"]),
        ('["x", "y", "z"]', '["x", "y", "?"]', ["position.channels", "in place of each ?"]),
        ('["x", "y", "z"]', '["x", "y", ""]', ["position.channels", "in each place"]),
        ('"L7", "L8"]', '"L7"]', ["lengths.channels", "7 channels", "8, one for each cable of cogiro"]),
        ('"z"]\nunit = "m"', '"z"]\nunit = "m"\nfactor = [1, 0, 1]', ["position.factor", "none of them zero"]),
        ('"z"]\nunit = "m"', '"z"]\nunit = "m"\noffset = [1, 2]', ["position.offset", "a list of 3"]),
        ('robot = "cogiro"', "", ["robot is missing", "--robot"]),
        ('robot = "cogiro"', 'robot = "mine.toml"', ["mine.toml", "cogiro"]),
        ('mode = "motion"', 'mode = "moving"', ["sampling.mode", "'moving'", "'still', 'motion'"]),
        ('mode = "motion"', 'mode = "motion"\nspan = [30, 60]', ["sampling.span", "cover 0 to 11.9 s"]),
        ('mode = "motion"', 'mode = "motion"\nspan = [6, 3]', ["sampling.span", "a later end"]),
        ('mode = "motion"', 'mode = "motion"\nrate_hz = 1e9', ["frames", "at most 20000"]),
        ('mode = "motion"', 'mode = "still"\nstill_speed = 1e-9\nleast_s = 9', ["nothing still", "still_speed"]),
        ('mode = "motion"', 'mode = "still"\nleast_s = 90', ["11.9 s", "at least", "least_s is 90"]),
        ("[sampling]", TURNING.replace("wxyz", "wxyy") + "[sampling]",
         ["rotation.order", "'wxyy'", "xyzw"]),
        ("[sampling]", TURNING.replace("qz", "F1") + "[sampling]",
         ["qw to F1", "norm", "unit quaternions"]),
        ("[sampling]", "[rotation]\nform = 'angles'\norder = 'xxz'\nchannels = ['qx', 'qy', 'qz']\n[sampling]",
         ["rotation.order", "'xxz'", "ZYX"]),
        ("[sampling]", "[rotation]\nform = 'angles'\norder = 'xyz'\nchannels = ['qx', 'qy', 'qz']\n[sampling]",
         ["rotation.unit is missing", "rad, deg"]),
        ("[sampling]", "[sampling", ["map.toml", "line 11"]),
    ],
    ids=range(29),
)  # fmt: skip
def test_mappings_that_do_not_fit(old, new, words, log, refused):
    assert old in MAPPING
    line = refused(log(), MAPPING.replace(old, new, 1))
    assert [word for word in words if word not in line] == [], line


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        (altered("x", 7, "nan"), ["log.csv: x", "1 of 120 samples that are no numbers", "sample 8", "leave_out"]),
        (altered("L3", 0, "#N/A"), ["L3", "sample 1"]),
        (altered("t", 50, 4.9), ["times that do not rise", "sample 51 at 4.9 s after 4.9 s", "leave_out"]),
        (altered("t", 50, 2.0), ["times that do not rise", "sample 51 at 2 s"]),
        ({"t": [*COLUMNS["t"][0][:60], *(COLUMNS["t"][0][60:] + 5.0)]}, None),
        ({"t": ["nan"] * 120}, ["x", "no numbers"]),
    ],
    ids=range(6),
)  # fmt: skip
def test_samples_that_cannot_be_used(changed, words, log, refused, capsys, tmp_path):
    path = log(**changed)
    if words is None:  # a gap, in which no frame lies as long as frames are at the samples
        mapping = MAPPING.replace('mode = "motion"', 'mode = "motion"\nrate_hz = 5')
        words = ["log.csv: x", "a gap of 5.1 s after 5.9 s", "frames lie", "largest_gap_s", "leave_out"]
    else:
        mapping = MAPPING
    line = refused(path, mapping)
    assert [word for word in words if word not in line] == [], line


def test_faulty_samples_are_left_out_if_that_is_asked(log, tmp_path, capsys):
    times = [*COLUMNS["t"][0][:60], *(COLUMNS["t"][0][60:] + 5.0)]
    path = log(t=times, **altered("x", 7, "nan"))
    asked = 'mode = "motion"\nrate_hz = 5\nfaulty = "leave_out"'
    (tmp_path / "map.toml").write_text(MAPPING.replace('mode = "motion"', asked))
    assert run(["import-recording", str(path), str(tmp_path / "map.toml"), "--out", str(tmp_path / "campaign")]) == 0
    said = capsys.readouterr().out
    assert "1 faulty samples of 1 channels were left out, most of x (1)" in said
    assert "25 frames that lie in gaps were left out; 60 remain" in said
    assert len((tmp_path / "campaign" / "states.csv").read_text().splitlines()) == 1 + 60


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("none.csv", None, ["none.csv", "No such file", "ROS 1 and 2 bags"]),
        ("empty.bag", b"", ["an empty file"]),
        ("log.bag", b"t,x\n0,1\n1,2\n", ["a text table, although its name ends with .bag", "a ROS 1 bag"]),
        ("log.mcap", b"#ROSBAG V2.0\n" + bytes(50), ["a ROS 1 bag, although its name ends with .mcap"]),
        ("log.tdms", b"\0\1\2\3" * 50, ["something else than a TDMS file"]),
        ("log.bin", b"\0\1\2\3" * 50, ["an unknown binary file"]),
        ("log.csv", b"hello\nworld\n", ["no table of numbers in its first 2 lines", "commas, semicolons"]),
        ("log.bag", b"#ROSBAG V2.0\n" + bytes(50), ["a ROS 1 bag that cannot be read"]),
        ("log.mcap", b"\x89MCAP0\r\n" + bytes(90), ["an MCAP file that cannot be read"]),
        ("log.db3", b"SQLite format 3\0" + bytes(90), ["a ROS 2 bag (SQLite) that cannot be read"]),
        ("log.tdms", b"TDSm" + bytes(90), ["a TDMS file"]),
        ("log.mf4", b"MDF     4.10    " + bytes(90), ["an MDF file whose lists of blocks are damaged at byte 64"]),
        ("log.mat", b"MATLAB 5.0 MAT-file".ljust(124) + b"\0\1IM" + b"\7" * 90, ["a MATLAB file that cannot be read"]),
        ("log.mat", b"MATLAB 7.3 MAT-file".ljust(512) + bytes(90), ["a MATLAB file (v7.3) that cannot be read"]),
        ("log.xlsx", b"PK\3\4" + bytes(90), ["an Excel workbook that cannot be read"]),
        ("log.uff", b"    -1\n    58\nrubbish\n    -1\n", ["log.uff: dataset 1", "of type 58", "cannot be read"]),
        ("log.uff", b"    -1\n   999\nrubbish\n    -1\n", ["no signal in time", "a dataset 58 with function type 1"]),
    ],
    ids=range(17),
)  # fmt: skip
def test_files_that_are_no_recordings(name, content, words, tmp_path, refused):
    for package in ("rosbags", "nptdms", "asammdf", "openpyxl", "h5py"):
        pytest.importorskip(package, reason="the extra recordings is not installed")
    if content is not None:
        (tmp_path / name).write_bytes(content)
    line = refused(tmp_path / name)
    assert [word for word in words if word not in line] == [], line


def test_a_folder_that_is_no_bag(tmp_path, refused):
    (tmp_path / "bag").mkdir()
    assert "the folder of a ROS 2 bag with the file metadata.yaml" in refused(tmp_path / "bag")


def test_a_bag_without_a_message(tmp_path, refused):
    rosbag = pytest.importorskip("rosbags.rosbag2", reason="the extra recordings is not installed")
    with rosbag.Writer(tmp_path / "bag", version=9):
        pass
    assert "a ROS 2 bag without a message" in refused(tmp_path / "bag")


def test_a_bag_whose_database_is_gone(tmp_path, refused):
    path, _ = FORMS["ros2"](tmp_path)
    shutil.move(path / "log.db3", tmp_path / "elsewhere.db3")
    line = refused(path)
    assert "a ROS 2 bag that cannot be read" in line
    assert "missing" in line


@pytest.mark.parametrize("form", ["mdf", "mdf3"])
def test_a_list_of_blocks_that_leads_back_is_refused(form, tmp_path, refused):
    """The library would follow it without end."""
    path, _ = FORMS[form](tmp_path)
    data = bytearray(path.read_bytes())
    size, links = (8, 24) if form == "mdf" else (4, 4)
    first = int.from_bytes(data[64 + links : 64 + links + size], "little")  # of the lists of data groups
    data[first + links : first + links + size] = first.to_bytes(size, "little")  # is the next one of itself
    path.write_bytes(data)
    assert f"damaged at byte {first}" in refused(path)


def test_a_file_that_says_it_has_more_samples_than_it_holds(tmp_path, refused):
    """It would be read in empty parts for hours."""
    path, _ = FORMS["mdf"](tmp_path)
    data = bytearray(path.read_bytes())
    group = data.index(b"##CG")
    links = int.from_bytes(data[group + 16 : group + 24], "little")
    place = group + 24 + 8 * links + 8
    assert int.from_bytes(data[place : place + 8], "little") == 120
    data[place : place + 8] = (10**13).to_bytes(8, "little")
    path.write_bytes(data)
    line = refused(path, MAPPING.replace('[time]\nchannel = "t"\nunit = "s"\n', ""))
    assert "an MDF file that cannot be read" in line


def test_channels_of_other_times_make_no_rotation(tmp_path):
    import cdpr_struct as cs

    path, mapping = FORMS["waveforms"](tmp_path)
    import nptdms

    with nptdms.TdmsWriter(path) as writer:
        for name, (values, unit) in COLUMNS.items():
            late = {"wf_increment": 0.1, "wf_start_offset": 0.05 * (name == "qy"), "unit_string": unit}
            writer.write_segment([nptdms.ChannelObject("daq", name, values, late)])
    with pytest.raises(cs.InputError, match="daq/qy: got 'other times than daq/qx"):
        cs.import_recording(path, mapping)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda m: m["sampling"].update(mode="free_motion") or m.pop("position"), "the tracked position"),
        (lambda m: (m.pop("lengths"), m.pop("tensions")), "or both; poses alone"),
        (
            lambda m: m["sampling"].update(mode="still") or (m.pop("position"), m.pop("lengths")),
            "when the robot stands",
        ),
        (lambda m: m["time"].update(rate_hz=10.0), "not both"),
    ],
    ids=range(4),
)
def test_quantities_that_do_not_make_a_campaign(change, words, tmp_path):
    import cdpr_struct as cs

    path, mapping = FORMS["text"](tmp_path)
    change(mapping)
    with pytest.raises(cs.InputError, match=words):
        cs.import_recording(path, mapping)
    assert PLAIN["sampling"]["mode"] == "motion"  # the tables of others are left alone
