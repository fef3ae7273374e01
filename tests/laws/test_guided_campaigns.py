"""Campaigns of guided platforms, and of lines whose tension nobody read: what may be said of them."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cdpr_struct as cs
import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.reports.diagnose.corrected_columns import changed_columns
from cdpr_struct.residuals.assembled import linear_model
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.linearised import Local, Point
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

EXAMPLES = Path(__file__).parents[2] / "examples"
ROUTER = EXAMPLES / "two-chain-router"
HELD, FREE = [1, 3, 5], [0, 2, 4, 6, 7]  # rows of a state: wrench, lengths


def rows_of(campaign):
    """Residuals (S, 6 + 2) as entered, and the stack of the linear model."""
    data = recorded(campaign)
    local = Local.about(data, Point.entered(data))
    (stack,) = linear_model(local, layout(data)).stacks
    return local.r.static, stack


@pytest.fixture(scope="module")
def holes():
    return load_campaign(ROUTER / "campaign.toml")


def pushed(campaign, force):
    """The campaign on a robot that something pushes across the sheet [N]."""
    robot = campaign.robot
    return replace(campaign, robot=replace(robot, extensions=replace(robot.extensions, force=np.array(force))))


def test_nothing_has_to_balance_what_a_guide_holds(holes):
    static, stack = rows_of(holes)
    assert not static[:, HELD].any()
    assert np.abs(static[:, FREE]).max() > 1e-4
    assert np.all(stack.floor[:, HELD] == 1.0)
    assert not stack.A[:, HELD].any()
    assert not stack.X[:, HELD].any()


def test_a_force_across_the_sheet_changes_nothing_and_one_along_it_does(holes):
    _, without = rows_of(holes)
    _, across = rows_of(pushed(holes, [0.0, 50.0, 0.0]))
    _, along = rows_of(pushed(holes, [50.0, 0.0, 0.0]))
    for part in ("r", "A", "X", "floor"):
        assert np.allclose(getattr(across, part), getattr(without, part), atol=1e-9)
    assert np.abs(along.r - without.r).max() > 1.0


def test_rows_in_the_plane_are_those_of_the_same_robot_without_a_guide(holes):
    guided, _ = rows_of(holes)
    free, _ = rows_of(replace(holes, robot=replace(holes.robot, guided=())))
    assert np.allclose(guided[:, FREE], free[:, FREE], atol=1e-6)


def test_a_pose_that_only_the_guide_holds_contradicts_nothing(tmp_path):
    shutil.copytree(ROUTER, tmp_path / "router")
    table = (tmp_path / "router" / "holes.csv").read_text().splitlines()
    lines = [line.split(",") for line in table]
    blank = [lines[0], *([case, "", y, "", *rest] for case, _, y, _, *rest in lines[1:])]
    (tmp_path / "router" / "holes.csv").write_text("\n".join(",".join(line) for line in blank))
    with pytest.raises(cs.InputError, match="no state where one could contradict another"):
        recorded(load_campaign(tmp_path / "router" / "campaign.toml"))


def test_vibration_of_a_guided_platform_is_refused(tmp_path):
    shutil.copytree(ROUTER, tmp_path / "router")
    (tmp_path / "router" / "peaks.csv").write_text("case,frequency_hz\nhole 1,3.0\n")
    path = tmp_path / "router" / "campaign.toml"
    path.write_text(path.read_text() + '[[measurement]]\nkind = "robot_frequency"\nfile = "peaks.csv"\n')
    with pytest.raises(cs.InputError, match="robot_frequency is not diagnosed there"):
        load_campaign(path)


def test_unread_tensions_may_be_as_large_as_what_the_file_says_that_cables_carry():
    campaign = load_campaign(EXAMPLES / "hanging-printer" / "campaign.toml")
    loose = replace(campaign, robot=campaign.robot.with_force_limits(0.0))
    weight = 2.0 * 9.81 / 9.0
    assert recorded(loose).known.mean_tension == pytest.approx(weight)
    assert recorded(campaign).known.mean_tension == pytest.approx((6 * 40.0 + 3 * weight) / 9.0)
    assert np.all(recorded(campaign).unread[:, 6:15] == recorded(campaign).known.mean_tension)


def test_columns_of_two_cables_are_no_pose(holes):
    states = holes.states
    changed = replace(holes, states=replace(states, length=states.length + 0.1))
    assert changed_columns(holes, changed, "static_state") == {"length_m", "length_1_m", "length_2_m"}


def test_ends_of_a_beam_move_as_its_flexibility_says():
    robot = load_robot(ROUTER / "robot.toml")
    lengths = inverse(robot, np.array([0.4, 0.0, 1.0]), np.eye(3), allow_unheld=True).lengths
    flexibility = np.array([[4e-5, 1.5e-5], [1.5e-5, 4e-5]])
    beam = fem.carrying_beam((0, 1), np.array([0.0, 0.0, 1.0]), flexibility)
    data = replace(to_fem(robot, lengths), surroundings=fem.SurroundingsData(beams=(beam,)))
    rest = fem.solve_robot(data, np.array([0.4, 0.0, 1.0]), np.eye(3), 20)
    moved = np.array([cable.nodes[0] for cable in rest.cables]) - robot.frame_anchors
    pulls = -np.array([cable.start_force for cable in rest.cables])
    assert np.allclose(moved[:, 2], flexibility @ pulls[:, 2], rtol=1e-9)
    assert not moved[:, :2].any()
    assert moved[:, 2].max() < -1e-3


def test_a_cable_is_carried_once():
    beam = fem.carrying_beam((0, 1), np.array([0.0, 0.0, 1.0]), np.eye(2) * 1e-5)
    with pytest.raises(ValueError, match="name no cable twice"):
        fem.SurroundingsData(masts=((1,),), beams=(beam,))
