"""Slack cables, and the lower bound that cures them."""

import numpy as np
import pytest

from cdpr_struct.crosscheck.robot_modes import robot_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import platform_static_stiffness
from cdpr_struct.errors import UnstableEquilibriumError
from cdpr_struct.reports.statics_map import map_json
from cdpr_struct.reports.statics_pose_error import pose_error_json
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.bound_advice import bound_hint, outside_limits, shared_cure, slack_warning
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.slack_cables import hangs_slack, slack_count, slack_sentence
from cdpr_struct.statics.sufficient_bound import (
    SufficientBound,
    rounded_up,
    shared_bound_of_pose_errors,
    shared_lower_bound,
    sufficient_lower_bound,
)
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.pose_error_map import PoseErrorMap
from cdpr_struct.workspace.quantities import evaluate
from cdpr_struct.workspace.vibration import first_frequencies

PRELOADED = load_robot("thesis-5")
BARE = PRELOADED.with_force_limits(0.0)
HOME = PRELOADED.home.position
LEVEL = np.eye(3)
GRID = Grid(np.linspace(-2.0, 2.0, 3), np.linspace(-1.5, 1.5, 3), np.array([2.5]), np.zeros(3))


def at_rest(robot, lower_bound=None) -> OperatingPoint:
    return OperatingPoint(robot, HOME, LEVEL, inverse(robot, HOME, LEVEL, lower_bound=lower_bound).cables)


@pytest.fixture
def flat(tmp_path):
    """Eight cables, four of them from below, and a centre of mass half a metre above their anchors: without preload the
    platform would roll over."""
    corners = [(-3, -2), (3, -2), (3, 2), (-3, 2)]
    rows = [f"[[cables]]\nplatform_anchor = [{x / 30}, {y / 20}, {z}]\nframe_anchor = [{x}, {y}, {h}]\n"
            for x, y in corners for z, h in ((-0.1, 3.0), (-0.1, 0.0))]  # fmt: skip
    text = (
        'name = "top-heavy"\n[platform]\nmass = 20.0\ncenter_of_mass = [0.0, 0.0, 0.5]\n'
        "inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n[cable]\naxial_stiffness = 1e5\nlinear_density = 0.05\n"
    )
    path = tmp_path / "robot.toml"
    path.write_text(text + "".join(rows))
    return load_robot(path)


@pytest.mark.parametrize(("share", "slack"), [(0.98, True), (1.02, False)])
def test_a_level_cable_by_hand(share, slack):
    """10 m of 0.12 kg/m weigh 11.8 N. A parabola of chord tension H sags by w l^2 / (8 H): an eighth of it at H = w l;
    the arc is longer by 8/3 (s / l)^2 = 4 %, and so is its weight."""
    robot = load_robot("thesis-5")
    arrays, points = RobotArrays.of(robot), robot.frame_anchors + np.array([10.0, 0.0, 0.0])
    weight = 0.12 * 9.81 * 10.0 * (1.0 + 8.0 / 3.0 / 64.0)
    states = cable_model("sagging").hold(arrays, points, np.full(8, share * weight)).states
    assert (hangs_slack(states) == slack).all()
    np.testing.assert_allclose(states.sag / 10.0, 0.125, rtol=0.08)
    assert slack_count(states, np.array(True)) == (8 if slack else 0)
    assert np.isnan(slack_count(states, np.array(False)))


def test_a_straight_cable_is_slack_where_it_does_not_pull():
    robot = load_robot("thesis-5")
    arrays, points = RobotArrays.of(robot), robot.frame_anchors + np.array([10.0, 0.0, 0.0])
    length = np.where(np.arange(8) < 4, 9.99, 10.01)
    assert hangs_slack(cable_model("spring").states(arrays, points, length)).tolist() == [False] * 4 + [True] * 4


def test_slack_cables_are_named():
    assert slack_sentence(np.zeros(8, dtype=bool)) is None
    one, three = np.arange(8) == 4, np.isin(np.arange(8), (0, 4, 7))
    assert slack_sentence(one) == "cable 5 hangs slack (it pulls with less than its own weight)"
    assert slack_sentence(three) == "cables 1, 5 and 8 hang slack (they pull with less than their own weight)"


