"""The fast path on frame ends that give way: pulleys with any axis, and what is elastic in line."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.dynamics.batched_modes import Batch, first_mode, fits, lowest_modes
from cdpr_struct.dynamics.cable_dynamics import expand_catenaries_at
from cdpr_struct.dynamics.cable_freedoms import CableFreedoms
from cdpr_struct.dynamics.cables_of_poses import HangingCables
from cdpr_struct.dynamics.condensed_cables import condensed
from cdpr_struct.dynamics.condensed_robot import pencil
from cdpr_struct.dynamics.frame_springs import FrameSprings, softened
from cdpr_struct.dynamics.lowest_clamped import lowest_clamped
from cdpr_struct.dynamics.string_functions import string_functions
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_response import end_stiffness
from cdpr_struct.workspace import vibration
from cdpr_struct.workspace.vibration import SHARE, first_frequencies
from tests.laws.fast_mode_cases import (
    FIRST,
    LEVEL,
    MANY,
    at_rest,
    certified_squared,
    compare,
    largest_error,
    near_home,
    on_pulleys,
    with_extensions,
)

ENDS = {
    "in line": {"axes": "none", "line": True},
    "upright": {"axes": "upright"},
    "level": {"axes": "level"},
    "oblique": {"axes": "oblique"},
    "oblique and in line": {"axes": "oblique", "line": True},
}

IN_LINE = (((0, 1), (0,)), ((2,), ()))


def robot_with(ends: str, name: str = "thesis-3-1"):
    return on_pulleys(np.random.default_rng(4), load_robot(name), **ENDS[ends])


@pytest.mark.parametrize("ends", ENDS)
def test_random_robots_agree_with_certified_modes(ends):
    found = compare(7, 2, 2, lambda rng, robot: on_pulleys(rng, robot, **ENDS[ends]))
    assert found["stable"] >= 2
    assert found["error"] < FIRST
    assert found["many_error"] < MANY
    assert found["missed"] == 0
    assert found["proved"] > 0.95


@pytest.mark.slow
@pytest.mark.parametrize("ends", ENDS)
def test_random_robots_agree_with_certified_modes_at_hundreds_of_poses(ends):
    found = compare(8, 20, 8, lambda rng, robot: on_pulleys(rng, robot, **ENDS[ends]))
    print(ends, found)
    assert found["error"] < FIRST
    assert found["many_error"] < MANY
    assert found["missed"] == 0
    assert found["proved"] > 0.95


@pytest.mark.parametrize("given", [{"series_compliance": 2e-5}, {"radius": 0.05}])
def test_frame_ends_two_percent_softer_are_told_apart(given):
    """The twin of the test above."""

    def robot(factor):
        if "radius" in given:
            return replace(load_robot("thesis-3-1"), pulleys=(Pulley(factor * given["radius"]),) * 8)
        return with_extensions(series_compliance=factor * given["series_compliance"])

    positions = near_home(robot(1.0), 2)
    exact = certified_squared(at_rest(robot(1.0), positions), 12)
    ours = Batch.of(at_rest(robot(1.02), positions))
    assert largest_error(lowest_modes(ours, 12).squared, exact) > 1e3 * MANY


def test_one_pulley_and_stiff_ends_beside_fixed_points():
    """A frame end that hardly gives way is a fixed point."""
    plain = load_robot("thesis-3-1")
    positions = near_home(plain, 3)
    exact = first_mode(Batch.of(at_rest(plain, positions))).squared
    tiny = replace(with_extensions(series_compliance=1e-12), pulleys=(Pulley(1e-9),) * 4 + (None,) * 4)
    assert largest_error(first_mode(Batch.of(at_rest(tiny, positions))).squared, exact) < FIRST
    one = at_rest(replace(plain, pulleys=(Pulley(0.1, np.array([1.0, 0.0, 0.5])),) + (None,) * 7), positions)
    assert fits(one).all()
    assert largest_error(first_mode(Batch.of(one)).squared, certified_squared(one, 1)[:, 0]) < FIRST


@pytest.mark.parametrize("ends", ["in line", "oblique"])
@pytest.mark.parametrize("share", [0.3, 1.0, 1.7])
def test_a_shift_encloses_every_frequency_below_the_eliminated_ones(ends, share):
    robot = robot_with(ends)
    point = at_rest(robot, near_home(robot, 3))
    exact, batch = certified_squared(point, 12), Batch.of(point)
    shift = share * batch.lowest_string
    own = condensed(batch.cables, shift, batch.functions(12), 1)
    small = pencil(batch.platform, own, shift)
    squared = small.squared[:, :12]
    below = exact < 0.8 * own.lowest[:, None]
    assert below[:, :6].all()
    assert (exact <= squared * (1.0 + 3e-9)).all()  # a certified frequency lies anywhere in its bracket
    assert (small.enclosed(squared) <= exact * (1.0 + 3e-9))[below].all()
    overstated = replace(small, lowest=1e6 * small.lowest)  # twin
    assert not (overstated.enclosed(squared) <= exact * (1.0 + 3e-9))[below].all()


@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize("leads", [1, 3])
def test_eliminated_motions_have_no_frequency_below_the_bound(ends, leads):
    """The bound against the eliminated block's own eigenvalues, which it comes near."""
    robot = robot_with(ends, "thesis-3-1-8mm")
    cables = Batch.of(at_rest(robot, near_home(robot, 4))).cables
    functions = string_functions(12, True)
    blocks = [(functions.pairs @ d.reshape(len(d), -1)).reshape((-1, *cables.length.shape))
              for d in cables.densities(functions.nodes)]  # fmt: skip
    lowest = []
    for axes, springs in cables.groups:
        freedoms = CableFreedoms.of(axes, springs, functions, leads)
        matrix = freedoms.stiffness(blocks, functions, cables)[: freedoms.eliminated, : freedoms.eliminated]
        assert (freedoms.mass[: freedoms.eliminated, : freedoms.eliminated] - np.eye(freedoms.eliminated) < 1e-12).all()
        lowest.append(np.linalg.eigvalsh(np.moveaxis(matrix, (0, 1), (-2, -1)), UPLO="U")[..., 0])
    true = np.min(lowest, axis=0) / cables.per_squared
    bound = condensed(cables, 0.0 * true, functions, leads).of_cables
    assert (bound <= true).all()
    assert (bound / true).min() > 0.85


