"""A motion of CoGiRo with two stops, written in every form that recordings come in by the packages that write them."""

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import pyuff
from scipy.io import savemat
from scipy.spatial.transform import Rotation

from cdpr_struct.robot.robot_file import load_robot

ROBOT = load_robot("cogiro")
TIME = np.arange(0.0, 12.0, 0.1)
_PART = np.clip((TIME - 4.0) / 4.0, 0.0, 1.0)
PLACE = np.array([0.0, 0.0, 1.2]) + np.outer(0.5 - 0.5 * np.cos(np.pi * _PART), [1.0, 0.5, 0.2])
TURNS = Rotation.from_rotvec(np.outer(_PART, [0.05, -0.1, 0.2]))
QUATERNION = TURNS.as_quat(canonical=True)  # x, y, z, w
_TIPS = PLACE[:, None] + np.einsum("kij,mj->kmi", TURNS.as_matrix(), ROBOT.platform_anchors)
LENGTHS = np.linalg.norm(ROBOT.frame_anchors - _TIPS, axis=2)
TENSIONS = 300.0 + 20.0 * np.sin(np.arange(8)) + np.outer(_PART, np.arange(8))
EPOCH = 1_700_000_000_000_000_000  # ns

COLUMNS = {
    "t": (TIME, "s"),
    **{axis: (PLACE[:, i], "m") for i, axis in enumerate("xyz")},
    **{f"q{part}": (QUATERNION[:, i], "") for i, part in enumerate("xyzw")},
    **{f"L{i + 1}": (LENGTHS[:, i], "m") for i in range(8)},
    **{f"F{i + 1}": (TENSIONS[:, i], "N") for i in range(8)},
}
PLAIN = {
    "robot": "cogiro",
    "time": {"channel": "t"},
    "position": {"channels": ["x", "y", "z"]},
    "rotation": {"form": "quaternion", "order": "xyzw", "channels": ["qx", "qy", "qz", "qw"]},
    "lengths": {"channels": [f"L{i}" for i in range(1, 9)]},
    "tensions": {"channels": [f"F{i}" for i in range(1, 9)]},
    "sampling": {"mode": "motion"},
    "sigma": {"position_m": 1e-3, "rotation_deg": 0.1, "length_m": 1e-3, "tension_N": 2.0},
}  # fmt: skip
"""A mapping of channels called like the columns, in units that the file says."""


def renamed(change: Callable[[str], str], time: bool = True) -> dict:
    """The plain mapping with other names of channels, and with or without one of the time."""
    made = {name: dict(table) if isinstance(table, dict) else table for name, table in PLAIN.items()}
    for name in ("position", "rotation", "lengths", "tensions"):
        made[name]["channels"] = [change(channel) for channel in PLAIN[name]["channels"]]
    made["time"] = {"channel": change("t")} if time else {}
    return made


def in_units(mapping: dict, length: str = "m", force: str = "N", time: str = "") -> dict:
    for name, unit in (("position", length), ("lengths", length), ("tensions", force)):
        mapping[name]["unit"] = unit
    if time:
        mapping["time"]["unit"] = time
    return mapping


def text(folder: Path) -> tuple[Path, dict]:
    path = folder / "log.csv"
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow([f"{name} [{unit}]" if unit else name for name, (_, unit) in COLUMNS.items()])
        writer.writerows(zip(*(values for values, _ in COLUMNS.values()), strict=True))
    return path, renamed(lambda name: f"{name} [{COLUMNS[name][1]}]" if COLUMNS[name][1] else name)


def decimal_commas(folder: Path) -> tuple[Path, dict]:
    """With lines above, a row of units, semicolons, and umlauts in an old encoding; mm, kN and ms."""
    scales = {"m": ("mm", 1e3), "N": ("kN", 1e-3), "s": ("ms", 1e3), "": ("", 1.0)}
    rows = [";".join(COLUMNS), ";".join(scales[unit][0] for _, unit in COLUMNS.values())]
    columns = [values * scales[unit][1] for values, unit in COLUMNS.values()]
    rows += [";".join(f"{v:.12g}".replace(".", ",") for v in row) for row in zip(*columns, strict=True)]
    path = folder / "log.txt"
    path.write_text("\n".join(["Prüfstand 7", "Beginn;26.11.2026", "", *rows]) + "\n", "cp1252")
    return path, renamed(str)


