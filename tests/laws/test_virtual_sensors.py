"""Virtual sensors: true tensions of finite-element robots lie in bands, readings are predicted without themselves."""

import shutil
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import cdpr_struct as cs
from cdpr_struct.cli.main import run
from cdpr_struct.diagnosis.virtual_sensors import opened, virtual_sensors
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded
from tests.virtual_truths import PRINTER, filmed, inside, predicted, printed

LEVELS = {50: 0.674, 90: 1.645, 99: 2.576}  # percent, sigmas
GAUGED = (0, 2, 4)  # one line of each lower motor


@pytest.fixture(scope="module")
def one():
    """A filmed robot, its true tensions and what is predicted of it."""
    campaign, true = filmed(3, 26)
    return campaign, true, predicted(campaign)


def test_tensions_without_a_cell_are_predicted(one):
    _, true, seen = one
    off = true - seen.value[:, 6:10]
    assert np.isnan(seen.reading[:, 6:10]).all()
    assert np.abs(off).max() < 0.2 * true.min()
    assert inside(seen, true, 3.0).mean() > 0.9


def test_a_sensor_is_predicted_without_its_own_reading(one):
    """A reading that is wrong by 50 mm moves its own prediction by a thousandth of that; those of others feel it."""
    campaign = one[0]
    length = campaign.states.length.copy()
    length[7, 2] += 0.05
    data = opened(recorded(campaign))
    found = judged(data, layout(data), Hypothesis())
    own = data.readings.length.copy()
    own[7, 2] += 0.05
    spoiled = replace(
        data, readings=replace(data.readings, length=own),
        campaign=replace(campaign, states=replace(campaign.states, length=length)),
    )  # fmt: skip
    none = np.zeros(data.states, dtype=bool)
    before = virtual_sensors(found, data, none, np.zeros(4))
    after = virtual_sensors(found, spoiled, none, np.zeros(4))
    change = after.value[7] - before.value[7]
    assert abs(change[12]) < 1e-3
    assert np.abs(change[:3]).max() > 5e-3
    assert after.reading[7, 12] - before.reading[7, 12] == pytest.approx(0.05)


def test_states_that_were_fitted_do_not_count_twice(one):
    campaign, _, seen = one
    data = opened(recorded(campaign))
    found = judged(data, layout(data), Hypothesis())
    twice = virtual_sensors(found, data, np.zeros(data.states, dtype=bool), np.zeros(4))
    assert np.all(seen.sigma >= twice.sigma * (1.0 - 1e-6))
    assert (seen.sigma > 1.001 * twice.sigma).any()


@pytest.mark.slow
def test_what_is_known_of_a_pretension_comes_from_the_readings():
    """Twice the pretension that the file states: with three gauges it is found, without one the bands are wide."""
    campaign, true = printed(1, 80.0, GAUGED)
    seen, bare = predicted(campaign), predicted(printed(1, 80.0)[0])
    others = [i for i in range(9) if i not in GAUGED]
    taut = true.min(axis=1) > 3.0
    assert np.abs(true - seen.value[:, 6:15])[taut][:, others].max() < 8.0
    assert np.median(seen.sigma[:, 6:15][:, others]) < 2.0
    assert np.median(bare.sigma[:, 6:15]) > 10.0


def test_several_campaigns_are_refused(capsys):
    files = [str(PRINTER / "campaign.toml"), str(PRINTER / "beam.toml")]
    assert run(["diagnose", *files, "--virtual-sensors"]) == 2
    assert "--virtual-sensors: got '2 campaigns'; a single campaign to diagnose" in capsys.readouterr().err


@pytest.mark.slow
def test_the_command_writes_table_and_figure(tmp_path):
    found = cs.diagnose(PRINTER / "with-tensions.toml", later=PRINTER / "campaign.toml", virtual_sensors=True)
    files = found.files()
    assert {"virtual_sensors.csv", "virtual_sensors_later.csv", "virtual_sensors.svg"} <= set(files)
    table = found.virtual_frame()
    assert list(table.columns[:5]) == ["case", "time_s", "sensor", "number", "unit"]
    assert len(table) == 15 * 24
    assert (table.low < table.predicted).all()
    read = pd.read_csv(PRINTER / "pulls.csv").filter(regex="tension_").notna().to_numpy().sum()
    assert table[table.sensor == "tension"].reading.notna().sum() == read
    told = found.to_json()["virtual_sensors"]
    assert told["states"] == told["later"]["states"] == 15
    assert told["later"]["sensors"][6]["readings"] == 0


@pytest.mark.slow
@pytest.mark.parametrize(("kept", "rms", "held"), [((1, 3, 5, 7), 1.5, 88), ((), 17.6, 89)], ids=["four", "none"])
def test_tensions_of_the_shipped_printer_whose_beam_nobody_entered(kept, rms, held, tmp_path):
    shutil.copytree(PRINTER, tmp_path / "printer")
    pulls = pd.read_csv(PRINTER / "pulls.csv")
    true = pulls.filter(regex="tension_").to_numpy()
    hidden = [i for i in range(1, 10) if i not in kept]
    pulls[[f"tension_{i}_N" for i in hidden]] = np.nan
    pulls.to_csv(tmp_path / "printer" / "pulls.csv", index=False)
    name = "with-tensions.toml" if kept else "campaign.toml"
    found = cs.diagnose(tmp_path / "printer" / name, virtual_sensors=True).virtual_sensors
    assert found is not None
    place = [found.own.names.index(case) for case in pulls.case]
    column = [5 + i for i in hidden]
    off = (true - found.own.value[place, 6:15])[:, [i - 1 for i in hidden]]
    sigma = np.hypot(found.own.sigma[place][:, column], 1.0)
    assert np.sqrt(np.nanmean(off**2)) == pytest.approx(rms, abs=0.1)
    assert round(100.0 * float((np.abs(off) < LEVELS[90] * sigma)[np.isfinite(off)].mean())) == held


@pytest.mark.slow
@pytest.mark.parametrize(
    ("made", "chosen", "said"),
    [
        (lambda seed: filmed(seed, 40), range(4), {50: 51, 90: 87, 99: 100}),
        (lambda seed: printed(seed, 40.0, GAUGED), (1, 3, 5, 6, 7, 8), {50: 50, 90: 90, 99: 98}),
        (printed, range(9), {50: 55, 90: 84, 99: 97}),
    ],
    ids=["filmed", "gauged", "ungauged"],
)
def test_true_tensions_lie_in_their_bands_as_often_as_the_page_says(made, chosen, said):
    """Twenty robots each; docs/virtual_sensors.md."""
    held = {level: [] for level in LEVELS}
    for seed in range(20):
        campaign, true = made(seed)
        seen = predicted(campaign)
        for level, reach in LEVELS.items():
            held[level].append(inside(seen, true, reach)[:, list(chosen)].mean())
    assert {level: round(100.0 * float(np.mean(own))) for level, own in held.items()} == pytest.approx(said, abs=1)


@pytest.mark.slow
def test_bands_half_as_wide_are_seen():
    held = []
    for seed in range(6):
        campaign, true = printed(seed, 40.0, GAUGED)
        held.append(inside(predicted(campaign), true, 0.5 * LEVELS[90])[:, [1, 3, 5, 6, 7, 8]].mean())
    assert np.mean(held) + 2.0 * np.std(held) / np.sqrt(len(held)) < 0.9
