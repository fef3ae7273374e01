"""Orientations as quaternions: the same campaign as with angles; anything else is refused in one sentence."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign_file import load_campaign

SOURCE = Path(__file__).parents[2] / "examples" / "soft-masts"
ANGLES = ["rx_deg", "ry_deg", "rz_deg"]
TILTED = dict(zip(ANGLES, (12.0, -20.0, 35.0), strict=True))


@pytest.fixture
def folder(tmp_path):
    shutil.copytree(SOURCE, tmp_path / "campaign")
    return tmp_path / "campaign"


def rewritten(folder: Path, change) -> Path:
    """The campaign with the tables of its CSV files changed."""
    for file in folder.glob("*.csv"):
        table = pd.read_csv(file, comment="#")
        if set(ANGLES) <= set(table):
            change(table).to_csv(file, index=False)
    return folder / "campaign.toml"


def with_quaternions(table: pd.DataFrame, factor: float = 1.0) -> pd.DataFrame:
    x, y, z, w = factor * Rotation.from_euler("xyz", table[ANGLES], degrees=True).as_quat().T
    return table.drop(columns=ANGLES).assign(qw=w, qx=x, qy=y, qz=z)


def test_quaternions_give_the_same_campaign(folder):
    before = load_campaign(rewritten(folder, lambda table: table.assign(**TILTED))).states
    after = load_campaign(rewritten(folder, with_quaternions)).states
    assert after.names == before.names
    assert np.abs(before.angles).max() > 0.01
    assert after.angles == pytest.approx(before.angles, abs=1e-12)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda t: with_quaternions(t).drop(columns="qy"), "column qy"),
        (lambda t: with_quaternions(t).assign(rz_deg=0.0), "angles or a quaternion, not both"),
        (lambda t: with_quaternions(t, 1.1), "a unit quaternion"),
        (lambda t: with_quaternions(t).assign(qw=np.nan), "a unit quaternion"),
    ],
    ids=["three of four", "angles too", "not unit", "partly blank"],
)
def test_what_is_no_quaternion_is_refused(folder, change, said):
    with pytest.raises(InputError, match=said):
        load_campaign(rewritten(folder, change))
