"""Workspaces: feasibility against a linear program, known volumes and their errors, requirements."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, Delaunay

import cdpr_struct as cs
from cdpr_struct.errors import InputError
from cdpr_struct.robot.robot import anchors_in_world
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.wrench_feasibility import wrench_feasibility
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.region import Region


def light(name: str, low: float, high: float) -> cs.Robot:
    """A robot on almost weightless, almost rigid cables."""
    robot = load_robot(name).with_force_limits(low, high)
    cables = tuple(replace(c, linear_density=1e-9, axial_stiffness=1e9) for c in robot.cables)
    return replace(robot, cables=cables, pulleys=())


def refined(inside, grid: Grid, times: int) -> Region:
    """The region in which `inside` (n, 3) -> (n,) bool holds."""
    region = Region(grid, inside(grid.positions))
    for _ in range(times):
        halved, holds, asked = region.next_grid()
        holds[asked] = inside(halved.positions[asked])
        region = Region(halved, holds, region)
    return region


def cube(count: int, size: float = 1.3) -> Grid:
    axis = np.linspace(-size, size, count)
    return Grid(axis, axis, axis, np.zeros(3))


@pytest.mark.parametrize("name", ["thesis-3-1", "thesis-5"])
def test_feasibility_is_that_of_a_linear_program(name):
    """Straight weightless cables: f within its limits and W f = - wrench is a linear program."""
    robot, rng = light(name, 1.0, 1500.0), np.random.default_rng(5)
    low, high = robot.frame_anchors.min(axis=0), robot.frame_anchors.max(axis=0)
    position = rng.uniform(0.8 * low, 0.8 * high, (40, 3))
    wrenches = np.concatenate([np.zeros((1, 6)), rng.normal(size=(3, 6)) * [150, 150, 150, 60, 60, 60]])
    found = wrench_feasibility(robot, position, np.eye(3), wrenches)
    points, arms = anchors_in_world(robot, position, np.broadcast_to(np.eye(3), (40, 3, 3)))
    pull = robot.frame_anchors - points
    pull /= np.linalg.norm(pull, axis=-1, keepdims=True)
    matrix = np.concatenate([pull, np.cross(arms, pull)], axis=-1)
    weight = np.array([0.0, 0.0, -robot.platform.mass * robot.gravity, 0.0, 0.0, 0.0])
    bounds = [(1.0, 1500.0)] * len(robot.cables)
    expected = np.array([
        [linprog(np.zeros(len(bounds)), A_eq=m.T, b_eq=-(weight + w), bounds=bounds).status == 0 for w in wrenches]
        for m in matrix
    ])  # fmt: skip
    assert expected.any()
    assert not expected.all()
    assert (found.feasible == expected).all()
    assert np.isnan(found.slack_margin[~expected.all(axis=1)]).all()
    assert (found.slack_margin[expected.all(axis=1)] >= 0.0).all()


def test_forces_at_their_limit_have_a_margin_of_zero_and_not_of_rounding():
    facade = Path(__file__).parents[2] / "examples" / "robots" / "facade" / "robot.toml"
    found = cs.map(facade, "-12:12:5,1,3:37:5", "slack-margin", lower_bound=400).frame()
    held = found["held"] == 1
    assert (found["slack_margin_N"][held] >= 0.0).all()
    assert (found["slack_margin_N"][held] == 0.0).sum() > 5


def test_volume_of_a_ball_converges():
    """Counted corners: the error falls faster than the spacing, and stays below the estimate."""
    region = refined(lambda p: np.linalg.norm(p, axis=1) <= 1.0, cube(9), 3)
    true = 4.0 / 3.0 * np.pi
    errors = [abs(level.volume - true) for level in region.levels]
    assert errors[-1] < 0.1 * errors[0]
    assert errors[-1] < 0.005 * true
    assert all(e <= level.error for e, level in zip(errors, region.levels, strict=True))
    assert region.inner <= true <= region.outer


def test_error_estimate_covers_boxes_and_tetrahedra():
    """Regions whose faces lie anywhere between poses: the estimate covers the error in at least 95 of 100."""
    rng, covered = np.random.default_rng(8), []
    for number in range(60):
        if number % 2:
            low, high = np.sort(rng.uniform(-1.2, 1.2, (2, 3)), axis=0)
            low, high = np.minimum(low, high - 0.5), high
            region = refined(lambda p, a=low, b=high: ((p >= a) & (p <= b)).all(axis=1), cube(9), 1)
            inside = np.clip(high, -1.3, 1.3) - np.clip(low, -1.3, 1.3)
            true = float(np.prod(inside))
        else:
            corners = rng.uniform(-1.25, 1.25, (4, 3))
            hull, cells = ConvexHull(corners), Delaunay(corners)
            region = refined(lambda p, c=cells: c.find_simplex(p) >= 0, cube(17), 1)
            true = hull.volume
        covered.append(abs(region.volume - true) <= region.error)
    assert np.mean(covered) >= 0.95


def test_refining_agrees_with_computing_every_pose():
    inside = lambda p: (np.linalg.norm(p, axis=1) <= 1.0) & (p[:, 0] <= 0.4)  # noqa: E731
    region = refined(inside, cube(13), 2)
    assert (region.holds == inside(region.grid.positions)).all()


def test_point_mass_workspace_is_the_hull_below_its_anchors():
    """A point on three straight weightless cables in one plane: the area below the anchors within the triangle."""
    anchors = np.array([[-3.0, -2.0, 4.0], [3.0, -2.0, 4.0], [0.0, 3.0, 4.0]])
    body = cs.Platform(10.0, np.zeros(3), np.eye(3))
    robot = cs.Robot(
        "point", body, (cs.Cable(1e9, 1e-9),) * 3, np.zeros((3, 3)), anchors, guided=("rx", "ry", "rz")
    )  # fmt: skip
    found = cs.map(robot, "-3.3:3.3:9,-2.3:3.3:9,1", "workspace", refine=2)
    area = 15.0
    space = found.answer["workspace"]
    assert abs(space["area"] - area) <= space["error"] < 0.1 * area
    assert abs(space["levels"][0]["area"] - area) > abs(space["area"] - area)


def test_requirements_name_what_rejects():
    asked = ["slack-margin>=150", "cable-distance>=0.4", "tilt<=1"]
    found = cs.map("thesis-3-1", "-4:4:7,-3:3:5,0.5:2.5:3", "workspace", require=asked, refine=0)
    table = found.frame()
    assert (table["holds"] == ((table["slack_margin_N"] >= 150) & (table["cable_distance_m"] >= 0.4))).all()
    assert set(table["rejected_by"]) >= {"", "slack-margin>=150", "cable-distance>=0.4"}
    told = {one["requirement"]: one for one in found.answer["rejections"]}
    assert told["cable-distance>=0.4"]["poses"] == (table["cable_distance_m"] < 0.4).sum()
    assert told["tilt<=1"]["poses"] == 0
    assert found.answer["hold_all"] == table["holds"].sum()


def test_wrenches_shrink_the_workspace():
    grid = "-4:4:7,-3:3:5,1.5"
    free = cs.map("thesis-3-1", grid, "workspace", upper_bound=420.0, refine=0)
    held = cs.map("thesis-3-1", grid, "workspace", upper_bound=420.0, wrenches="fx=-400:400,fy=-400:400", refine=0)
    assert held.answer["requirements"] == ["wrench-feasible"]
    assert len(held.answer["wrenches"]) == 4
    assert held.answer["workspace"]["area"] < free.answer["workspace"]["area"]


def test_freely_hanging_poses_are_judged_for_stability():
    found = cs.map("six-cable-4mm", "0:0.5:2,0,0.5", "tilt", free="rx,ry,rz")
    table = found.frame()
    assert table["stable"].any()
    assert "tability is judged" in found.warnings[0]
    largest = np.nanmax(table["tilt_deg"])
    assert found.answer["free"]["largest_tilt_deg"] == pytest.approx(largest, abs=1e-9)  # the same angles, rounded
    assert f"tilt up to {largest:.1f}°" in found.warnings[0]
    assert found.answer["unstable"] == (table["held"] & ~table["stable"].astype(bool)).sum()


@pytest.mark.parametrize("given", ["slack-margin>50", "nonsense>=1", "mode-3>=1", "slack-margin>=a"])
def test_a_requirement_that_is_none_is_refused(given):
    with pytest.raises(InputError, match="require"):
        cs.map("thesis-3-1", "-1:1:3,0,1", "workspace", require=[given])


@pytest.mark.parametrize("given", ["fx=1:0", "fq=0:1", "no-such-file.csv", "fx=0:1,fx=0:2", [[1.0, 2.0]]])
def test_wrenches_that_are_none_are_refused(given):
    with pytest.raises(InputError, match="wrenches"):
        cs.map("thesis-3-1", "-1:1:3,0,1", "workspace", wrenches=given)


def test_wrenches_of_a_file(tmp_path):
    (tmp_path / "w.csv").write_text("fx_N,mz_Nm\n10,1\n-10,2\n")
    found = cs.map("thesis-3-1", "-1:1:3,0,1", "slack-margin", wrenches=tmp_path / "w.csv")
    assert found.values["wrenches_held"].max() == 1.0
    (tmp_path / "w.csv").write_text("fx_N,mz\n10,1\n")
    with pytest.raises(InputError, match="mx_Nm"):
        cs.map("thesis-3-1", "-1:1:3,0,1", "slack-margin", wrenches=tmp_path / "w.csv")


def test_bodies_are_read_written_and_measured(tmp_path):
    plain = (tmp_path / "r.toml", "[[bodies]]\nname = 'post'\nfixed_to = 'frame'\nshape = 'cylinder'\n")
    robot = load_robot("thesis-3-1")
    text = cs.write_robot(robot, plain[0]).read_text()
    plain[0].write_text(text + plain[1] + "radius = 0.2\nlength = 6\ncenter = [-4, 3, 3]\nangles_deg = [0, 30, 0]\n")
    read = load_robot(plain[0])
    again = load_robot(cs.write_robot(read, tmp_path / "again.toml"))
    for name in ("size", "center", "rotation"):
        assert np.allclose(getattr(again.bodies[0], name), getattr(read.bodies[0], name), atol=1e-15)
    near = cs.map(read, "0:2:3,0,1", "body-distance")
    assert np.isfinite(near.values["body_distance_m"]).all()
    plain[0].write_text(text + plain[1] + "radius = 0.2\ncenter = [-4, 3, 3]\n")
    with pytest.raises(InputError, match=r"bodies\[1\].length"):
        load_robot(plain[0])
