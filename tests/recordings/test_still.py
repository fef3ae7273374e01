"""Stops become states: their means, sigmas from the scatter; what does not scatter has no sigma of its own."""

import io

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

import cdpr_struct as cs
from tests.recordings.written import LENGTHS, PLACE, TENSIONS, TIME, TURNS, in_units, renamed

SIGMA = {"x": 1e-3, "L": 3e-4, "F": 4.0}  # m, m, N: white noise of every sample
HERTZ, STOPS = 50.0, 6


def recorded(tmp_path, noise: np.random.Generator, form: str = "quaternion", correlated: bool = False):
    """A log of stops of 4 s at noisy places, with moves of 2 s between them; and where the stops were."""
    stops = [(1.0, 0.2, 1.3), (0.0, 0.0, 1.2), (-1.0, 0.4, 1.5), (0.5, -0.5, 1.1), (1.5, 0.0, 1.4), (0.0, 1.0, 1.0)]
    time = np.arange(0.0, STOPS * 6.0 - 2.0, 1.0 / HERTZ)
    knots = [t for i in range(STOPS) for t in (6.0 * i, 6.0 * i + 4.0)]
    place = np.stack([np.interp(time, knots, np.repeat(axis, 2)) for axis in np.transpose(stops)], axis=1)
    vector = 0.1 * place
    robot = cs.load_robot("cogiro")
    turns = Rotation.from_rotvec(vector)
    tips = place[:, None] + np.einsum("kij,mj->kmi", turns.as_matrix(), robot.platform_anchors)
    lengths = np.linalg.norm(robot.frame_anchors - tips, axis=2)

    def noisy(values, sigma):
        white = noise.normal(0.0, sigma, values.shape)
        if correlated:  # each sample holds nine tenths of the one before
            for i in range(1, len(white)):
                white[i] = 0.9 * white[i - 1] + np.sqrt(1.0 - 0.81) * white[i]
        return values + white

    columns = {"t": time, **dict(zip("xyz", noisy(place, SIGMA["x"]).T, strict=True))}
    columns |= _turned(turns, form)
    columns |= {f"L{i + 1}": v for i, v in enumerate(noisy(lengths, SIGMA["L"]).T)}
    columns |= {f"F{i + 1}": v for i, v in enumerate(noisy(np.full(lengths.shape, 300.0), SIGMA["F"]).T)}
    pd.DataFrame(columns).to_csv(tmp_path / "log.csv", index=False)
    mapping = in_units(renamed(str), time="s") | {"sampling": {"mode": "still"}, "sigma": {}}
    return tmp_path / "log.csv", mapping, np.array(stops)


def _turned(turns: Rotation, form: str) -> dict[str, np.ndarray]:
    if form == "quaternion":
        return dict(zip(("qx", "qy", "qz", "qw"), turns.as_quat().T, strict=True))
    values = turns.as_rotvec() if form == "rotation_vector" else np.degrees(turns.as_euler("ZYX"))
    return dict(zip(("a", "b", "c"), values.T, strict=True))


def states(made) -> pd.DataFrame:
    return pd.read_csv(io.StringIO(made.files["states.csv"]))


def test_stops_are_states_and_their_means_are_better_than_a_sample(tmp_path):
    path, mapping, stops = recorded(tmp_path, np.random.default_rng(1))
    made = cs.import_recording(path, mapping)
    got = states(made)
    assert list(got.case) == [f"log {i}" for i in range(1, STOPS + 1)]
    assert got.time_s.diff().dropna().to_numpy() == pytest.approx(6.0, abs=0.3)
    off = got[["x_m", "y_m", "z_m"]].to_numpy() - stops
    sigma = made.answer["sigma"]
    samples = 3.0 * HERTZ  # of a stop, at the least
    assert SIGMA["x"] / np.sqrt(2.0 * samples) < sigma["position_m"] < SIGMA["x"] / np.sqrt(0.5 * samples)
    assert SIGMA["L"] / np.sqrt(2.0 * samples) < sigma["length_m"] < SIGMA["L"] / np.sqrt(0.5 * samples)
    assert SIGMA["F"] / np.sqrt(2.0 * samples) < sigma["tension_N"] < SIGMA["F"] / np.sqrt(0.5 * samples)
    assert np.sqrt((off**2).mean()) < 2.0 * sigma["position_m"]
    assert "calibration" in made.warnings[-1]


def test_noise_that_lasts_makes_a_larger_sigma(tmp_path):
    """The mean of n samples is not better by the root of n where neighbours are alike."""
    path, mapping, stops = recorded(tmp_path, np.random.default_rng(2), correlated=True)
    mapping["sampling"]["still_speed"] = 0.02
    made = cs.import_recording(path, mapping)
    off = states(made)[["x_m", "y_m", "z_m"]].to_numpy() - stops
    sigma = made.answer["sigma"]["position_m"]
    assert 2.5 < sigma / (SIGMA["x"] / np.sqrt(4.0 * HERTZ)) < 6.0  # sqrt((1 + 0.9) / (1 - 0.9)) is 4.4
    assert 0.5 < np.sqrt((off**2).mean()) / sigma < 2.0


