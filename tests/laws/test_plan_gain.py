"""What one more measurement is worth: against the whole campaign computed anew, and laws that any gain obeys."""

from dataclasses import fields, replace

import numpy as np
import pytest

from cdpr_struct.diagnosis import planned_gain
from cdpr_struct.diagnosis.plan import WIDE, left_over, plainest
from cdpr_struct.diagnosis.planned_checks import CHECKS, Check
from cdpr_struct.diagnosis.planned_gain import next_measurements, size_of
from cdpr_struct.diagnosis.planned_series import series
from cdpr_struct.diagnosis.planned_states import one_sided, proposals
from cdpr_struct.diagnosis.prepared import BUDGETS, prepare
from cdpr_struct.diagnosis.world import World
from cdpr_struct.measurement.campaign import CableFrequencies, Campaign, RobotFrequencies
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.crime_campaign import clean_campaign

PAIRS = [
    ("platform_mass", "joint_mass"),
    ("joint_mass", "platform_mass"),
    ("load_cell_gain", "pulley_friction"),
    ("frame_anchor_position", "tracker_frame"),
    ("axial_stiffness", "joint_compliance"),
    ("cable_linear_density", "load_cell_gain"),
    ("dead_length", "joint_compliance"),
]


@pytest.fixture(scope="module")
def ground():
    return prepare(one_sided(clean_campaign(4)), BUDGETS["small"]).ground


@pytest.fixture(scope="module")
def gains(ground):
    return next_measurements(ground, PAIRS)


def of(gains, text):
    (found,) = [g for g in gains if text in g.measurement]
    return {(s.cause, s.rival): s for s in found.separations}


def joined(old: Campaign, new: Campaign) -> Campaign:
    """Both campaigns' states and cable frequencies in one."""
    first, second = old.states, new.states
    lock = np.where(second.lock >= 0, second.lock + first.lock.max() + 1, -1)
    second = replace(second, lock=lock)
    states = {}
    for f in fields(first):
        a, b = getattr(first, f.name), getattr(second, f.name)
        states[f.name] = a + b if f.name == "names" else np.concatenate([a, b])
    one, two = old.cable_frequencies, new.cable_frequencies
    two = replace(two, state=two.state + len(first.names))
    rows = (np.concatenate([getattr(one, f.name), getattr(two, f.name)]) for f in fields(CableFrequencies))
    same = RobotFrequencies(*(getattr(old.robot_frequencies, f.name) for f in fields(RobotFrequencies)))
    return replace(
        old, states=replace(first, **states), cable_frequencies=CableFrequencies(*rows), robot_frequencies=same
    )


SLOW = [pytest.param(f, marks=pytest.mark.slow) for f in ("tilt", "payload", "cable frequencies")]


@pytest.mark.parametrize("family", ["approach", "locked", *SLOW])
def test_stacked_rows_say_what_the_whole_campaign_says(ground, family):
    """The noise of bending is drawn anew in the joined campaign."""
    proposal = next(p for p in proposals(ground.setting.campaign) if p.family == family)
    judge = planned_gain.Judge(ground, PAIRS)
    stacked = judge.nats(planned_gain.simulated(ground, proposal))
    whole = prepare(joined(ground.setting.campaign, proposal.campaign), BUDGETS["small"]).ground
    choices = {c.name: plainest(c) for c in whole.candidates}
    anew = np.array([
        left_over(choices[a].signature @ judge.theta[a], WIDE * choices[b].signature) for a, b in PAIRS
    ])  # fmt: skip
    assert (stacked > judge.before + 0.05).any()
    np.testing.assert_allclose(stacked, anew, rtol=1e-3, atol=1e-3)  # measured 3e-4


@pytest.mark.slow
def test_no_measurement_makes_causes_harder_to_tell_apart(ground):
    judge = planned_gain.Judge(ground, PAIRS)
    rows = [planned_gain.checked(ground, check) for check in CHECKS]
    campaign = ground.setting.campaign
    rows += [planned_gain.simulated(ground, p) for p in (*proposals(campaign), *series(campaign))]
    assert len(rows) >= len(CHECKS) + 10
    for added in rows:
        assert (judge.nats(added) >= judge.before * (1.0 - 1e-6) - 1e-6).all()


