"""Laws that came into the library after the sets had been drawn: the truth knows each by other means."""

from dataclasses import replace

import numpy as np
import pytest

from tests.blind.answers import Answer, names_in_truth, right_answer
from tests.blind.catalogue import BEYOND, CAME_IN, CAUSES, LAWS, LIBRARY, RARE
from tests.blind.deviations import Deviations, field_sizes
from tests.blind.entered_robot import entered_robot
from tests.blind.measuring_plan import PlanSize, drawn_plan
from tests.blind.observation import Rest, observed
from tests.blind.platform_parts import PART_HZ
from tests.blind.sensors import cell_readings
from tests.blind.suite import composed
from tests.blind.true_robot import BEDDED, HOURS, at_rest, powers, true_cables, true_lengths
from tests.blind.vibrations import CORD, robot_frequencies

SMALL = PlanSize(1, 0, 0, 1)


def hidden(name: str, size: float) -> Deviations:
    exact = Deviations.none(8)
    return exact.plus(name, np.full(field_sizes(8)[name], size))


def test_every_law_has_a_field_and_a_size_and_is_drawn():
    assert set(LAWS) <= set(field_sizes(8))
    assert all(effect.typical > 0.0 for effect in LAWS.values())
    assert {kind.effects[0][0] for kind in composed("laws", 8, 5)} == set(LAWS) - set(RARE)
    assert not (set(LAWS) - {"backlash"}) & {*LIBRARY, *BEYOND}
    assert set(CAUSES) <= {*LAWS, *CAME_IN}


def test_a_wheel_is_in_balance_about_its_axle():
    """Seen from the wheel: both pulls, and the part of their sum that its bearing turns into a moment."""
    robot = entered_robot("cogiro")
    command = drawn_plan(robot, np.random.default_rng(1), size=SMALL).statics[0]
    rest = Rest(np.zeros(3), np.eye(3), np.linspace(100.0, 300.0, 8), np.linspace(0.5, 3.0, 8))
    read = cell_readings(hidden("bearing_friction", 0.05), command, rest)
    pulls = read[:, None] * np.array([0.0, -1.0])
    pulls += rest.tensions[:, None] * np.stack([np.sin(rest.exit_angles), np.cos(rest.exit_angles)], axis=1)
    np.testing.assert_allclose(
        read - rest.tensions, 0.05 * command.approach * np.linalg.norm(pulls, axis=1), rtol=1e-12
    )


def test_a_swinging_payload_adds_two_slow_modes_and_frees_the_horizontal_ones():
    robot = entered_robot("cogiro")
    plan = drawn_plan(robot, np.random.default_rng(2), size=SMALL)
    rest = at_rest(robot, Deviations.none(8), plan.statics[0], 10)
    rigid, free = (robot_frequencies(robot, hidden("swinging_payload", share), rest)[0] for share in (0.0, 0.25))
    own = np.sqrt(robot.gravity / CORD) / (2.0 * np.pi)
    np.testing.assert_allclose(free[:2], own, rtol=0.05)  # a platform on cables gives way a little
    assert rigid[0] > 1.5 * own


def test_a_part_on_a_spring_splits_a_mode_and_keeps_what_is_slow():
    """A part far stiffer than the platform's modes moves with it: all modes stay; a soft one adds one mode."""
    robot = entered_robot("cogiro")
    plan = drawn_plan(robot, np.random.default_rng(2), size=SMALL)
    rest = at_rest(robot, Deviations.none(8), plan.statics[0], 10)
    exact = Deviations.none(8)
    rigid = robot_frequencies(robot, exact, rest)[0]
    part = robot_frequencies(robot, exact.plus("flexible_platform", np.array([1e-9, 0.0, 0.0])), rest)[0]
    near = np.argmin(np.abs(part - PART_HZ))
    np.testing.assert_allclose(part[near], PART_HZ, rtol=1e-6)
    np.testing.assert_allclose(np.delete(part, near)[:40], rigid[:40], rtol=1e-6)


def test_sensors_vibrate_like_a_payload_that_is_not_there_when_tensions_are_read():
    robot = entered_robot("cogiro")
    plan = drawn_plan(robot, np.random.default_rng(2), size=SMALL)
    bare, heavy = (observed(robot, hidden("accelerometer_mass", mass), plan, 10) for mass in (0.0, 10.0))
    assert (heavy.statics[0].tensions == bare.statics[0].tensions).all()
    loaded = replace(plan, statics=(replace(plan.statics[0], payload=plan.statics[0].payload + 10.0),))
    like = observed(robot, Deviations.none(8), loaded, 10)
    np.testing.assert_allclose(heavy.robot_hz, like.robot_hz, rtol=1e-9)
    np.testing.assert_allclose(heavy.cable_hz, like.cable_hz, rtol=1e-9)
    assert (heavy.cable_hz > 1.001 * bare.cable_hz).any()


def test_slip_and_creep_take_time():
    robot = entered_robot("cogiro")
    plan = drawn_plan(robot, np.random.default_rng(1), size=PlanSize(3, 0, 0, 0))
    paid = [true_lengths(hidden("brake_slip", 1e-3), command) - command.lengths for command in plan.statics]
    np.testing.assert_allclose(paid, 1e-3 * HOURS * np.array([0.0, 0.5, 1.0])[:, None] * np.ones(8), atol=1e-12)
    tension = np.full(8, 300.0)
    soft = [true_cables(robot, hidden("creep", 0.1), plan.statics[0].lengths, tension, day) for day in (0.0, 1.0)]
    ratio = soft[0][0].axial_stiffness / soft[1][0].axial_stiffness
    assert ratio == pytest.approx(1.0 + 0.1 * np.log10(241.0))


def test_a_marker_hangs_on_its_cable():
    robot = entered_robot("cogiro")
    cables = true_cables(robot, hidden("cable_added_mass", 0.05), np.full(8, 10.0), np.zeros(8))
    assert cables[3].lumps == ((3.0, 0.05),)


def test_the_line_of_a_power_law_touches_it():
    stiffness, tension = np.full(8, 1e6), np.linspace(50.0, 900.0, 8)
    law = hidden("power_elasticity", 0.3)
    slope, start = powers(law, tension, stiffness)
    strain = tension[0] / slope[0] + start[0]
    grid = np.geomspace(1e-9, tension[0], 200001)
    np.testing.assert_allclose(strain, np.trapezoid(1.0 / (1e6 * (grid / BEDDED) ** 0.3), grid), rtol=1e-5)


@pytest.mark.parametrize(
    ("hidden", "name", "said", "right"),
    [
        ("backlash", "backlash", "backlash", True),
        ("backlash", "backlash", "unstrained_length_offset", False),
        ("construction_stretch", "nonlinear_elasticity", "nonlinear_elasticity", True),
        ("construction_stretch", "nonlinear_elasticity", "axial_stiffness", False),
    ],
)
def test_a_law_outside_the_library_that_came_into_it_is_right_if_named(hidden, name, said, right):
    truth = {"kind": "outside", "effects": [{"cause": hidden, "multiple": 4.0}]}
    assert names_in_truth(truth) == (name,)
    answer = Answer("named", (said,), ((said,),), 0.99, 1.0, {})
    assert right_answer(answer, truth) is right
