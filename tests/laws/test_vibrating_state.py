"""What hangs on the platform while vibration is measured: laws of the state it makes."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.causes.registry import LIBRARY, causes_for
from cdpr_struct.diagnosis.conditioned_state import unbalanced
from cdpr_struct.diagnosis.extended_model import robot_toml
from cdpr_struct.diagnosis.extended_robot import extensions_of, robot_of
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import States, residuals
from cdpr_struct.diagnosis.setting import make_setting
from cdpr_struct.diagnosis.vibrating_state import raised, vibrating
from cdpr_struct.diagnosis.world import World
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.crime_campaign import NO_CABLES, clean_campaign

MASS = 2.0
UP = np.array([0.0, 0.0, 1.0])
WORLDS = {
    "as entered": lambda world: world,
    "masts": lambda world: world.plus(frame_compliance=np.full(world.cables, 2e-6)),
    "tilted, with a hose": lambda world: world.plus(tilt=np.array([0.02, -0.01]), hose=np.array(200.0)),
    "in line": lambda world: world.plus(series_compliance=np.full(world.cables, 1e-5)),
    "pulleys": lambda world: replace(world, pulley_radius=np.full(world.cables, 0.05)),
}


@pytest.fixture(scope="module")
def entered():
    campaign = clean_campaign(3)
    setting = make_setting(campaign)[1]
    return setting, World.of(campaign.robot, 3), Readings.of(campaign.states)


@pytest.mark.parametrize("case", WORLDS)
def test_lengths_stay_locked_and_the_cables_carry_the_weight(entered, case):
    """To first order in 2 kg on 118.5 kg: about a thousandth of the stretch and of the weight is left over."""
    setting, world, readings = entered
    world = replace(WORLDS[case](world), sensor_mass=np.array(MASS)).per_state()
    rest = States(setting, world, readings).all
    moving = vibrating(world, rest, setting.known)
    rise = moving.tension - rest.tension
    assert (rise > 0.0).all()
    let_out = np.abs(moving.cables.total_length - rest.cables.total_length)
    strain = rise * rest.cables.length / rest.cables.axial_stiffness
    assert let_out.max() < (0.02 if case == "pulleys" else 0.002) * strain.max()  # measured 0.0125, 0.0011 without
    carried = unbalanced(world, moving, setting.known) - unbalanced(world, rest, setting.known)
    weight = MASS * 9.81 * np.array([-world.tilt[0], -world.tilt[1], 1.0])
    np.testing.assert_allclose(carried[:, :3], np.broadcast_to(weight, (3, 3)), atol=5e-4 * MASS * 9.81)
    assert np.abs(carried[:, 3:]).max() < 5e-4 * MASS * 9.81  # measured 1.3e-4 of the weight


def test_nothing_hangs_there_by_default(entered):
    setting, world, readings = entered
    rest = States(setting, world.per_state(), readings).all
    assert vibrating(world.per_state(), rest, setting.known) is rest
    assert raised(rest, rest) is None


def test_a_batch_is_its_items_and_only_vibration_changes(entered):
    setting, world, readings = entered
    masses = np.array([0.0, 0.5, MASS])
    found = residuals(setting, replace(world, sensor_mass=masses), readings)
    for mass, row in zip(masses, found, strict=True):
        np.testing.assert_allclose(row, residuals(setting, world.plus(sensor_mass=mass), readings), atol=1e-9)
    vibrates = setting.labels.block == "CF"
    np.testing.assert_array_equal(found[:, ~vibrates], np.broadcast_to(found[0, ~vibrates], found[:, ~vibrates].shape))
    slope = (found[1:, vibrates] - found[0, vibrates]) / masses[1:, None]
    assert (slope < -0.05).all()  # frequencies of the model rise, so ln of measured over computed falls
    np.testing.assert_allclose(slope[0], slope[1], rtol=0.02)


def test_it_needs_frequencies():
    campaign = clean_campaign(2)
    assert "accelerometer_mass" in {c.name for c in causes_for(make_setting(campaign)[0])[0]}
    bare = make_setting(replace(campaign, cable_frequencies=NO_CABLES))[0]
    assert causes_for(bare)[1]["accelerometer_mass"] == "needs frequencies of the cables or of the robot"


def test_a_robot_file_says_what_hung_there(tmp_path, entered):
    """Written as an extension that only the comparison with readings knows, and read again into the same world."""
    setting, world, _ = entered
    heavy = LIBRARY["accelerometer_mass"].apply(world, np.array([MASS]))
    robot = replace(robot_of(setting.campaign.robot, heavy), extensions=extensions_of(heavy, np.zeros(3), 300.0))
    (tmp_path / "robot.toml").write_text(robot_toml(robot, "shaken"))
    again = load_robot(str(tmp_path / "robot.toml"))
    assert again.extensions.active == ("sensor_mass",)
    assert again.platform.mass == setting.campaign.robot.platform.mass
    assert float(World.of(again, 3).sensor_mass) == MASS


def test_pulleys_of_the_robot_itself(entered):
    """A campaign of a robot with pulleys goes all the way through."""
    campaign = clean_campaign(2)
    wheels = tuple(Pulley(0.05, UP) for _ in campaign.robot.cables)
    setting = make_setting(replace(campaign, robot=replace(campaign.robot, pulleys=wheels)))[1]
    world = World.of(setting.campaign.robot, 2)
    readings = Readings.of(setting.campaign.states)
    change = residuals(setting, world.plus(sensor_mass=np.array(MASS)), readings) - residuals(setting, world, readings)
    assert (change[setting.labels.block == "CF"] < -0.1).all()
