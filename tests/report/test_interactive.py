"""Plots that can be zoomed hold what the static figure shows, and are valid plotly."""

import numpy as np
import pytest
from plotly import graph_objects

import cdpr_struct as cs
from cdpr_struct.reports.figures.diagnose import ROW_NAMES
from cdpr_struct.reports.figures.frame_plan import FramePlan, outline
from cdpr_struct.reports.figures.interactive_forces import forces_plot
from cdpr_struct.reports.figures.interactive_frf import frf_plot
from cdpr_struct.reports.figures.interactive_map import map_plot
from cdpr_struct.reports.figures.interactive_residuals import residuals_plot
from cdpr_struct.reports.figures.workspace_map import Layer
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.workspace.grid import Grid


def grid(*shape: int) -> Grid:
    return Grid(*(np.arange(count, dtype=float) for count in shape), np.zeros(3))


def mapped(over: Grid, count: int = 1) -> dict:
    values = over.positions @ np.array([1.0, 10.0, 100.0])
    values[1] = np.nan
    layers = [Layer(f"quantity {i}", "N", values + i, np.zeros(over.size, bool)) for i in range(count)]
    return map_plot(over, layers, FramePlan.of(load_robot("thesis-3-1"), over))


@pytest.mark.parametrize(("shape", "count"), [((5, 1, 1), 1), ((5, 4, 1), 1), ((1, 4, 3), 3), ((5, 4, 3), 1)])
def test_maps_are_valid_plotly(shape, count):
    graph_objects.Figure(mapped(grid(*shape), count))


def test_each_step_of_the_slider_shows_one_slice_and_the_frame():
    plot = mapped(grid(5, 4, 3))
    kinds = [trace["type"] for trace in plot["data"]]
    assert kinds == ["heatmap", "scatter"] * 3 + ["scatter"] * 4
    for number, step in enumerate(plot["layout"]["sliders"][0]["steps"]):
        shown = [kind for kind, seen in zip(kinds, step["args"][0]["visible"], strict=True) if seen]
        assert shown == ["heatmap", *["scatter"] * 5]
        assert step["label"] == f"z = {number} m"
        heat = plot["data"][2 * number]
        assert heat["z"][3][4] == 4.0 + 30.0 + 100.0 * number  # rows are y, columns x
    assert plot["data"][0]["z"][0][0] == 0.0
    assert len({(trace["zmin"], trace["zmax"]) for trace in plot["data"] if trace["type"] == "heatmap"}) == 1


def test_the_frame_is_that_of_the_robot():
    robot = load_robot("thesis-3-1")
    frame, platform, anchors = mapped(grid(5, 4, 1))["data"][-3:]
    assert np.array_equal(np.transpose([anchors["x"], anchors["y"]]), robot.frame_anchors[:, :2])
    assert max(frame["x"]) == robot.frame_anchors[:, 0].max()
    assert np.mean(platform["x"][:-1]) == pytest.approx(2.0)  # the middle of the grid


def test_an_outline_of_points_in_a_row_is_the_row():
    row = np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]])
    assert np.array_equal(outline(row), row)


def test_residuals_say_their_size_where_the_axis_is_bent():
    columns = {
        "block": np.array(["RF", "EQ", "EQ"]), "case": ["a", "b", "b"], "row": [1, 1, 2], "cable": ["", 3, ""],
        "residual": np.array([0.3, 50.0, -1.0]), "unit": ["Hz", "N", "N"], "sigma": np.array([0.1, 0.5, 1.0]),
        "with_causes": np.array([0.1, 0.5, -1.0]),
    }  # fmt: skip
    plot = residuals_plot(columns, ROW_NAMES)
    graph_objects.Figure(plot)
    before, after = plot["data"]
    assert "wrench balance, state b, cable 3" in before["text"][0]
    assert "as entered: +100 sigma" in before["text"][0]
    assert before["y"][1:] == [-1.0, 3.0]  # even up to three sigmas; the robot frequency comes last
    assert 3.0 < before["y"][0] < 100.0
    assert after["y"] == [1.0, -1.0, 1.0]


def test_responses_and_forces_are_valid_plotly():
    response = cs.frf("thesis-3-1", excite="fz", respond="x,z", band="2:4:0.05")
    plot = frf_plot(response.sweep)
    graph_objects.Figure(plot)
    marks = [text for trace in plot["data"] for text in trace.get("text", [])]
    assert len(marks) == len(response.answer["natural_frequencies_hz"])
    forces = forces_plot(cs.distribute("thesis-5", trajectory="helix", instants=7).found)
    graph_objects.Figure(forces)
    assert len(forces["data"]) == 2 * 8
