"""What the live view shows is what the commands compute, and a state that cannot be is a sentence, not a crash."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.dynamics.robot_dynamic_stiffness import attachment
from cdpr_struct.live import colours, panel
from cdpr_struct.live.controls import Controls, slider_ranges
from cdpr_struct.live.measured_state import measured_state, shown_states
from cdpr_struct.live.scene_lines import arrows, linear, quaternion, segments
from cdpr_struct.live.view_modes import NoModes, ViewModes, view_modes
from cdpr_struct.live.view_state import Refusal, ViewState, view_state

POSE = (0.5, -1.0, 0.8, 2.0, 0.0, 5.0)
TABLE_4_4 = "examples/table-4-4/campaign.toml"


@pytest.fixture(scope="module")
def robot():
    return cs.load_robot("thesis-3-1")


@pytest.fixture(scope="module")
def state(robot) -> ViewState:
    found = view_state(robot, Controls(POSE, 7.0))
    assert isinstance(found, ViewState)
    return found


@pytest.fixture(scope="module")
def modes(state) -> ViewModes:
    found = view_modes(state, 12)
    assert isinstance(found, ViewModes)
    return found


def test_a_pose_shows_what_inverse_answers(state):
    expected = cs.inverse("thesis-3-1", POSE, payload=7.0).answer
    np.testing.assert_allclose(state.tensions, expected["tensions_N"], rtol=1e-9)
    np.testing.assert_allclose(state.lengths, expected["lengths_m"], rtol=1e-12)
    assert state.messages == ()
    assert (state.exceeded == 0).all()
    np.testing.assert_allclose(state.curves[:, -1], state.geometry.platform, atol=1e-9)
    np.testing.assert_allclose(state.curves[:, 0], state.geometry.frame, atol=1e-12)


def test_lengths_show_the_pose_that_they_lead_to(robot, state):
    """From a start a little away, the lengths of a pose lead back to it."""
    near = Controls((0.45, -0.95, 0.85, 0.0, 0.0, 0.0), 7.0, tuple(state.lengths.tolist()))
    found = view_state(robot, near)
    assert isinstance(found, ViewState)
    np.testing.assert_allclose(found.pose.in_degrees(), POSE, atol=1e-6)
    np.testing.assert_allclose(found.tensions, state.tensions, rtol=1e-5)


def test_a_pose_outside_the_force_limits_is_shown_with_what_it_would_take(robot, state):
    most = float(np.median(state.tensions))
    found = view_state(robot.with_force_limits(0.0, most), Controls(POSE, 7.0))
    assert isinstance(found, ViewState)
    assert found.messages[0].startswith("Outside the force limits: the cables cannot hold this pose: cable")
    assert (found.exceeded == (found.tensions > most)).all()
    np.testing.assert_allclose(found.tensions, state.tensions, rtol=1e-9)
    assert "**high**" in panel.cable_table(found)
    shown = colours.state_colours(found, 8)
    assert (shown[found.exceeded == 1] == colours.ABOVE).all()
    assert (shown[found.exceeded == 0] != colours.ABOVE).any(axis=1).all()


def test_locked_lengths_outside_the_limits_name_the_cables(robot, state):
    found = view_state(robot.with_force_limits(230.0), Controls(POSE, 7.0, tuple(state.lengths.tolist())))
    assert isinstance(found, ViewState)
    low = np.flatnonzero(state.tensions < 230.0) + 1
    assert "below force_min" in found.messages[0]
    assert all(str(number) in found.messages[0] for number in low)
    assert (colours.state_colours(found, 8)[found.exceeded < 0] == colours.BELOW).all()


@pytest.mark.parametrize(
    "controls",
    [
        Controls((30.0, 0.0, 1.0, 0.0, 0.0, 0.0)),
        Controls((0.0, 0.0, 0.5, 0.0, 0.0, 0.0), 0.0, (-1.0,) * 8),
        Controls((0.0, 0.0, 9.0, 0.0, 0.0, 0.0), 50.0),
    ],
)
def test_what_cannot_be_is_one_sentence_and_a_picture(robot, controls):
    found = view_state(robot, controls)
    assert isinstance(found, Refusal)
    assert "\n" not in found.message
    assert len(found.message) > 20
    assert panel.status(found).startswith("**Cannot be held.**")
    assert panel.cable_table(found) == ""
    assert found.geometry.curves.shape[0] == 8
    assert (colours.state_colours(found, 8) == colours.NONE).all()


def test_modes_are_those_of_the_command_and_move_with_the_platform(state, modes):
    expected = cs.modes("thesis-3-1", POSE, payload=7.0, count=12)
    np.testing.assert_allclose(modes.hertz, expected.answer["frequencies_hz"], rtol=1e-12)
    assert list(modes.kinds) == expected.answer["kinds"]
    assert list(modes.words) == expected.answer["motion_words"]
    ends = attachment(state.point)
    for mode in (0, 5, 11):
        cables, shift, turn = modes.displaced(mode, 0.25)
        rest, _, _ = modes.displaced(mode, 0.0)
        moved = cables - rest
        np.testing.assert_allclose(moved[:, -1], ends @ np.r_[shift, turn], atol=1e-12)
        assert np.linalg.norm(moved, axis=-1).max() == pytest.approx(0.25, rel=0.01)
        np.testing.assert_allclose(rest[:, -1], state.geometry.platform, atol=1e-9)


def test_an_unstable_state_has_no_modes_but_a_reason(robot, state):
    """A centre of mass far above the anchors: balanced, and it falls over."""
    body = replace(robot.platform, center_of_mass=np.array([0.0, 0.0, 40.0]))
    found = view_state(replace(robot, platform=body), Controls((0.0, 0.0, 0.5, 0.0, 0.0, 0.0)))
    assert isinstance(found, ViewState)
    none = view_modes(found, 4)
    assert isinstance(none, NoModes)
    assert panel.mode_table(none).startswith("No vibrations: the equilibrium is unstable")


def test_tables_hold_every_cable_and_mode(state, modes):
    cables, table = panel.cable_table(state), panel.mode_table(modes)
    assert all(f"{pull:.1f}" in cables for pull in state.tensions)
    assert all(f"{hertz:.3f}" in table for hertz in modes.hertz)
    assert cables.count("\n| ") == 8 + 1
    assert table.count("\n| ") == 12 + 1


def test_sliders_reach_over_the_frame_and_to_the_start(robot, state):
    far = Controls((20.0, 0.0, -3.0, 0.0, 90.0, 0.0), 1000.0)
    found = slider_ranges(robot, far, state.lengths)
    for value, (low, high) in zip((*far.pose, far.payload), (*found.pose, found.payload), strict=True):
        assert low <= value <= high
    low, high = np.array(found.pose[:3]).T
    assert (low <= robot.frame_anchors.min(axis=0)).all()
    assert (high >= robot.frame_anchors.max(axis=0)).all()
    assert all(low < length < high for length, (low, high) in zip(state.lengths, found.lengths, strict=True))


def test_measured_states_stand_beside_the_prediction_of_the_robot_that_is_shown():
    campaign = cs.load_campaign(TABLE_4_4)
    names = shown_states(campaign)
    found = measured_state(campaign.robot, campaign, names["horizontal centre"])
    expected = cs.inverse("cogiro", found.controls.pose).answer["tensions_N"]
    np.testing.assert_allclose(found.predicted_tension, expected, rtol=1e-6)
    np.testing.assert_allclose(found.in_sigmas, (found.tension - expected) / 5.0, rtol=1e-5)
    assert np.isnan(found.missed).all()  # no lengths were read
    table = panel.residual_table(found)
    assert f"{found.tension[0]:.1f}" in table
    assert "-" in table  # no lengths
    other = measured_state(campaign.robot.with_load(0.0, 200.0), campaign, names["horizontal centre"])
    assert (other.predicted_tension > found.predicted_tension).all()


def test_locked_lengths_of_a_campaign_show_how_far_the_platform_missed():
    campaign = cs.load_campaign("examples/soft-masts/campaign.toml")
    read = [i for i in shown_states(campaign).values() if campaign.states.has_length[i]]
    found = measured_state(campaign.robot, campaign, read[0])
    place = cs.forward(
        campaign.robot, lengths=found.length, payload=found.controls.payload, start=found.controls.pose
    ).answer["pose"][:3]
    np.testing.assert_allclose(found.missed, np.array(found.controls.pose[:3]) - place, atol=1e-7)
    assert "mm." in panel.residual_table(found)


def test_colours_and_arrows_show_size_and_sign(state):
    shown = colours.residual_colours(np.array([0.0, 5.0, 50.0, -5.0, np.nan]))
    assert shown.tolist() == [list(c) for c in (colours.NONE, colours.MORE, colours.MORE, colours.LESS, colours.NONE)]
    residual = np.array([1.0, -2.0, np.nan, 0.0, 0.0, 0.0, 0.0, 0.0])
    lines, own = arrows(state.geometry, residual, 0.6)
    assert own.tolist() == [0, 1]
    length = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1)
    np.testing.assert_allclose(length, [0.3, 0.6])
    toward = np.einsum("ai,ai->a", lines[:, 1] - lines[:, 0], (state.geometry.frame - state.geometry.platform)[own])
    assert np.sign(toward).tolist() == [1.0, -1.0]
    assert linear(np.array([0, 255])).tolist() == [0, 255]
    assert 50 < linear(np.array([128]))[0] < 60


def test_pieces_of_curves_and_rotations(state):
    pieces = segments(state.curves)
    assert pieces.shape == (8 * 48, 2, 3)
    np.testing.assert_array_equal(pieces[47, 1], state.curves[0, -1])
    np.testing.assert_array_equal(pieces[48, 0], state.curves[1, 0])
    w, x, y, z = quaternion(np.eye(3), np.array([0.0, 0.0, 0.2]))
    np.testing.assert_allclose([w, x, y, z], [np.cos(0.1), 0.0, 0.0, np.sin(0.1)])
