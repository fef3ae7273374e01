"""Table 3.2 and figs 2.4, 3.4-3.7, 4.4: what is met, and what the thesis says that our figures do not show."""

import numpy as np
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.thesis import load_thresholds, pose_errors
from cdpr_struct.thesis.cable_profiles import fig_2_4
from cdpr_struct.thesis.catalogue import ITEMS


def test_all_twelve_averages_of_table_3_2_are_met():
    """To 0.07 mm; the largest deviation is 0.058 mm, of a print in steps of 0.1 mm."""
    table = pose_errors.table_3_2()
    assert table.within_tolerance == len(table.cells) == 12
    assert max(abs(cell.deviation) for cell in table.cells) == pytest.approx(0.058, abs=0.002)


def test_table_3_2_fails_with_another_stiffness(monkeypatch):
    """A twin that must fail: the 4 mm averages with the stretch of the 8 mm cable."""
    monkeypatch.setitem(pose_errors.ROBOTS, "4", "thesis-3-1-8mm")
    pose_errors.error_map.cache_clear()
    try:
        assert pose_errors.table_3_2().within_tolerance == 6
    finally:
        pose_errors.error_map.cache_clear()
        pose_errors.area_average.cache_clear()


def test_averages_over_the_area_are_converged(monkeypatch):
    """Half the Gauss nodes move no average by more than 2e-3 mm; finer grids tend to it."""
    fine = pose_errors.area_average("8", "60")
    pose_errors.area_average.cache_clear()
    monkeypatch.setattr(pose_errors, "GAUSS", 4)
    coarse = pose_errors.area_average("8", "60")
    pose_errors.area_average.cache_clear()
    assert all(abs(fine[part] - coarse[part]) < 2e-3 for part in fine)
    gaps = [abs(pose_errors.error_map("8", "60", n).mean("sag") - fine["sag"]) for n in (7, 13, 25)]
    assert gaps[0] > 1.9 * gaps[1] > 3.6 * gaps[2]


def test_the_print_overstates_sag_by_its_coarse_grid():
    """28 % at 4 mm and 60 kg, as the note says."""
    ratio = [c.ours / c.converged - 1.0 for c in pose_errors.table_3_2().cells if c.column == "sag"]
    assert max(ratio) == pytest.approx(0.28, abs=0.01)


@pytest.mark.parametrize(
    ("name", "calm_centre"), [("fig-3.4", False), ("fig-3.5", False), ("fig-3.6", True), ("fig-3.7", True)]
)
def test_signs_are_as_stated_and_the_centre_is_calmest_for_heavy_cables_only(name, calm_centre):
    """Section 3.4.2 says that the error is smallest near the centre; with 4 mm cables it is largest there."""
    item = ITEMS[name]()
    assert [s.holds for s in item.statements] == [True, True, calm_centre]
    assert item.within_tolerance == 3
    np.testing.assert_allclose(item.columns["global_mm"], item.columns["sag_mm"] + item.columns["axial_mm"], atol=1e-9)


def test_maps_are_symmetric_about_the_centre():
    errors = pose_errors.error_map("4", "30", 7)
    for part in ("sag", "axial", "global"):
        value = errors.vertical(part).reshape(7, 7)
        np.testing.assert_allclose(value, value[::-1, ::-1], atol=1e-6)


def test_thresholds_of_fig_4_4():
    item = load_thresholds.fig_4_4()
    assert item.within_tolerance == 2
    assert [cell.ours for cell in item.cells] == pytest.approx([51.0, 61.6], abs=0.5)
    assert [s.holds for s in item.statements] == [False, True, True, True]


def test_no_single_tolerance_gives_both_thresholds():
    """Sag's part at the printed thresholds: 0.33 mm against 2.62 mm."""
    left = []
    for diameter, mass in (("4", 50.0), ("8", 70.0)):
        curve = load_thresholds.load_curve(diameter)
        left.append(np.interp(mass, curve["mass_kg"], curve["sagging_mm"] - curve["spring_mm"]))
    assert left == pytest.approx([0.33, 2.62], abs=0.01)


def test_fig_2_4_ends_where_table_2_2_says():
    item = fig_2_4()
    assert all(s.holds for s in item.statements)
    ends = item.columns["arc_m"] == 20.0
    printed = np.array([[float(c.printed) for c in item.cells if c.column == name] for name in ("xC_m", "zC_m")])
    assert np.abs(np.array([item.columns["x_m"][ends], item.columns["z_m"][ends]]) - printed).max() < 0.025


def test_reproduce_writes_figures_tables_and_page(tmp_path):
    assert run(["reproduce", "fig-2.4", "table-3.2", "fig-4.4", "--out", str(tmp_path)]) == 0
    names = {path.name for path in tmp_path.iterdir()}
    tables = {"fig-2.4.csv", "fig-2.4-data.csv", "table-3.2.csv", "fig-4.4.csv", "fig-4.4-data.csv"}
    figures = {f"{name}.{form}" for name in ("fig_2_4", "fig_4_4") for form in ("svg", "pdf")}
    assert names == tables | figures | {"result.json", "report.html"}
    page = (tmp_path / "report.html").read_text()
    assert "http://" not in page.replace("http://www.w3.org", "")
    assert "4.75123" in page
