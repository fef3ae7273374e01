"""What results can do: text, tables, figures and JSON, each with the robot's name and no surprise."""

import json
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from matplotlib import pyplot
from matplotlib.axes import Axes

import cdpr_struct as cs

ROOT = Path(__file__).parents[2]
NAME = "thesis-3-1"
BANDS = ROOT / "examples/bands"
ANSWERS = {
    "robots": cs.robots,
    "cable": lambda: cs.cable(force=(100, -100), length=20, EA=2.5e5, rho=0.067),
    "inverse": lambda: cs.inverse(NAME),
    "forward": lambda: cs.forward(NAME, cs.inverse(NAME).solution.lengths, equilibria=True),
    "pose_error": lambda: cs.pose_error(NAME, "-1:1:2,-1:1:2,0.5"),
    "pose_error with bands": lambda: cs.pose_error(NAME, band=90, samples=20),
    "map": lambda: cs.map(NAME, "-1:1:3,-1:1:3,0.5", "tension-max"),
    "map of three axes": lambda: cs.map(NAME, "-1:1:3,-1:1:3,0.3:0.6:2", "sag-max"),
    "map of one axis": lambda: cs.map(NAME, "-1:1:3,0,0.5", "stiffness-min"),
    "modes": lambda: cs.modes(NAME, count=12),
    "modes with bands": lambda: cs.modes(NAME, count=6, band=90),
    "sensitivity": lambda: cs.sensitivity(NAME, count=3),
    "compare": lambda: cs.compare(BANDS / "robot.toml", BANDS / "measured.csv"),
    "accept": lambda: cs.accept(BANDS / "robot.toml", BANDS / "requirements.toml"),
    "frf": lambda: cs.frf(NAME, excite="fz", respond="x,z", band=(1, 4, 0.1)),
    "cable with bands": lambda: cs.cable(force=(100, -100), length=20, EA=2.5e5, rho=0.067, band=90, held="ends"),
    "map with bands": lambda: cs.map(NAME, "-1:1:3,0,0.5", "tension-min", band=90, limit=190),
    "frf with bands": lambda: cs.frf(NAME, excite="fz", respond="x,z", band=(1, 4, 0.1), percent=90, samples=20),
    "transient": lambda: cs.transient(NAME, initial_velocity=(0.3, 0, 0), duration=1, highest=8),
    "spectrogram": lambda: cs.spectrogram(ROOT / "examples/stop/acceleration.csv", NAME, highest=10),
    "verify": lambda: cs.verify(NAME, modes=3, elements=(4, 8, 16)),
    "audit": lambda: cs.audit(NAME),
    "audit of a grid": lambda: cs.audit(NAME, grid="-1:1:2,-1:1:2,0.5"),
    "audit of a motion": lambda: cs.audit("thesis-5", trajectory="line:0,0,2:1,0,2.5:4"),
    "distribute": lambda: cs.distribute("thesis-5", "helix", instants=31, compare=["fixed"]),
    "distribute with bands": lambda: cs.distribute("thesis-5", "helix", instants=7, band=90),
    "ambient": lambda: pytest.importorskip("pyoma2") and cs.ambient(ROOT / "examples/ambient/campaign.toml"),
    "plan": lambda: cs.plan(ROOT / "examples/table-4-4/level.toml"),
    "reproduce": lambda: cs.reproduce("fig-2.4"),
}
NAMELESS = {"robots", "cable", "cable with bands", "reproduce"}


@pytest.fixture(scope="module")
def answers():
    known: dict[str, cs.Result] = {}

    def of(name: str) -> cs.Result:
        if name not in known:
            known[name] = ANSWERS[name]()
        return known[name]

    return of


@pytest.fixture(autouse=True)
def off_screen():
    with mpl.rc_context({"backend": "Agg"}):
        yield
    pyplot.close("all")


@pytest.mark.parametrize("name", ANSWERS)
def test_figure(name, answers):
    found = answers(name)
    axes = found.plot()
    assert isinstance(axes, Axes)
    assert axes.get_title().splitlines()[0] == found.title
    if name not in NAMELESS:
        assert any(robot in found.title for robot in (NAME, "thesis-5", "cogiro", "six-cable-4mm"))
    axes.figure.canvas.draw()
    title = axes.title.get_window_extent()
    (low_x, low_y), (high_x, high_y) = axes.figure.bbox.min, axes.figure.bbox.max
    assert low_x <= title.x0 < title.x1 <= high_x, "the title leaves the figure"
    assert low_y <= title.y0 < title.y1 <= high_y, "the title leaves the figure"


@pytest.mark.parametrize("name", ANSWERS)
def test_table_text_and_json(name, answers):
    found = answers(name)
    frame = found.frame()
    assert isinstance(frame, pd.DataFrame)
    assert len(frame)
    assert str(found).startswith(found.text())
    assert all(sentence in str(found) for sentence in found.warnings)
    assert repr(found).startswith(f"<{type(found).__name__} {found.title}")
    assert "\n" not in repr(found)
    assert json.loads(json.dumps(found.to_json(), allow_nan=False)) == found.to_json()
    assert name in NAMELESS or found.to_json()["trust"]["checks"]
    page = found._repr_html_()
    assert page.count("<div") >= 1
    assert page.startswith("<div>")
    assert page.endswith("</div>")
    assert page.count("<tr") == min(len(frame), 12) + 1
    assert str(frame.columns[0]) in page


def test_a_notebook_shows_warnings_and_no_markup_of_names():
    robot = cs.load_robot("thesis-3-1")
    from dataclasses import replace

    named = replace(robot, name="<b>mine</b>")
    page = cs.inverse(named, (3.0, 3.0, 0.0), mass=1.0)._repr_html_()
    assert "<b>mine</b>" not in page
    assert "&lt;b&gt;mine" in page
    assert "Warning:" in page


def test_verdicts_are_truths():
    assert cs.verify(NAME, modes=3, elements=(4, 8, 16)).holds is True
    assert cs.verify(NAME, modes=3, elements=(4, 8, 16), tolerance=1e-6, model="dsm").holds is False
    assert cs.audit(NAME).valid is True
    assert cs.forward(NAME, cs.inverse(NAME).solution.lengths).stable is True


def test_results_are_frozen():
    found = cs.inverse(NAME)
    with pytest.raises(AttributeError):
        found.pose = None


def test_a_single_pose_has_no_map():
    found = cs.map(NAME, "0,0,0.5", "tension-max")
    with pytest.raises(cs.InputError, match="a range for x, y or z"):
        found.plot()
    assert np.isfinite(found.frame()["tension_max_N"]).all()
