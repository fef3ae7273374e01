"""When samples were taken: clocks of bags, channels of the time, rates, instants; and what a free motion says."""

import io

import numpy as np
import pandas as pd
import pytest

import cdpr_struct as cs
from tests.recordings.written import COLUMNS, FORMS, LENGTHS, TENSIONS, TIME, in_units, renamed


def states(made) -> pd.DataFrame:
    return pd.read_csv(io.StringIO(made.files["states.csv"]))


def plain_log(tmp_path, **changed) -> tuple:
    columns = {name: values for name, (values, _) in COLUMNS.items()} | changed
    pd.DataFrame(columns).to_csv(tmp_path / "log.csv", index=False)
    return tmp_path / "log.csv", in_units(renamed(str), time="s")


def test_a_bag_has_two_clocks(tmp_path):
    """The recorder hears of each message 7 ms after its stamp, and the bag begins when it hears of the first."""
    path, mapping = FORMS["mcap"](tmp_path)
    stamped = cs.import_recording(path, mapping)
    assert stamped.answer["zero_s"] == pytest.approx(-0.007)
    mapping["time"] = {"clock": "received"}
    heard = cs.import_recording(path, mapping)
    assert heard.answer["zero_s"] == 0.0
    assert {one.channel.clock for one in cs.recording_channels(path, clock="received").channels} == {"received"}
    np.testing.assert_allclose(states(heard).time_s, states(stamped).time_s, atol=1e-6)


def test_topics_without_a_stamp_and_transforms_by_their_frames(tmp_path):
    rosbag = pytest.importorskip("rosbags.rosbag2", reason="the extra recordings is not installed")
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    kinds = {name.rpartition("/")[2]: kind for name, kind in store.types.items() if name.split("/")[0] != "std_srvs"}
    with rosbag.Writer(tmp_path / "log", version=9) as writer:
        tf, force = (
            writer.add_connection(topic, kind, typestore=store)
            for topic, kind in (("/tf", "tf2_msgs/msg/TFMessage"), ("/force", "std_msgs/msg/Float64MultiArray"))
        )
        for k in range(30):
            head = kinds["Header"](kinds["Time"](sec=100 + k, nanosec=0), "world")
            moved = kinds["Transform"](kinds["Vector3"](0.1 * k, 0.0, 1.2), kinds["Quaternion"](0.0, 0.0, 0.0, 1.0))
            message = kinds["TFMessage"]([kinds["TransformStamped"](head, "platform", moved)])
            writer.write(tf, (100 + k) * 10**9, store.serialize_cdr(message, message.__msgtype__))
            layout = kinds["MultiArrayLayout"](dim=[], data_offset=0)
            pulls = kinds["Float64MultiArray"](layout, 300.0 + np.arange(8.0))
            writer.write(force, (100 + k) * 10**9, store.serialize_cdr(pulls, pulls.__msgtype__))
    place = "/tf.transforms[platform].transform.translation"
    mapping = {
        "robot": "cogiro", "position": {"channels": [f"{place}.{axis}" for axis in "xyz"], "unit": "m"},
        "tensions": {"channels": [f"/force.data[{i}]" for i in range(8)], "unit": "N"}, "sampling": {"mode": "motion"},
        "sigma": {"position_m": 1e-3, "tension_N": 1.0},
    }  # fmt: skip
    made = cs.import_recording(tmp_path / "log", mapping)
    np.testing.assert_allclose(states(made).x_m, 0.1 * np.arange(30), atol=1e-9)
    assert any("/force.data[0] has no stamp" in said and 'clock = "received"' in said for said in made.warnings)


def test_a_clock_since_1970_begins_at_a_whole_second(tmp_path):
    path, mapping = plain_log(tmp_path, t=1_700_000_000.25 + TIME)
    made = cs.import_recording(path, mapping)
    assert made.answer["zero_s"] == 1_700_000_000.0
    np.testing.assert_allclose(states(made).time_s, TIME + 0.25, atol=1e-6)
    assert "time_s is zero at 1700000000 s of its clock" in made.files["campaign.toml"]


def test_instants_are_times(tmp_path):
    instants = pd.Timestamp("2026-11-26T10:00:00.5") + pd.to_timedelta(TIME, unit="s")
    path, mapping = plain_log(tmp_path, t=instants.map(lambda one: one.isoformat()))
    mapping["time"] = {"channel": "t"}
    np.testing.assert_allclose(states(cs.import_recording(path, mapping)).time_s, TIME + 0.5, atol=1e-6)