@pytest.mark.parametrize(
    ("force", "wanted"), [(14.0, 14.0), (14.01, 15.0), (0.0993, 0.1), (99.2, 100.0), (101.0, 110.0), (3.05, 3.1)]
)
def test_bounds_are_rounded_up_to_two_digits(force, wanted):
    assert rounded_up(force) == wanted


def test_the_bound_that_cures_is_found_and_no_smaller_one_does():
    """thesis-5 without its limits: at home the lower cables weigh 11 N and hang 2 m below their upper ends."""
    bound = sufficient_lower_bound(BARE, HOME, LEVEL)
    assert not hangs_slack(at_rest(BARE, bound).cables).any()
    assert hangs_slack(at_rest(BARE, 0.85 * bound).cables).sum() == 4
    assert 11.0 < bound < 17.0
    warning = slack_warning(BARE, HOME, LEVEL, at_rest(BARE).cables)
    assert warning == (
        "cables 5, 6, 7 and 8 hang slack (they pull with less than their own weight); "
        f"with --lower-bound {bound:g} every cable is taut."
    )
    assert slack_warning(PRELOADED, HOME, LEVEL, at_rest(PRELOADED).cables) is None


def test_an_unstable_pose_is_told_its_bound(flat):
    """The plain answer is balanced and unstable; at the bound that the hint names there are modes."""
    place = np.array([0.0, 0.0, 1.5])
    held = inverse(flat, place, LEVEL)
    point = OperatingPoint(flat, place, LEVEL, held.cables)
    assert np.linalg.eigvalsh(platform_static_stiffness(point))[0] < 0.0
    with pytest.raises(UnstableEquilibriumError, match="the equilibrium is unstable"):
        robot_modes(point, "exact", 3, "consistent", 40)
    bound = sufficient_lower_bound(flat, place, LEVEL)
    hint = bound_hint(flat, place, LEVEL)
    assert (
        hint
        == f" With --lower-bound {bound:g} (or force_min in the robot file) the pose is stable and every cable is taut."
    )
    cured = inverse(flat, place, LEVEL, lower_bound=bound).cables
    assert robot_modes(OperatingPoint(flat, place, LEVEL, cured), "exact", 3, "consistent", 40).hertz[0] > 0.0


def test_the_search_works_where_the_plain_inverse_fails(monkeypatch):
    """Four iterations are too few without a bound, and enough with one."""
    monkeypatch.setattr("cdpr_struct.statics.holding_tensions.MAX_ITERATIONS", 4)
    assert not inverse(BARE, HOME, LEVEL, allow_unheld=True).held
    assert "--lower-bound" in bound_hint(BARE, HOME, LEVEL)


def test_where_nothing_cures_nothing_is_promised():
    suspended = load_robot("thesis-3-1")
    outside = [30.0, 0.0, 0.5]
    assert sufficient_lower_bound(suspended, outside, LEVEL) is None
    assert bound_hint(suspended, outside, LEVEL) == ""
    assert sufficient_lower_bound(BARE, HOME, LEVEL, upper=700.0) is None  # the upper cables need 740 N
    slack = at_rest(BARE).cables
    limited = BARE.with_force_limits(None, 755.0)  # enough without preload, not with it
    assert slack_warning(limited, HOME, LEVEL, slack).endswith("no lower bound of force makes every cable taut here.")


def test_one_bound_for_many_poses():
    shared = shared_lower_bound(BARE, GRID.positions, LEVEL)
    assert (shared.works, shared.tried) == (9, 9)
    found = inverse(BARE, GRID.positions, LEVEL, lower_bound=shared.bound)
    assert not hangs_slack(found.cables).any()
    with_one_outside = np.concatenate([GRID.positions, [[30.0, 0.0, 2.5]]])
    assert shared_lower_bound(BARE, with_one_outside, LEVEL).works == 9


