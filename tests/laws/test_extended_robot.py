"""The extended robot of a diagnosis means the same to every command and to the next diagnosis."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from cdpr_struct.diagnosis.diagnose import diagnose
from cdpr_struct.diagnosis.extended_model import _embodied, extended_robot_toml, robot_toml
from cdpr_struct.diagnosis.extended_robot import extensions_of, robot_of
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import residuals
from cdpr_struct.diagnosis.setting import make_setting
from cdpr_struct.diagnosis.world import World
from cdpr_struct.reports.diagnosis_result import diagnosis_json
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.masts import carriers
from tests.laws.crime_campaign import clean_campaign, hidden

HIDDEN = {
    "series_compliance": lambda w: w.plus(series_compliance=np.full(8, 8e-6)),
    "nonlinearity": lambda w: w.plus(nonlinearity=np.array(0.5)),
    "frame_compliance": lambda w: w.plus(frame_compliance=8e-6 * carriers(w.masts)[:, 1]),
    "cell_gain": lambda w: w.times(cell_gain=np.full(8, 1.06)),
}


EVERYDAY = ("series_compliance", "cell_gain")  # one in the cables, one in a sensor


@pytest.mark.parametrize("name", [n if n in EVERYDAY else pytest.param(n, marks=pytest.mark.slow) for n in HIDDEN])
def test_a_campaign_is_adequate_for_its_own_extended_robot(name, tmp_path):
    campaign = hidden(HIDDEN[name])
    found = diagnose(campaign)
    assert diagnosis_json(found)["significant"]
    file = tmp_path / "extended_robot.toml"
    file.write_text(extended_robot_toml(found))
    robot = load_robot(file)
    assert robot.extensions.active == (name,)
    again = diagnose(replace(campaign, robot=robot))
    assert diagnosis_json(again)["verdict"]["status"] == "adequate"
    assert again.selection.fit is None


def everything(world: World) -> World:
    """A world in which every extension is at work."""
    each = np.linspace(0.5, 1.5, 8)
    masts = 2e-6 * np.linspace(0.0, 1.5, 4) @ carriers(world.masts).T  # one of them rigid
    return replace(
        world, length_offset=0.002 * each, length_scale=1.0 + 0.001 * each, series_compliance=2e-6 * each,
        frame_compliance=masts, joint_mass=0.1 * each, cell_gain=1.0 + 0.01 * each, cell_bias=2.0 * each,
        friction=0.02 * each, force=np.array([5.0, -3.0, 2.0]), hose=np.array(30.0), tilt=np.array([0.002, -0.001]),
        tracker=np.array([0.001, 0.0, 0.002, 0.0, 0.001, 0.0]), nonlinearity=np.array(0.1), creep=np.array(0.05),
        slip=1e-4 * each,
    )  # fmt: skip


def test_extended_robot_leaves_the_same_residuals_as_the_world_it_stands_for(tmp_path):
    campaign = clean_campaign()
    setting, readings = make_setting(campaign)[0], Readings.of(campaign.states)
    world = everything(World.of(campaign.robot, len(campaign.states.names)))
    known = setting.known
    robot = replace(robot_of(campaign.robot, world), extensions=extensions_of(world, known.center, known.mean_tension))
    file = tmp_path / "robot.toml"
    file.write_text(robot_toml(robot, "again"))
    second = replace(campaign, robot=load_robot(file))
    again, there = make_setting(second)[0], World.of(second.robot, len(campaign.states.names))
    static = np.isin(setting.labels.block, ["EQ", "CO"])
    expected = residuals(setting, world, readings)[static]
    np.testing.assert_allclose(residuals(again, there, readings)[static], expected, rtol=1e-9, atol=1e-9)
    assert np.abs(expected).max() > 5.0  # N or mm: not the world as entered


def test_statics_of_the_extended_robot_are_those_of_the_diagnosis(tmp_path):
    """Lengths that hold a pose leave no residual when they are read back with the tensions there.

    In line, the diagnosis spreads the compliance over the chord, statics put a spring at the frame end: they differ by
    what the strain and the weight of the cable change, 1e-5 m; a twin without the extensions is off by millimetres.
    """
    campaign = clean_campaign(count=2)
    setting = make_setting(campaign)[0]
    world = everything(World.of(campaign.robot, 2))
    bare = replace(world, nonlinearity=0.0 * world.nonlinearity, creep=0.0 * world.creep, slip=0.0 * world.slip)
    quiet = replace(bare, tracker=0.0 * bare.tracker)
    robot = replace(
        robot_of(campaign.robot, quiet),
        extensions=extensions_of(quiet, setting.known.center, setting.known.mean_tension),
    )
    readings = Readings.of(campaign.states)
    held = [
        inverse(robot.with_load(float(w)), p, r)
        for w, p, r in zip(campaign.states.payload, readings.position, readings.rotation, strict=True)
    ]
    more = robot.extensions
    tension = np.array([h.tensions for h in held]) * more.cell_gain + more.cell_bias
    seen = replace(readings, tension=tension, length=np.array([h.lengths for h in held]))
    static = np.isin(setting.labels.block, ["EQ", "CO"])
    assert np.abs(residuals(setting, quiet, seen)[static]).max() < 0.05  # N, mm
    plain = World.of(campaign.robot, 2)
    assert np.abs(residuals(setting, plain, seen)[static]).max() > 5.0


def test_an_inertia_that_no_body_has_becomes_the_nearest_that_one_has():
    """Principal moments 1, 2, 4: the largest becomes 3, along the same axes."""
    world = World.of(load_robot("cogiro"))
    turn = Rotation.from_rotvec([0.3, -0.2, 0.5]).as_matrix()
    flat = _embodied(replace(world, inertia=turn @ np.diag([1.0, 2.0, 4.0]) @ turn.T))
    assert flat.inertia == pytest.approx(turn @ np.diag([1.0, 2.0, 3.0]) @ turn.T)
    assert _embodied(world) is world
