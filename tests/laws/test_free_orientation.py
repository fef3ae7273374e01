"""Free angles: no moment is left about them, the referee rests at the same pose, and maps have them at every pose."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from scipy.optimize import minimize

import cdpr_struct as cs
from benchmarks.random_robots.drawing import drawn
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.errors import InputError, UnholdablePoseError
from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.pose import Pose, angles_from_rotation
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics import free_orientation
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.free_orientation import left_free
from tests.fast_like import fast_like, few_cables

ROBOTS = Path(__file__).parents[2] / "examples" / "robots"
PLACE = [60.0, -50.0, 145.0]


def moment_about(
    robot: cs.Robot, pose: Pose, tensions: np.ndarray, forces: np.ndarray, acceleration: npt.ArrayLike = (0.0, 0.0, 0.0)
) -> np.ndarray:
    """(3,) moments of cables (m, 3) [N] and of weight less mass times acceleration [m/s^2] about rx, ry, rz.

    Over arms times tensions; written down here.
    """
    _, ry, rz = pose.angles
    about_z = np.array([[np.cos(rz), -np.sin(rz), 0.0], [np.sin(rz), np.cos(rz), 0.0], [0.0, 0.0, 1.0]])
    about_y = np.array([[np.cos(ry), 0.0, np.sin(ry)], [0.0, 1.0, 0.0], [-np.sin(ry), 0.0, np.cos(ry)]])
    axes = np.array([about_z @ about_y[:, 0], about_z[:, 1], [0.0, 0.0, 1.0]])
    arms = robot.platform_anchors @ pose.rotation.T
    weight = -robot.platform.mass * (np.array([0.0, 0.0, robot.gravity]) + acceleration)
    moment = np.cross(arms, forces).sum(axis=0) + np.cross(pose.rotation @ robot.platform.center_of_mass, weight)
    return axes @ moment / (np.linalg.norm(arms, axis=1).mean() * tensions.sum())


@pytest.mark.parametrize(
    ("robot", "place", "free"),
    [
        (fast_like(), PLACE, "rx,ry,rz"),
        (few_cables(3), [0.5, 0.3, 0.4], "rx,ry,rz"),
        (few_cables(4), [0.5, 0.3, 0.4], "rx,ry"),
        (cs.load_robot("cogiro"), [1.0, 0.5, 1.0], "ry"),
        (cs.load_robot("thesis-5"), [1.0, 0.5, 2.0], "rx,ry"),  # three cables in their lower bound
        (few_cables(5), [0.5, 0.3, 0.4], "rx,ry,rz"),
    ],
)
def test_no_moment_is_left_and_the_referee_rests_there(robot, place, free):
    found = cs.inverse(robot, place, free=free)
    cables = found.solution.cables
    left = moment_about(robot, found.pose, found.solution.tensions, cables.force_on_platform)
    assert np.abs(left).max() <= 1e-9
    assert found.answer["stable"]
    assert np.abs(found.pose.angles).max() > np.radians(0.5)  # it does hang at a tilt
    coarse, fine = (solve_in_fem(found.point, elements) for elements in (16, 32))
    rest = (4.0 * fine.position - coarse.position) / 3.0
    turn = (4.0 * fine.rotation - coarse.rotation) / 3.0
    size = float(np.linalg.norm(robot.frame_anchors[0] - place))
    assert np.abs(rest - place).max() <= 2e-6 * size
    assert np.abs(turn - found.pose.rotation).max() <= 2e-5


def test_a_receiver_hangs_with_all_cables_tight_where_level_it_does_not_hold():
    robot = fast_like()
    with pytest.raises(UnholdablePoseError):
        cs.inverse(robot, PLACE)
    found = cs.modes(robot, PLACE, free="rx,ry,rz", count=1)
    rx, ry, _ = found.answer["free"]["orientation_deg"]
    assert [rx, ry] == pytest.approx([-7.3, -8.7], abs=0.5)
    assert found.answer["sagging_cables"] == []
    assert found.modes.hertz[0] == pytest.approx(0.14, abs=0.01)
    assert "were left free: the platform hangs at" in found.warnings[0]


def test_a_map_has_its_own_orientation_at_every_pose():
    robot, grid = fast_like(), "-80:80:3,-60:60:3,145"
    level = cs.map(robot, grid, "tension-max").answer["held"]
    found = cs.map(robot, grid, "tension-max", free="rx,ry,rz")
    assert (level, found.answer["held"]) == (1, 9)
    columns = found.values
    for row in (0, 5):
        one = cs.inverse(robot, found.grid.positions[row], free="rx,ry,rz")
        assert columns["rx_deg"][row] == pytest.approx(one.answer["free"]["orientation_deg"][0], abs=1e-7)
        assert columns["tension_max_N"][row] == pytest.approx(one.solution.tensions.max(), rel=1e-8)


def test_a_followed_mode_is_that_of_the_hanging_platform_also_at_inserted_poses():
    """Of two coarse steps: without inserted poses at their own orientations the modes' order would be lost."""
    found = cs.map("six-cable-4mm", "-1:1:3,0.2,0.5", "mode-3", free="rx,ry,rz").values
    assert found["rx_deg"].min() == pytest.approx(13.5, abs=1.0)
    assert found["rx_deg"].max() == pytest.approx(26.0, abs=0.1)
    for x, hertz, number in zip((-1.0, 0.0, 1.0), found["mode_Hz"], found["mode_number"], strict=True):
        own = cs.modes("six-cable-4mm", [x, 0.2, 0.5], free="rx,ry,rz", count=6).answer["frequencies_hz"]
        assert hertz == pytest.approx(own[number - 1], rel=1e-9)  # of Ritz against exact cables


