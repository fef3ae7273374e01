"""Universal files, time series and spectrograms: what is written reads back, and tones are found where they are."""

import numpy as np
import pytest
import pyuff

from cdpr_struct.dynamics.frequency_response import FrequencyResponse
from cdpr_struct.dynamics.ports import CablePort, platform_port
from cdpr_struct.errors import InputError
from cdpr_struct.measurement.spectrogram import dominant_frequency, spectrogram
from cdpr_struct.measurement.time_series import read_accelerations
from cdpr_struct.measurement.trajectory_file import read_trajectory
from cdpr_struct.measurement.universal_file import response_unit, universal_file

X, Y, Z = np.eye(3)


@pytest.fixture
def response():
    hertz = np.arange(1.0, 5.0, 0.01)
    values = np.random.default_rng(3).normal(size=(len(hertz), 3, 2)) @ [1.0, 1j]
    ports = (
        platform_port("x", X, False, np.zeros(3)),
        platform_port("rz", Z, True, np.zeros(3)),
        CablePort("cable5@0.3:y", 4, 0.3, Y),
    )
    return FrequencyResponse(hertz, values, platform_port("mz", Z, True, np.zeros(3)), ports, "acceleration")


def test_universal_file_reads_back(response, tmp_path):
    path = tmp_path / "frf.uff"
    path.write_bytes(universal_file(response, "thesis-3-1", np.eye(3)))
    sets = pyuff.UFF(str(path)).read_sets()
    assert [s["type"] for s in sets] == [58, 58, 58]
    assert [s["func_type"] for s in sets] == [4, 4, 4]
    for column, found in enumerate(sets):
        np.testing.assert_allclose(found["data"], response.response[:, column], rtol=1e-11)
        np.testing.assert_allclose(found["x"], response.hertz, rtol=1e-5)  # the format gives the step six digits
    assert [(s["rsp_node"], s["rsp_dir"]) for s in sets] == [(1, 1), (1, 6), (5300, 2)]
    assert {(s["ref_node"], s["ref_dir"]) for s in sets} == {(1, 6)}
    assert {s["ordinate_spec_data_type"] for s in sets} == {12}


def test_directions_are_those_of_the_axes_that_named_the_ports():
    """In platform axes turned by 90 degrees about z, the platform's x is the world's y."""
    turned = np.column_stack([Y, -X, Z])
    port = platform_port("x", turned[:, 0], False, np.zeros(3))
    response = FrequencyResponse(np.array([1.0, 2.0]), np.ones((2, 1), complex), port, (port,), "velocity")
    assert b"x over x" in universal_file(response, "r", turned)


def test_units():
    translation, turn = platform_port("x", X, False, np.zeros(3)), platform_port("rx", X, True, np.zeros(3))
    assert response_unit(translation, translation, "acceleration") == "(m/s^2)/N"
    assert response_unit(translation, translation, "displacement") == "m/N"
    assert response_unit(turn, turn, "velocity") == "(rad/s)/(N m)"


def test_spectrogram_holds_the_power_and_the_place_of_a_tone():
    """A tone of amplitude a has the power a^2 / 2 whatever the window; it begins halfway."""
    time = np.arange(0.0, 20.0, 0.005)
    tone = 3.0 * np.sin(2.0 * np.pi * 7.3 * time) * (time > 10.0)
    found = spectrogram(time, np.stack([tone, 0.0 * tone], axis=1), window=2.0)
    power = found.density[:, :, 0].sum(axis=0) * (found.hertz[1] - found.hertz[0])
    during = (found.time > 12.0) & (found.time < 18.0)
    np.testing.assert_allclose(power[during], 4.5, rtol=0.02)
    assert power[found.time < 8.0].max() < 1e-3
    assert found.hertz[found.total().sum(axis=1).argmax()] == pytest.approx(7.3, abs=0.1)


@pytest.mark.parametrize("hertz", [0.93, 3.3333, 11.07])
def test_dominant_frequency_of_a_decaying_tone(hertz):
    time = np.arange(0.0, 10.0, 0.01)
    tone = np.exp(-0.1 * time) * np.cos(2.0 * np.pi * hertz * time + 1.0)
    assert dominant_frequency(time, tone[:, None]) == pytest.approx(hertz, abs=2e-3)


def test_a_dead_signal_has_no_frequency():
    assert np.isnan(dominant_frequency(np.arange(100.0), np.zeros((100, 3))))


def test_impossible_windows_are_refused():
    time = np.arange(0.0, 1.0, 0.01)
    for window in (0.01, 3.0):
        with pytest.raises(ValueError, match="window"):
            spectrogram(time, np.zeros((100, 1)), window)


def write(path, header, rows):
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def test_accelerations_read_back(tmp_path):
    rows = [f"{0.01 * i!r},{i},{2 * i},0" for i in range(100)]
    time, signal = read_accelerations(write(tmp_path / "a.csv", "time_s,ax,ay,az", rows))
    assert time[-1] == pytest.approx(0.99)
    np.testing.assert_array_equal(signal[:, 1], 2.0 * np.arange(100))


GOOD = [f"{0.01 * i},1,2,3" for i in range(100)]


@pytest.mark.parametrize(
    ("header", "rows", "words"),
    [
        ("time_s,ax,ay", GOOD, ["az", "required"]),
        ("time_s,ax,ay,az", GOOD[:9], ["9 rows"]),
        ("time_s,ax,ay,az", [*GOOD[:50], "0.5,1,oops,3", *GOOD[51:]], ["line 52", "ay", "oops"]),
        ("time_s,ax,ay,az", [*GOOD[:50], "0.505,1,2,3", *GOOD[51:]], ["line 52", "even"]),
        ("time_s,ax,ay,az", [*GOOD[:50], "0.5,1,nan,3", *GOOD[51:]], ["line 52", "finite"]),
    ],
)
def test_bad_acceleration_files_are_refused(tmp_path, header, rows, words):
    with pytest.raises(InputError) as error:
        read_accelerations(write(tmp_path / "a.csv", header, rows))
    assert all(word in str(error.value) for word in words), str(error.value)


def test_bad_trajectories_are_refused(tmp_path):
    back = write(tmp_path / "t.csv", "time_s,x_m,y_m,z_m", ["0,0,0,0", "1,0,0,0", "0.5,0,0,0", "2,0,0,0"])
    with pytest.raises(InputError, match="ascend"):
        read_trajectory(back)
    with pytest.raises(InputError, match="header"):
        read_trajectory(tmp_path / "none.csv")
