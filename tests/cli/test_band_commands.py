"""`--band` of commands that have other results than a state of rest: keys, columns, pages, and what is refused."""

import json

import numpy as np
import pytest

from cdpr_struct.cli.main import run

POSE = "--pose=0.2,0.1,1.3"


def result_of(words: list[str], out) -> dict:
    assert run([*words, "--out", str(out), "--quiet"]) == 0
    return json.loads((out / "result.json").read_text())


def test_pose_error_at_one_pose(tmp_path):
    found = result_of(["pose-error", "cogiro", POSE, "--band", "90", "--samples", "50"], tmp_path)
    rows = found["bands"]["errors"]
    assert rows["global_z_mm"]["value"] == pytest.approx(found["mean_mm"]["global"])
    assert all(low < high for low, high in (row["band"] for row in rows.values()))
    assert found["bands"]["samples"]["count"] == 50
    header, row = (tmp_path / "pose_error.csv").read_text().splitlines()
    told = dict(zip(header.split(","), map(float, row.split(",")), strict=True))
    assert [told[f"global_z_{end}_mm"] for end in ("low", "high")] == pytest.approx(rows["global_z_mm"]["band"])
    page = (tmp_path / "report.html").read_text()
    assert "Pose error within the tolerances" in page
    assert (tmp_path / "bands.svg").exists()


def test_pose_error_with_free_angles_is_about_the_pose_that_hangs(tmp_path):
    found = result_of(["pose-error", "cogiro", POSE, "--free", "rx,ry", "--band", "90"], tmp_path)
    assert found["bands"]["errors"]["global_z_mm"]["value"] == pytest.approx(found["mean_mm"]["global"], abs=1e-6)
    assert np.ptp(found["bands"]["errors"]["global_z_mm"]["band"]) > 0.0


def test_map_has_pictures_of_sigma_and_of_the_probability(tmp_path):
    words = ["map", "cogiro", "--grid=-1:1:3,0:1:2,1.2", "--quantity", "tension-min", "--band", "90", "--limit", "320"]
    found = result_of([*words, "--samples", "40"], tmp_path)["bands"]
    header, *rows = (tmp_path / "map.csv").read_text().splitlines()
    assert {"tension_min_low_N", "tension_min_high_N", "tension_min_sigma_N", "probability_below"} <= set(
        header.split(",")
    )
    assert len(rows) == found["poses"] == 6
    assert found["sigma"]["smallest"]["value"] <= found["sigma"]["mean"] <= found["sigma"]["largest"]["value"]
    assert found["samples"]["largest_difference_of_probability"] < 0.2
    assert {"sigma.svg", "probability.svg", "map.svg"} <= {path.name for path in tmp_path.iterdir()}
    assert "falls below 320 N" in (tmp_path / "report.html").read_text()


def test_cable_has_bands_and_their_picture(tmp_path):
    words = ["cable", "--force", "100,-100", "--length", "20", "--EA", "251327.4", "--rho", "0.067", "--band", "50"]
    found = result_of([*words, "--tolerances", "linear_density=0.05,load_cell_gain=0"], tmp_path)
    bands = found["bands"]
    assert bands["tolerances"]["linear_density"] == {"value": 0.05, "stated": True}
    for plane, ends in bands["exact_frequencies_hz"].items():
        for (low, high), hertz in zip(ends, found["exact_frequencies_hz"][plane], strict=True):
            assert low < hertz < high
    assert bands["variance_shares"]["density"]["out_of_plane"][0] > 0.9
    assert (tmp_path / "bands.svg").exists()
    assert "within the tolerances" in (tmp_path / "report.html").read_text()


FRF = ["frf", "cogiro", "--excite", "fz", "--respond", "z,rx", "--band", "2:4:0.05"]


def test_frf_takes_the_level_beside_its_frequencies(tmp_path, capsys):
    """--band with colons is frequencies, as ever; a level is --percent, or a second --band without colons."""
    assert run([*FRF, "--percent", "90", "--samples", "20", "--json", "--quiet"]) == 0
    found = json.loads(capsys.readouterr().out)
    again = result_of([*FRF, "--band", "90", "--samples", "20"], tmp_path / "band")
    assert found["bands"] == again["bands"]
    assert found["band_hz"] == again["band_hz"] == "2:4:0.05"
    assert found["bands"]["samples"] == {"count": 20, "not_stable": 0}
    (low, high) = found["bands"]["curves"][0]["largest"]
    assert low < found["bands"]["curves"][0]["as_entered"] < high
    rows = (tmp_path / "band" / "frf_band.csv").read_text().splitlines()
    assert rows[0] == "frequency_hz,respond,as_entered,low,median,high"
    assert len(rows) == 1 + 2 * found["bands"]["lines"]
    assert "Within the tolerances" in (tmp_path / "band" / "report.html").read_text()


def test_transient_has_displacements_with_their_band(tmp_path):
    words = ["transient", "cogiro", "--initial-velocity", "0.2,0,0", "--duration", "1", "--highest", "8"]
    found = result_of([*words, "--band", "90", "--samples", "20"], tmp_path)
    assert [curve["name"] for curve in found["bands"]["curves"]] == ["x", "y", "z", "rx", "ry", "rz"]
    assert len(found["bands"]["curves"][0]["largest_at_s"]) == 2
    assert (tmp_path / "transient_band.csv").read_text().startswith("time_s,port,as_entered,low,median,high")
    assert (tmp_path / "bands.svg").exists()


@pytest.mark.slow
def test_distribute_says_how_sure_the_bounds_are(tmp_path):
    words = ["distribute", "thesis-5", "--trajectory", "helix", "--instants", "11", "--band", "90", "--samples", "40"]
    bands = result_of(words, tmp_path)["bands"]
    assert bands["probability_all_taut"] > 0.99
    assert bands["raise_lower_bound"]["by_N"] > 0.0
    assert [cable["cable"] for cable in bands["cables"]] == list(range(1, 9))
    rows = (tmp_path / "force_bands.csv").read_text().splitlines()
    assert len(rows) == 1 + 11 * 8
    assert rows[0].startswith("time_s,cable,tension_N,sigma_N,low_N,high_N,lower_bound_N")
    assert "How sure are the forces?" in (tmp_path / "report.html").read_text()