def test_a_rate_stands_for_a_channel_of_the_time(tmp_path):
    path, mapping = plain_log(tmp_path)
    mapping["time"] = {"rate_hz": 10.0}
    np.testing.assert_allclose(states(cs.import_recording(path, mapping)).time_s, TIME, atol=1e-9)


def test_groups_may_have_times_of_their_own(tmp_path):
    """Encoders at half the rate of the tracker: their lengths are interpolated."""
    nptdms = pytest.importorskip("nptdms", reason="the extra recordings is not installed")
    with nptdms.TdmsWriter(tmp_path / "log.tdms") as writer:
        for name, (values, unit) in COLUMNS.items():
            if name != "t":
                group, step = ("slow", 2) if name[0] == "L" else ("fast", 1)
                writer.write_segment([nptdms.ChannelObject(group, name, values[::step], {"unit_string": unit})])
        for group, step in (("slow", 2), ("fast", 1)):
            writer.write_segment([nptdms.ChannelObject(group, "t", TIME[::step], {"unit_string": "s"})])
    mapping = renamed(lambda name: f"{'slow' if name[0] == 'L' else 'fast'}/{name}")
    with pytest.raises(cs.InputError, match="slow/L1: got '60 samples, and 120 of the time fast/t'"):
        cs.import_recording(tmp_path / "log.tdms", mapping | {"time": {"channel": "fast/t"}})
    made = states(cs.import_recording(tmp_path / "log.tdms", mapping | {"time": {"channel": ["fast/t", "slow/t"]}}))
    np.testing.assert_allclose(made.time_s, TIME[:-1], atol=1e-9)
    np.testing.assert_allclose(made.length_1_m, np.interp(made.time_s, TIME[::2], LENGTHS[::2, 0]), rtol=1e-9)
    np.testing.assert_allclose(made.tension_1_N, TENSIONS[:-1, 0], rtol=1e-9)


def test_channels_that_never_overlap_are_refused(tmp_path):
    nptdms = pytest.importorskip("nptdms", reason="the extra recordings is not installed")
    with nptdms.TdmsWriter(tmp_path / "log.tdms") as writer:
        for name, (values, unit) in COLUMNS.items():
            start = np.datetime64("2026-11-26T10:00:00") + np.timedelta64(3600 * (name[0] == "L"), "s")
            clock = {"unit_string": unit, "wf_increment": 0.1, "wf_start_time": start}
            writer.write_segment([nptdms.ChannelObject("daq", name, values, clock)])
    with pytest.raises(cs.InputError, match=r"ends at 11\.9 s, daq/L1 begins at 3600 s'; .*on the same clock"):
        cs.import_recording(tmp_path / "log.tdms", renamed(lambda name: f"daq/{name}", time=False))


def test_a_free_motion_gives_frequencies(tmp_path):
    """A platform that swings at 2.5 and 3.1 Hz, tracked at 50 Hz with locked winches."""
    time, rest = np.arange(0.0, 10.0, 0.02), cs.load_robot("thesis-3-1").home.position
    wave = np.exp(-0.2 * time)
    swing = [0.01 * wave * np.cos(5.0 * np.pi * time), 0.01 * wave * np.sin(5.0 * np.pi * time), 0.0 * time]
    place = rest + np.stack(swing, axis=1) + 1e-5 * np.random.default_rng(0).normal(size=(len(time), 3))
    columns = {"t": time, **dict(zip("xyz", place.T, strict=True))}
    columns |= {axis: 0.05 * wave * np.cos(6.2 * np.pi * time) for axis in ("a", "b", "c")}
    columns |= {f"L{i}": v for i, v in enumerate(cs.inverse("thesis-3-1", rest).solution.lengths, start=1)}
    pd.DataFrame(columns).to_csv(tmp_path / "free.csv", index=False)
    mapping = in_units(renamed(str), time="s") | {"robot": "thesis-3-1", "sampling": {"mode": "free_motion"}}
    mapping["rotation"] = {"form": "angles", "order": "xyz", "channels": ["a", "b", "c"], "unit": "deg"}
    mapping["sigma"] = {"position_m": 1e-4, "rotation_deg": 0.01, "length_m": 1e-3}
    del mapping["tensions"]
    made = cs.import_recording(tmp_path / "free.csv", mapping)
    assert made.answer["kind"] == "platform_motion"
    assert made.campaign.identified[0].modes.hertz == pytest.approx([2.5, 3.1], abs=2e-3)
