"""What hangs on the platform only while vibration is measured, with the FEM as truth: name and size."""

import numpy as np
import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.robot.robot_file import load_robot
from tests.crosscheck.sensors_on import sensors_campaign

COGIRO = load_robot("cogiro").home.position + np.array(
    [[1.0, 0.5, 0.1], [-2.0, 1.0, 0.3], [2.5, -1.2, -0.2], [-1.0, -1.5, 0.5]]
)
THESIS = np.array([[0.4, 0.3, 0.6], [-0.8, 0.5, 1.0], [0.9, -0.7, 0.8], [1.5, 0.8, 0.5]])


def size_of(said: Diagnosis) -> tuple[float, float]:
    """Mass and sigma [kg] of the best candidate that is the mass alone."""
    one = next(one for one in said.candidates if one.names == ("accelerometer_mass",))
    row = one.sizes[0].parameters["sensor_mass"]
    return float(row["value"]), float(row["sigma"])


def test_a_shaker_is_named_with_its_mass(tmp_path):
    said = diagnosed(sensors_campaign(tmp_path, "cogiro", COGIRO, 6.0))
    assert said.decision.classes == (("accelerometer_mass",),)
    value, sigma = size_of(said)
    assert abs(value - 6.0) < 1.96 * sigma
    assert 0.3 < sigma < 1.5


@pytest.mark.slow
def test_a_mass_just_large_enough_to_be_seen_has_its_size(tmp_path):
    """1.5 kg on 60 kg change frequencies by 1 %, as cables heavier by one of their tolerances do by half of that."""
    said = diagnosed(sensors_campaign(tmp_path, "thesis-3-1", THESIS, 1.5))
    value, sigma = size_of(said)
    assert any("accelerometer_mass" in names for names in said.decision.classes)
    assert abs(value - 1.5) < 1.96 * sigma
    assert 0.2 < sigma < 0.8


@pytest.mark.slow
def test_nothing_on_the_platform_is_adequate(tmp_path):
    assert diagnosed(sensors_campaign(tmp_path, "thesis-3-1", THESIS, 0.0)).decision.status == "adequate"