def test_a_string_on_a_spring_is_never_softer_than_said():
    functions, rng = string_functions(9, True), np.random.default_rng(0)
    for leads in (0, 1, 3):
        uniform = functions.uniform[leads:-1, leads:-1]
        springs = 10.0 ** rng.uniform(-4.0, 8.0, 60)
        for spring, said in zip(springs, softened(springs, 9, leads), strict=True):
            matrix = uniform.copy()
            matrix[-1, -1] += spring * functions.frame_value**2
            true = np.linalg.eigvalsh(matrix)[0]
            assert true * (1.0 - 1e-3) <= said <= true * (1.0 + 1e-12)
    assert softened(np.array([np.inf]), 9, 0)[0] == pytest.approx(0.25 * np.pi**2, rel=1e-6)
    assert softened(np.array([0.0]), 9, 0)[0] == pytest.approx(np.pi**2 / 16.0, rel=1e-6)


def test_springs_along_the_axes_store_no_more_energy():
    rng = np.random.default_rng(1)
    directions = np.linalg.qr(rng.normal(size=(40, 3, 3)))[0][..., :2]
    stiffness = 10.0 ** rng.uniform(0.0, 6.0, (40, 2))
    springs = FrameSprings(np.moveaxis(directions, 0, -1)[:, :, None], stiffness.T[:, None], (((0, 1, 2), (0, 1)),))
    give = (directions / stiffness[:, None, :]) @ np.swapaxes(directions, 1, 2)
    for axes, own in zip(np.moveaxis(springs.along_axes[:, 0], -1, 0), give, strict=True):
        assert np.linalg.eigvalsh(np.diag(1.0 / axes) - own)[0] >= -1e-12 * np.abs(own).max()
    largest = np.linalg.eigvalsh(give[:, 1:, 1:])[:, -1]  # across the chord, in any direction
    np.testing.assert_allclose(springs.give_across[0], largest, rtol=1e-12)


