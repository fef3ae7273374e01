"""One row a pose and one column a cable says the same as one row a cable, whatever was read and whatever was not."""

from dataclasses import fields, is_dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.reports.diagnose.corrected_columns import changed_columns

EXAMPLE = Path(__file__).parents[2] / "examples" / "table-4-4"
POSE = ["case", "x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg"]
FREQUENCIES = 'robot = "cogiro"\n[[measurement]]\nkind = "cable_frequency"\nfile = "states.csv"\n'


def one_row_a_pose(table: pd.DataFrame, row: list[str], columns: dict[str, str]) -> pd.DataFrame:
    """The long table with the quantities `columns` (long name to form of the wide name) in one column a cable."""
    rows = []
    for values, cables in table.groupby(row, sort=False, dropna=False):
        cells = {form.format(i): np.nan for form in columns.values() for i in range(1, 9)}
        for long, form in columns.items():
            cells |= {form.format(i): value for i, value in zip(cables["cable"], cables[long], strict=True)}
        rows.append(dict(zip(row, values, strict=True)) | cells)
    return pd.DataFrame(rows)


def campaigns(tmp_path, long: pd.DataFrame, wide: pd.DataFrame, text: str):
    """The campaigns of two tables."""
    found = []
    for name, table in (("long", long), ("wide", wide)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "campaign.toml").write_text(text)
        table.to_csv(tmp_path / name / "states.csv", index=False)
        found.append(load_campaign(tmp_path / name / "campaign.toml"))
    return found


def assert_same(one: object, other: object, place: str = "") -> None:
    """All fields equal, arrays number by number; of the path and of how the file was laid out no more is asked."""
    if isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, other, err_msg=place)
    elif is_dataclass(one) and not isinstance(one, type):
        for field in fields(one):
            if field.name not in ("source", "headings", "columns"):
                assert_same(getattr(one, field.name), getattr(other, field.name), f"{place}.{field.name}")
    elif isinstance(one, tuple):
        assert len(one) == len(other), place
        for i, (a, b) in enumerate(zip(one, other, strict=True)):
            assert_same(a, b, f"{place}[{i}]")
    else:
        assert one == other, place


@pytest.fixture
def states() -> pd.DataFrame:
    return pd.read_csv(EXAMPLE / "states.csv", comment="#")


def test_the_example_gives_the_same_campaign(states, tmp_path):
    wide = one_row_a_pose(states, POSE, {"tension_N": "tension_{}_N"})
    long, other = campaigns(tmp_path, states, wide, (EXAMPLE / "campaign.toml").read_text())
    assert long.states.tension.shape == (4, 8)
    assert_same(long, other)
    assert set(other.sheets[0].columns) == set(long.sheets[0].columns)
    assert other.sheets[0].headings == {"tension_N": "tension_1_N ... tension_8_N"}


def test_everything_that_a_row_may_say_holds_for_all_its_cables(states, tmp_path):
    """The third pose has no tension and the fourth no length; one sigma, temperature and time is left open."""
    number = states.groupby(POSE, sort=False).ngroup()
    states = states.assign(
        payload_kg=2.5 * number, sigma=np.where(number == 1, np.nan, 3.0 + number), temperature_K=290.0 + number,
        approach=np.where(number % 2, 1, -1), time_s=60.0 * number, length_m=8.0 + 0.01 * states["cable"],
    )  # fmt: skip
    states.loc[number == 2, "tension_N"], states.loc[number == 3, "length_m"] = np.nan, np.nan
    states.loc[number == 0, ["temperature_K", "time_s"]] = np.nan
    row = [*POSE, "payload_kg", "sigma", "temperature_K", "approach", "time_s"]
    columns = {"tension_N": "tension_{}_N", "length_m": "length_{}_m"}
    wide = one_row_a_pose(states, row, columns)
    long, other = campaigns(tmp_path, states, wide, (EXAMPLE / "campaign.toml").read_text())
    assert_same(long, other)
    assert np.isnan(other.states.tension).all(axis=1).tolist() == [False, False, True, False]
    assert other.states.tension_sigma[:, 0].tolist() == [3.0, 5.0, 5.0, 6.0]


def test_directions_may_differ_between_the_cables_of_a_row(states, tmp_path):
    states = states.assign(approach=np.where(states["cable"] % 3, 1, -1))
    wide = one_row_a_pose(states, POSE, {"tension_N": "tension_{}_N", "approach": "approach_{}"})
    long, other = campaigns(tmp_path, states, wide, (EXAMPLE / "campaign.toml").read_text())
    assert_same(long, other)
    assert other.states.approach[0].tolist() == [1, 1, -1, 1, 1, -1, 1, 1]


def test_cases_are_named_by_their_poses_in_both_forms(states, tmp_path):
    wide = one_row_a_pose(states, POSE, {"tension_N": "tension_{}_N"}).drop(columns="case")
    assert_same(*campaigns(tmp_path, states.drop(columns="case"), wide, (EXAMPLE / "campaign.toml").read_text()))


@pytest.mark.parametrize("named", [False, True])
def test_frequencies_of_cables(states, named, tmp_path):
    """First modes need no column `mode`; a frequency that was not found has no row in the long form."""
    mode = np.where(states["x_m"] > 1.0, 2, 1) if named else np.ones(len(states), dtype=int)
    long = states.assign(mode=mode, frequency_hz=3.0 + 0.1 * states.index, plane="out", sigma=0.01)
    row = [*POSE, "mode", "plane", "sigma"]
    kept = long[states.index % 5 > 0]
    wide = one_row_a_pose(kept, row, {"frequency_hz": "frequency_{}_hz", "tension_N": "tension_{}_N"})
    wide = wide if named else wide.drop(columns="mode")
    one, other = campaigns(tmp_path, kept, wide, FREQUENCIES)
    assert len(other.cable_frequencies.hertz) == len(kept) < 32
    assert_same(one, other)


def test_corrections_name_the_columns_of_the_file(states, tmp_path):
    """`changed_columns` speaks of the long form; a sheet knows what the file calls them."""
    wide = one_row_a_pose(states, POSE, {"tension_N": "tension_{}_N"})
    _, campaign = campaigns(tmp_path, states, wide, (EXAMPLE / "campaign.toml").read_text())
    tripled = campaign.states.tension * 3.0
    changed = campaign.with_states_only(_with(campaign.states, tension=tripled))
    (name,) = changed_columns(campaign, changed, "static_state") & set(campaign.sheets[0].columns)
    assert campaign.sheets[0].headings[name] == "tension_1_N ... tension_8_N"


def _with(states, **change):
    return type(states)(**{f.name: change.get(f.name, getattr(states, f.name)) for f in fields(states)})
