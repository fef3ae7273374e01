"""Figures of signals: nothing on the curve, every peak explained, every line named; files of `transient` are read."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from cdpr_struct.diagnosis.damping_rows import DampingRows
from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign_rows import read_rows
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.modal_estimate import Modes
from cdpr_struct.measurement.peak_kinds import MODE
from cdpr_struct.measurement.signal_records import SignalRecord
from cdpr_struct.measurement.time_series import read_accelerations
from cdpr_struct.reports.figures.signals import draw_damping, draw_spectrum, unfitted_peaks


def two_peaks() -> Identified:
    """An FRF with peaks at 4 and 7.75 Hz, of which only the first was fitted."""
    lines, blank = np.linspace(1.0, 12.0, 551), np.full(3, np.nan)
    answer = sum(lines**2 / (f**2 - lines**2 + 0.01j * f * lines) for f in (4.0, 7.75))[:, None]
    record = SignalRecord("frf", "a", "a.csv", lines, answer, ("x/fx",), blank, blank, 0.0, np.full(8, np.nan))
    one = np.ones(1)
    modes = Modes(4.0 * one, 1e-3 * one, 0.005 * one, 1e-4 * one, one[:, None] + 0j, 100.0 * one, 1e-2 * one)
    later = Modes(9.0 * one, 1e-3 * one, 0.005 * one, 1e-4 * one, one[:, None] + 0j, 100.0 * one, 1e-2 * one)
    both = Modes(*(np.concatenate([getattr(m, n) for m in (modes, later)]) for n in Modes.__slots__[:-1]), modes.noise)
    used = np.array([True, False])
    return Identified(record, both, None, both.hertz_sigma, (MODE,) * 2, np.full(2, -1), used, ("", "weak"), "", None)


def test_a_peak_without_a_mode_is_marked_and_the_legend_is_off_the_curve():
    item, figure = two_peaks(), Figure((9.6, 3.4))
    np.testing.assert_allclose(unfitted_peaks(item), [7.75], atol=0.03)
    draw_spectrum(figure, item)
    figure.draw_without_rendering()
    axes = figure.axes[0]
    (legend,) = figure.legends
    assert "no mode fitted" in [text.get_text() for text in legend.get_texts()]
    assert legend.get_window_extent().y0 >= axes.get_window_extent().y1 - 1.0


def test_damping_lines_are_named():
    value = np.array([0.002, 0.003, 0.004])
    rows = DampingRows(
        ("a", "a", "b"), np.array([0, 0, 100]), np.array([3.5, 3.5, 5.25]), value, 0.1 * value, 1e-3 * value,
        value, value, value, value,
    )  # fmt: skip
    figure = Figure((9.6, 3.6))
    draw_damping(figure, rows)
    names = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert {"a, 3.50 Hz", "b, 5.25 Hz", "entered law"} == set(names)


def test_accelerations_are_read_from_a_file_that_transient_wrote(tmp_path):
    time = np.arange(100) * 0.01
    table = pd.DataFrame({"time_s": time, "x_m": 0.0, "x_m_s2": np.sin(time), "y_m_s2": 1.0, "z_m_s2": 2.0})
    table.to_csv(tmp_path / "transient.csv", index=False)
    found, acceleration = read_accelerations(tmp_path / "transient.csv")
    np.testing.assert_allclose(found, time)
    np.testing.assert_allclose(acceleration[5], [np.sin(0.05), 1.0, 2.0])
    with pytest.raises(InputError, match="pose at rest"):  # x_m is motion there, the pose in a campaign
        read_rows("free_decay", tmp_path / "transient.csv", 8)
