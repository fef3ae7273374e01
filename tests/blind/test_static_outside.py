"""Effects outside the library of the sets without frequencies: each changes what it should, at zero nothing."""

import numpy as np
import pytest

from tests.blind.catalogue import LIBRARY, OUTSIDE_DEV, OUTSIDE_HELD, STATIC_OUTSIDE
from tests.blind.detectability import SENSOR_FIELDS, reference_size
from tests.blind.deviations import Deviations
from tests.blind.entered_robot import entered_robot
from tests.blind.measuring_plan import Plan, PlanSize, drawn_plan
from tests.blind.observation import observed
from tests.blind.sensors import SIGMA, pose_readings, settled_readings
from tests.blind.suite import composed
from tests.blind.true_robot import moved_exits, placed_force, true_lengths

ROBOT = entered_robot("cogiro")
EXACT = Deviations.none(ROBOT.cables)
CELLS, TRACKER, BOTH = {"tension"}, {"pose"}, {"tension", "pose"}
SEEN_IN = {"cell_tilt": CELLS, "cell_fading": CELLS, "tracker_shear": TRACKER, "tracker_heading": TRACKER}


def grown(name: str) -> Deviations:
    """Four times what can be detected, as in the sets."""
    size = STATIC_OUTSIDE[name].typical or reference_size(ROBOT.name, name, np.ones(1), statics=True)
    assert size is not None
    return EXACT.plus(name, np.full(1, 4.0 * size))


@pytest.fixture(scope="module")
def plan() -> Plan:
    """Lengths on both sides of 6 m, and states before the middle of the campaign and after it."""
    return drawn_plan(ROBOT, np.random.default_rng(4), size=PlanSize(6, 1, 2, 0))


def readings(plan: Plan, deviations: Deviations) -> dict[str, np.ndarray]:
    """All readings without noise, by kind, in sigmas."""
    seen = observed(ROBOT, deviations, plan, 12)
    pose = np.repeat([SIGMA["position_m"], SIGMA["rotation_deg"]], 3)
    rests = [*seen.statics, *(rest for lock in seen.locks for rest in lock)]
    return {
        "tension": np.array(settled_readings(plan, seen, deviations)) / SIGMA["tension_N"],
        "pose": np.array([pose_readings(deviations, rest) for rest in rests]) / pose,
    }


@pytest.fixture(scope="module")
def undisturbed(plan) -> dict[str, np.ndarray]:
    return readings(plan, EXACT)


@pytest.mark.parametrize("name", STATIC_OUTSIDE)
def test_an_effect_changes_the_readings_that_it_should(plan, undisturbed, name):
    changed = readings(plan, grown(name))
    moved = {kind: float(np.abs(changed[kind] - undisturbed[kind]).max()) for kind in changed}
    assert all(moved[kind] > 0.3 for kind in SEEN_IN.get(name, BOTH)), moved
    assert (name in SENSOR_FIELDS) == (name in SEEN_IN)
    assert all(moved[kind] == 0.0 for kind in set(moved) - SEEN_IN.get(name, BOTH)), moved


def test_effects_to_develop_with_and_those_held_back_are_different_and_none_of_the_library():
    assert not set(OUTSIDE_DEV) & set(OUTSIDE_HELD)
    assert not set(STATIC_OUTSIDE) & set(LIBRARY)


def test_sets_deal_each_effect_in_turn_and_file_no_frequencies():
    for name, effects in (("outside-dev", OUTSIDE_DEV), ("outside-held", OUTSIDE_HELD)):
        kinds = composed(name, 24, 5)
        names = [kind.effects[0][0] for kind in kinds]
        assert {each: names.count(each) for each in names} == dict.fromkeys(effects, 4)
        assert all(kind.statics and kind.effects[0][1] == 4.0 for kind in kinds)


def test_exits_settle_early_and_the_frame_is_widest_at_noon():
    sunk = [moved_exits(ROBOT, EXACT.plus("anchor_settling", np.ones(1)), day)[:, 2] for day in (0.0, 0.2, 1.0)]
    assert not sunk[0].any()
    np.testing.assert_allclose(sunk[1][:3], [1.0 / np.e - 1.0, 1.0 / np.e - 1.0, 0.0])
    np.testing.assert_allclose(sunk[2][0], np.exp(-5.0) - 1.0)
    wide = [moved_exits(ROBOT, EXACT.plus("noon_frame", np.ones(1)), day) for day in (0.0, 0.5, 1.0)]
    np.testing.assert_allclose(wide[1], (ROBOT.frame_anchors - ROBOT.home) / 5.0)
    np.testing.assert_allclose([wide[0], wide[2]], 0.0, atol=1e-12)


def test_a_magnet_pulls_down_with_the_inverse_square_and_a_gust_stays_with_its_moment():
    magnet, gusts = (EXACT.plus(name, np.ones(1)) for name in ("floor_magnet", "gusts"))
    pull = placed_force(ROBOT, magnet, ROBOT.home)
    assert pull is not None
    assert np.linalg.norm(pull.force) == pytest.approx(1.0 / (0.8**2 + 0.5**2 + 2.0**2))
    assert pull.force[2] < 0.0
    first, again, later = (placed_force(ROBOT, gusts, ROBOT.home, day) for day in (0.3, 0.3, 0.4))
    assert first is not None
    assert again is not None
    assert later is not None
    np.testing.assert_array_equal(first.force, again.force)
    assert np.abs(first.force - later.force).max() > 0.1


def test_a_rope_that_slips_is_longer_afterwards_and_no_other(plan):
    slipped = EXACT.plus("clamp_slip", np.full(1, 0.01))
    more = [true_lengths(slipped, command) - command.lengths for command in (plan.statics[0], plan.locks[0][-1])]
    np.testing.assert_allclose(more, [np.zeros(8), 0.01 * np.eye(8)[2]], atol=1e-12)


def test_a_drum_pays_out_more_beyond_its_home_length_which_a_plan_crosses(plan):
    layered = EXACT.plus("second_layer", np.full(1, 0.01))
    more = np.array([true_lengths(layered, c, ROBOT.home_lengths) - c.lengths for c in plan.statics])
    longer = np.array([command.lengths for command in plan.statics]) - ROBOT.home_lengths
    assert (np.ptp(longer, axis=0) > 0.2).all()
    np.testing.assert_allclose(more[longer > 0.5], 0.01, atol=1e-4)
    np.testing.assert_allclose(more[longer < -0.5], 0.0, atol=1e-4)
    assert (longer > 0.5).any()
    assert (longer < -0.5).any()
