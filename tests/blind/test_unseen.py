"""Effects outside the library that its authors did not know: each changes what it should, at zero nothing."""

from dataclasses import replace

import numpy as np
import pytest

from tests.blind import detectability
from tests.blind.catalogue import BEYOND, EQUIVALENT, LIBRARY, OUTSIDE, STATIC_OUTSIDE, UNSEEN
from tests.blind.deviations import Deviations, field_sizes
from tests.blind.entered_robot import entered_robot
from tests.blind.measuring_plan import Plan, PlanSize, drawn_plan
from tests.blind.observation import Rest, observed
from tests.blind.sensors import SIGMA, pose_readings, settled_readings
from tests.blind.suite import composed
from tests.blind.true_robot import HOOK, at_rest, balancer_stiffness, bedding, placed_force, true_lengths, true_platform

ROBOT = entered_robot("cogiro")
EXACT = Deviations.none(ROBOT.cables)
SMALL = PlanSize(static_states=3, locks=1, loads_per_lock=2, frequency_states=1)
SIZES = {"cable_warming": 10.0, "construction_stretch": 3e-4, "tracker_lens": 0.02, "tool_balancer": 20.0}
SIZES |= {"hook_offset": 0.05, "cell_settling": 0.1}
SEEN_IN = {
    "cable_warming": {"tension", "pose", "lock"},
    "construction_stretch": {"tension", "pose", "lock", "cable", "robot"},
    "tracker_lens": {"pose", "lock"},
    "tool_balancer": {"tension", "pose", "lock", "cable", "robot"},
    "hook_offset": {"tension", "pose", "lock", "robot"},
    "cell_settling": {"tension"},
}


def grown(name: str, size: float) -> Deviations:
    return EXACT.plus(name, np.full(field_sizes(ROBOT.cables)[name], size))


@pytest.fixture(scope="module")
def plan() -> Plan:
    """Frequencies at a state that is neither the first nor without payload."""
    drawn = drawn_plan(ROBOT, np.random.default_rng(4), size=SMALL)
    return replace(drawn, statics=drawn.statics[::-1])


def readings(plan: Plan, deviations: Deviations) -> dict[str, np.ndarray]:
    """All readings without noise, by kind, in sigmas or 0.1 %."""
    seen = observed(ROBOT, deviations, plan, 12)
    pose = np.repeat([SIGMA["position_m"], SIGMA["rotation_deg"]], 3)
    return {
        "tension": np.array(settled_readings(plan, seen, deviations)) / SIGMA["tension_N"],
        "pose": np.array([pose_readings(deviations, rest) for rest in seen.statics]) / pose,
        "lock": np.array([pose_readings(deviations, rest) for lock in seen.locks for rest in lock]) / pose,
        "cable": 1e3 * np.log(seen.cable_hz),
        "robot": 1e3 * np.log(seen.robot_hz),
    }


@pytest.fixture(scope="module")
def undisturbed(plan) -> dict[str, np.ndarray]:
    return readings(plan, EXACT)


def test_unseen_effects_are_neither_in_the_library_nor_among_those_known():
    assert not set(UNSEEN) & {*LIBRARY, *EQUIVALENT, *OUTSIDE, *STATIC_OUTSIDE}
    assert set(BEYOND) == {*OUTSIDE, *UNSEEN, *STATIC_OUTSIDE}
    assert set(UNSEEN) == set(SEEN_IN) <= set(field_sizes(8))


@pytest.mark.parametrize("name", UNSEEN)
def test_an_unseen_effect_changes_the_readings_that_it_should(plan, undisturbed, name):
    changed = readings(plan, grown(name, SIZES[name]))
    moved = {kind: float(np.abs(changed[kind] - undisturbed[kind]).max()) for kind in changed}
    assert all(moved[kind] > 0.3 for kind in SEEN_IN[name]), moved
    if name in detectability.SENSOR_FIELDS:
        assert all(moved[kind] == 0.0 for kind in set(moved) - SEEN_IN[name]), moved


@pytest.mark.parametrize("name", UNSEEN)
def test_an_unseen_effect_of_size_zero_changes_nothing(plan, undisturbed, name):
    changed = readings(plan, grown(name, 0.0))
    assert all(np.array_equal(changed[kind], undisturbed[kind]) for kind in changed)


def test_cables_lengthen_from_the_first_state_filed_to_the_last():
    drawn = drawn_plan(ROBOT, np.random.default_rng(4), size=SMALL)
    commands = [*drawn.statics, *drawn.locks[0]]
    assert [command.day for command in commands] == [0.0, 0.25, 0.5, 0.75, 1.0]
    warm = grown("cable_warming", 10.0)
    strains = [np.ptp(true_lengths(warm, command) / command.lengths - 1.0) for command in commands]
    assert max(strains) < 1e-15
    assert true_lengths(warm, commands[0]) == pytest.approx(commands[0].lengths, rel=1e-15)
    assert true_lengths(warm, commands[-1]) == pytest.approx(commands[-1].lengths * (1.0 + 1.2e-4), rel=1e-12)


