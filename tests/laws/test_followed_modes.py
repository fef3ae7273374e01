"""Modes followed by their shape over neighbouring poses: what is the same mode, and where that is not known."""

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.workspace import shaped_modes as module
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.inserted_poses import InsertedPoses
from cdpr_struct.workspace.mode_following import FollowedMode, Following
from cdpr_struct.workspace.mode_map import ModeMap, reference
from cdpr_struct.workspace.mode_matching import SAME, matched, unlike_neighbours
from cdpr_struct.workspace.quantities import quantity_of
from cdpr_struct.workspace.shaped_modes import ShapedModes, shaped_modes

LEVEL, NONE = np.eye(3), np.zeros(3)
Columns = dict[str, np.ndarray]


def grid(x, y, z) -> Grid:
    return Grid(*(np.atleast_1d(np.asarray(axis, dtype=float)) for axis in (x, y, z)), NONE)


@cache
def mapped(name: str, number: int, half: float, count: int, height: float) -> tuple[Grid, Columns]:
    """A square map about the origin."""
    poses = grid(np.linspace(-half, half, count), np.linspace(-half, half, count), height)
    return poses, columns_of(name, f"mode-{number}", poses)


def columns_of(name: str, quantity: str, poses: Grid) -> Columns:
    robot, what = load_robot(name), quantity_of(quantity)
    return what.finished(robot, poses, what.evaluate(robot, poses.positions, poses.rotation))


def steps(poses: Grid) -> np.ndarray:
    """(e, 2) every pair of neighbours once."""
    beside = poses.neighbours[:, ::2]
    first, direction = np.nonzero(beside >= 0)
    return np.stack([first, beside[first, direction]], axis=1)


def unmarked(poses: Grid, veering: np.ndarray) -> np.ndarray:
    pairs = steps(poses)
    return pairs[~veering[pairs].all(axis=1)]


