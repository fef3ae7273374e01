"""Every form of recording gives the same campaign; a listing tells its channels; a missing package is named."""

import io
import sys

import numpy as np
import pandas as pd
import pytest

import cdpr_struct as cs
from cdpr_struct.recordings import text_table
from cdpr_struct.recordings.mapping import UNFILLED
from tests.recordings.written import COLUMNS, FORMS, LENGTHS, PLACE, QUATERNION, TENSIONS, TIME, text

WRITTEN = 1e-9  # relative: campaigns have ten digits
PACKAGES = {
    "workbook": "openpyxl", "matlab_hdf": "h5py", "tdms": "nptdms", "mdf": "asammdf", "ros1": "rosbags.highlevel",
    "mcap": "rosbags.highlevel",
}  # fmt: skip


def table(made: "cs.interface.import_recording.ImportedRecording") -> pd.DataFrame:
    return pd.read_csv(io.StringIO(made.files["states.csv"]))


@pytest.mark.parametrize("form", FORMS)
def test_every_form_gives_the_campaign_that_was_written(form, tmp_path):
    path, mapping = FORMS[form](tmp_path)
    made = cs.import_recording(path, mapping, directory=tmp_path / "campaign")
    got = table(made)
    np.testing.assert_allclose(got.time_s - got.time_s[0], TIME, atol=1e-6)
    np.testing.assert_allclose(got[["x_m", "y_m", "z_m"]], PLACE, atol=2e-9)
    np.testing.assert_allclose(got[["qx", "qy", "qz", "qw"]], QUATERNION, atol=2e-9)
    np.testing.assert_allclose(got[[f"length_{i}_m" for i in range(1, 9)]], LENGTHS, rtol=WRITTEN)
    np.testing.assert_allclose(got[[f"tension_{i}_N" for i in range(1, 9)]], TENSIONS, rtol=WRITTEN)
    assert made.campaign.states.has_length.all()
    assert made.warnings == ()


def test_a_scale_that_is_off_is_seen(tmp_path):
    path, mapping = FORMS["text"](tmp_path)
    mapping["lengths"]["factor"] = 1.0 + 1e-8
    got = table(cs.import_recording(path, mapping))
    assert np.abs(got[[f"length_{i}_m" for i in range(1, 9)]] / LENGTHS - 1.0).to_numpy().max() > 1e-9


@pytest.mark.parametrize("form", FORMS)
def test_a_listing_tells_range_and_rate(form, tmp_path):
    path, mapping = FORMS[form](tmp_path)
    found = cs.recording_channels(path)
    by_name = found.frame().set_index("name")
    longest = by_name.loc[mapping["lengths"]["channels"][7]]
    scale = 1e3 if form == "decimal_commas" else 1.0
    assert longest["samples"] == len(TIME)
    assert [longest["low"], longest["high"]] == pytest.approx(
        [scale * f(LENGTHS[:, 7]) for f in (np.min, np.max)], 1e-6
    )
    if longest["clock"]:
        assert longest["rate_hz"] == pytest.approx(10.0, rel=1e-6)


@pytest.mark.parametrize("form", sorted(set(FORMS) - {"matlab", "matlab_hdf"}))
def test_the_template_names_the_channels(form, tmp_path):
    """Once robot and mode are filled in it is a mapping of this recording; MATLAB's files say no units."""
    path, mapping = FORMS[form](tmp_path)
    text = cs.recording_channels(path).template
    for name in ("position", "rotation", "lengths", "tensions"):
        assert all(f'"{channel}"' in text for channel in mapping[name]["channels"]), text
    assert f'"{UNFILLED}"' in text  # the robot
    (tmp_path / "map.toml").write_text(text)
    made = cs.import_recording(path, tmp_path / "map.toml", robot="cogiro", directory=tmp_path)
    assert len(table(made)) == 2  # stops


@pytest.mark.parametrize("form", PACKAGES)
def test_without_the_package_one_sentence_names_the_extra(form, tmp_path, monkeypatch):
    path, mapping = FORMS[form](tmp_path)
    monkeypatch.setitem(sys.modules, PACKAGES[form], None)
    with pytest.raises(cs.InputError, match=r"pip install 'cdpr-struct\[recordings\]'"):
        cs.import_recording(path, mapping)
    with pytest.raises(cs.InputError, match=PACKAGES[form].partition(".")[0]):
        cs.recording_channels(path)


def test_a_text_table_is_read_in_parts(tmp_path, monkeypatch):
    monkeypatch.setattr(text_table, "_ROWS", 7)
    path, mapping = text(tmp_path)
    assert len(table(cs.import_recording(path, mapping))) == len(TIME)


@pytest.mark.parametrize("form", ["tdms", "mdf", "matlab_hdf", "workbook", "ros1"])
def test_others_are_read_in_parts_too(form, tmp_path, monkeypatch):
    path, mapping = FORMS[form](tmp_path)
    home = {"workbook": "workbook", "ros1": "ros_bag"}.get(form, form)
    monkeypatch.setattr(f"cdpr_struct.recordings.{home}._ROWS", 17)
    np.testing.assert_allclose(table(cs.import_recording(path, mapping))["x_m"], PLACE[:, 0], atol=1e-9)


def test_the_channels_are_those_that_were_written(tmp_path):
    path, _ = FORMS["decimal_commas"](tmp_path)
    assert [channel.channel.name for channel in cs.recording_channels(path).channels] == list(COLUMNS)
