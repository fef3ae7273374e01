"""Campaigns along a motion: what is late is late by what was drawn, and sizes are those of the reference."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.blind.clock_sizes import Seen
from tests.blind.deviations import Deviations
from tests.blind.entered_robot import entered_robot
from tests.blind.motion import MARGIN, STEP, Curve, Motion, commanded, moved, planned
from tests.blind.moving_scoring import moving_right
from tests.blind.moving_sets import DELAY, DRIFT, Late, MovingKind, moving_kinds, read
from tests.blind.scoring import Scored
from tests.blind.suite import SET_SEEDS
from tests.blind.true_robot import Command, inertia_force, true_platform

NOISELESS = {"position_m": 0.0, "rotation_deg": 0.0, "length_m": 0.0, "tension_N": 0.0}
SIGMA = {"position_m": 0.001, "rotation_deg": 0.1, "length_m": 0.0005, "tension_N": 2.0}


def curve(pace: float = 0.5) -> Curve:
    size = np.array([0.8, 0.6, 0.2, 0.05, 0.04, 0.03])
    return Curve(np.array([0.0, 0.0, 1.0, 0, 0, 0]), size, pace * np.linspace(0.8, 1.3, 6), np.arange(6.0))


def straight_line() -> Motion:
    """Everything changes evenly, each cable at a rate of its own."""
    time = STEP * np.arange(-MARGIN, 12 + MARGIN)
    rates = np.multiply.outer(time, np.arange(1.0, 5.0))
    return Motion(time, 9.0 + rates, 0.1 * rates[:, :3], np.zeros((len(time), 3)), 100.0 + rates)


def test_lengths_and_tensions_are_of_later_moments_where_poses_are_older():
    robot, late = entered_robot("four-cables"), Late(np.array([0.1, 0.0, 0.0, -0.2]), np.full(4, 0.05), drift=0.01)
    table = read(robot, straight_line(), late, NOISELESS, True, np.random.default_rng(1))
    time = STEP * np.arange(12)
    for i in range(4):
        own, rate = table[table["cable"] == i + 1], i + 1.0
        np.testing.assert_allclose(own["length_m"], 9.0 + rate * (time + late.lengths[i] + 0.01 * time), rtol=1e-9)
        np.testing.assert_allclose(own["tension_N"], 100.0 + rate * (time + 0.05 + 0.01 * time), rtol=1e-9)
        np.testing.assert_allclose(own["x_m"], 0.1 * time, atol=1e-12)
    assert "tension_N" not in read(robot, straight_line(), late, NOISELESS, False, np.random.default_rng(1))


def test_a_curve_knows_its_own_derivatives():
    line, time, step = curve(), np.linspace(0.0, 9.0, 7), 1e-3
    places = [line.place(time + shift)[0] for shift in (-step, 0.0, step)]
    moved_, spin, turning = np.moveaxis(line.motion(time), 1, 0)
    np.testing.assert_allclose(moved_, (places[0] - 2.0 * places[1] + places[2]) / step**2, atol=1e-6)
    turns = [Rotation.from_matrix(line.place(time + shift)[1]) for shift in (-step, step)]
    np.testing.assert_allclose(spin, (turns[1] * turns[0].inv()).as_rotvec() / (2.0 * step), atol=1e-9)
    spins = [line.motion(time + shift)[:, 1] for shift in (-step, step)]
    np.testing.assert_allclose(turning, (spins[1] - spins[0]) / (2.0 * step), atol=1e-5)


def test_a_moving_platform_pulls_at_its_cables():
    """Lifted at 1 m/s^2, the cables carry a tenth more than its weight."""
    robot, exact = entered_robot("thesis-3-1"), Deviations.none(8)
    platform, up = true_platform(robot, exact, 0.0, np.eye(3)), np.zeros((3, 3))
    up[0, 2] = 1.0
    command = Command(np.ones(8), 0.0, np.zeros(8), np.zeros(3), np.eye(3), motion=up)
    assert inertia_force(platform, command).force == pytest.approx([0.0, 0.0, -robot.mass])
    still = [c for c in commanded(robot, curve(1e-3), 1)]
    fast = commanded(robot, curve(), 1)
    assert np.ptp(moved(robot, exact, still).tensions, axis=0).max() < 0.5 < np.ptp(moved(robot, exact, fast).tensions)


def test_sizes_fall_with_speed_and_grow_with_noise():
    robot, found = entered_robot("thesis-3-1"), []
    for pace, factor in ((0.2, 1.0), (0.4, 1.0), (0.4, 3.0)):
        time = STEP * np.arange(96)
        sigma = {name: factor * value for name, value in SIGMA.items()}
        seen = Seen.of(robot, planned(robot, curve(pace), 96), time, sigma, True)
        column = seen.rows(np.zeros((96, 8)), seen.rate("lengths"))
        found.append(seen.size([column], np.ones(1), []))
    assert found[1] < 0.6 * found[0]
    assert 2.5 * found[1] < found[2]


def test_internal_forces_that_nobody_read_hide_what_is_late():
    robot, time = entered_robot("thesis-3-1"), STEP * np.arange(48)
    sizes = []
    for tensions in (True, False):
        seen = Seen.of(robot, planned(robot, curve(), 48), time, SIGMA, tensions)
        alone = seen.rows(np.zeros((48, 8)), seen.rate("lengths") * (np.arange(8) == 2))
        sizes.append(seen.size([alone], np.ones(1), []))
    assert sizes[1] > 1.2 * sizes[0]


def test_a_set_holds_every_way_and_every_second_effect():
    kinds = moving_kinds(120, SET_SEEDS["delays"])
    assert {kind.way for kind in kinds} == {
        "null", "alike", "lengths", "tensions", "one", "each", "drift", "drift from a start"
    }  # fmt: skip
    assert sum(bool(kind.second) for kind in kinds) == pytest.approx(0.23 * 120, abs=2)
    assert all(kind.tensions for kind in kinds if kind.way in ("lengths", "tensions") or "stiff" in kind.second)
    assert kinds == moving_kinds(120, SET_SEEDS["delays"])
    assert MovingKind("null") in kinds


class _Said:
    def __init__(self, *causes: str) -> None:
        self.status, self.causes = "named" if causes else "adequate", causes


@pytest.mark.parametrize(
    ("hidden", "more", "said", "right"),
    [
        ((), (), (), True),
        ((), (), (DELAY,), False),
        ((DELAY,), (), (DELAY,), True),
        ((DELAY,), (), (DELAY, "drum_scale"), False),
        ((DELAY, "axial_stiffness"), (), (DELAY,), False),
        ((DRIFT,), (DELAY,), (DRIFT, DELAY), True),
        ((DRIFT,), (DELAY,), (DELAY,), False),
    ],
)
def test_what_counts_as_right(hidden, more, said, right):
    effects = [{"cause": name, "may_be_said": more} for name in hidden]
    kind = ("null", "single", "pair")[len(hidden)]
    assert moving_right(Scored("c", {"kind": kind, "effects": effects}, _Said(*said))) is right