def workbook(folder: Path) -> tuple[Path, dict]:
    openpyxl = pytest.importorskip("openpyxl", reason="the extra recordings is not installed")
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(list(COLUMNS))
    sheet.append([unit for _, unit in COLUMNS.values()])
    for row in zip(*(values for values, _ in COLUMNS.values()), strict=True):
        sheet.append([float(value) for value in row])
    book.save(folder / "log.xlsx")
    return folder / "log.xlsx", renamed(str)


def _matlab() -> tuple[dict, dict]:
    held = {"log": {"t": TIME, "pos": PLACE, "q": QUATERNION, "L": LENGTHS.T, "F": TENSIONS}}
    names = {"t": "log.t", **{axis: f"log.pos(:,{i})" for i, axis in enumerate("xyz", 1)}}
    names |= {f"q{part}": f"log.q(:,{i})" for i, part in enumerate("xyzw", 1)}
    names |= {f"L{i}": f"log.L({i},:)" for i in range(1, 9)} | {f"F{i}": f"log.F(:,{i})" for i in range(1, 9)}
    return held, in_units(renamed(names.__getitem__), time="s")


def matlab(folder: Path) -> tuple[Path, dict]:
    held, mapping = _matlab()
    savemat(folder / "log.mat", held)
    return folder / "log.mat", mapping


def matlab_hdf(folder: Path) -> tuple[Path, dict]:
    """As MATLAB writes it: transposed, behind a block of its own."""
    h5py = pytest.importorskip("h5py", reason="the extra recordings is not installed")
    held, mapping = _matlab()
    path = folder / "log.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in held["log"].items():
            file[f"log/{name}"] = np.atleast_2d(values).T if values.ndim > 1 else values[None]
    with path.open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\0\2IM")
    return path, mapping


def tdms(folder: Path) -> tuple[Path, dict]:
    """Load cells with a waveform's clock, poses and lengths with a channel of the time."""
    nptdms = pytest.importorskip("nptdms", reason="the extra recordings is not installed")
    with nptdms.TdmsWriter(folder / "log.tdms") as writer:
        writer.write_segment(
            [
                nptdms.ChannelObject("daq", name, values, {"unit_string": unit})
                for name, (values, unit) in COLUMNS.items()
            ]
        )
    return folder / "log.tdms", renamed(lambda name: f"daq/{name}")


def waveforms(folder: Path) -> tuple[Path, dict]:
    nptdms = pytest.importorskip("nptdms", reason="the extra recordings is not installed")
    start = {"wf_increment": 0.1, "wf_start_time": np.datetime64("2026-11-26T10:00:00")}
    with nptdms.TdmsWriter(folder / "log.tdms") as writer:
        writer.write_segment(
            [nptdms.ChannelObject("daq", n, v, {"unit_string": unit} | start) for n, (v, unit) in COLUMNS.items()]
        )
    return folder / "log.tdms", renamed(lambda name: f"daq/{name}", time=False)


def mdf(folder: Path, version: str = "4.10") -> tuple[Path, dict]:
    asammdf = pytest.importorskip("asammdf", reason="the extra recordings is not installed")
    path = folder / ("log.mf4" if version.startswith("4") else "log.mdf")
    with asammdf.MDF(version=version) as file:
        for names in (["x", "y", "z", "qx", "qy", "qz", "qw"], [n for n in COLUMNS if n[0] in "LF"]):
            file.append([asammdf.Signal(COLUMNS[n][0].copy(), TIME, name=n, unit=COLUMNS[n][1]) for n in names])
        file.save(path, overwrite=True)
    return path, renamed(str, time=False)


def mdf3(folder: Path) -> tuple[Path, dict]:
    return mdf(folder, "3.30")