def test_a_check_too_coarse_to_see_anything_is_worth_nothing(ground):
    judge = planned_gain.Judge(ground, PAIRS)
    for check in CHECKS:
        blind = Check(check.text, 1e9 * check.sigma, check.reads, check.cause)
        found = judge.gain("blind", "blind", planned_gain.checked(ground, blind))
        assert found.nats == pytest.approx(0.0, abs=1e-6), check.text


def test_what_a_person_would_do_is_found(gains):
    """Weighing tells platform from joints; the other side tells friction from gain, which one side cannot at all."""
    weighed = of(gains, "weigh the platform")
    assert weighed["platform_mass", "joint_mass"].after > 5.0 > 3.0 > weighed["platform_mass", "joint_mass"].before
    friction = of(gains, "the state at")["load_cell_gain", "pulley_friction"]
    assert friction.before < 1.0
    assert friction.after > 5.0
    tracked = of(gains, "laser tracker on the frame anchors")["frame_anchor_position", "tracker_frame"]
    assert tracked.after > tracked.before + 3.0


def test_a_clamp_tells_what_lies_behind_it_from_what_does_not(gains):
    """Loads on clamped cables; the same loads on free ones, and all other states, see a compliance and no more."""
    pair = ("dead_length", "joint_compliance")
    assert of(gains, "clamp the cables")[pair].after > of(gains, "clamp the cables")[pair].before + 3.0
    for gain in gains:
        if gain.family not in ("clamped", "dial gauge across the joints (+-0.1 um/N)"):
            (seen,) = [s for s in gain.separations if (s.cause, s.rival) == pair]
            assert seen.after < seen.before + 0.3, gain.measurement


def test_a_clamped_dead_length_keeps_its_stretch_and_gives_no_further(ground):
    (clamped,) = [p for p in series(ground.setting.campaign) if p.family == "clamped"]
    world = World.of(clamped.campaign.robot, 3)
    moved = clamped.acts["dead_length"](world, np.ones(world.cables))
    tension = 1.0 / world.axial_stiffness * ground.setting.campaign.robot.platform.mass
    assert (moved.length_offset > tension).all()  # every cable carries more than an eighth of the weight
    np.testing.assert_array_equal(moved.series_compliance, world.series_compliance)


def test_states_of_a_preloaded_robot_are_proposed_within_its_lower_bound():
    """With the least tensions of all, some of its cables would hang slack nearly everywhere."""
    robot, campaign = load_robot("thesis-5"), clean_campaign(2)
    home = np.tile(robot.home.position, (2, 1))
    states = replace(campaign.states, position=home, angles=np.zeros((2, 3)), payload=np.zeros(2))
    campaign = replace(campaign, robot=robot, states=states, lower_bound=150.0)
    families = {p.family for p in (*proposals(campaign), *series(campaign))}
    assert {"pose", "payload", "locked", "poses", "payloads", "clamped"} <= families


def test_a_check_leaves_alone_what_it_does_not_read(gains):
    weighed = of(gains, "weigh the joints")["load_cell_gain", "pulley_friction"]
    assert weighed.after == pytest.approx(weighed.before, abs=0.05)


def test_ranked_by_what_they_are_worth(gains):
    worth = [g.nats for g in gains]
    assert worth == sorted(worth, reverse=True)
    assert len({g.family for g in gains}) == len(gains)


def test_sizes_are_twice_detectable_or_the_widest_prior(ground):
    for candidate in ground.candidates:
        choice = plainest(candidate)
        theta = size_of(choice)
        seen = np.linalg.norm(choice.signature @ theta)
        assert np.linalg.norm(theta) <= WIDE * np.sqrt(theta.size) * (1.0 + 1e-9)
        assert seen <= 2.0 * np.sqrt(planned_gain.noncentrality(1)) * (1.0 + 1e-9)


def test_a_check_reads_parameters_or_a_cause():
    with pytest.raises(ValueError, match="either reads or cause"):
        Check("nothing", 1.0)
    with pytest.raises(ValueError, match="must be positive"):
        Check("exact", 0.0, cause="temperature")