def test_angles_that_few_cables_cannot_hold_are_free_too():
    assert left_free([False, True, False], 4).tolist() == [True, True, False]
    assert left_free([False, False, True], 3).all()
    with pytest.raises(ValueError, match="at least 3 are needed"):
        left_free([True, True, True], 2)
    found = cs.inverse(few_cables(4), [0.5, 0.3, 0.4], free="ry")
    assert found.answer["free"]["added"] == ["rx"]


def test_unusable_names_are_refused():
    for free in ("rx,rw", "", "all"):
        with pytest.raises(InputError, match="give some of rx,ry,rz"):
            cs.inverse("cogiro", free=free)


@pytest.mark.parametrize(("start", "free"), [((20, -10, 30), "rx,ry,rz"), ((10, 40, 9), "rx")])
def test_a_camera_on_cables_that_meet_in_its_origin_hangs_with_its_mass_below(start, free):
    found = cs.inverse(ROBOTS / "point-camera" / "robot.toml", [2, 1, 6, *start], free=free)
    below = found.pose.rotation @ [0.0, 0.0, -0.2]
    # A moment of 1e-11 m g r, r = 0.21 m, is left at an angle of as many rad.
    assert np.abs(below - [0.0, 0.0, -0.2]).max() <= 1e-11
    assert found.answer["residual_wrench"] == pytest.approx([0.0] * 6, abs=1e-8)
    level = cs.inverse(ROBOTS / "point-camera" / "robot.toml", [2, 1, 6])
    assert found.solution.tensions == pytest.approx(level.solution.tensions, rel=1e-9)  # they do not turn it


@pytest.mark.parametrize("start", [(0, 90, 0), (0, 89.9999999, 0), (15, 80, 12)])
def test_axes_of_rx_and_rz_that_meet_where_the_platform_hangs_do_no_harm(start):
    robot, quarter = fast_like(), Pose.from_degrees([0, 0, 0, 0, 90, 0]).rotation
    own = robot.platform
    turned = replace(own, center_of_mass=quarter.T @ own.center_of_mass, inertia=quarter.T @ own.inertia @ quarter)
    renamed = replace(robot, platform=turned, platform_anchors=robot.platform_anchors @ quarter)
    found = cs.inverse(renamed, [*PLACE, *start], free="rx,ry,rz")
    level = cs.inverse(robot, PLACE, free="rx,ry,rz")
    assert found.pose.rotation == pytest.approx(level.pose.rotation @ quarter, abs=1e-8)  # other axes, the same body
    assert found.solution.tensions == pytest.approx(level.solution.tensions, rel=1e-8)


def test_angles_of_a_rotation_give_it_back_where_axes_meet():
    other = Pose.from_degrees([0, 0, 0, 33, 44, 55]).rotation
    for ry in (90.0, -90.0, 90.0 - 1e-7, 89.0, 12.0):
        rounded = other @ Pose.from_degrees([0, 0, 0, 25, ry, -70]).rotation
        rotation = other.T @ rounded  # with the rounding of a product
        again = Pose(np.zeros(3), angles_from_rotation(rotation)).rotation
        assert np.abs(again - rotation).max() <= 1e-15  # rounding; rx alone is off by 1e-8 next to 90 degrees


