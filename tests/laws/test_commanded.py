"""States without encoder lengths: in the world that is true the internal force is the commanded one."""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.plan import minimum_detectable
from cdpr_struct.diagnosis.prepared import BUDGETS, prepare
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import residuals
from cdpr_struct.diagnosis.setting import make_setting
from cdpr_struct.diagnosis.world import World
from cdpr_struct.generated.platform import rotation
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from tests.laws.crime_campaign import NO_CABLES, clean_campaign

BOUND = 150.0  # N


def sent_to(wrong_anchors):
    """Campaign of a preloaded robot whose frame anchors are elsewhere, sent by lengths of the robot as entered."""
    robot, generator = load_robot("thesis-5"), np.random.default_rng(7)
    campaign = replace(clean_campaign(5), cable_frequencies=NO_CABLES, robot=robot, lower_bound=BOUND)
    states = replace(campaign.states, payload=np.zeros(5))
    real = replace(robot, frame_anchors=robot.frame_anchors + wrong_anchors)
    position, angles, tension = np.zeros((5, 3)), np.zeros((5, 3)), np.zeros((5, 8))
    for i in range(5):
        sent = None
        while sent is None or not sent.held:
            place, turn = (
                generator.uniform([-2.0, -1.5, 1.5], [2.0, 1.5, 3.5]),
                rotation(*generator.uniform(-0.02, 0.02, 3)),
            )
            sent = inverse(robot, place, turn, lower_bound=BOUND, allow_unheld=True)
        there = forward(real, sent.lengths, place, turn)
        position[i], tension[i], angles[i] = there.position, there.tensions, _angles(there.rotation)
    unread = np.full_like(states.length, np.nan)
    moved = replace(states, position=position, angles=angles, tension=tension, length=unread, length_sigma=unread,
                    lock=np.full(5, -1))  # fmt: skip
    return replace(campaign, states=moved)


def _angles(turn):
    """(rx, ry, rz) [rad] with R = Rz Ry Rx."""
    flat = np.hypot(turn[0, 0], turn[1, 0])
    return [np.arctan2(turn[2, 1], turn[2, 2]), np.arctan2(-turn[2, 0], flat), np.arctan2(turn[1, 0], turn[0, 0])]


def internal(campaign, world):
    setting, _ = make_setting(campaign)
    assert setting.sent.null_space.any()
    return residuals(setting, world, Readings.of(campaign.states))[setting.labels.block == "NS"]


def test_the_true_world_explains_the_internal_force():
    """2 mm of misplaced anchors: as entered a millimetre of internal force is left, in the true world nothing."""
    wrong = 0.002 * np.random.default_rng(2).standard_normal((8, 3))
    campaign = sent_to(wrong)
    world = World.of(campaign.robot, len(campaign.states.names))
    entered, true = internal(campaign, world), internal(campaign, world.plus(frame_anchors=wrong))
    assert np.abs(entered).max() > 0.5
    assert np.abs(true).max() < 0.05


def test_a_robot_as_entered_leaves_nothing():
    campaign = sent_to(np.zeros((8, 3)))
    assert np.abs(internal(campaign, World.of(campaign.robot, len(campaign.states.names)))).max() < 1e-2


def test_the_smallest_detectable_internal_force_is_one_force_everywhere():
    """In newtons, not the lengths of each state its own."""
    ground = prepare(sent_to(np.zeros((8, 3))), BUDGETS["small"]).ground
    smallest = minimum_detectable([c for c in ground.candidates if c.name == "internal_force"])["internal_force"]
    assert (smallest["unit"], smallest["pattern"]) == ("N", "the same everywhere")
    assert 1.0 < smallest["value"] < 60.0
