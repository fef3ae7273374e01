"""Unusable signals: one line naming file, case, value and what would be right; exit code 2."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import pyuff

from cdpr_struct.cli.main import run
from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.measurement.universal_rows import universal_columns

CAMPAIGN = 'robot = "thesis-3-1"\nmodel = "exact"\n[[measurement]]\nkind = "{kind}"\nfile = "{file}"\n'


def complaint(tmp_path, capsys, kind, file) -> str:
    path = tmp_path / "campaign.toml"
    path.write_text(CAMPAIGN.format(kind=kind, file=file))
    assert run(["diagnose", str(path)]) == 2
    captured = capsys.readouterr()
    lines = captured.err.strip().splitlines()
    assert captured.out == ""
    assert len(lines) == 1, captured.err
    return lines[0]


def decay(time) -> pd.DataFrame:
    wave = np.exp(-0.1 * time) * np.cos(20.0 * time)
    return pd.DataFrame(
        {"case": "a", "x_m": 0.0, "y_m": 0.0, "z_m": 0.5, "time_s": time, "ax": wave, "ay": 0.5 * wave, "az": 0.0}
    )


def _late(table: pd.DataFrame) -> pd.DataFrame:
    """A sample half a step late."""
    return table.assign(time_s=table["time_s"] + 0.005 * (table.index == 50))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda t: t.head(20), ["case a", "20 samples", "at least 64"]),
        (_late, ["case a", "time_s", "even steps"]),
        (lambda t: t.drop(index=range(100, 250)), ["case a", "150 of 400 samples missing", "at most 20% missing"]),
        (lambda t: t.assign(x_m=np.linspace(0.0, 1.0, len(t))), ["case a", "one pose a case"]),
        (lambda t: t.assign(ax="much"), ["row 1", "ax", "much", "a number"]),
        (lambda t: t.assign(z_m=500.0), ["case a", "x_m, y_m, z_m", "500.0", "in mm"]),
        (lambda t: t.assign(**{f"length_{i}_m": 9000.0 for i in range(1, 9)}), ["case a", "length_m", "in mm"]),
        (lambda t: t.assign(**{f"length_{i}_m": 30.0 for i in range(1, 9)}), ["case a", "length_m", "in ft"]),
    ],
    ids=range(8),
)
def test_bad_decays(change, words, tmp_path, capsys):
    change(decay(np.arange(400) * 0.01)).to_csv(tmp_path / "decay.csv", index=False)
    line = complaint(tmp_path, capsys, "free_decay", "decay.csv")
    assert all(word in line for word in ["decay.csv", *words]), line


def test_a_tracked_motion_in_mm_is_refused(tmp_path, capsys):
    """It used to be left out, and only the table of peaks said so."""
    track = decay(np.arange(400) * 0.01).rename(columns={"ax": "x_m", "ay": "y_m", "az": "z_m"})
    track = track.loc[:, ~track.columns.duplicated(keep="last")]
    track[["x_m", "y_m", "z_m"]] = 1000.0 * (0.01 * track[["x_m", "y_m", "z_m"]] + [0.0, 0.0, 0.5])
    track.to_csv(tmp_path / "track.csv", index=False)
    assert "is it in mm?" in complaint(tmp_path, capsys, "platform_motion", "track.csv")


def test_a_record_that_adds_nothing_is_told(tmp_path, capsys):
    noise = np.random.default_rng(5).standard_normal((400, 3))
    quiet = decay(np.arange(400) * 0.01).assign(**dict(zip(("ax", "ay", "az"), noise.T, strict=True)))
    quiet.to_csv(tmp_path / "decay.csv", index=False)
    states = (Path(__file__).parents[2] / "examples" / "table-4-4" / "level.csv").read_text().splitlines()
    (tmp_path / "one.csv").write_text("\n".join(states[: 2 + 8]))  # head and one pose
    path = tmp_path / "campaign.toml"
    more = '[[measurement]]\nkind = "static_state"\nfile = "one.csv"\n'
    path.write_text(CAMPAIGN.format(kind="free_decay", file="decay.csv").replace("thesis-3-1", "cogiro") + more)
    assert run(["diagnose", str(path)]) == 0
    assert "Warning: free_decay a adds no frequency: " in capsys.readouterr().out


def test_a_decay_without_a_pose_says_so(tmp_path):
    decay(np.arange(400) * 0.01).drop(columns=["x_m", "y_m", "z_m"]).to_csv(tmp_path / "decay.csv", index=False)
    path = tmp_path / "campaign.toml"
    path.write_text(CAMPAIGN.format(kind="free_decay", file="decay.csv"))
    with pytest.raises(InputError, match="carries no pose, so give that of case"):
        load_campaign(path)


def universal(path, **change):
    hertz = np.linspace(0.0, 20.0, 401)
    value = 1.0 / (25.0 - hertz**2 + 0.1j * hertz)
    entry = pyuff.prepare_58(
        binary=0, func_type=change.get("func_type", 4), rsp_ent_name="A", rsp_node=1, rsp_dir=3, ref_ent_name="A",
        ref_node=1, ref_dir=-3, abscissa_spacing=1, abscissa_spec_data_type=18,
        ordinate_spec_data_type=change.get("ordinate", 8), orddenom_spec_data_type=13, data=value, x=hertz,
        id1="a", id2="b", id3="c", id4="d", id5="e",
    )  # fmt: skip
    pyuff.UFF(str(path)).write_sets([entry], mode="overwrite")
    return hertz, value


def test_universal_displacement_becomes_acceleration(tmp_path):
    hertz, value = universal(tmp_path / "point.uff")
    numbers, words = universal_columns(tmp_path / "point.uff")
    got = numbers["real"] + 1j * numbers["imag"]
    assert np.abs(got + (2.0 * np.pi * hertz[1:]) ** 2 * value[1:]).max() < 1e-5 * np.abs(got).max()
    assert (words["case"][0], words["respond"][0], words["excite"][0]) == ("point", "z", "-z")


@pytest.mark.parametrize(
    ("change", "words"),
    [({"func_type": 1}, ["function type 4"]), ({"ordinate": 2}, ["ordinate type", "12 (acceleration)"])],
    ids=range(2),
)
def test_universal_files_without_frfs(change, words, tmp_path, capsys):
    universal(tmp_path / "point.uff", **change)
    line = complaint(tmp_path, capsys, "frf", "point.uff")
    assert all(word in line for word in ["point.uff", *words]), line


@pytest.mark.parametrize("content", ["", "no universal file\n", "    -1\n    58\nrubbish\n    -1\n", None])
def test_broken_universal_files(content, tmp_path, capsys):
    if content is not None:
        (tmp_path / "point.uff").write_text(content)
    assert "point.uff" in complaint(tmp_path, capsys, "frf", "point.uff")


def test_universal_files_are_frfs_and_modes_only(tmp_path, capsys):
    universal(tmp_path / "point.uff")
    assert "FRFs and modes only" in complaint(tmp_path, capsys, "free_decay", "point.uff")


def units_of(path, length: float, force: float) -> None:
    """Dataset 164 in front of a file's other datasets."""
    told = pyuff.prepare_164(
        units_code=9, units_description="own", temp_mode=1, length=length, force=force, temp=1.0, temp_offset=0.0
    )
    rest = path.read_bytes()
    pyuff.UFF(str(path)).write_sets([told], mode="overwrite")
    path.write_bytes(path.read_bytes() + rest)


