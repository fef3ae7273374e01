"""Signs of print, and what a page says of the picture that it shows."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from cdpr_struct.diagnosis.recommended import Recommendation, _merged
from cdpr_struct.reports.diagnose.result import _is_among
from cdpr_struct.reports.figures.frf import frf_caption
from cdpr_struct.reports.figures.interactive_map import map_plot
from cdpr_struct.reports.figures.solid_scene import _LETTERS, _NARROW, _corners, _seen, anchor_labels, solid_scene
from cdpr_struct.reports.figures.workspace_map import Layer, colour_scale
from cdpr_struct.reports.frf_text import nearest_mode
from cdpr_struct.reports.html import completed
from cdpr_struct.reports.typeset import typeset
from tests.report.test_interactive import grid


@pytest.mark.parametrize(
    ("written", "printed"),
    [
        ("within +-2 sigma, +-0.1 um/N", "within ±2 sigma, ±0.1 µm/N"),
        ("408 ± 1.4e+02 m^3", "408 ± 140 m³"),
        ("p = 1.3e-39", "p = 1.3·10⁻³⁹"),
        ("tilt<=5, cable-distance>=0.1", "tilt ≤ 5, cable-distance ≥ 0.1"),
        (">= 0.2", "≥ 0.2"),
        ("2.0e-03 kg m^2", "0.0020 kg m²"),
        ("case 1e3x of names e5, sum, a+-b", "case 1e3x of names e5, sum, a+-b"),
    ],
)
def test_pages_have_signs_of_print(written, printed):
    assert typeset(written) == printed


def test_a_command_breaks_between_its_words_and_is_the_same_text():
    page = completed("<!-- end -->", "cdpr-struct map robot --grid=-1:1:3,0,1 \\\n  --upper-bound 3000")
    pre = re.search(r"<pre>(.*)</pre>", page, re.S)[1]
    assert re.sub(r"<[^>]*>", "", pre) == "cdpr-struct map robot --grid=-1:1:3,0,1 \\\n  --upper-bound 3000"
    assert '<span class="word">--upper-bound</span>' in pre


@pytest.mark.parametrize(("value", "low", "high"), [(0.0, 0.0, 1.0), (5.0, 4.0, 6.0), (-5.0, -6.0, -4.0)])
def test_a_constant_map_has_a_range_about_its_value(value, low, high):
    scale, _ = colour_scale(Layer("quantity", "N", np.full(9, value), np.zeros(9, bool)))
    assert (scale.vmin, scale.vmax) == (pytest.approx(low, abs=1e-4), pytest.approx(high, abs=1e-4))


def test_level_lines_end_where_poses_have_no_value(robot_plan):
    """A single row of poses between others without a value has no cell, so no line and no number."""
    over = grid(5, 3, 1)
    values = over.positions[:, 0].copy()
    values[over.positions[:, 1] != 1.0] = np.nan
    lines = map_plot(over, [Layer("quantity", "N", values, np.zeros(over.size, bool))], robot_plan(over))["data"][1]
    assert lines["x"] == []
    whole = map_plot(over, [Layer("q", "N", over.positions[:, 0], np.zeros(over.size, bool))], robot_plan(over))
    assert {word for word in whole["data"][1]["text"] if word} >= {"0.8", "1.6", "2.4"}


@pytest.mark.parametrize("size", [(6.0, 4.0, 3.0), (14.0, 10.0, 5.0), (1.0, 1.0, 8.0), (8.0, 3.0, 2.0)])
def test_scenes_show_the_whole_box_and_leave_room_for_letters(size):
    box = np.array([np.zeros(3), size])
    scene = solid_scene(box)
    for place, camera, width in (
        (scene["layout"], scene["layout"]["scene"]["camera"], 960.0),
        (scene["narrow"], scene["narrow"]["scene"]["camera"], _NARROW),
    ):
        eye, center = (np.array(list(camera[name].values())) for name in ("eye", "center"))
        seen = np.abs(_seen(_corners(box[1]), eye, center, width / place["height"])).max(axis=0)
        free = 1.0 - 2.0 * np.array(_LETTERS) / np.array([width, place["height"]])
        assert (seen <= free + 0.01).all()  # the height of the figure is a whole number of pixels
        assert (seen > free - 0.05).any()  # as near as that allows; steps between distances are 4 %


def test_anchors_that_lie_close_share_a_label():
    box = np.array([[0.0, 0.0, 0.0], [6.0, 4.0, 3.0]])
    anchors = np.array([[0.0, 0.0, 3.0], [0.02, 0.0, 3.0], [6.0, 0.0, 3.0]])
    assert anchor_labels(anchors, box) == ["1, 2", "", "3"]


def test_a_peak_belongs_to_the_mode_in_whose_reach_it_is():
    """On the broad flank of a cable mode the sharp platform mode that is nearer has nothing to do with it."""
    modes = {
        "natural_frequencies_hz": [25.4, 26.03],
        "natural_damping_ratios": [0.02, 0.0007],
        "kinds": ["cable 1", "platform"],
    }
    assert nearest_mode(modes, 25.77) == (25.4, "cable 1")
    assert nearest_mode(modes, 26.035) == (26.03, "platform")
    assert nearest_mode(modes, 60.0) == (26.03, "platform")  # none is within reach


@pytest.mark.parametrize(
    ("kinds", "said"),
    [
        (["platform", "cable 2"], "blue for platform and orange for cable modes"),
        (["mixed"], "band, pink for mixed modes"),
    ],
)
def test_a_caption_names_only_the_kinds_that_are_there(kinds, said):
    modes = SimpleNamespace(hertz=np.arange(1.0, 1.0 + len(kinds)), kinds=kinds)
    caption = frf_caption(SimpleNamespace(modes=modes, response=SimpleNamespace(hertz=np.array([0.5])), peaks=[]))
    assert said in caption
    assert ("pink" in caption) == ("mixed" in kinds)


def test_each_measurement_is_proposed_once():
    found = [
        Recommendation("tell_apart", "clamping the cable", (name,)) for name in ("dead_length", "joint_compliance")
    ]
    assert _merged(found) == [Recommendation("tell_apart", "clamping the cable", ("dead_length", "joint_compliance"))]
    simulated = ["dial gauge across the joints (+-0.1 um/N): expected to separate a from b by 7 nats"]
    assert _is_among("a dial gauge across the joint (tests joint compliance)", simulated)
    assert not _is_among("an amplitude sweep (tests dead length)", simulated)