def test_beside_a_guide_the_angle_that_it_leaves_may_be_free():
    robot = cs.load_robot(ROBOTS / "planar-four-cables" / "robot.toml")
    found = cs.inverse(robot, [0.3, 0.0, 0.2], free="ry")
    assert found.answer["free"]["added"] == []
    assert np.abs(found.pose.angles[1]) > np.radians(5.0)
    left = moment_about(robot, found.pose, found.solution.tensions, found.solution.cables.force_on_platform)
    assert np.abs(left).max() <= 1e-9
    mapped = cs.map(robot, "0.3,0,0.2", "tension-max", free="ry").frame()
    assert mapped["ry_deg"][0] == pytest.approx(np.degrees(found.pose.angles[1]), abs=1e-9)


def test_angles_that_a_guide_holds_or_couples_are_refused():
    robot = cs.load_robot(ROBOTS / "planar-four-cables" / "robot.toml")
    with pytest.raises(InputError, match="leave out rx: a guide of planar-four-cables holds it"):
        cs.inverse(robot, free="rx,ry")
    with pytest.raises(InputError, match="beside guided rotations only the last one can be free"):
        cs.inverse(robot, [0.0, 0.0, 0.0, 0.0, 0.0, 5.0], free="ry")
    assert left_free([False] * 3, 2, [0, 1, 0, 1, 0, 1]).tolist() == [False, True, False]


def test_angles_are_told_without_their_rounding():
    told = cs.inverse(ROBOTS / "zero-gravity" / "robot.toml", [0.1, 0.0, 0.1], free="rx,ry,rz").warnings
    assert "the platform hangs at (0, -5.78, 0)° about x, y, z." in told[0]


@pytest.mark.parametrize("count", [3, 5])
def test_a_reference_that_hangs_on_ideal_cables_is_met_by_stiff_weightless_ones(count):
    """Held at another orientation, the platform would turn once it is let go: the reference is where it does not."""
    robot = few_cables(count)
    stiff = replace(robot, cables=(Cable(2e12, 1e-9),) * count)
    found = cs.pose_error(stiff, "0.2:0.5:2,0.3,0.4", free="rx,ry,rz")
    columns = found.columns()
    assert columns["held"].all()
    assert columns["stable"].all()
    missed = np.array([columns[f"global_{axis}_mm"] for axis in "xyz"])
    turned = np.array([columns[f"global_r{axis}_deg"] for axis in "xyz"])
    # stretch of 200 N on 2e12 N over 5 m: 5e-7 mm; the search for the reference ends at 1e-11 of its moments
    assert np.abs(missed).max() <= 1e-5
    assert np.abs(turned).max() <= 1e-5
    assert any("hang on straight, inextensible cables" in warning for warning in found.warnings)
    mapped = cs.map(stiff, "0.2:0.5:2,0.3,0.4", "pose-error", free="rx,ry,rz")
    assert mapped.values["rx_deg"] == pytest.approx(columns["rx_deg"], abs=1e-9)


def test_free_angles_of_pose_errors_need_a_grid():
    with pytest.raises(InputError, match="errors over a `grid`"):
        cs.pose_error("cogiro", sufficient_load=1.0, free="rx")


def test_an_audit_over_a_grid_finds_every_pose_as_an_audit_of_that_pose():
    robot = fast_like()
    found = cs.audit(robot, grid="-80:80:2,60,145", free="rx,ry,rz")
    alone = cs.audit(robot, [80.0, 60.0, 145.0], free="rx,ry,rz")
    assert found.answer["poses_held"] == 2
    assert found.audit.rotation[1] == pytest.approx(alone.audit.rotation[0], abs=1e-9)
    assert found.audit.tension[1] == pytest.approx(alone.audit.tension[0], rel=1e-8)


def test_along_a_trajectory_the_platform_hangs_along_the_apparent_gravity():
    robot, way = fast_like(), "line:10,0,145:60,-50,150:40"
    found = cs.distribute(robot, way, instants=11, b=0.3, free="rx,ry,rz")
    forces, path = found.found[0], found.found[0].trajectory
    assert path.acceleration_size.max() > 0.2  # a fiftieth of gravity
    for i in (1, 4, 8):
        pose = Pose(path.position[i], angles_from_rotation(path.rotation[i]))
        cables = forces.distribution.cables.at(i)
        pull = cables.force_on_platform, path.acceleration[i]
        left = moment_about(robot, pose, forces.distribution.tensions[i], *pull)
        assert np.abs(left).max() <= 1e-8  # orientations settle to 1e-10 rad
    told = found.answer["free"]
    assert told["angles"] == ["rx", "ry", "rz"]
    righting = robot.platform.mass * robot.gravity * 3.5  # by the lever of the centre of mass [N m]
    assert 0.0 < told["left_out_Nm"] < 1e-3 * righting  # what is left out would tilt it by less than a milliradian
    with pytest.raises(InputError, match="six cables or more"):
        cs.distribute(few_cables(4), "line:0,0,0:0.1,0,0:5", free="rx")


