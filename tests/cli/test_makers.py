"""The two machines of makers: files are those that make.py writes, campaigns validate, errors are as the pages say."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import cdpr_struct as cs
from cdpr_struct.hypotheses.handled import promising, readings_felt
from cdpr_struct.hypotheses.handling import corrections
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from tests.virtual_truths import made

EXAMPLES = Path(__file__).parents[2] / "examples"
ROUTER, PRINTER = EXAMPLES / "two-chain-router", EXAMPLES / "hanging-printer"
CAMPAIGNS = [
    ROUTER / "campaign.toml", ROUTER / "with-weight.toml", ROUTER / "level.toml",
    PRINTER / "campaign.toml", PRINTER / "with-weight.toml", PRINTER / "with-tensions.toml", PRINTER / "beam.toml",
]  # fmt: skip


def rests(path: Path, lengths: np.ndarray, model: str = "sagging") -> np.ndarray:
    """(n, 3) [m] where a robot rests at lengths (n, m)."""
    robot = load_robot(path)
    assert robot.home is not None
    start = [np.broadcast_to(own, (len(lengths), *own.shape)) for own in (robot.home.position, robot.home.rotation)]
    return forward(robot, lengths, *start, model).position


def off(table: pd.DataFrame, predicted: np.ndarray) -> float:
    """[mm] rms distance of predicted from measured places."""
    gap = predicted - table[["x_m", "y_m", "z_m"]].to_numpy()
    return float(1e3 * np.sqrt((gap**2).sum(axis=1).mean()))


@pytest.mark.parametrize("path", CAMPAIGNS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_the_campaigns_validate(path):
    campaign = load_campaign(path)
    assert np.isfinite(campaign.states.length).all()
    assert np.isfinite(campaign.states.position).all()


@pytest.mark.slow
@pytest.mark.parametrize("folder", [ROUTER, PRINTER], ids=lambda folder: folder.name)
def test_the_files_are_those_of_the_script(folder):
    for name, table in made(folder).tables(np.random.default_rng(made(folder).SEED)).items():
        stored = pd.read_csv(folder / name)
        pd.testing.assert_frame_equal(table.round(6), stored, check_dtype=False, atol=2e-6)


def test_errors_of_later_holes_before_and_after_the_level():
    later = pd.read_csv(ROUTER / "later.csv")
    lengths = later[["length_1_m", "length_2_m"]].to_numpy()
    found = {
        (name, model): off(later, rests(ROUTER / name, lengths, model))
        for name, model in (("robot.toml", "spring"), ("robot.toml", "sagging"), ("robot-level.toml", "sagging"))
    }
    assert [round(value, 1) for value in found.values()] == [5.4, 5.4, 2.3]


def test_errors_of_the_printer_before_and_after_the_beam():
    found = []
    for robot in ("robot.toml", "robot-beam.toml"):
        home = inverse(load_robot(PRINTER / robot), np.zeros(3), np.eye(3)).lengths
        for file in ("points.csv", "later.csv"):
            table = pd.read_csv(PRINTER / file)
            wound = table.filter(regex="length_").to_numpy()
            found.append(round(off(table, rests(PRINTER / robot, home + wound)), 1))
    assert found == [1.3, 1.1, 1.1, 1.3]


@pytest.mark.slow
def test_the_band_of_the_diagnosed_router_predicts_later_holes():
    extended = cs.diagnose(ROUTER / "campaign.toml").extended
    assert extended is not None
    later, predicted = pd.read_csv(ROUTER / "later.csv"), []
    for lengths in later[["length_1_m", "length_2_m"]].to_numpy():
        bands = cs.forward(extended, lengths=lengths, band=90).answer["bands"]["pose"]
        predicted.append(np.mean(bands, axis=1)[:3])
    assert round(off(later, np.array(predicted)), 1) == 1.4


@pytest.mark.slow
def test_tensions_of_the_printer_are_unknown():
    found = cs.diagnose(PRINTER / "with-tensions.toml").answer
    assert found["verdict"]["status"] == "unknown"
    assert found["p_value"] == pytest.approx(0.013, abs=0.001)


def test_corrections_that_no_mast_could_hold_are_passed_over(tmp_path):
    """Tensions of four lines in another unit would bend the beam out of sight; the others are judged all the same."""
    shutil.copytree(PRINTER, tmp_path / "printer")
    pulls = pd.read_csv(PRINTER / "pulls.csv")
    pulls[[f"tension_{i}_N" for i in (2, 4, 6, 8, 9)]] = np.nan
    pulls.to_csv(tmp_path / "printer" / "pulls.csv", index=False)
    path = tmp_path / "printer" / "with-tensions.toml"
    path.write_text(path.read_text("utf-8").replace('"robot.toml"', '"robot-beam.toml"'), "utf-8")
    campaign = load_campaign(path)
    data = recorded(campaign)
    assert promising(data, corrections(campaign), readings_felt(data)) == []