def change(values: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    return np.abs(np.diff(np.log(values[pairs]), axis=1)[:, 0])


# Modes of a small matrix that varies along a line: everything about them is known.


def modes_of(stiffness: Callable[[float], np.ndarray], x: np.ndarray, count: int | None = None) -> ShapedModes:
    values, vectors = np.linalg.eigh(np.array([stiffness(at) for at in x]))
    return ShapedModes(np.sqrt(values)[:, :count], np.swapaxes(vectors, 1, 2)[:, :count].astype(np.float16))


def followed(stiffness, x, number, computed=None, most=256) -> FollowedMode:
    poses = grid(x, 0.0, 0.0)

    def compute(positions: np.ndarray, count: int) -> ShapedModes:
        return modes_of(stiffness, positions[:, 0], count)

    between = InsertedPoses(poses.positions, compute, most)
    modes = modes_of(stiffness, x, computed)
    return Following(modes, poses.neighbours, between, len(stiffness(0.0))).from_pose(0, number)


def crossing(gap: float, slope: float = 1.0) -> Callable[[float], np.ndarray]:
    """Two modes that come within 2 gap of each other at x = 0, and a third one far away."""
    return lambda x: np.array([[10.0 + slope * x, gap, 0.0], [gap, 10.0 - slope * x, 0.0], [0.0, 0.0, 20.0]])


EVEN, ODD = np.linspace(-1.0, 1.0, 21), np.linspace(-1.0, 1.0, 20)  # with a pose at the crossing, and without


@pytest.mark.parametrize("x", [EVEN, ODD], ids=["a pose at the crossing", "none"])
def test_where_modes_cross_each_keeps_its_branch(x):
    found = followed(crossing(0.0), x, 0)
    np.testing.assert_allclose(found.hertz**2, 10.0 + x, rtol=1e-12)
    assert found.number[0] == 0
    assert found.number[-1] == 1
    assert not found.veering.any()
    assert found.inserted == 0


def test_at_a_double_mode_the_mixture_is_followed():
    """At x = 0 the two are 1e-7 apart, and each is half of the one and half of the other."""
    found = followed(crossing(1e-6), EVEN, 0)
    np.testing.assert_allclose(found.hertz**2, 10.0 + EVEN, rtol=1e-6)
    assert not found.veering.any()
    assert found.mac.min() > 0.99


def test_modes_that_avoid_each_other_slowly_are_followed_by_their_order():
    found = followed(crossing(0.5), EVEN, 0)
    assert (found.number == 0).all()
    assert not found.veering.any()


def test_modes_that_avoid_each_other_within_a_fraction_of_a_step_are_crossed():
    found = followed(crossing(1e-3), ODD, 0)
    assert found.number[-1] == 1
    assert not found.veering.any()
    np.testing.assert_allclose(found.hertz**2, 10.0 + ODD, rtol=1e-5)


def test_inserted_poses_tell_a_turning_shape_from_another_mode():
    """Two modes turn by 50 degrees a step while their frequencies stay: one step alone leads to the other mode."""

    def turning(x: float) -> np.ndarray:
        cos, sin = np.cos(8.73 * x), np.sin(8.73 * x)
        turn = np.array([[cos, -sin], [sin, cos]])
        return turn @ np.diag([10.0, 11.0]) @ turn.T

    found, blind = followed(turning, EVEN, 0), followed(turning, EVEN, 0, most=0)
    assert found.inserted > 0
    assert (found.number == 0).all()
    assert (blind.number[1:] != 0).any()
    assert found.veering.all()  # the shapes at two neighbours are not half alike
    assert not found.behind.any()  # but the way is sure
    assert blind.behind.any()


def test_a_mode_in_the_midst_of_an_exchange_is_marked():
    """An exchange between two poses is followed by poses between them; one at a pose, without these, is passed over."""
    x = np.linspace(-1.0, 1.0, 14)
    between = followed(crossing(0.05), x, 0)
    assert between.mac[7] < SAME
    assert np.flatnonzero(between.veering).tolist() == [6, 7]
    assert not between.behind.any()
    at = followed(crossing(0.01), np.insert(x, 7, 5e-3), 0, most=0)
    assert at.before[8] == 6
    assert at.number[-1] == 1
    assert np.flatnonzero(at.behind).tolist() == [7]
    assert at.veering[7]


def test_a_mode_that_leaves_the_first_ones_is_found_among_more():
    """One mode rises through eight others; only three are computed at first."""

    def rising(x: float) -> np.ndarray:
        return np.diag([9.0 + 10.0 * (x + 1.0), *np.arange(10.0, 26.0, 2.0)])

    x = np.linspace(-1.0, 1.0, 41)
    found = followed(rising, x, 0, computed=3)
    np.testing.assert_allclose(found.hertz**2, 9.0 + 10.0 * (x + 1.0), rtol=1e-12)
    assert found.number.max() > 3
    assert not found.veering.any()


def test_poses_that_no_neighbours_lead_to_are_reached():
    x = np.linspace(-1.0, 1.0, 21)
    poses = grid(x, 0.0, 0.0)
    modes = modes_of(crossing(0.5), x)
    hertz = modes.hertz.copy()
    hertz[9:12] = np.nan  # the platform cannot be held there
    between = InsertedPoses(poses.positions, lambda positions, count: modes_of(crossing(0.5), positions[:, 0]), 99)
    found = Following(ShapedModes(hertz, modes.shapes), poses.neighbours, between, 3).from_pose(0, 0)
    assert (np.flatnonzero(np.isnan(found.hertz)) == [9, 10, 11]).all()
    assert (found.number[9:12] == -1).all()
    assert (found.number[12:] >= 0).all()


def test_likeness_is_at_most_one_and_finds_the_mode_itself():
    modes = modes_of(crossing(0.3), EVEN)
    for number in range(3):
        match = matched(modes.shapes[:, number].astype(np.float32), modes)
        assert (match.number == number).all()
        np.testing.assert_allclose(match.mac, 1.0, atol=2e-3)  # half precision
        np.testing.assert_allclose(match.seen, 1.0, atol=4e-3)


def test_neighbours_are_the_next_poses_along_each_axis():
    poses = grid([0.0, 1.0, 3.0], [0.0, 2.0], [5.0, 6.0])
    for a, beside in enumerate(poses.neighbours):
        for direction, b in enumerate(beside.tolist()):
            axis, back = divmod(direction, 2)
            way = poses.positions[b] - poses.positions[a]
            if b >= 0:
                assert (np.flatnonzero(way) == [axis]).all()
                assert (way[axis] < 0.0) == bool(back)
                assert poses.neighbours[b, 2 * axis + 1 - back] == a
    assert (poses.neighbours >= 0).sum() == 2 * (2 * 4 + 1 * 6 + 1 * 6)


# Modes of robots.


@pytest.mark.parametrize("name", ["thesis-3-1", "thesis-3-1-8mm", "cogiro", "thesis-5"])
def test_both_solvers_give_the_same_shapes(name, monkeypatch):
    robot = load_robot(name)
    positions = robot.home.position + np.random.default_rng(2).uniform(-1.0, 1.0, (5, 3)) * [1.2, 1.0, 0.3]
    ours, _ = shaped_modes(robot, positions, LEVEL, 8, 4)
    monkeypatch.setattr(module, "fits", lambda point: np.zeros(len(point.position), dtype=bool))
    theirs, _ = shaped_modes(robot, positions, LEVEL, 8, 4)
    np.testing.assert_allclose(ours.hertz, theirs.hertz, rtol=2e-7)
    product = np.einsum("nkd,nkd->nk", ours.shapes.astype(float), theirs.shapes.astype(float))
    apart = np.abs(np.diff(theirs.hertz, axis=1)) > 1e-3 * theirs.hertz[:, 1:]
    single = np.pad(apart, ((0, 0), (1, 0)), constant_values=True) & np.pad(apart, ((0, 0), (0, 1)))
    assert single.sum() > 10
    assert (product[single] ** 2 > 0.99).all()
    own = np.einsum("nid,njd->nij", ours.shapes.astype(float), ours.shapes.astype(float))
    assert np.abs(own - np.eye(8)).max() < 0.12  # the mass beyond four harmonics is left out


@pytest.mark.parametrize("number", [1, 2])
def test_where_symmetry_lets_modes_cross_the_followed_frequency_is_smooth(number):
    """Along x in a plane of symmetry modes of different symmetry cross; the one of fixed order has a kink there."""
    bend, kink = [], []
    for count in (31, 61):
        poses = grid(np.linspace(0.5, 1.0, count), 0.0, 2.5)
        found = columns_of("thesis-5", f"mode-{number}", poses)
        ordered = columns_of("thesis-5", "frequencies", poses)[f"f{number}_Hz"]
        assert np.unique(found["mode_number"]).size == 2
        assert not found["veering"].any()
        bend.append(np.abs(np.diff(found["mode_Hz"], 2)).max())
        kink.append(np.abs(np.diff(ordered, 2)).max())
    assert bend[1] < 0.3 * bend[0]  # as the square of the step
    assert kink[1] > 0.4 * kink[0]  # as the step
    assert bend[1] < 0.5 * kink[1]


def test_no_step_is_left_without_a_mark():
    """Between neighbours that are not both marked the mode is the same: shapes computed afresh are half alike, and the
    frequency's step halves with the grid's, as its slope says. Marked steps do not."""
    largest, worst = [], []
    for count in (17, 33):
        poses, found = mapped("cogiro", 3, 2.0, count, 1.0)
        pairs = unmarked(poses, found["veering"])
        most = int(found["mode_number"].max())
        fresh, _ = shaped_modes(load_robot("cogiro"), poses.positions, LEVEL, most, 4)
        row = np.arange(poses.size)
        np.testing.assert_allclose(fresh.hertz[row, found["mode_number"] - 1], found["mode_Hz"], rtol=1e-6)
        shape = fresh.shapes[row, found["mode_number"] - 1].astype(float)
        single = np.isclose(found["mode_Hz"][:, None], fresh.hertz, rtol=1e-3).sum(axis=1) == 1
        pairs_single = pairs[single[pairs].all(axis=1)]
        assert len(pairs_single) > 0.8 * len(pairs)
        assert ((shape[pairs_single[:, 0]] * shape[pairs_single[:, 1]]).sum(axis=1) ** 2 > SAME - 0.01).all()
        largest.append(change(found["mode_Hz"], pairs).max())
        worst.append(change(found["mode_Hz"], steps(poses)).max())
    assert largest[1] < 0.6 * largest[0]
    assert worst[1] > 4.0 * largest[1]


def test_a_finer_line_agrees_with_a_coarse_one():
    for number in (1, 2, 4):
        line = [grid(np.linspace(0.02, 1.0, count), 0.0, 2.5) for count in (21, 41)]
        coarse, fine = (columns_of("thesis-5", f"mode-{number}", poses) for poses in line)
        assert not coarse["veering"].any()
        np.testing.assert_allclose(coarse["mode_Hz"], fine["mode_Hz"][::2], rtol=1e-9)


def test_a_closed_loop_without_marks_comes_back_to_the_same_mode():
    robot, count = load_robot("cogiro"), 8
    angle = np.linspace(0.0, 2.0 * np.pi, 61)
    loop = np.stack([1.2 + 0.6 * np.cos(angle), 0.4 + 0.6 * np.sin(angle), np.ones(61)], axis=1)
    modes, _ = shaped_modes(robot, loop, LEVEL, count, 4)
    beside = np.full((61, 6), -1)
    beside[:-1, 0], beside[1:, 1] = np.arange(1, 61), np.arange(60)
    returned, crossed = 0, 0
    for number in range(6):
        between = InsertedPoses(loop, lambda p, k: shaped_modes(robot, p, LEVEL, k, 4)[0], 300)
        found = Following(modes, beside, between, 16).from_pose(0, number)
        assert (found.before[1:] >= 0).all()
        if not found.veering.any():
            assert found.number[-1] == number
            assert found.hertz[-1] == pytest.approx(found.hertz[0], rel=1e-9)
            returned += 1
            crossed += np.unique(found.number).size > 1
        else:
            assert found.number[-1] != number  # the twin: around poses at which two modes coincide, one is exchanged
    assert (returned, crossed) == (5, 2)


def test_the_reference_is_the_pose_next_to_home_at_which_the_mode_is_single():
    poses, found = mapped("thesis-3-1", 1, 1.0, 5, 0.5)
    start = np.flatnonzero(found["followed_from"] == 0)
    np.testing.assert_allclose(poses.positions[start], [[0.0, 0.0, 0.5]], atol=1e-12)
    robot, line = load_robot("thesis-3-1"), grid(np.linspace(-0.2, 0.2, 5), 0.0, 0.5)
    hertz = np.tile([2.0, 3.0, 4.0], (5, 1))
    hertz[2] = [2.0, 3.0, 3.0 + 1e-5]
    assert reference(robot, line, hertz, 0) == 2
    assert reference(robot, line, hertz, 1) in (1, 3)
    hertz[3] = np.nan
    assert reference(robot, line, hertz, 1) == 1
    hertz[:] = np.nan
    assert reference(robot, line, hertz, 1) == -1
    away = grid(np.linspace(1.0, 2.0, 5), 0.0, 0.5)  # home lies outside
    assert np.flatnonzero(columns_of("thesis-3-1", "mode-1", away)["followed_from"] == 0).tolist() == [2]


def test_the_platform_frequency_does_not_step_without_a_mark():
    """The line on which the share alone let steps of 5.7 % pass unmarked; and a grid three times as fine."""
    largest = []
    for count in (13, 37):
        poses = grid(np.linspace(-3.0, 3.0, count), 0.3, 1.0)
        found = columns_of("cogiro", "first-platform-frequency", poses)
        largest.append(change(found["platform_Hz"], unmarked(poses, found["veering"])).max())
        halved = found["platform_share"] < 0.5
        assert found["veering"][halved].all()
        if count == 13:
            held = change(found["platform_Hz"], unmarked(poses, halved))
            assert held.max() > 0.05
            assert largest[0] < 0.02
    assert largest[1] < 0.5 * largest[0]


def test_neighbours_are_told_apart_in_any_direction():
    shapes = np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 1.0]], dtype=np.float16)
    line, there = grid(np.arange(4.0), 0.0, 0.0), np.ones(4, dtype=bool)
    assert unlike_neighbours(shapes, there, line.neighbours).tolist() == [False, True, True, False]
    assert not unlike_neighbours(shapes, np.array([True, True, False, True]), line.neighbours).any()


def test_what_a_pose_takes_is_what_its_records_are():
    robot, own = load_robot("thesis-3-1"), ModeMap(3)
    columns = own.evaluate(robot, robot.home.position[None] + [[0.3, 0.2, 0.0]], LEVEL)
    assert sum(values.itemsize for values in columns.values() if values.dtype.names) * own.most_poses(robot) <= 2**29
    assert own.most_poses(robot) > 200_000