def _messages(store, one: bool):
    """Connections' types, and for each instant the time [ns] and the messages."""
    names = (
        "geometry_msgs/msg/PoseStamped", "sensor_msgs/msg/JointState", "std_msgs/msg/Header", "geometry_msgs/msg/Pose",
        "builtin_interfaces/msg/Time", "geometry_msgs/msg/Point", "geometry_msgs/msg/Quaternion",
    )  # fmt: skip
    stamped, joints, header, pose, stamp, point, turn = (store.types[name] for name in names)
    serialize = store.serialize_ros1 if one else store.serialize_cdr
    for k, time in enumerate(TIME):
        now = EPOCH + round(time * 1e9)
        first = {"seq": k} if one else {}
        head = header(stamp=stamp(sec=now // 10**9, nanosec=now % 10**9), frame_id="world", **first)
        seen = stamped(head, pose(point(*PLACE[k]), turn(*QUATERNION[k])))
        wound = joints(head, [f"w{i}" for i in range(1, 9)], LENGTHS[k].copy(), np.zeros(0), TENSIONS[k].copy())
        yield now, [serialize(seen, stamped.__msgtype__), serialize(wound, joints.__msgtype__)]


def _fill(writer, store, one: bool = False) -> dict:
    kinds = ("geometry_msgs/msg/PoseStamped", "sensor_msgs/msg/JointState")
    topics = [
        writer.add_connection(t, kind, typestore=store) for t, kind in zip(("/pose", "/winches"), kinds, strict=True)
    ]
    for now, messages in _messages(store, one):
        for topic, message in zip(topics, messages, strict=True):
            writer.write(topic, now + 7_000_000, message)
    names = {axis: f"/pose.pose.position.{axis}" for axis in "xyz"}
    names |= {f"q{part}": f"/pose.pose.orientation.{part}" for part in "xyzw"}
    names |= {f"L{i}": f"/winches.position[w{i}]" for i in range(1, 9)}
    names |= {f"F{i}": f"/winches.effort[w{i}]" for i in range(1, 9)}
    return in_units(renamed(lambda name: names.get(name, ""), time=False))


def ros1(folder: Path) -> tuple[Path, dict]:
    rosbag = pytest.importorskip("rosbags.rosbag1", reason="the extra recordings is not installed")
    from rosbags.typesys import Stores, get_typestore

    with rosbag.Writer(folder / "log.bag") as writer:
        return folder / "log.bag", _fill(writer, get_typestore(Stores.ROS1_NOETIC), one=True)


def ros2(folder: Path, plugin: str = "SQLITE3") -> tuple[Path, dict]:
    rosbag = pytest.importorskip("rosbags.rosbag2", reason="the extra recordings is not installed")
    from rosbags.typesys import Stores, get_typestore

    with rosbag.Writer(folder / "log", version=9, storage_plugin=rosbag.StoragePlugin[plugin]) as writer:
        return folder / "log", _fill(writer, get_typestore(Stores.ROS2_HUMBLE))


def ros2_mcap(folder: Path) -> tuple[Path, dict]:
    return ros2(folder, "MCAP")


def mcap(folder: Path) -> tuple[Path, dict]:
    path, mapping = ros2(folder, "MCAP")
    return path / "log.mcap", mapping


def universal(folder: Path) -> tuple[Path, dict]:
    """Without a rotation, which keeps the file short; positions in m, lengths in m, tensions in N."""
    path = folder / "log.uff"
    sets = [
        pyuff.prepare_58(
            binary=0, func_type=1, id1=name, id2="b", id3="c", id4="d", id5="e", rsp_ent_name="A", rsp_node=1,
            rsp_dir=1, ref_ent_name="A", ref_node=1, ref_dir=1, abscissa_spacing=1, abscissa_spec_data_type=17,
            ordinate_spec_data_type=8, ordinate_axis_units_lab=unit or "NONE", orddenom_spec_data_type=0,
            data=values, x=TIME,
        )
        for name, (values, unit) in COLUMNS.items() if name != "t"
    ]  # fmt: skip
    pyuff.UFF(str(path)).write_sets(sets, mode="overwrite")
    return path, renamed(str, time=False)


FORMS = {
    write.__name__: write
    for write in (
        text, decimal_commas, workbook, matlab, matlab_hdf, tdms, waveforms, mdf, mdf3, ros1, ros2, ros2_mcap, mcap,
        universal,
    )
}  # fmt: skip
