"""Maps over three axes: which slices are drawn, with which values, on one scale; and pages of a single pose."""

import numpy as np
import pytest

from cdpr_struct.reports.figures.frame_plan import FramePlan
from cdpr_struct.reports.figures.pose_error import draw_pose_error, pose_error_caption, pose_error_size
from cdpr_struct.reports.figures.style import svg
from cdpr_struct.reports.figures.workspace_map import OTHER, UNHELD, Layer
from cdpr_struct.reports.figures.workspace_slices import MOST, Slices, draw_slices, slices_size
from cdpr_struct.reports.statics_map import map_files, map_json
from cdpr_struct.reports.statics_pose_error import pose_error_files
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.pose_error_map import PARTS, PoseErrorMap


def grid(nx, ny, nz) -> Grid:
    return Grid(np.arange(nx) * 1.0, np.arange(ny) * 0.5, np.arange(nz) * 0.25, np.zeros(3))


def value_of(over: Grid) -> np.ndarray:
    """A value that tells its pose: x + 100 y + 10000 z."""
    return over.positions @ np.array([1.0, 100.0, 10000.0])


def error_map(over: Grid, unheld=()) -> PoseErrorMap:
    offset = {"x": 1.0, "y": 2.0, "z": -3000.0}
    columns = {f"{part}_{axis}_mm": value_of(over) + offset[axis] for part in PARTS for axis in "xyz"}
    flags = {name: np.full(over.size, name != "more_stable_pose") for name in ("held", "stable", "more_stable_pose")}
    flags["held"][list(unheld)] = False
    return PoseErrorMap("robot", 30.0, over, columns | flags)


def drawn(over: Grid, values: np.ndarray, marked=()) -> str:
    flags = np.zeros(over.size, bool)
    flags[list(marked)] = True
    layer = Layer("quantity", "N", values, flags)
    return svg(
        "m", slices_size(over), lambda f: draw_slices(f, over, layer, FramePlan.of(load_robot("thesis-3-1"), over))
    )


@pytest.mark.parametrize(
    ("shape", "axis", "index"),
    [
        ((5, 4, 3), 2, [0, 1, 2]),
        ((2, 4, 3), 0, [0, 1]),
        ((9, 4, 9), 1, [0, 1, 2, 3]),
        ((4, 4, 4), 2, [0, 1, 2, 3]),
        ((13, 13, 13), 2, [0, 2, 4, 6, 8, 10, 12]),  # every second one: twelve of thirteen would leave a gap
        ((20, 20, 12), 2, list(range(12))),
        ((25, 25, 25), 2, list(range(0, 25, 3))),
        ((14, 14, 14), 2, [0, 1, 2, 4, 5, 6, 7, 8, 9, 11, 12, 13]),  # 13 steps have no even division
    ],
)
def test_slices_are_along_the_axis_with_the_fewest_positions(shape, axis, index):
    slices = Slices.of(grid(*shape))
    assert slices.axis == axis
    assert slices.index.tolist() == index
    assert len(index) <= MOST


@pytest.mark.parametrize("shape", [(5, 4, 3), (2, 4, 3), (5, 2, 6)])
def test_a_slice_holds_the_values_and_marks_of_its_poses(shape):
    over = grid(*shape)
    slices = Slices.of(over)
    layer = Layer("quantity", "N", value_of(over), value_of(over) > 300.0)
    for index in slices.index:
        part, cut = slices.grid_at(index), slices.layer_at(layer, index)
        assert len(part.free) == 2
        assert cut.values.tolist() == value_of(part).tolist()
        assert cut.marked.tolist() == (value_of(part) > 300.0).tolist()


@pytest.mark.parametrize(("shape", "name", "count"), [((5, 4, 3), "z", 3), ((3, 8, 8), "x", 3), ((8, 7, 9), "y", 7)])
def test_every_slice_is_drawn_on_one_scale(shape, name, count):
    over = grid(*shape)
    picture = drawn(over, value_of(over))
    places = over.axes["xyz".index(name)]
    assert [f">{name} = {value:g} m<" in picture for value in places] == [True] * count
    assert picture.count(">[N]<") == 1
    assert picture == drawn(over, value_of(over))


def test_hatching_and_marks_have_a_legend():
    over = grid(5, 4, 3)
    values = value_of(over)
    assert UNHELD not in drawn(over, values)
    assert OTHER in drawn(over, values, marked=[3])
    values[7] = np.nan
    assert UNHELD in drawn(over, values)


@pytest.mark.parametrize("values", [np.zeros(60), np.full(60, np.nan), -np.arange(60.0)])
def test_any_values_can_be_drawn(values):
    assert "</svg>" in drawn(grid(5, 4, 3), values)


def mapped(over, columns):
    robot = load_robot("thesis-3-1")
    return map_files(robot, "sag-max", over, columns, map_json(robot, "sag-max", over, columns))


def test_map_page_says_which_slices_it_shows(read_page):
    over = grid(13, 13, 13)
    columns = {"sag_max_mm": value_of(over) + 1.0, "held": np.ones(over.size, bool)}
    page = read_page(mapped(over, columns)["report.html"])
    assert "7 of 13 slices, at z = 0, 0.5, 1, 1.5, 2, 2.5, 3 m; all on one colour scale" in page.text
    assert page.values("figure", "id") == ["map"]
    assert page.foreign == []


def test_pose_error_over_three_axes_has_a_row_a_slice():
    errors = error_map(grid(6, 5, 4), unheld=[3])
    picture = svg("p", pose_error_size(errors), lambda f: draw_pose_error(f, errors))
    assert [picture.count(f">z = {value:g} m<") for value in errors.grid.z] == [3, 3, 3, 3]
    assert picture.count(">[mm]<") == 3
    assert UNHELD in picture
    assert "4 values of z, z = 0 to 0.75 m; all on one colour scale in each column" in pose_error_caption(errors)
    files = pose_error_files(load_robot("thesis-3-1"), errors, None)
    assert set(files) == {"pose_error.csv", "pose_error.svg", "pose_error.pdf", "report.html"}


def test_page_of_a_single_pose_says_its_value_once(read_page):
    over = grid(1, 1, 1)
    columns = {"sag_max_mm": np.array([12.5]), "held": np.ones(1, bool)}
    files = mapped(over, columns)
    page = read_page(files["report.html"])
    assert set(files) == {"map.csv", "report.html"}
    assert "Largest sag at (0, 0, 0) m: 12.5 mm." in page.text
    assert "average" not in page.text
    assert page.text.count("12.5 mm") == 2  # in the sentence and in large type


def test_pose_error_of_a_single_pose_has_its_components(read_page):
    files = pose_error_files(load_robot("thesis-3-1"), error_map(grid(1, 1, 1)), None)
    page = read_page(files["report.html"])
    assert "The platform hangs 3000.00 mm too low" in page.text
    assert "average" not in page.text
    assert "global +1.000 +2.000 -3000.000" in page.text
