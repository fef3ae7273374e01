"""Do poses at locked lengths balance in every world, and do small changes of them start where they should?"""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.locked_pose import equilibria, locked_pose, missed_pose, nearby_pose, reference
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import States, among
from cdpr_struct.diagnosis.setting import circumstances, make_setting
from cdpr_struct.diagnosis.world import World
from cdpr_struct.errors import CdprError
from tests.laws.crime_campaign import clean_campaign


@pytest.fixture(scope="module")
def campaign():
    return clean_campaign(4)


def state_of(campaign, **changes):
    """World per state with some of its fields changed, readings and circumstances."""
    world = World.of(campaign.robot, len(campaign.states.names))
    return replace(world, **changes).per_state(), Readings.of(campaign.states), circumstances(campaign)


@pytest.mark.parametrize("pulleys", [0.0, 0.05])
def test_masts_stand_where_the_cables_pull_them(campaign, pulleys):
    give, radius = np.full(8, 2e-5), np.full(8, pulleys)
    world, readings, known = state_of(campaign, frame_compliance=give, pulley_radius=radius)
    found, _ = locked_pose(world, readings, known)
    assert found.converged.all()
    stiff, *_ = state_of(campaign, pulley_radius=radius)
    together = np.einsum("ij,sjk->sik", world.masts, found.cables.force_at_frame)
    held = replace(stiff, frame_anchors=stiff.frame_anchors + give[:, None] * together)
    again, _ = locked_pose(held, readings, known)
    assert np.abs(missed_pose(stiff, readings, found)).max() > 1e-3
    np.testing.assert_allclose(again.position, found.position, atol=1e-9)
    np.testing.assert_allclose(again.rotation, found.rotation, atol=1e-9)


def test_a_law_that_leaves_a_cable_no_length_leaves_no_pose(campaign):
    """Of a batch of two worlds only the impossible one is lost; a step of a fit may go that far."""
    world, readings, known = state_of(campaign)
    worlds = replace(world, length_offset=world.length_offset + np.array([0.0, -50.0])[:, None, None])
    found, _ = locked_pose(worlds, readings, known)
    np.testing.assert_allclose(found.position[0], locked_pose(world, readings, known)[0].position, atol=1e-9)
    assert np.isnan(found.position[1]).all()
    assert np.isnan(missed_pose(worlds, readings, found)[1]).any(axis=-1).all()
    near = equilibria(worlds, readings, known, reference(world, readings, known), small=True)
    np.testing.assert_array_equal(near.position, found.position)
    with pytest.raises(CdprError, match="no length"):
        reference(replace(world, length_offset=world.length_offset - 50.0), readings, known)


@pytest.mark.parametrize("give", [0.0, 1e-5])
def test_small_changes_are_those_of_whole_equilibria(campaign, give):
    world, readings, known = state_of(campaign, frame_compliance=np.full(8, give))
    about = reference(world, readings, known)
    steps = 1e-4 * np.concatenate([np.zeros((1, 8)), np.eye(8)])
    moved = replace(world, length_offset=world.length_offset + steps[:, None])
    whole, near = (equilibria(moved, readings, known, about, small) for small in (False, True))
    change = [np.diff(missed_pose(moved, readings, found)[[0, 3]], axis=0) for found in (whole, near)]
    assert np.abs(change[0]).max() > 2e-5  # m; a change that is there
    np.testing.assert_allclose(change[1], change[0], atol=0.01 * np.abs(change[0]).max())
    tension = [np.diff(found.tensions[[0, 3]], axis=0) for found in (whole, near)]
    np.testing.assert_allclose(tension[1], tension[0], atol=0.02 * np.abs(tension[0]).max())


def test_steps_that_lead_nowhere_are_replaced_by_the_whole_equilibrium(campaign):
    """A light platform on cables that hardly stretch, drawn aside by as much as it weighs."""
    world, readings, known = state_of(campaign)
    light = replace(world, axial_stiffness=1e3 * world.axial_stiffness)
    about = reference(light, readings, known)
    drawn = replace(light, force=light.force + np.array([2000.0, 0.0, 0.0]))
    assert nearby_pose(drawn, readings, known, about) is None
    found = equilibria(drawn, readings, known, about, small=True)
    whole, _ = locked_pose(drawn, readings, known)
    np.testing.assert_allclose(found.position, whole.position, atol=1e-6)


@pytest.mark.parametrize("small", [False, True])
@pytest.mark.parametrize("some", [[3], [0, 2], [1, 2, 4]])
def test_some_of_the_states_are_those_among_all(some, small):
    """Two held states and three locked ones, in a world beside that of the reference."""
    whole = clean_campaign(5)
    tension = np.where(np.arange(5)[:, None] < 2, whole.states.tension, np.nan)
    sigma = np.where(np.isnan(tension), np.nan, 2.0)
    known = replace(whole, states=replace(whole.states, tension=tension, tension_sigma=sigma))
    setting, readings = make_setting(known)[0], Readings.of(known.states)
    world = World.of(known.robot, 5).plus(length_offset=np.full(8, 1e-3)).per_state()
    alone = States(among(setting, np.array(some)), world, readings, small).all
    for name in ("position", "rotation", "tension"):
        every = getattr(States(setting, world, readings, small).all, name)
        np.testing.assert_allclose(getattr(alone, name), every[some], rtol=1e-7, atol=1e-9)
