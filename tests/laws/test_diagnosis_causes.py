"""Each cause, put into readings made by the same model (crime=True), is found again with its size."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.diagnosis.causes.handling import corrections
from cdpr_struct.diagnosis.causes.registry import LIBRARY, causes_for
from cdpr_struct.diagnosis.diagnose import diagnose
from cdpr_struct.diagnosis.evidence import candidates, choices
from cdpr_struct.diagnosis.null_model import null_model, tolerance_count
from cdpr_struct.diagnosis.ranking import Search
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.refit import Ground, refit
from cdpr_struct.diagnosis.selection import select
from cdpr_struct.diagnosis.setting import make_setting
from cdpr_struct.diagnosis.verdict import verdict
from cdpr_struct.diagnosis.world import World
from cdpr_struct.measurement.campaign_file import load_campaign
from tests.laws.crime_campaign import clean_campaign, hidden

# cause, pattern, hidden size in SI of theta (logarithm for ratios)
HIDDEN = [
    ("axial_stiffness", "all alike", -0.2),
    ("joint_compliance", "all alike", 1e-5),
    ("frame_compliance", "all alike", 6e-6),
    ("frame_compliance", "mast of cables 3, 4 alone", 8e-6),
    ("unstrained_length_offset", "cable 3 alone", 0.012),
    ("drum_scale", "all alike", 1.5e-3),
    ("pulley_radius", "all alike", 0.02),
    ("platform_mass", "", 0.03),
    ("joint_mass", "all alike", 0.4),
    ("center_of_mass", "", 0.02),
    ("external_force", "", 30.0),
    ("cable_linear_density", "all alike", 0.09),
    ("load_cell_gain", "cable 5 alone", 0.08),
    ("load_cell_bias", "cable 2 alone", 15.0),
    ("gravity_tilt", "", 0.025),
    ("accelerometer_mass", "", 5.0),
    ("frame_anchor_position", "cable 4 alone", 0.015),
    ("platform_anchor_position", "cable 6 alone", 0.012),
]
OCTAGON = np.array([[np.cos(a), np.sin(a)] for a in np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)])


def ground_of(campaign, names) -> Ground:
    """Ground with the named causes, without draws of the null."""
    setting, _ = make_setting(campaign)
    world, readings = World.of(campaign.robot, len(campaign.states.names)), Readings.of(campaign.states)
    null = null_model(setting, world, readings)
    library = candidates(setting, world, readings, null, [LIBRARY[n] for n in names])
    likeliest, nothing = np.zeros(tolerance_count(setting)), np.zeros(len(null.r))
    return Ground(setting, world, readings, null, library, 3, null.level, nothing, likeliest, nothing, world)


@pytest.mark.parametrize(("name", "label", "size"), HIDDEN, ids=[h[0] for h in HIDDEN])
def test_hidden_size_is_recovered(name, label, size):
    """Fitted with the right pattern the size comes back within two of its sigmas, and beats the null."""
    campaign = clean_campaign()
    pattern = next(p for p in LIBRARY[name].patterns(make_setting(campaign)[0]) if p.label == label)
    theta = np.zeros(pattern.basis.shape[1])
    theta[0] = size
    ground = ground_of(hidden(lambda world: LIBRARY[name].apply(world, pattern.basis @ theta)), [name])
    options = [c for c in choices(ground.candidates[0]) if c.pattern.label == label]
    fit = max((refit(ground, (c,)) for c in options), key=lambda fit: fit.gain)
    found = fit.theta * fit.choices[0].prior
    sigma = np.sqrt(np.diagonal(fit.covariance)) * fit.choices[0].prior
    assert fit.gain > 3.0
    assert np.all(np.abs(found - theta) < 2.0 * sigma + 0.02 * abs(size)), (found, theta, sigma)


@pytest.mark.parametrize(
    ("plan", "labels", "names"),
    [
        (None, ["all alike", "each its own", "mast of cables 1, 2 alone"], ["compliance_mast_of_1_2"]),
        (np.zeros((8, 2)), [""], ["compliance"]),
        (OCTAGON, ["all alike", "each its own", "mast of cable 1 alone"],
         ["compliance_mast_of_1", "compliance_mast_of_2"]),
    ],
    ids=["two cables a mast", "one mast", "a mast each"],
)  # fmt: skip
def test_a_parameter_of_each_mast_is_named_by_its_cables(plan, labels, names):
    campaign = clean_campaign(count=2)
    setting, anchors = make_setting(campaign)[0], campaign.robot.frame_anchors.copy()
    if plan is not None:
        anchors[:, :2] = plan
        robot = replace(campaign.robot, frame_anchors=anchors)
        setting = replace(setting, campaign=replace(campaign, robot=robot))
    patterns = LIBRARY["frame_compliance"].patterns(setting)
    assert [p.label for p in patterns][: len(labels)] == labels
    own = patterns[min(1, len(patterns) - 1)].parameters
    assert [p.name for p in own][: len(names)] == names
    assert sum(p.weight for p in patterns) == pytest.approx(1.0)
    assert len(patterns) == (1 if len(own) == 1 else 2 + len(own))


def test_a_wrong_name_does_not_win():
    """Heavier cables are not taken for anything else."""
    campaign = hidden(lambda world: world.times(linear_density=np.full(8, 1.09)))
    ground = ground_of(campaign, ["axial_stiffness", "cable_linear_density", "load_cell_gain", "joint_mass"])
    assert Search(ground).rank()[0].names == ("cable_linear_density",)


@pytest.mark.slow
def test_clean_readings_give_no_cause():
    found = diagnose(clean_campaign())
    assert verdict(found).status == "adequate"
    assert found.p_value > 0.5


def test_a_force_that_is_alike_everywhere_is_no_hose():
    """A hose without stiffness says no more than the force; one with stiffness does, and is chosen."""
    names = ["external_force", "hose_stiffness"]
    force = hidden(lambda world: world.plus(force=np.array([20.0, 0.0, 0.0])))
    found = select(Search(ground_of(force, names)), 6.0, 1)
    assert found.fit.names == ("external_force",)
    assert {fit.names for fit in found.first} == {("external_force",), ("hose_stiffness",)}
    assert found.rivals == [[]]
    stiff = np.array([60.0, 0.0, 0.0, 0.0])
    bent = ground_of(hidden(lambda world: LIBRARY["hose_stiffness"].apply(world, stiff)), names)
    hose = select(Search(bent), 6.0, 1)
    assert hose.fit.names == ("hose_stiffness",)
    assert [fit.names for fit in hose.rivals[0]] == [("external_force",)]


def test_compliances_in_line_are_one_class():
    """Elastic joints and cable behind the pulley are the same to these data: their evidence is within three nats."""
    campaign = hidden(lambda world: world.plus(series_compliance=np.full(8, 1e-5)))
    first, second = Search(ground_of(campaign, ["joint_compliance", "dead_length"])).rank()
    assert abs(first.gain - second.gain) < 3.0


def test_every_two_static_poses_are_tried_as_exchanged():
    """28 states are 378 pairs; the last two of them are tried as well."""
    campaign = clean_campaign(28)
    said = [c.sentence for c in corrections(campaign) if c.cause == "pose_mismatch"]
    assert len(said) == 378 + 2
    assert "the poses of cases s26 and s27 are exchanged" in said


@pytest.mark.slow
def test_exchanged_load_cells_are_found():
    campaign = clean_campaign()
    order = [0, 4, 2, 3, 1, 5, 6, 7]
    swapped = replace(campaign, states=replace(campaign.states, tension=campaign.states.tension[:, order]))
    found = diagnose(swapped)
    assert [c.cause for c, _ in found.corrections] == ["swapped_channels"]
    assert "cables 2 and 5" in verdict(found).sentence


def test_load_cells_that_nobody_read_are_no_cause():
    """States known by pose and frequencies only stand with the simulation's tensions; no cell was there."""
    campaign = load_campaign(Path(__file__).parents[2] / "examples" / "section-4-3-3" / "simulated.toml")
    testable, why = causes_for(make_setting(campaign)[0])
    assert {"load_cell_gain", "load_cell_bias"} <= why.keys()
    assert "axial_stiffness" in {cause.name for cause in testable}
    campaign = load_campaign(Path(__file__).parents[2] / "examples" / "table-4-4" / "level.toml")
    testable, _ = causes_for(make_setting(campaign)[0])
    assert {"load_cell_gain", "load_cell_bias"} <= {cause.name for cause in testable}