@pytest.mark.parametrize("form", ["rotation_vector", "angles"])
def test_other_forms_of_rotations(form, tmp_path):
    path, mapping, stops = recorded(tmp_path, np.random.default_rng(3), form)
    mapping["rotation"] = {"form": form, "channels": ["a", "b", "c"], "unit": "rad"}
    if form == "angles":
        mapping["rotation"] |= {"unit": "deg", "order": "ZYX"}
    made = cs.import_recording(path, mapping)
    angles = states(made)[["rx_deg", "ry_deg", "rz_deg"]].to_numpy()
    got = Rotation.from_euler("xyz", np.radians(angles))
    assert (got * Rotation.from_rotvec(0.1 * stops).inv()).magnitude() == pytest.approx(0.0, abs=1e-6)
    mapping["rotation"]["inverse"] = True
    back = states(cs.import_recording(path, mapping))[["rx_deg", "ry_deg", "rz_deg"]].to_numpy()
    assert (got * Rotation.from_euler("xyz", np.radians(back))).magnitude() == pytest.approx(0.0, abs=1e-6)


def test_a_sensor_that_does_not_scatter_has_no_sigma_of_its_own(tmp_path):
    path, mapping, _ = recorded(tmp_path, np.random.default_rng(4))
    table = pd.read_csv(path)
    for i in range(1, 9):
        table[f"F{i}"] = 310.0 + i
    table.to_csv(path, index=False)
    made = cs.import_recording(path, mapping)
    assert "tension_N" not in made.answer["sigma"]
    assert any(said.startswith("No sigma of rotation_deg, tension_N is given") for said in made.warnings)
    mapping["sigma"] = {"tension_N": 3.0}
    assert cs.import_recording(path, mapping).answer["sigma"]["tension_N"] == 3.0


def test_a_cable_without_a_sensor_has_empty_cells(tmp_path):
    path, mapping, _ = recorded(tmp_path, np.random.default_rng(5))
    mapping["tensions"]["channels"][3] = ""
    made = cs.import_recording(path, mapping)
    assert states(made)["tension_4_N"].isna().all()
    assert any("cable 4 has none" in said for said in made.warnings)


def test_factor_offset_and_delay(tmp_path):
    path, mapping, _ = recorded(tmp_path, np.random.default_rng(6))
    plain = states(cs.import_recording(path, mapping))
    table = pd.read_csv(path)
    table.assign(F1=-table.F1).to_csv(path, index=False)
    mapping["tensions"] |= {"factor": [-1.0] + [1.0] * 7, "offset": 5.0}
    mapping["lengths"] |= {"unit": "mm", "factor": 1000.0, "delay_s": 0.5}
    made = cs.import_recording(path, mapping)
    got = states(made)
    assert got["tension_1_N"].to_numpy() == pytest.approx(5.0 + plain["tension_1_N"], abs=1.0)
    assert got["length_2_m"].to_numpy() == pytest.approx(plain["length_2_m"], abs=1e-3)


def test_an_unknown_rotation_is_said_and_one_of_a_free_motion_is_read(tmp_path):
    path, mapping, _ = recorded(tmp_path, np.random.default_rng(7))
    del mapping["rotation"]
    made = cs.import_recording(path, mapping)
    assert states(made)["rx_deg"].isna().all()
    assert any("rotation" in said and "taken as unknown" in said for said in made.warnings)


def test_frames_at_a_rate_are_interpolated(tmp_path):
    table = pd.DataFrame({"t": TIME, **dict(zip("xyz", PLACE.T, strict=True))})
    quaternion = dict(zip(("qx", "qy", "qz", "qw"), TURNS.as_quat().T, strict=True))
    table = table.assign(**quaternion, **{f"L{i + 1}": v for i, v in enumerate(LENGTHS.T)})
    table.assign(**{f"F{i + 1}": v for i, v in enumerate(TENSIONS.T)}).to_csv(tmp_path / "log.csv", index=False)
    mapping = in_units(renamed(str), time="s") | {"sampling": {"mode": "motion", "rate_hz": 4.0, "span": [3.0, 9.0]}}
    made = cs.import_recording(tmp_path / "log.csv", mapping)
    got = states(made)
    assert got.time_s.to_numpy() == pytest.approx(3.0 + 0.25 * np.arange(25))
    assert got.x_m.to_numpy() == pytest.approx(np.interp(got.time_s, TIME, PLACE[:, 0]), abs=1e-9)
    between = Rotation.from_quat(got[["qx", "qy", "qz", "qw"]].to_numpy())
    exact = Rotation.from_rotvec(np.outer(np.clip((got.time_s - 4.0) / 4.0, 0.0, 1.0), [0.05, -0.1, 0.2]))
    assert (between * exact.inv()).magnitude().max() < 1e-3
    assert "Frames at 4 Hz" in made.answer["sampling"]
    assert "interpolated linearly" in made.files["campaign.toml"]
    mapping["sampling"] = {"mode": "motion", "every": 10}
    assert len(states(cs.import_recording(tmp_path / "log.csv", mapping))) == len(TIME) // 10
