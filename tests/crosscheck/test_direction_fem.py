"""What changes with the direction of the last motion, on states of the FEM: wheels on bearings, drives with play.

The tension behind a wheel is found from the balance of moments about its axle by bisection.
"""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import brentq

from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.observation.readings import cell_reading
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

ROBOT, PAYLOADS, ELEMENTS = "thesis-3-1", (0.0, 60.0, 140.0), 10  # kg on 60
NOISE = {"tension": 1.0, "position": 3e-4, "length": 1e-4}
CAMPAIGN = f"""robot = "{ROBOT}"
model = "dsm"
[[measurement]]
kind = "static_state"
file = "states.csv"
sigma = {{ tension_N = 1.0, position_m = 0.0003, rotation_deg = 0.01, length_m = 0.0001 }}
"""


def behind_wheel(tension, angle, direction, bearing, drag):
    """Tension [N] on the winch's side: (T1 - T2) R = direction (mu r F + M), F the size of both pulls' sum."""
    leaving = np.array([np.sin(angle), np.cos(angle)])  # the cable comes up along y, and goes this way

    def moment(before):
        pull = np.linalg.norm(before * np.array([0.0, -1.0]) + tension * leaving)
        return before - tension - direction * (bearing * pull + drag)

    return brentq(moment, 0.2 * tension, 5.0 * tension, xtol=1e-10)


def written(folder, seed, bearing=0.0, drag=0.0, play=0.0):
    """Campaign of the FEM's states with noise; every cable comes from one side or the other."""
    generator = np.random.default_rng(seed)
    robot, rows = load_robot(ROBOT), []
    shift = 5e-4 * generator.normal(size=(2, len(robot.cables), 3))
    built = replace(
        robot, frame_anchors=robot.frame_anchors + shift[0], platform_anchors=robot.platform_anchors + shift[1]
    )
    for number in range(12):
        machine = built.with_load(PAYLOADS[number % 3])
        place = robot.home.position + generator.uniform(-1.0, 1.0, 3) * [2.0, 1.5, 0.5]
        held = inverse(machine, place, np.eye(3))
        rest = solve_in_fem(OperatingPoint(machine, place, np.eye(3), held.cables), ELEMENTS)
        read = rest.position + NOISE["position"] * generator.normal(size=3)
        where = {"case": f"s{number}", "payload_kg": PAYLOADS[number % 3]}
        where |= dict(zip(("x_m", "y_m", "z_m"), read, strict=True))
        for i, cable in enumerate(rest.cables):
            away = rest.position + rest.rotation @ built.platform_anchors[i] - built.frame_anchors[i]
            angle, side = np.arccos(away[2] / np.linalg.norm(away)), generator.choice([-1.0, 1.0])
            pull = behind_wheel(float(np.linalg.norm(cable.end_force)), angle, side, bearing, drag)
            length = rest.robot.cables[i].unstrained_length - 0.5 * side * play
            pull += NOISE["tension"] * generator.normal()
            length += NOISE["length"] * generator.normal()
            rows.append(where | {"cable": i + 1, "tension_N": pull, "length_m": length, "approach": side})
    pd.DataFrame(rows).to_csv(folder / "states.csv", index=False)
    (folder / "campaign.toml").write_text(CAMPAIGN)
    return load_campaign(folder / "campaign.toml")


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize(("bearing", "drag"), [(0.03, 0.0), (0.3, 0.0), (0.0, 4.0), (1e-9, 4.0)])
def test_the_law_is_the_balance_of_moments(side, bearing, drag):
    """Of one part alone; with both the closed form leaves out what the drag adds to the load of the bearing."""
    angle, tension = np.linspace(0.6, 3.0, 8), np.linspace(40.0, 300.0, 8)
    more = Extensions.of(8, {"bearing_friction": bearing, "pulley_drag": drag})
    arrays = RobotArrays.of(replace(load_robot(ROBOT), extensions=more))
    found = cell_reading(arrays, tension, np.full(8, side), angle / (0.5 * np.pi))
    expected = [behind_wheel(t, a, side, bearing, drag) for t, a in zip(tension, angle, strict=True)]
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_bearing_and_drag_together_miss_their_product():
    """A twin that says how much: half of mu r / R of the drag, here 0.06 of 4 N."""
    arrays = RobotArrays.of(
        replace(load_robot(ROBOT), extensions=Extensions.of(8, {"bearing_friction": 0.03, "pulley_drag": 4.0}))
    )
    found = cell_reading(arrays, np.full(8, 150.0), np.ones(8), np.full(8, 1.5))
    missed = behind_wheel(150.0, 0.75 * np.pi, 1.0, 0.03, 4.0) - found[0]
    assert 0.01 < missed < 0.03 * 4.0


@pytest.mark.slow
def test_wheels_on_bearings_are_named_with_their_friction(tmp_path):
    said = diagnosed(written(tmp_path, seed=1, bearing=0.03))
    assert said.decision.classes == (("pulley_friction",),)
    told = said.sizes[0].parameters["bearing_friction"]
    assert abs(told["value"] - 0.03) < 3.0 * told["sigma"] < 0.01


def test_drives_with_play_are_named_with_their_play(tmp_path):
    said = diagnosed(written(tmp_path, seed=2, play=2e-3))
    assert said.decision.classes == (("backlash",),)
    told = said.sizes[0].parameters["backlash"]
    assert abs(told["value"] - 2e-3) < 3.0 * told["sigma"] < 5e-4


@pytest.mark.slow
def test_nothing_of_the_kind_is_adequate(tmp_path):
    assert diagnosed(written(tmp_path, seed=3)).decision.status == "adequate"
