"""Lines about resonances: inside the band, apart from each other, each for a mode that is near."""

import numpy as np

from cdpr_struct.dynamics.resonances import Resonances

EVEN = np.arange(1.0, 9.01, 0.25)
MODES = Resonances(np.array([0.5, 2.0, 3.3, 3.3, 4.6, 20.0]), np.array([0.01, 0.01, 0.02, 0.02, 0.0, 0.1]), 8.0)


def test_lines_lie_inside_the_band_apart_from_even_ones_and_from_each_other():
    """By a hundredth of a half width; mode 2 lies on an even line, modes 3 and 4 on each other."""
    lines = MODES.lines(EVEN)
    width = np.where(MODES.half_width > 0.0, MODES.half_width, 1e-3 * MODES.hertz)[lines.mode]
    assert ((lines.hertz > 1.0) & (lines.hertz < 9.0)).all()
    assert (np.abs(lines.hertz[:, None] - EVEN).min(axis=1) > 0.01 * width).all()
    assert (np.diff(lines.hertz) > 0.01 * width[1:]).all()
    assert 2.0 not in lines.hertz
    assert (lines.hertz == 3.3).sum() == 1
    assert 4.6 not in lines.hertz  # nothing damps it
    assert (np.abs(lines.hertz - MODES.hertz[lines.mode]) < 2.0 * 0.25).all()


def test_every_mode_inside_has_lines_within_its_half_width_on_both_sides():
    lines = MODES.lines(EVEN)
    for mode in (1, 4):
        apart = lines.hertz[lines.mode == mode] - MODES.hertz[mode]
        width = MODES.half_width[mode] or 1e-3 * MODES.hertz[mode]
        assert ((apart > 0.0) & (apart < 1.001 * width)).sum() >= 4
        assert ((apart < 0.0) & (apart > -1.001 * width)).sum() >= 4


def test_a_maximum_belongs_to_a_mode_within_ten_half_widths_or_to_one_that_is_not_known():
    assert MODES.near(np.array([2.0, 2.0999, 2.1001, 4.6, 4.60001, 7.9, 8.1])).tolist() == [
        True, True, False, True, False, False, True,
    ]  # fmt: skip


def test_without_modes_there_are_no_lines():
    lines = Resonances(np.zeros(0), np.zeros(0), 8.0).lines(EVEN)
    assert lines.hertz.size == lines.mode.size == 0