def test_responses_come_in_the_units_of_the_file(tmp_path):
    """Dataset 164: what is in mm and mN is divided by 1000 for lengths and for forces, so that mm/mN is m/N."""
    universal(tmp_path / "plain.uff")
    universal(tmp_path / "mm.uff")
    units_of(tmp_path / "mm.uff", length=1000.0, force=1.0)
    plain, _ = universal_columns(tmp_path / "plain.uff")
    in_mm, _ = universal_columns(tmp_path / "mm.uff")
    np.testing.assert_allclose(1000.0 * in_mm["real"], plain["real"], rtol=1e-6)
    universal(tmp_path / "mn.uff")
    units_of(tmp_path / "mn.uff", length=1.0, force=1000.0)
    np.testing.assert_allclose(universal_columns(tmp_path / "mn.uff")[0]["imag"], 1000.0 * plain["imag"], rtol=1e-6)


def test_datasets_of_vendors_do_no_harm(tmp_path):
    """Headers (151) and kinds that are not known are passed over, damaged ones among them."""
    universal(tmp_path / "point.uff")
    before, _ = universal_columns(tmp_path / "point.uff")
    kinds = ((b"   151", b"model\nall that a vendor says"), (b"  2411", b"rubbish"), (b"  1858", b"own"))
    foreign = b"".join(b"    -1\n" + kind + b"\n" + text + b"\n    -1\n" for kind, text in kinds)
    (tmp_path / "point.uff").write_bytes(foreign + (tmp_path / "point.uff").read_bytes())
    after, _ = universal_columns(tmp_path / "point.uff")
    np.testing.assert_array_equal(before["real"], after["real"])


