"""What hangs on the platform only while vibration is measured, with the FEM as truth: law, name and size."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis import vibrating_state
from cdpr_struct.diagnosis.candidate_rows import candidate_rows
from cdpr_struct.diagnosis.diagnose import diagnose
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import States, residuals
from cdpr_struct.diagnosis.setting import _points, make_setting
from cdpr_struct.diagnosis.verdict import verdict
from cdpr_struct.diagnosis.world import World
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.robot.robot_file import load_robot
from tests.crosscheck.sensors_on import equilibria, sensors_campaign, tensions, vibration

COGIRO = load_robot("cogiro").home.position + np.array(
    [[1.0, 0.5, 0.1], [-2.0, 1.0, 0.3], [2.5, -1.2, -0.2], [-1.0, -1.5, 0.5]]
)
THESIS = np.array([[0.4, 0.3, 0.6], [-0.8, 0.5, 1.0], [0.9, -0.7, 0.8], [1.5, 0.8, 0.5]])
SHIFTED = [("thesis-3-1", THESIS[0], 1.5), ("cogiro", COGIRO[0], 1.5), ("cogiro", COGIRO[0], 15.0)]
MODES = 20


@pytest.fixture(scope="module", params=SHIFTED, ids=lambda case: f"{case[0]} with {case[2]:g} kg")
def shifted(request, tmp_path_factory):
    """Equilibria and vibration of the FEM without and with a mass; setting and world of readings without."""
    name, place, mass = request.param
    both = equilibria(name, place, mass)
    campaign = sensors_campaign(tmp_path_factory.mktemp("shift"), name, place[None], 0.0, seed=None)
    setting, world = make_setting(campaign)[1], World.of(campaign.robot, 1)
    return mass, both, [vibration(equilibrium) for equilibrium in both], setting, world


def law(setting, world) -> tuple[np.ndarray, np.ndarray]:
    """ln f of the measured cable frequencies (16,) by the residuals, of the robot's lowest (20,) by the exact model."""
    rows = setting.labels.block == "CF"
    own = residuals(setting, world, Readings.of(setting.campaign.states))[rows] / 100.0
    point = _points(setting, world, np.array([0]))[0]
    return -own, np.log(certified_modes(point, "exact", MODES).frequencies.hertz[:MODES])


def shifts(setting, world, mass) -> tuple[np.ndarray, np.ndarray]:
    with_mass = law(setting, world.plus(sensor_mass=np.array(mass)))
    return tuple(a - b for a, b in zip(with_mass, law(setting, world), strict=True))


def test_tensions_rise_and_frequencies_shift_as_in_the_fem(shifted):
    """First order in the weight: 15 kg on 118.5 kg leave 0.2 % of the rise and of the shifts open."""
    mass, (rest, shaken), (before, after), setting, world = shifted
    heavy = world.plus(sensor_mass=np.array(mass)).per_state()
    still = States(setting, heavy, Readings.of(setting.campaign.states)).all
    moving = vibrating_state.vibrating(heavy, still, setting.known)
    rise = tensions(shaken) - tensions(rest)
    np.testing.assert_allclose((moving.tension - still.tension)[0], rise, rtol=3e-3)  # measured 1.5e-3 (15 kg)
    sunk = shaken.position - rest.position
    assert np.abs((moving.position - still.position)[0] - sunk).max() < 6e-3 * np.abs(sunk).max()  # 4.1e-3 (15 kg)
    cables, robot = shifts(setting, world, mass)
    np.testing.assert_allclose(cables, np.log(after.cables / before.cables).ravel(), rtol=4e-3)
    fem = np.log(after.robot / before.robot)[:MODES]
    assert np.abs(robot - fem).max() < 3e-3 * np.abs(fem).max()


def test_without_the_rise_of_tensions_the_law_is_found_out(shifted, monkeypatch):
    """Twin: inertia at the tensions read at rest, which shifts no cable and every mode downwards."""
    mass, _, (before, after), setting, world = shifted
    monkeypatch.setattr(
        vibrating_state, "_given_way", lambda world, state, known: (np.zeros(6), np.zeros_like(state.tension))
    )
    cables, robot = shifts(setting, world, mass)
    fem = np.log(after.robot / before.robot)[:MODES]
    assert np.abs(cables).max() < 1e-9
    assert np.abs(robot - fem).max() > 0.5 * np.abs(fem).max()


def test_nothing_but_vibration_changes(shifted):
    mass, _, _, setting, world = shifted
    readings = Readings.of(setting.campaign.states)
    plain, moved = (residuals(setting, w, readings) for w in (world, world.plus(sensor_mass=np.array(mass))))
    vibrates = np.isin(setting.labels.block, ("CF", "RF", "FA"))
    np.testing.assert_array_equal(plain[~vibrates], moved[~vibrates])
    assert (plain[vibrates] != moved[vibrates]).all()
    np.testing.assert_array_equal(plain, residuals(setting, replace(world, sensor_mass=np.array(0.0)), readings))


def size(found) -> dict:
    return candidate_rows(found)[0]["parameters"]["sensor_mass"]


def test_a_shaker_is_named_with_its_mass(tmp_path):
    found = diagnose(sensors_campaign(tmp_path, "cogiro", COGIRO, 6.0))
    said = verdict(found)
    assert (said.status, said.causes) == ("named", ("accelerometer_mass",))
    assert abs(size(found)["value"] - 6.0) < 1.96 * size(found)["sigma"]  # measured 5.87 +- 0.81
    assert 0.3 < size(found)["sigma"] < 1.5


def test_a_mass_just_large_enough_to_be_seen_is_in_the_class(tmp_path):
    """1.5 kg on 60 kg change frequencies by 1 %, as cables heavier by one of their tolerances do by half of that."""
    found = diagnose(sensors_campaign(tmp_path, "thesis-3-1", THESIS, 1.5))
    said = verdict(found)
    assert said.status == "class"
    assert said.causes == ("accelerometer_mass",)
    assert abs(size(found)["value"] - 1.5) < 1.96 * size(found)["sigma"]  # measured 1.17 +- 0.39
    assert 0.2 < size(found)["sigma"] < 0.8


def test_nothing_on_the_platform_is_adequate(tmp_path):
    assert verdict(diagnose(sensors_campaign(tmp_path, "thesis-3-1", THESIS, 0.0))).status == "adequate"
