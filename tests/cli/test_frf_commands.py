"""frf, transient and spectrogram as a script uses them: exit code, stdout, files, and one line for bad input."""

import csv
import json
from importlib import resources

import numpy as np
import pytest
import pyuff

from cdpr_struct.cli.main import run
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.measurement.response_modes import response_modes
from cdpr_struct.measurement.signal_records import records

POSE = ["--pose", "1.3,-0.8,0.9"]
FRF = ["frf", "thesis-3-1", *POSE, "--excite", "fz", "--respond", "x,z,cable5@0.3:z", "--band", "0.5:8:0.01"]
STOP = ["transient", "thesis-3-1", *POSE, "--initial-velocity", "0.3,-0.2,0.1", "--duration", "2"]


def result_of(arguments, capsys) -> dict:
    assert run([*arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_frf_lists_the_peaks_of_every_response(capsys):
    r = result_of(FRF, capsys)
    assert [x["respond"] for x in r["responses"]] == ["x", "z", "cable5@0.3:z"]
    every = [hertz for x in r["responses"] for hertz in x["peaks_hz"]]
    assert set(r["peaks_hz"]) <= set(every)
    assert r["peaks_hz"] == sorted(r["peaks_hz"])
    assert r["count_certified"] is True
    strongest = r["responses"][1]
    index = int(np.argmax(strongest["peak_magnitudes"]))
    vertical = next(h for h, k in zip(r["natural_frequencies_hz"], r["kinds"], strict=True) if k == "platform")
    assert strongest["peaks_hz"][index] == pytest.approx(vertical, abs=0.01)


def test_frf_writes_csv_universal_file_and_report(tmp_path, capsys):
    assert run([*FRF, "--out", str(tmp_path)]) == 0
    rows = list(csv.DictReader((tmp_path / "frf.csv").read_text().splitlines()))
    assert list(rows[0]) == ["frequency_hz", "real", "imag", "respond", "excite"]
    r = json.loads((tmp_path / "result.json").read_text())
    assert r["frequencies"] == 751
    assert r["lines"] > 751
    assert len(rows) == 3 * r["lines"]
    answers = np.array([complex(float(row["real"]), float(row["imag"])) for row in rows]).reshape(3, r["lines"])
    hertz = np.array([float(row["frequency_hz"]) for row in rows]).reshape(3, r["lines"])
    assert (hertz == hertz[0]).all()
    even = np.abs(hertz[0, :, None] - (0.5 + 0.01 * np.arange(751))).min(axis=1) < 1e-9
    sets = pyuff.UFF(str(tmp_path / "frf.uff")).read_sets()
    np.testing.assert_allclose([s["data"] for s in sets], answers[:, even], rtol=1e-10)
    for response, own in zip(r["responses"], answers, strict=True):
        peaks, widths = np.array(response["peaks_hz"]), np.array(response["half_power_widths_hz"], dtype=float)
        apart = np.abs(hertz[0, :, None] - peaks)
        assert (apart.min(axis=0) < 0.1 * np.nan_to_num(widths, nan=1e-6)).all()
        height = np.abs(own)[apart.argmin(axis=0)]
        np.testing.assert_allclose(height, response["peak_magnitudes"], rtol=1e-6)
    page = (tmp_path / "report.html").read_text()
    assert '<span class="word">frf</span> <span class="word">thesis-3-1</span>' in page
    assert "show as peaks" in page
    assert (tmp_path / "frf.svg").read_text().startswith("<?xml")


def test_velocity_and_frame_change_what_they_say(capsys, tmp_path):
    """At a pose turned by 90 degrees about z the platform's x is the world's y."""
    turned = ["frf", "thesis-3-1", "--pose", "0,0,0.5,0,0,10", "--band", "1:4:0.1", "--out"]
    run([*turned, str(tmp_path / "a"), "--excite", "fx", "--respond", "x", "--frame", "platform"])
    run([*turned, str(tmp_path / "b"), "--excite", "fx", "--respond", "x,y"])
    run([*turned, str(tmp_path / "c"), "--excite", "fy", "--respond", "x,y"])
    read = [np.genfromtxt(tmp_path / n / "frf.csv", delimiter=",", skip_header=1, usecols=(0, 1, 2)) for n in "abc"]
    even = [a[np.abs(a[:, 0] - (1.0 + 0.1 * np.arange(31))[:, None]).min(axis=0) < 1e-12] for a in read]
    own, by_x, by_y = (a[:, 1] + 1j * a[:, 2] for a in even)
    c, s = np.cos(np.radians(10.0)), np.sin(np.radians(10.0))
    n = len(own)
    expected = c * c * by_x[:n] + c * s * (by_x[n:] + by_y[:n]) + s * s * by_y[n:]
    np.testing.assert_allclose(own, expected, rtol=1e-9)


@pytest.mark.parametrize(
    "damping", ["none", "viscous", "viscous:0.02", "hysteretic:0.03", "rayleigh:0.1,1e-4", "frequency-dependent",
                "frequency-dependent:0.02,0.5,3", "modal:0.01,0.02"],
)  # fmt: skip
@pytest.mark.parametrize("model", ["exact", "dsm"])
def test_every_law_runs_with_every_model(damping, model, capsys):
    r = result_of([*FRF, "--damping", damping, "--model", model, "--force"], capsys)
    assert len(r["peaks_hz"]) > 3


def test_peaks_do_not_depend_on_the_step(capsys):
    """Widths and damping ratios beside them: those of the viscous law, where a peak is a mode of its own."""
    fine, coarse = (result_of([*FRF[:9], f"0.5:8:{step}"], capsys) for step in ("0.001", "0.1"))
    assert coarse["frequencies"] == 76
    assert len(coarse["peaks_hz"]) == len(fine["peaks_hz"])
    for one, other in zip(fine["responses"], coarse["responses"], strict=True):
        np.testing.assert_allclose(other["peaks_hz"], one["peaks_hz"], rtol=1e-4)
        np.testing.assert_allclose(other["peak_magnitudes"], one["peak_magnitudes"], rtol=1e-3)
        widths = [np.array(r["half_power_widths_hz"], dtype=float) for r in (one, other)]
        np.testing.assert_allclose(*widths, rtol=1e-3)
        ratios = np.array(one["damping_ratios"], dtype=float)
        np.testing.assert_allclose(ratios, widths[0] / 2.0 / np.array(one["peaks_hz"]), rtol=1e-9)


def test_undamped_peaks_are_unbounded_and_said_so(capsys, tmp_path):
    r = result_of([*FRF, "--damping", "none", "--out", str(tmp_path)], capsys)
    for response in r["responses"]:
        assert response["peaks_hz"] == [h for h in r["natural_frequencies_hz"] if h > 0.5]
        for key in ("peak_magnitudes", "half_power_widths_hz", "damping_ratios"):
            assert set(response[key]) == {None}
    assert r["damping_note"] == "No damping (option): peaks are unbounded."
    assert run([*FRF, "--damping", "viscous:0"]) == 0
    text = capsys.readouterr().out
    assert "the damping ratio 0 (option): peaks are unbounded." in text
    assert "unbounded (no damping)" in text
    page = (tmp_path / "report.html").read_text()
    assert "unbounded (no damping)" in page
    assert "No damping (option)" in page


@pytest.mark.parametrize(
    ("damping", "model", "words"),
    [
        ("viscous", "exact", "damping ratio 0.01 of the robot file."),
        ("viscous:0.02", "exact", "damping ratio 0.02 (option)."),
        ("viscous", "static", "leaves out: peaks are unbounded."),
        ("hysteretic", "exact", "loss factor 0.02, twice the mean damping_ratio of the robot file."),
        ("hysteretic:0.03", "exact", "loss factor 0.03 (option)."),
        ("rayleigh:0.1,1e-4", "exact", "0.1 1/s times their mass and 0.0001 s times their stiffness (option)."),
        ("rayleigh:0.1,0", "static", "peaks are unbounded."),
        ("frequency-dependent:0.02,0.5,3", "exact", "loss factor 0.02 at 3 Hz, exponent 0.5 (option)."),
        ("modal:0.01", "exact", "ratio 0.01 of all modes of the robot (option)."),
        ("modal:0.01,0.02", "exact", "0.01 of mode 1 and 0.02 of mode 2 and all higher modes of the robot (option)."),
        ("modal:0", "exact", "peaks are unbounded."),
    ],
)
def test_the_damping_that_acts_is_said(damping, model, words, capsys):
    r = result_of([*FRF[:6], "--respond", "x,z", "--band", "2:4:0.1", "--damping", damping, "--model", model], capsys)
    assert r["damping_note"].endswith(words)
    unbounded = all(size is None for response in r["responses"] for size in response["peak_magnitudes"])
    assert unbounded == ("unbounded" in r["damping_note"])


def test_a_robot_file_without_damping_is_said_to_be_undamped(tmp_path, capsys):
    import cdpr_struct.robot.builtin as builtin

    text = resources.files(builtin).joinpath("thesis-3-1.toml").read_text()
    bare = tmp_path / "bare.toml"
    bare.write_text("\n".join(line for line in text.splitlines() if not line.startswith("damping_ratio")))
    for damping in ("viscous", "hysteretic"):
        r = result_of([FRF[0], str(bare), *FRF[2:], "--damping", damping], capsys)
        assert r["damping_note"].startswith("The robot file has no damping_ratio above zero")
        assert "peaks are unbounded" in r["damping_note"]
        assert "--damping viscous:0.01" in r["damping_note"]
        assert all(size is None for response in r["responses"] for size in response["peak_magnitudes"])
    own = bare.read_text().replace("[[cables]]", "[[cables]]\ndamping_ratio = 0.02", 1)
    bare.write_text(own)
    r = result_of([FRF[0], str(bare), *FRF[2:]], capsys)
    assert r["damping_note"].endswith("with the damping ratio 0 to 0.02 of the robot file (cable by cable).")


def test_diagnose_reads_the_lines_of_an_frf(tmp_path, capsys):
    """The table has uneven lines; the modes that are found in it are those of the robot."""
    command = [*FRF[:6], "--respond", "x,z", "--band", "2:5:0.01", "--out", str(tmp_path)]
    r = result_of(command, capsys)
    campaign = tmp_path / "campaign.toml"
    table = '[[measurement]]\nkind = "frf"\nfile = "measured.csv"\nsigma = { acceleration = 1e-6 }\n'
    campaign.write_text(f'robot = "thesis-3-1"\nmodel = "exact"\n{table}')
    rows = (tmp_path / "frf.csv").read_text().splitlines()
    head = "case,x_m,y_m,z_m," + rows[0]
    (tmp_path / "measured.csv").write_text("\n".join([head, *(f"a,1.3,-0.8,0.9,{row}" for row in rows[1:])]) + "\n")
    (record,) = load_campaign(campaign).series
    (signal,) = records(record, 8)
    assert np.ptp(np.diff(signal.axis)) > 1e-3
    assert len(signal.axis) == r["lines"]
    found = response_modes(signal.axis, signal.signal)
    known = np.array(r["natural_frequencies_hz"])
    assert len(found) > 8
    assert np.median(np.abs(found.hertz[:, None] - known).min(axis=1) / found.hertz) < 5e-4  # the even ones: 2e-4


def test_transient_finds_the_dominant_frequency(capsys):
    r = result_of([*STOP, "--watch", "cable5@0.25:z"], capsys)
    assert r["dominant_hz"] == pytest.approx(7.04, abs=0.15)
    assert [port["name"] for port in r["ports"]] == ["x", "y", "z", "rx", "ry", "rz", "cable5@0.25:z"]
    assert r["energy_last_J"] < r["energy_first_J"]
    assert r["energy_share"] > 0.999


def test_displacement_and_acceleration_may_have_different_dominant_frequencies(capsys):
    """Of two tones the acceleration shows the faster one, which is the smaller motion here."""
    stop = ["--initial-velocity", "0.1,0,0.1", "--duration", "8"]
    r = result_of(["transient", "thesis-3-1", "--pose", "0.5,-1,0.8", *stop], capsys)
    along_x, along_z = (next(port for port in r["ports"] if port["name"] == name) for name in "xz")
    assert r["dominant_hz"] == pytest.approx(along_x["dominant_hz"], rel=1e-2)
    assert r["dominant_displacement_hz"] == pytest.approx(along_z["dominant_displacement_hz"], rel=1e-2)
    assert r["dominant_hz"] > 2.0 * r["dominant_displacement_hz"]


def test_transient_file_feeds_the_spectrogram(tmp_path, capsys):
    assert run([*STOP, "--out", str(tmp_path)]) == 0
    rows = list(csv.DictReader((tmp_path / "transient.csv").read_text().splitlines()))
    assert {"time_s", "x_m", "x_m_s", "x_m_s2", "rz_rad_s2", "energy_J"} <= rows[0].keys()
    measured = tmp_path / "measured.csv"
    lines = [f"{r['time_s']},{r['x_m_s2']},{r['y_m_s2']},{r['z_m_s2']}" for r in rows]
    measured.write_text("\n".join(["time_s,ax,ay,az", *lines]) + "\n")
    capsys.readouterr()
    picture = tmp_path / "picture"
    r = result_of(["spectrogram", str(measured), "--robot", "thesis-3-1", *POSE, "--out", str(picture)], capsys)
    own = json.loads((tmp_path / "result.json").read_text())
    assert r["dominant_hz"] == pytest.approx(own["dominant_hz"], rel=1e-9)
    assert r["natural_frequencies_hz"] == pytest.approx(own["natural_frequencies_hz"])
    assert {"spectrogram.svg", "spectrogram.csv", "modes.csv"} <= {path.name for path in picture.iterdir()}


def test_transient_along_a_trajectory_ends_where_it_ends(tmp_path, capsys):
    """A trajectory file that ends at full speed: an emergency stop. The pose is its last one."""
    path = tmp_path / "way.csv"
    rows = [f"{0.1 * i:.1f},{0.02 * i!r},0,0.5" for i in range(21)]
    path.write_text("\n".join(["time_s,x_m,y_m,z_m", *rows]) + "\n")
    r = result_of(["transient", "thesis-3-1", "--trajectory", str(path), "--duration", "5"], capsys)
    assert r["pose"][:3] == pytest.approx([0.4, 0.0, 0.5])
    at_once = result_of(
        ["transient", "thesis-3-1", "--pose", "0.4,0,0.5", "--initial-velocity", "0.2,0,0", "--duration", "3"], capsys
    )
    largest = [x["ports"][0]["largest_displacement_m"] for x in (r, at_once)]
    assert largest[0] == pytest.approx(largest[1], rel=0.02)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([*FRF[:4], "--excite", "fq", *FRF[6:]], ["--excite", "fq", "fz"]),
        ([*FRF[:4], "--excite", "fx,fy", *FRF[6:]], ["--excite", "one"]),
        ([*FRF[:6], "--respond", "cable9@0.3:z", *FRF[8:]], ["--respond", "cable9", "1 to 8"]),
        ([*FRF[:6], "--respond", "cable5@1.3:z", *FRF[8:]], ["--respond", "cable5@1.3:z"]),
        ([*FRF[:6], "--respond", "cable5@0.3:rx", *FRF[8:]], ["--respond", "cable5@0.3:rx"]),
        ([*FRF[:8], "--band", "1:2"], ["--band", "1:2", "F0:F1:DF"]),
        ([*FRF[:8], "--band", "8:2:0.1"], ["--band", "8:2:0.1"]),
        ([*FRF[:8], "--band", "0:8:1e-9"], ["--band", "at most"]),
        ([*FRF[:8], "--band", "0:8:nan"], ["--band", "nan"]),
        ([*FRF, "--quantity", "jerk"], ["--quantity", "jerk", "velocity"]),
        ([*FRF, "--model", "rubber"], ["--model", "rubber", "exact"]),
        ([*FRF, "--frame", "sky"], ["--frame", "sky"]),
        ([*FRF, "--at", "1,2"], ["--at", "1,2"]),
        ([*FRF, "--damping", "magic"], ["--damping", "magic", "hysteretic"]),
        ([*FRF, "--damping", "rayleigh"], ["--damping", "2 numbers"]),
        ([*FRF, "--damping", "rayleigh:1,-1"], ["--damping", "zero or more"]),
        ([*FRF, "--damping", "viscous:1.5"], ["--damping", "viscous:1.5"]),
        ([*FRF, "--damping", "modal"], ["--damping", "modal:0.01,0.012"]),
        ([*FRF, "--damping", "modal:"], ["--damping", "modal:0.01,0.012"]),
        ([*FRF, "--damping", "modal:0.1,1"], ["--damping", "[0, 1)"]),
        ([*FRF, "--damping", "modal:0.1,-0.01"], ["--damping", "[0, 1)"]),
        ([*STOP, "--damping", "modal:0.1,x"], ["--damping", "0.1,x", "ratios"]),
        ([*FRF, "--damping", "frequency-dependent", "--model", "static"], ["--damping", "F_REF"]),
        ([*FRF[:4], "--excite", "cable1@0.5:z", *FRF[6:], "--model", "static"], ["--excite", "massless"]),
        (STOP[:4], ["--initial-velocity", "--trajectory"]),
        ([*STOP, "--trajectory", "helix"], ["--initial-velocity", "either"]),
        ([*STOP[:5], "0,0,0", *STOP[6:]], ["--initial-velocity", "zero"]),
        ([*STOP[:5], "1,2", *STOP[6:]], ["--initial-velocity", "1,2"]),
        ([*STOP[:7], "-2"], ["--duration", "-2"]),
        ([*STOP, "--highest", "0"], ["--highest", "0"]),
        ([*STOP, "--window", "9"], ["--window", "9"]),
        ([*STOP, "--watch", "cable0@0.3:z"], ["--watch", "cable0"]),
        (["transient", "thesis-3-1", "--trajectory", "none.csv"], ["none.csv"]),
        (["spectrogram", "none.csv", "--robot", "thesis-3-1"], ["none.csv"]),
    ],
    ids=lambda value: " ".join(value)[-60:] if isinstance(value, list) else None,
)  # fmt: skip
def test_bad_options_are_one_line(arguments, words, capsys):
    assert run(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    lines = captured.err.strip().splitlines()
    assert len(lines) == 1, captured.err
    assert all(word in lines[0] for word in words), lines[0]
