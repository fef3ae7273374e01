"""Samples that a recorder lost have no weight: the modes are those of the whole record within their sigma."""

import numpy as np
import pytest

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import Series, Sigmas
from cdpr_struct.measurement.identified import lost_notes
from cdpr_struct.measurement.lost_samples import common_lines, even_samples
from cdpr_struct.measurement.signal_records import records
from cdpr_struct.measurement.signal_states import own_modes

HERTZ = np.array([2.1, 5.3])
RATIO = 0.01
LOST = np.r_[40:55, 200:212, 300]


def decay() -> dict[str, np.ndarray]:
    time, omega = 0.02 * np.arange(600), 2.0 * np.pi * HERTZ
    waves = np.exp(-RATIO * omega * time[:, None]) * np.cos(omega * np.sqrt(1.0 - RATIO**2) * time[:, None])
    shape = np.array([[1.0, 0.4, -0.3], [0.2, -0.8, 0.5]])
    signal = waves @ shape + 0.01 * np.random.default_rng(3).standard_normal((600, 3))
    return {"time_s": time, **dict(zip(("ax", "ay", "az"), signal.T, strict=True))}


def identified(columns: dict[str, np.ndarray]):
    series = Series("free_decay", "decay.csv", ["a"] * len(columns["time_s"]), columns, {})
    (record,) = records(series, 8)
    return own_modes(record, Sigmas())


def dropped(columns):
    return {name: np.delete(values, LOST) for name, values in columns.items()}


def blanked(columns):
    blank = {name: values.copy() for name, values in columns.items()}
    for name in ("ax", "ay", "az"):
        blank[name][LOST] = np.nan
    return blank


@pytest.mark.parametrize("spoil", [dropped, blanked])
def test_modes_are_those_of_the_whole_record(spoil):
    whole, item = identified(decay()), identified(spoil(decay()))
    assert item.record.missing == len(LOST)
    assert len(item.modes) == len(whole.modes) == 2
    assert np.abs(item.modes.hertz - HERTZ).max() < 4.0 * item.sigma.max()
    assert np.abs(item.modes.hertz - whole.modes.hertz).max() < whole.sigma.max()
    assert item.modes.damping == pytest.approx(RATIO, rel=0.05)
    assert lost_notes([item.record]) == ("decay.csv, case a: 28 of 600 samples are missing; they have no weight.",)


def test_straight_lines_in_place_of_lost_samples_would_not_do():
    """The filling matters: with straight lines alone a mode is off by more, or the damping is."""
    columns, lost = even_samples("decay.csv", "a", dropped(decay()), ("ax", "ay", "az"))
    series = Series("free_decay", "decay.csv", ["a"] * 600, columns, {})
    straight, item = own_modes(records(series, 8)[0], Sigmas()), identified(dropped(decay()))
    assert lost.sum() == len(LOST)
    assert np.abs(straight.modes.noise).max() > 2.0 * np.abs(item.modes.noise).max()


def test_lines_that_one_response_lacks_are_left_out():
    lines = np.linspace(1.0, 5.0, 200)
    found = {"x/fx": (lines, lines + 0j), "y/fx": (np.delete(lines, [7, 8]), np.delete(lines, [7, 8]) * 1j)}
    found["y/fx"][1][50] = np.nan
    hertz, signal, lost = common_lines("frf.csv", "a", found)
    assert lost == 3
    assert np.array_equal(hertz, np.delete(lines, [7, 8, 52]))
    assert np.array_equal(signal[:, 1], 1j * hertz)


def test_responses_on_other_lines_are_refused():
    lines = np.linspace(1.0, 5.0, 200)
    with pytest.raises(InputError, match="the same lines for all responses"):
        common_lines("frf.csv", "a", {"x/fx": (lines, lines + 0j), "y/fx": (lines + 0.003, lines + 0j)})
