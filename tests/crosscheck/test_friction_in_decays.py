"""Decays with dry friction at cable ends, simulated in time by `transient`, and what the diagnosis says of them."""

import numpy as np
import pandas as pd
import pytest

import cdpr_struct as cs
from cdpr_struct.diagnosis.amplitude_law import amplitude_finding, held_out_rms
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot_writing import robot_toml
from tests.large_motion_robots import three_cables

NOISE = 2e-4  # m/s^2
CAMPAIGN = """robot = "three.toml"
model = "exact"
[[measurement]]
kind = "free_decay"
file = "decay.csv"
sigma = { acceleration = 2e-4 }
"""


def decays(directory, radius: float, count: int = 6):
    """Campaign of some decays in different places, friction at the platform ends over 0.004 rad."""
    robot = directory / "three.toml"
    robot.write_text(robot_toml(three_cables().entered, "three"))
    rng, tables = np.random.default_rng(1), []
    for i in range(count):
        lengths = np.array([2.3, 2.2, 2.4]) + rng.uniform(-0.15, 0.15, 3)
        twist = rng.uniform(-0.06, 0.06, 6) * [1.0, 1.0, 0.2, 1.0, 1.0, 1.0]
        record = cs.transient(
            robot, lengths=lengths.tolist(), start=[0.1, 0.0, 0.4], initial_velocity=twist.tolist(), duration=12.0,
            highest=4.0, end_friction=f"platform:{radius},0.004", damping="none",
        ).record  # fmt: skip
        read = record.vibration.acceleration[:, :3] + NOISE * rng.normal(size=(len(record.vibration.time), 3))
        pose = [*record.point.position, *np.degrees(angles_from_rotation(record.point.rotation))]
        table = pd.DataFrame(read, columns=["ax", "ay", "az"])
        table = table.assign(case=f"c{i}", time_s=record.vibration.time, payload_kg=0.0)
        names = ["x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg", "length_1_m", "length_2_m", "length_3_m"]
        tables.append(table.assign(**dict(zip(names, [*pose, *lengths], strict=True))))
    pd.concat(tables).to_csv(directory / "decay.csv", index=False)
    (directory / "campaign.toml").write_text(CAMPAIGN)
    return load_campaign(directory / "campaign.toml")


@pytest.mark.slow
def test_friction_is_found_in_decays_that_were_integrated_in_time(tmp_path):
    """0.1 mm: found as 0.075 mm with 54 nats. Amplitudes fall within a window, so that sizes are good to a factor of
    1.6 only, and which ends rub is not told; motions of some millimetres are not large."""
    found = amplitude_finding(decays(tmp_path, 1e-4).identified)
    rows, best = found.rows, found.fits[0]
    assert found.status == "friction"
    assert best.gain > 20.0
    assert abs(found.large_gain) < 3.0
    assert held_out_rms(rows, rows.large + best.held_out) < 0.6 * held_out_rms(rows, rows.large)
    platform = next(fit for fit in found.rivals if [part.ends for part in fit.parts] == ["platform"])
    (part,) = platform.parts
    assert 1e-4 / 1.6 < part.radius[0] < 1.6e-4
    assert 0.004 / 1.7 < part.angle[0] < 0.004 * 1.7


@pytest.mark.slow
def test_no_friction_is_found_where_there_is_too_little(tmp_path):
    """3 micrometres, of which noise and windows leave nothing."""
    assert amplitude_finding(decays(tmp_path, 3e-6).identified).status == "adequate"
