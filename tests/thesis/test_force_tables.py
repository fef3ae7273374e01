"""Table 5.3, figs 5.4-5.6 and Table 4.4 of the thesis."""

import numpy as np
import pytest

from cdpr_struct.thesis import force_tables
from cdpr_struct.thesis.force_tables import fig_5_4, fig_5_5, fig_5_6, helix_distribution, table_4_4, table_5_3


def test_every_force_of_table_5_3_is_within_six_per_cent():
    """Measured 1.3 to 5.7 %, all above the print; the averages too, once exchanged back."""
    deviations = [cell.ours / float(cell.printed) - 1.0 for cell in table_5_3().cells]
    assert len(deviations) == 18
    assert min(deviations) > 0.01
    assert max(deviations) < 0.06


def test_fixed_bound_comes_from_cables_2_and_5():
    found = fig_5_4()
    assert found.holds
    assert [cell.ours for cell in found.cells] == [pytest.approx(5.48), pytest.approx(24.52)]


def test_energy_saving():
    """Printed 10.8 %; measured 10.33 %."""
    pose_dependent, fixed, saved = (cell.ours for cell in fig_5_6().cells)
    assert saved == pytest.approx(10.8, abs=0.8)
    assert pose_dependent == pytest.approx(138700.0, rel=0.06)
    assert fixed == pytest.approx(155400.0, rel=0.06)


@pytest.mark.slow
def test_straight_cables_meet_the_printed_energies():
    """What the note of fig. 5.6 says: both 0.8 % low, and the same saving as printed."""
    dependent, fixed = (helix_distribution(rule, "ideal").work.total for rule in force_tables.RULES)
    assert dependent / 138700.0 == pytest.approx(0.992, abs=5e-4)
    assert fixed / 155400.0 == pytest.approx(0.992, abs=5e-4)
    assert 100.0 * (1.0 - dependent / fixed) == pytest.approx(10.75, abs=0.01)


def test_fixed_bound_asks_more_of_every_cable():
    found = fig_5_5()
    assert found.within_tolerance == 8
    assert not found.statements[0].holds  # in 42 of 24008 cable instants it does not


def test_first_two_poses_of_table_4_4():
    """Thesis's simulation within 3 %, measurement within the 11 % that the thesis reports."""
    cells = [c for c in table_4_4().cells if c.row.startswith(("horizontal centre", "middle edge"))]
    assert len(cells) == 32
    assert all(cell.within for cell in cells)


def test_corner_pose_meets_the_measurement_better_than_the_print():
    cells = [c for c in table_4_4().cells if c.row.startswith("horizontal corner")]
    printed, measured = ([float(c.printed) for c in cells[i::2]] for i in (0, 1))
    ours = [c.ours for c in cells[1::2]]
    assert np.std(np.subtract(ours, measured)) < 0.5 * np.std(np.subtract(printed, measured))


def test_printed_sign_of_the_corner_is_wrong(monkeypatch):
    """Twin: with y = +2.930 the forces are those of the mirrored cables."""
    row = next(r for r in force_tables.printed_table("table_4_4") if r["pose"] == "horizontal corner")
    assert float(row["y_m"]) == 2.93
    assert force_tables._pose(row).position[1] == -2.93
