"""Figs 2.5, 3.8, 3.9 and Tables 4.5, 4.6: what comes out, and what the printed numbers would need."""

import numpy as np
import pytest

from cdpr_struct.thesis import cogiro_vibration, vibration


def test_first_peak_of_the_trace_is_the_first_out_of_plane_mode():
    """The printed formula for it, pi sqrt(tau / (rho g l)), is no frequency: it would put the peak at 1.67 rad/s."""
    item = vibration.fig_2_5()
    assert item.statements[0].holds
    assert (item.columns["static_trace_N_m"] == item.columns["static_trace_N_m"][0]).all()


def test_stated_first_frequency_is_a_cable_mode():
    """2.4 Hz in the thesis, 2.483 Hz here."""
    (cell,) = vibration.fig_3_8().cells
    assert cell.ours == pytest.approx(2.4831, abs=1e-4)
    assert abs(cell.deviation) < 0.1


def test_first_frequency_is_highest_at_the_centre_and_belongs_to_the_cables():
    """2.48 Hz at the centre, 1.30 Hz at the corners; the platform's own is nearly flat, a saddle at the centre."""
    item = vibration.fig_3_9()
    assert item.statements[0].holds
    assert item.columns["first_Hz"].max() == pytest.approx(2.483, abs=1e-3)
    assert 3.0 < item.columns["platform_massless_Hz"].min() < item.columns["platform_massless_Hz"].max() < 3.35
    assert (item.columns["first_Hz"] <= item.columns["platform_Hz"] + 1e-9).all()
    assert np.isfinite(item.columns["cable_8_Hz"]).all()


def test_printed_cable_frequencies_need_more_tension_than_table_4_4_lists():
    for item, worst in ((cogiro_vibration.table_4_5(), 0.10), (cogiro_vibration.table_4_6(), 0.09)):
        ratio = np.array([cell.ours / float(cell.printed) for cell in item.cells])
        assert (ratio < 1.0).all()
        assert (ratio > 1.0 - worst).all()


@pytest.mark.slow
def test_stated_platform_modes_need_twice_the_stiffness_per_mass():
    """With EA as stated no inertia meets them; with EA free the five are met within 0.03 Hz."""
    assert cogiro_vibration._fit(118.5, False).rms > 0.7
    free = cogiro_vibration._fit(118.5, True)
    assert free.rms < 0.03
    assert free.factor == pytest.approx(2.33, abs=0.05)
    assert free.inertia.sum() > 2.0 * free.inertia.max(), "triangle inequality"
