"""Figures carry units, text as text, no date, and helpers do what their names say."""

import re
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from cdpr_struct.diagnosis.left_out import KINDS
from cdpr_struct.reports.figures.diagnose import ROW_NAMES
from cdpr_struct.reports.figures.limits import label_groups, number_ranges
from cdpr_struct.reports.figures.mode_stacks import densest_window, stack_levels
from cdpr_struct.reports.figures.robot_geometry import robot_geometry
from cdpr_struct.reports.figures.style import plain_number

AXIS_LABELS = {
    "determinant.svg": ["frequency [Hz]", "log₁₀ |det(ω²E − M⁻¹K)|   [det in s⁻¹²]", "FEM modes [count]"],
    "convergence.svg": [
        "elements per cable [count]",
        "|relative deviation from the FEM limit| [%]",
        "kind of mode [-]",
    ],
    "mode_errors.svg": ["mode number [-]", "DSM / FEM limit − 1 [%]", "FEM eigenfrequency [Hz]"],
    "mac.svg": ["FEM mode [-]", "mode of the exact catenary [-]", "mode of the closed form (DSM) [-]", "MAC [-]"],
    "limits.svg": ["cable number [-]", "λ² [-]", "inclination of the chord |α| [deg]", "ε [-]"],
    "robot.svg": ["x [m]", "y [m]", "z [m]", "tension at the platform [N]"],
    "profile.svg": ["x [m]", "z, up [m]", "along the chord, from B to C [m]", "below the chord [mm]"],
    "stiffness_trace.svg": ["frequency [Hz]", "|k_xx + k_zz| at C [N/m]"],
}


@pytest.mark.parametrize("name", AXIS_LABELS)
def test_axes_are_labelled_with_units(name, files, cable_report):
    shown = [" ".join(t.itertext()) for t in _svg(name, files, cable_report).iter("{http://www.w3.org/2000/svg}text")]
    assert [label for label in AXIS_LABELS[name] if label not in shown] == []


@pytest.mark.parametrize("name", AXIS_LABELS)
def test_svg_stands_alone_without_date_or_foreign_ids(name, files, cable_report):
    text = {**files, **cable_report}[name]
    root = _svg(name, files, cable_report)
    assert "dc:date" not in text
    assert re.findall(r'(?:href|src)="(?!#|data:image/png;base64)[^"]*"', text) == []
    prefix = name.removesuffix(".svg")
    assert all(e.get("id", prefix).startswith(prefix) for e in root.iter())


def test_every_cable_is_numbered(files, trial):
    shown = {t.strip() for t in re.findall(r"<text[^>]*>([^<]*)</text>", files["robot.svg"])}
    numbers = [int(n) for t in shown if re.fullmatch(r"\d+(, \d+)*", t) for n in t.split(", ")]
    assert set(range(1, len(trial.point.robot.cables) + 1)) <= set(numbers)


def test_drawn_cables_end_at_the_anchors(thesis_point):
    geometry = robot_geometry(thesis_point)
    assert geometry.frame == pytest.approx(thesis_point.robot.frame_anchors, abs=1e-9)
    assert geometry.curves[:, 0] == pytest.approx(geometry.frame, abs=1e-9)
    assert geometry.curves[:, -1] == pytest.approx(geometry.platform, abs=1e-6)  # tolerance of the inverse kinematics


def test_platform_box_has_twelve_edges(thesis_point):
    assert len(robot_geometry(thesis_point).edges) == 12


def test_stacks_keep_every_mode_visible():
    hertz = np.array([2.50, 2.52, 2.51, 4.0, 4.0])
    assert stack_levels(hertz, 0.1).tolist() == [1, 3, 2, 1, 2]


def test_densest_window_holds_the_cluster():
    low, high = densest_window(np.array([1.0, 2.50, 2.52, 2.51, 4.0]), 0.1)
    assert 1.0 < low < 2.50
    assert 2.52 < high < 4.0


def test_close_points_share_a_label():
    points = np.array([[0.1, 0.1], [0.5, 0.5], [0.11, 0.1], [0.1, 0.11]])
    assert [label for _, label in label_groups(points, (0.05, 0.05))] == ["1, 3, 4", "2"]
    assert [label for _, label in label_groups(points, (0.05, 0.05), np.array([0, 1, 0, 1], bool))] == ["2", "4"]


@pytest.mark.parametrize(
    ("numbers", "text"), [([], ""), ([4], "4"), ([1, 2], "1, 2"), ([1, 3, 5, 6, 7, 8], "1, 3, 5–8")]
)
def test_number_ranges(numbers, text):
    assert number_ranges(numbers) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "0"), (0.001, "0.001"), (1e-4, "0.0001"), (2e-5, "2·10⁻⁵"), (5e4, "50000"), (1e5, "10⁵"), (-0.1, "-0.1")],
)
def test_plain_number(value, text):
    assert plain_number(value) == text


def _svg(name, files, cable_report):
    return ElementTree.fromstring({**files, **cable_report}[name])


def test_every_kind_of_residual_has_a_name_in_the_figure():
    """Campaigns with modal constants of FRFs could not be drawn without theirs."""
    assert set(ROW_NAMES) == set(KINDS)