@pytest.mark.parametrize(
    ("found", "poses", "words"),
    [
        (SufficientBound(14.0, 9, 9), 9, "with --lower-bound 14 every cable is taut there"),
        (SufficientBound(14.0, 64, 64), 90, "with --lower-bound 14 every cable is taut at all 64 tried"),
        (SufficientBound(14.0, 60, 64), 90, "with --lower-bound 14 every cable is taut at 60 of the 64 tried"),
        (SufficientBound(None, 0, 9), 9, "no lower bound of force makes every cable taut there"),
        (SufficientBound(None, 0, 64), 90, "no lower bound of force makes every cable taut at any of the 64 tried"),
    ],
)
def test_how_a_shared_cure_is_told(found, poses, words):
    assert shared_cure(found, poses) == words


@pytest.mark.parametrize("quantity", ["tension-min", "stiffness-min", "first-frequency"])
def test_a_map_counts_slack_cables_and_names_the_cure(quantity):
    slack = map_json(BARE, quantity, GRID, evaluate(quantity, BARE, GRID.positions, LEVEL))
    bound = shared_lower_bound(BARE, GRID.positions, LEVEL).bound
    assert slack["slack_poses"] == 9
    cure = (
        "Cables hang slack at 9 of 9 poses (they pull with less than their own weight); "
        f"with --lower-bound {bound:g} every cable is taut there."
    )
    deep = "Deep sag: at 9 of 9 poses a cable sags by a tenth of its chord or more, at most by 0.38 of it."
    assert slack["trust"].warnings == [cure, deep]
    cured = BARE.with_force_limits(bound)
    columns = evaluate(quantity, cured, GRID.positions, LEVEL)
    assert (columns["slack_cables"] == 0.0).all()
    taut = map_json(cured, quantity, GRID, columns)
    assert taut["slack_poses"] == 0
    assert [said for said in taut["trust"].warnings if not said.startswith("Deep sag")] == []


def test_slack_cables_are_counted_where_the_pose_is_held():
    columns = evaluate("tension-min", BARE, np.array([HOME, [30.0, 0.0, 2.5]]), LEVEL)
    assert columns["slack_cables"][0] == 4.0
    assert np.isnan(columns["slack_cables"][1])


def test_a_released_platform_with_slack_cables_is_told_its_bound():
    """A platform of 1 kg on 8 mm cables, which weigh more than it."""
    robot = load_robot("six-cable-8mm").with_load(mass=1.0)
    grid = Grid(np.array([-1.0, 1.0]), np.array([-0.5, 0.5]), np.array([1.5]), np.zeros(3))
    columns = evaluate("pose-error", robot, grid.positions, LEVEL)
    errors = PoseErrorMap(robot.name, 1.0, grid, columns)
    result = pose_error_json(errors, robot)
    assert result["slack_poses"] == int((columns["slack_cables"] > 0.0).sum()) > 0
    assert len(result["trust"].warnings) == 1
    assert "once the platform is let go" in result["trust"].warnings[0]


def test_bounds_for_released_platforms_are_tried_by_releasing_them():
    found = shared_bound_of_pose_errors(BARE, GRID.positions, LEVEL)
    assert (found.works, found.tried) == (9, 9)
    columns = evaluate("pose-error", BARE.with_force_limits(found.bound), GRID.positions, LEVEL)
    assert (columns["slack_cables"] == 0.0).all()


def test_the_first_frequency_of_the_preloaded_robot():
    """At home: 0.3904 Hz with slack lower cables, 1.1626 Hz with 60 N in them; the map has those of the modes."""
    for low, hertz in ((0.0, 0.3904), (60.0, 1.1626)):
        robot = PRELOADED.with_force_limits(low)
        mapped = first_frequencies(robot, HOME[None], LEVEL)["first_Hz"][0]
        assert mapped == pytest.approx(hertz, abs=5e-5)
        exact = robot_modes(at_rest(PRELOADED, low), "exact", 3, "consistent", 40).hertz[0]
        assert mapped == pytest.approx(exact, rel=1e-6)


def test_tensions_outside_the_limits_are_named():
    robot = PRELOADED.with_force_limits(60.0, 700.0)
    lines = outside_limits(robot, [12.0, 60.0, 60.0 - 1e-6, 700.0, 712.3, 200.0, 300.0, 400.0])
    assert lines == [
        "cable 1 pulls with 12 N, below its force_min of 60 N.",
        "cable 5 pulls with 712.3 N, above its force_max of 700 N.",
    ]
    assert outside_limits(BARE, np.zeros(8)) == []