@pytest.mark.parametrize(
    ("damaged", "words"),
    [
        (b"    -1\n    58\nrubbish\n    -1\n", ["dataset 2", "of type 58", "cannot be read"]),
        (b"    -1\n   164\nrubbish\n    -1\n", ["dataset 2", "of type 164"]),
        (
            b"    -1\n   164\n         1SI                          2\n 0.0 1.0 1.0\n 0.0\n    -1\n",
            ["dataset 2", "164"],
        ),
    ],
    ids=range(3),
)
def test_a_damaged_dataset_is_answered_with_its_number(damaged, words, tmp_path, capsys):
    universal(tmp_path / "point.uff")
    with (tmp_path / "point.uff").open("ab") as file:
        file.write(damaged)
    line = complaint(tmp_path, capsys, "frf", "point.uff")
    assert all(word in line for word in ["point.uff", *words]), line


def modes(path, *hertz: float, complex_: bool = False) -> None:
    """Datasets 55: a shape of one node each."""
    shape = {"node_nums": np.array([1]), "r1": np.array([0.1]), "r2": np.array([0.2]), "r3": np.array([0.3])}
    sets = []
    for number, one in enumerate(hertz, start=1):
        common = {"type": 55, "id1": "a", "id2": "b", "id3": "c", "id4": "d", "id5": "e", "model_type": 1, "data_ch": 2,
                  "spec_data_type": 8, "n_data_per_node": 3, "load_case": 1, "mode_n": number}  # fmt: skip
        if complex_:
            root = -0.1 + 2j * np.pi * one
            shape = {name: value.astype(complex) if name != "node_nums" else value for name, value in shape.items()}
            own = {"analysis_type": 3, "data_type": 5, "eig": root, "modal_a": 1.0 + 0j, "modal_b": 1.0 + 0j}
        else:
            own = {"analysis_type": 2, "data_type": 2, "freq": one, "modal_m": 1.0, "modal_damp_vis": 0.01,
                   "modal_damp_his": 0.0}  # fmt: skip
        sets.append({**common, **own, **shape})
    pyuff.UFF(str(path)).write_sets(sets, mode="overwrite")


@pytest.mark.parametrize("complex_", [False, True])
def test_modes_are_frequencies_of_the_robot(complex_, tmp_path):
    modes(tmp_path / "rest.uff", 2.78, 3.49, complex_=complex_)
    states = (Path(__file__).parents[2] / "examples" / "table-4-4" / "level.csv").read_text().splitlines()
    head, *rows = [line for line in states if not line.startswith("#")]
    case = rows[0].split(",")[0]
    (tmp_path / f"{case}.uff").write_bytes((tmp_path / "rest.uff").read_bytes())
    (tmp_path / "one.csv").write_text("\n".join([head, *(row for row in rows if row.split(",")[0] == case)]) + "\n")
    path = tmp_path / "campaign.toml"
    more = '[[measurement]]\nkind = "static_state"\nfile = "one.csv"\n'
    text = CAMPAIGN.format(kind="robot_frequency", file=f"{case}.uff").replace("thesis-3-1", "cogiro")
    path.write_text(text + more)
    assert load_campaign(path).robot_frequencies.hertz == pytest.approx([2.78, 3.49], rel=1e-5)


def test_a_universal_file_without_modes_says_what_it_has(tmp_path, capsys):
    universal(tmp_path / "point.uff")
    line = complaint(tmp_path, capsys, "robot_frequency", "point.uff")
    assert "datasets: got '58'; at least one dataset 55" in line