@pytest.mark.parametrize("ends", ENDS)
def test_lowest_frequency_of_a_clamped_cable(ends):
    """All the modes of the expansion; with fixed frame ends it would lie higher."""
    robot = robot_with(ends, "thesis-3-1-8mm")
    point = at_rest(robot, near_home(robot, 4))
    batch = Batch.of(point)
    exact = expand_catenaries_at(point, 24).omega_squared[..., 0].T
    lowest = lowest_clamped(batch.cables, batch.order)
    np.testing.assert_allclose(lowest, exact, rtol=5e-9)  # measured 1.6e-9: leaning directions count as orthonormal
    fixed = lowest_clamped(replace(batch.cables, frame=None), batch.order)
    assert (fixed >= exact * (1.0 - 1e-9)).all()
    if ends != "in line":
        assert (fixed > 1.001 * exact).any()


def test_a_clamped_cable_on_a_level_wheel_swings_in_its_plane():
    """Held more firmly across its plane than in it."""
    cable = HangingCables(*(np.full((1, 1), value) for value in (300.0, 5.0, 6.0, 0.8, 4e5, 0.08)))
    springs = np.array([1e9, 500.0])[:, None, None]
    lowest = {}
    for name, across in (("out of plane", [0.0, 0.0, 1.0]), ("in plane", [0.0, 1.0, 0.0])):
        directions = np.array([[1.0, 0.0, 0.0], across]).T[:, :, None, None]
        held = replace(cable, frame=FrameSprings(directions, springs, (((0, 1, 2), (0, 1)),)))
        lowest[name] = float(lowest_clamped(held, 12)[0, 0])
    fixed = float(lowest_clamped(cable, 12)[0, 0])
    assert lowest["out of plane"] < 0.85 * fixed
    assert lowest["out of plane"] < lowest["in plane"] < 0.95 * fixed


def test_what_is_not_known_to_be_the_lowest_is_not_said():
    """A cable so slack that the bound on the eliminated motions fails."""
    cable = HangingCables(*(np.full((1, 1), value) for value in (60.0, 5.0, 6.0, 30.0, 4e5, 3.0)))
    held = replace(cable, frame=FrameSprings(np.eye(3)[:, :1, None, None], np.full((1, 1, 1), 1e5), IN_LINE))
    assert np.isnan(lowest_clamped(held, 12)).all()


def test_the_stiffness_of_vibration_is_symmetric():
    """What statics leaves out on the wheel would make it depend on the triangle that is read."""
    robot = replace(load_robot("thesis-3-1-8mm"), pulleys=(Pulley(0.3, np.array([1.0, 0.3, 0.2])),) * 8)
    point = at_rest(robot, near_home(robot, 3))
    ours, statics = point.end_stiffness, end_stiffness(point.arrays, point.cables)
    assert (ours == np.swapaxes(ours, -1, -2)).all()
    rolling = (point.arrays.weight * point.arrays.pulley_radius).max()
    assert 0.0 < np.abs(ours - statics).max() < rolling


@pytest.mark.parametrize("ends", ["in line", "upright", "oblique and in line"])
def test_columns_of_a_map_are_those_of_the_general_solver(ends, monkeypatch):
    robot = robot_with(ends)
    positions = near_home(robot, 4)
    ours = first_frequencies(robot, positions, LEVEL)
    monkeypatch.setattr(vibration, "fits", lambda point: np.zeros(len(point.position), dtype=bool))
    theirs = first_frequencies(robot, positions, LEVEL)
    assert ours.keys() == theirs.keys()
    for column, values in theirs.items():
        rounding = {"platform_Hz": MANY, SHARE: 1e-3}.get(column, FIRST)
        np.testing.assert_allclose(ours[column], values, rtol=rounding)


@pytest.mark.parametrize("ends", ["upright", "oblique and in line"])
def test_a_mapped_pose_does_not_depend_on_its_company(ends):
    robot = robot_with(ends)
    positions = near_home(robot, 8)
    whole = first_frequencies(robot, positions, LEVEL)
    for part in (slice(0, 1), slice(5, 8)):
        alone = first_frequencies(robot, positions[part], LEVEL)
        for name, rounding in (("first_Hz", 1e-12), ("cable_1_Hz", 1e-10), ("platform_Hz", 1e-9)):
            np.testing.assert_allclose(alone[name], whole[name][part], rtol=rounding)