def test_the_most_even_tensions_are_met_by_a_search_without_derivatives():
    robot, place = cs.load_robot("six-cable-4mm"), [0.5, 0.3, 0.5]
    found = cs.inverse(robot, place, orient="even")

    def spread(angles: np.ndarray) -> float:
        tensions = cs.inverse(robot, Pose(np.array(place), angles)).solution.tensions
        return float(tensions.std() / tensions.mean())

    told = found.answer["free"]["tension_spread"]
    assert told == pytest.approx(spread(found.pose.angles), rel=1e-9)
    best = minimize(spread, found.pose.angles + 0.02, method="Nelder-Mead", options={"xatol": 1e-7, "fatol": 1e-12})
    assert told == pytest.approx(best.fun, abs=1e-9)
    assert found.pose.angles == pytest.approx(best.x, abs=1e-5)
    hanging = cs.inverse(robot, place, free="rx,ry,rz").solution.tensions
    assert told < hanging.std() / hanging.mean()
    with pytest.raises(InputError, match="six cables or more"):
        cs.inverse(few_cables(4), place, orient="even")
    with pytest.raises(InputError, match="give `free`, too"):
        cs.inverse(robot, place, orient="hanging")


def found_from(robot: cs.Robot, angles: np.ndarray, monkeypatch: pytest.MonkeyPatch, lost: int) -> bool:
    """Whether a search from `angles` finds the platform hanging if its first `lost` starts lead nowhere."""
    newton, begun = free_orientation.newton, []

    def failing(problem, ends):
        begun.append(ends.angles[0])
        return ends if len(begun) <= lost else newton(problem, ends)

    monkeypatch.setattr(free_orientation, "newton", failing)
    place = robot.home.position[None]
    return bool(free_orientation.free_orientation(robot, place, angles, [True, True, False]).found[0])


def test_a_single_pose_is_begun_again_level_and_from_all_around_its_angles(monkeypatch):
    robot, angles = cs.load_robot("cogiro"), np.array([0.05, -0.1, 0.0])
    assert found_from(robot, angles, monkeypatch, 2)  # the angles given, level ones
    assert not found_from(robot, angles, monkeypatch, 3)  # and all around


@pytest.mark.parametrize(("seed", "turned"), [(12, 46.0), pytest.param(111, 53.0, marks=pytest.mark.slow)])
def test_a_platform_that_hangs_far_from_the_angles_given_is_found_and_told(seed, turned):
    # an own search from a grid of 36 orientations finds them, too; before, both were refused
    case = drawn(seed)
    found = cs.inverse(case.robot, case.pose, free=case.free)
    forces, tensions = found.solution.cables.force_on_platform, found.solution.tensions
    assert np.abs(moment_about(case.robot, found.pose, tensions, forces)[:2]).max() <= 1e-9  # about rx, ry
    assert found.answer["free"]["turned_deg"] == pytest.approx(turned, abs=4.0)
    assert "from the angles given, near which none was found" in " ".join(found.warnings)


def test_an_end_that_tensions_carry_is_never_given_up_for_one_that_they_do_not():
    robot = cs.load_robot("cogiro")
    arrays = RobotArrays.of(robot).flattened((1,))
    bounds = np.zeros((1, 8)), np.full((1, 8), np.inf)
    free = np.array([True, True, True])
    place, none = robot.home.position[None], np.zeros((1, 6))
    problem = free_orientation.HangingProblem(arrays, cable_model("sagging"), place, none, bounds, free)
    held, far = problem.at(np.array([[0.1, 0.0, 0.0]])), replace(problem, position=place + np.array([0.0, 0.0, 50.0]))
    assert held.carried[0]
    assert held.size[0] > 1e-3  # far from hanging freely
    assert not far.at(np.zeros((1, 3))).carried[0]  # high above all winches
    free_orientation._begun_again(far, held, np.zeros(1, dtype=int), np.zeros((1, 3)))
    assert held.carried[0]