def test_a_bedded_rope_is_as_long_as_its_law_says(plan):
    """Independently of lines that touch it: the strain at rest is T / EA + s0 (1 - exp(-T / 300 N))."""
    command, size = plan.statics[0], 3e-4
    rest = at_rest(ROBOT, grown("construction_stretch", size), command, 12)
    ropes = zip(rest.cables, rest.robot.cables, command.lengths, ROBOT.axial_stiffness, strict=True)
    for cable, data, length, stiffness in ropes:
        pull = np.linalg.norm(cable.end_force)
        strain = pull / stiffness + size * (1.0 - np.exp(-pull / 300.0))
        ours = (1.0 + pull / data.axial_stiffness) * data.unstrained_length / length - 1.0
        assert ours == pytest.approx(strain, rel=1e-3)


def test_touching_line_of_bedding_has_the_slope_of_its_law():
    law = grown("construction_stretch", 1e-3)
    tensions = np.array([10.0, 300.0, 2000.0])
    value, slope = bedding(law, tensions)
    np.testing.assert_allclose(value + slope * tensions, 1e-3 * (1.0 - np.exp(-tensions / 300.0)), rtol=1e-9)
    np.testing.assert_allclose(slope, 1e-3 / 300.0 * np.exp(-tensions / 300.0))


def test_a_balancer_pulls_everywhere_alike_and_stiffens_only_across():
    law, place = grown("tool_balancer", 20.0), ROBOT.home + np.array([0.5, 0.3, 0.2])
    force = placed_force(ROBOT, law, place)
    assert force is not None
    assert np.linalg.norm(force.force) == pytest.approx(20.0)
    assert np.linalg.norm(np.cross(force.force, ROBOT.home + HOOK - place)) < 1e-9
    by_steps = []
    for step in 1e-5 * np.eye(3):
        ahead, behind = (placed_force(ROBOT, law, place + sign * step) for sign in (1.0, -1.0))
        assert ahead is not None
        assert behind is not None
        by_steps.append((behind.force - ahead.force) / 2e-5)
    np.testing.assert_allclose(balancer_stiffness(ROBOT, law, place), by_steps, atol=1e-6)


def test_only_a_payload_hangs_beside_the_origin():
    law = grown("hook_offset", 0.05)
    empty, same = (true_platform(ROBOT, each, 0.0, np.eye(3)).center_of_mass for each in (law, EXACT))
    np.testing.assert_array_equal(empty, same)
    loaded, plain = (true_platform(ROBOT, each, 50.0, np.eye(3)).center_of_mass for each in (law, EXACT))
    np.testing.assert_allclose(loaded - plain, 50.0 / (ROBOT.mass + 50.0) * np.array([0.05, 0.05, 0.0]), atol=1e-12)


def test_the_lens_errs_with_the_cube_of_the_distance():
    law = grown("tracker_lens", 0.02)
    near, far = (Rest(np.array([x, 0.0, 1.0]), np.eye(3), np.ones(8), np.ones(8)) for x in (1.5, 3.0))
    errors = [pose_readings(law, rest) - pose_readings(EXACT, rest) for rest in (near, far)]
    np.testing.assert_allclose(errors, [[0.0025, 0, 0, 0, 0, 0], [0.02, 0, 0, 0, 0, 0]], atol=1e-15)


def test_cells_keep_some_of_the_last_reading(plan):
    seen = observed(ROBOT, EXACT, plan, 12)
    slow, quick = (settled_readings(plan, seen, each) for each in (grown("cell_settling", 0.1), EXACT))
    np.testing.assert_array_equal(slow[0], quick[0])
    np.testing.assert_allclose(slow[2], 0.9 * quick[2] + 0.09 * quick[1] + 0.01 * quick[0])


def test_the_unseen_set_deals_every_unseen_effect_in_turn():
    kinds = composed("unseen", 24, 5)
    names = [kind.effects[0][0] for kind in kinds]
    assert {name: names.count(name) for name in names} == dict.fromkeys(UNSEEN, 4)
    assert {(kind.kind, kind.effects[0][1], kind.noise, kind.lengths) for kind in kinds} == {
        ("outside", 4.0, "white", True)
    }


def test_other_sets_hold_no_unseen_effect():
    kinds = [*composed("dev", 200, 5), *composed("ci", 12, 5)]
    assert not {name for kind in kinds for name, _ in kind.effects} & set(UNSEEN)


@pytest.mark.parametrize("name", UNSEEN)
def test_every_unseen_effect_has_a_plausible_smallest_detectable_size(name):
    if name not in detectability._table(ROBOT.name)[0]:
        pytest.skip("reference_sizes.npz is older than this effect: python -m tests.blind sizes")
    size = detectability.reference_size(ROBOT.name, name, np.eye(field_sizes(8)[name])[0])
    assert size is not None
    assert 0.0 < 4.0 * size < UNSEEN[name].largest / 0.8
