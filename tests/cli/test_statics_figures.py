"""Maps as figures: what is hatched, what is marked, and which grids can be drawn."""

import numpy as np
import pytest

from cdpr_struct.reports.figures.frame_plan import FramePlan
from cdpr_struct.reports.figures.pose_error import draw_pose_error, pose_error_caption, pose_error_size
from cdpr_struct.reports.figures.style import svg
from cdpr_struct.reports.figures.workspace_map import OTHER, UNHELD, Layer, draw_map
from cdpr_struct.reports.statics_map import map_files, map_json
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.pose_error_map import PARTS, PoseErrorMap


def grid(nx=5, ny=4, nz=1) -> Grid:
    return Grid(np.arange(nx) * 1.0, np.arange(ny) * 0.5, np.arange(nz) * 1.0, np.zeros(3))


def error_map(unheld=(), other=(), shape=(5, 4, 1)) -> PoseErrorMap:
    over = grid(*shape)
    columns = {f"{part}_z_mm": np.linspace(-1.0, 2.0, over.size) for part in PARTS}
    flags = {name: np.full(over.size, name != "more_stable_pose") for name in ("held", "stable", "more_stable_pose")}
    flags["held"][list(unheld)] = False
    flags["more_stable_pose"][list(other)] = True
    return PoseErrorMap("robot", 30.0, over, columns | flags)


@pytest.mark.parametrize(("unheld", "other"), [((), ()), ((3,), ()), ((), (5, 6)), ((3,), (3, 5))])
def test_hatching_and_marks_appear_when_there_is_something_to_show(unheld, other):
    errors = error_map(unheld, other)
    picture = svg("test", pose_error_size(errors), lambda f: draw_pose_error(f, errors))
    assert (UNHELD in picture) is bool(unheld)
    assert (OTHER in picture) is bool(other)
    caption = pose_error_caption(errors)
    assert ("Hatched" in caption) is bool(unheld)
    assert ("Triangles" in caption) is bool(other)


def test_a_pose_that_does_not_count_is_not_called_less_stable():
    assert error_map(unheld=(3,), other=(3, 5)).more_stable.sum() == 1


def test_equal_results_give_equal_bytes():
    errors = error_map((3,), (5,))
    size = pose_error_size(errors)
    assert svg("a", size, lambda f: draw_pose_error(f, errors)) == svg("a", size, lambda f: draw_pose_error(f, errors))


@pytest.mark.parametrize(
    "values", [np.zeros(20), np.full(20, np.nan), np.arange(20.0), -np.arange(20.0), np.arange(20.0) - 9]
)
@pytest.mark.parametrize("signed", [False, True])
def test_any_values_can_be_drawn(values, signed):
    layer = Layer("quantity", "N", values, np.zeros(20, bool), signed)
    plan = FramePlan.of(load_robot("thesis-3-1"), grid())
    assert "</svg>" in svg("m", (6.0, 4.0), lambda f: draw_map(f, grid(), layer, plan))


@pytest.mark.parametrize(
    ("shape", "drawn"), [((1, 1, 1), False), ((5, 1, 1), True), ((1, 4, 3), True), ((5, 4, 3), True)]
)
def test_a_map_over_any_axis_is_drawn_and_a_single_pose_tabled(shape, drawn):
    over = grid(*shape)
    columns = {"sag_max_mm": np.arange(over.size) + 1.0, "held": np.ones(over.size, bool)}
    robot = load_robot("thesis-3-1")
    files = map_files(robot, "sag-max", over, columns, map_json(robot, "sag-max", over, columns))
    assert ("map.svg" in files) is drawn
    text = b"".join(files["map.csv"])
    assert len(text.splitlines()) == over.size + 1
