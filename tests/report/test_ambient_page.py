"""The page of ambient records: whole, with the diagram that modes were chosen from; what a diagnosis makes of it."""

import io
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import cdpr_struct as cs

pytest.importorskip("pyoma2")
CAMPAIGN = Path(__file__).parents[2] / "examples" / "ambient" / "campaign.toml"


@pytest.fixture(scope="module")
def found():
    return cs.ambient(CAMPAIGN)


def test_pyoma_prints_nothing_and_leaves_numpy_as_it_is(capfd):
    before = np.geterr()
    cs.ambient(CAMPAIGN)
    assert np.geterr() == before
    assert tuple(capfd.readouterr()) == ("", "")


@pytest.fixture(scope="module")
def files(found):
    return found.files()


def test_page_is_whole_and_loads_nothing(files, read_page, inlined):
    page = read_page(files["report.html"])
    assert page.foreign == []
    assert page.values("figure", "id") == ["stabilisation_1"]
    assert inlined(files["stabilisation_1.svg"]) in files["report.html"]


def test_the_diagram_holds_each_mode_at_as_many_orders_as_are_told(found, files):
    poles = pd.read_csv(io.StringIO(files["diagram.csv"]))
    chosen = poles[poles["mode"] > 0]
    assert chosen["stable"].all()
    assert chosen.groupby("mode").size().tolist() == found.frame()["orders"].tolist()
    assert not chosen.duplicated(["mode", "order"]).any()
    middle = chosen.groupby("mode")["frequency_hz"].median()
    np.testing.assert_allclose(middle, found.frame()["frequency_hz"], rtol=0.01)


def test_frequencies_are_written_as_measured_data(files, tmp_path):
    for name in ("states.csv", "campaign.toml"):
        (tmp_path / name).write_text((CAMPAIGN.parent / name).read_text())
    (tmp_path / "robot_frequency.csv").write_text(files["robot_frequency.csv"])
    text = (tmp_path / "campaign.toml").read_text().replace("ambient.csv", "robot_frequency.csv")
    (tmp_path / "campaign.toml").write_text(text.replace('kind = "ambient"', 'kind = "robot_frequency"'))
    listed, recorded = cs.load_campaign(tmp_path / "campaign.toml"), cs.load_campaign(CAMPAIGN)
    for name in ("hertz", "sigma", "state"):
        np.testing.assert_allclose(
            getattr(listed.robot_frequencies, name), getattr(recorded.robot_frequencies, name), rtol=1e-9
        )


def test_noise_that_drifts_has_no_mode_and_the_result_says_so(tmp_path):
    generator = np.random.default_rng(4)
    noise = generator.normal(size=(3000, 2))
    table = pd.DataFrame(noise + 0.01 * np.cumsum(noise, axis=0), columns=["ax", "a_cable3"])
    table.insert(0, "time_s", np.arange(3000) / 25.0)
    table[["x_m", "y_m", "z_m"]] = [0.4, 0.3, 0.6]
    table.to_csv(tmp_path / "noise.csv", index=False)
    text = 'robot = "six-cable-4mm"\n[[measurement]]\nkind = "ambient"\nfile = "noise.csv"\n'
    (tmp_path / "campaign.toml").write_text(text)
    silent = cs.ambient(tmp_path / "campaign.toml")
    assert silent.to_json()["records"][0]["modes"] == []
    assert any("adds no frequency: no pole between 0.833 and 10 Hz is stable." in said for said in silent.warnings)
    assert not silent.to_json()["trust"]["holds"]
    assert "0 modes between" in silent.files()["report.html"]


@pytest.mark.slow
def test_a_diagnosis_finds_the_inertia_and_shows_the_diagram():
    """25 % more inertia than entered; five seconds."""
    diagnosed = cs.diagnose(CAMPAIGN)
    best = diagnosed.answer["candidates"][0]
    size = best["parameters"]["inertia"]
    assert best["cause"] == "platform_inertia"
    assert abs(size["value"] - 1.25) < 3.0 * size["sigma"]
    assert len(diagnosed.to_json()["ambient"][0]["modes"]) == 9
    assert "stabilisation_1.svg" in diagnosed.files()
