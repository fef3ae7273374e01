"""`import-recording`: a listing without a mapping, a campaign with one; files whole or not at all."""

import json
from pathlib import Path

import pytest

import cdpr_struct as cs
from cdpr_struct.cli.main import run
from cdpr_struct.reports.plain_json import result_text

EXAMPLES = Path(__file__).parents[2] / "examples" / "recordings"
LOG, MAPPING = str(EXAMPLES / "log.csv"), str(EXAMPLES / "log.toml")
KEYS = {
    "schema_version", "file", "form", "kind", "states", "left_out", "sampling", "sigma", "zero_s", "start_s", "end_s",
    "directory", "files_written", "warnings",
}  # fmt: skip
LISTED = {"schema_version", "file", "form", "channels", "template", "warnings"}
OF_A_CHANNEL = {"name", "unit", "clock", "samples", "faulty", "start_s", "end_s", "rate_hz", "low", "high"}


def test_without_a_mapping_the_channels_are_listed_and_nothing_is_written(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["import-recording", LOG]) == 0
    said = capsys.readouterr().out
    assert "24 channels" in said
    assert 'channels = ["tracker x [mm]", "tracker y [mm]", "tracker z [mm]"]' in said
    assert run(["import-recording", LOG, MAPPING, "--list", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert set(result) == LISTED
    assert set(result["channels"][0]) == OF_A_CHANNEL
    assert result["channels"][0]["start_s"] is None  # another channel has to say the times
    assert list(tmp_path.iterdir()) == []


def test_a_campaign_is_written_that_reads_again(tmp_path, capsys):
    out = tmp_path / "a" / "b"
    assert run(["import-recording", LOG, MAPPING, "--out", str(out), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert set(result) == KEYS
    assert result["states"] == 5
    assert {path.name for path in out.iterdir()} == set(result["files_written"]) == {"campaign.toml", "states.csv"}
    campaign = cs.load_campaign(out / "campaign.toml")
    assert campaign.states.has_length.all()
    assert campaign.states.has_tension.all()
    assert campaign.robot_name == "cogiro"


def test_files_that_are_there_stay_unless_that_is_asked(tmp_path, capsys):
    (tmp_path / "campaign.toml").write_text("mine")
    words = ["import-recording", LOG, MAPPING, "--out", str(tmp_path)]
    assert run(words) == 2
    assert "campaign.toml'; the file is there already" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["campaign.toml"]
    assert run([*words, "--overwrite", "--quiet"]) == 0
    assert "robot" in (tmp_path / "campaign.toml").read_text()
    assert run(["import-recording", LOG, "--template", str(tmp_path / "campaign.toml")]) == 2
    with pytest.raises(cs.InputError, match="overwrite=True"):
        cs.import_recording(LOG, MAPPING).write(tmp_path)


def test_all_files_are_written_or_none(tmp_path, monkeypatch):
    from cdpr_struct.cli import written_files

    def full(content: object) -> list[bytes]:
        if "measurement" in str(content):
            raise OSError(28, "No space left on device")
        return [str(content).encode()]

    monkeypatch.setattr(written_files, "_parts", full)
    assert run(["import-recording", LOG, MAPPING, "--out", str(tmp_path)]) == 2
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([LOG, "--out", "x"], "MAPPING.toml is missing"),
        ([LOG, MAPPING], "--out is missing"),
        ([LOG, "none.toml", "--out", "x"], "MAPPING: got 'none.toml'"),
        ([LOG, "--clock", "sun"], "--clock: got 'sun'"),
        ([LOG, MAPPING, "--robot", "none", "--out", "x"], "'none'"),
        ([LOG, MAPPING, "--robot", "six-cable-4mm", "--out", "x"], "6, one for each cable of six-cable-4mm"),
    ],
    ids=range(6),
)
def test_words_that_cannot_be_used(words, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["import-recording", *words]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert list(tmp_path.iterdir()) == []


def test_a_robot_file_is_named_as_seen_from_the_campaign(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    cs.write_robot(cs.load_robot("cogiro"), tmp_path / "mine.toml")
    assert run(["import-recording", LOG, MAPPING, "--robot", "mine.toml", "--out", "c/d", "--quiet"]) == 0
    assert 'robot = "../../mine.toml"' in (tmp_path / "c" / "d" / "campaign.toml").read_text()
    assert len(cs.load_campaign("c/d/campaign.toml").states.names) == 5


def test_a_listing_and_a_mapping_in_python(tmp_path):
    listed = cs.recording_channels(LOG)
    assert list(listed.frame().columns) == [
        "name", "unit", "clock", "samples", "faulty", "start_s", "end_s", "rate_hz", "low", "high",
    ]  # fmt: skip
    path = cs.import_recording(LOG, MAPPING, directory=tmp_path / "c").write(tmp_path / "c")
    assert path == tmp_path / "c" / "campaign.toml"
    with pytest.raises(cs.InputError, match="mapping: tims: got"):
        cs.import_recording(LOG, {"tims": {}})


def test_python_lists_the_channels_that_the_command_lists(capsys):
    assert run(["import-recording", LOG, "--list", "--json"]) == 0
    commanded = json.loads(capsys.readouterr().out)["channels"]
    asked = cs.recording_channels(LOG)
    listed = {"channels": [dict(channel.answer()) for channel in asked.channels]}
    assert json.loads(result_text(listed))["channels"] == commanded
