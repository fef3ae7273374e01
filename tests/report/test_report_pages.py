"""The pages say what was found, hold every figure, and load nothing from anywhere."""

import base64
import dataclasses
import gzip
import html
import json
import re
import xml.etree.ElementTree as ElementTree

import pytest
from plotly import graph_objects

from cdpr_struct.crosscheck.single_cable import describe_cable
from cdpr_struct.reports.cable_page import cable_files
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import Plate, completed, page_files
from cdpr_struct.reports.typeset import typeset
from cdpr_struct.reports.verification_page import verification_files, verification_page
from cdpr_struct.reports.verification_verdict import verdict_lines

FIGURES = ["determinant", "convergence", "mode_errors", "mac", "limits", "robot"]


def test_files_are_those_promised(files, cable_report):
    tables = {"eigenfrequencies.csv", "convergence.csv", "cables.csv", "determinant_scan.csv", "mac.csv"}
    assert set(files) == tables | {f"{name}.{form}" for name in FIGURES for form in ("svg", "pdf")} | {"report.html"}
    assert set(cable_report) == {
        "profile.csv", "stiffness_trace.csv", "profile.svg", "stiffness_trace.svg", "profile.pdf",
        "stiffness_trace.pdf", "report.html",
    }  # fmt: skip


def test_page_begins_with_the_verdict(trial, files, read_page):
    text = read_page(files["report.html"]).text
    sentence = typeset(verdict_lines(trial)[0])
    assert sentence.startswith("EXACT MODEL HOLDS")
    assert sentence in text
    assert all(text.index(sentence) < text.index(word) for word in ("How to read", "1. What a"))


def test_page_shows_a_failing_verdict_as_failing(trial, wrong_trial, read_page):
    """The twin: one frequency 5 % off turns sentence, colour, figure and table row."""
    made = verification_files(wrong_trial)
    page = read_page(made["report.html"])
    assert "EXACT MODEL DOES NOT HOLD: mode 4" in page.text
    assert "CLOSED-FORM DSM DOES NOT HOLD: mode 4" in page.text
    assert "HOLDS:" not in page.text.replace("DOES NOT HOLD:", "")
    assert [c for c in page.values("section", "class") if c.startswith("verdict")] == ["verdict fails"]
    assert len(page.values("tr", "class")) == 1
    assert ">outside<" in made["mode_errors.svg"]


def test_holding_page_marks_no_row_and_no_mode(files, read_page):
    page = read_page(files["report.html"])
    assert [c for c in page.values("section", "class") if c.startswith("verdict")] == ["verdict holds"]
    assert page.values("tr", "class") == []
    assert ">outside<" not in files["mode_errors.svg"]


def test_every_figure_is_on_the_page_with_a_caption(files, read_page, inlined):
    page = read_page(files["report.html"])
    assert page.values("figure", "id") == FIGURES
    for name in FIGURES:
        assert inlined(files[f"{name}.svg"]) in files["report.html"]
    captions = re.findall(r"<figcaption>(.*?)</figcaption>", files["report.html"], re.DOTALL)
    assert len(captions) == len(FIGURES)
    assert all(len(caption) > 100 for caption in captions)


@pytest.mark.parametrize("which", ["files", "cable_report"])
def test_page_loads_nothing(which, request, read_page):
    assert read_page(request.getfixturevalue(which)["report.html"]).foreign == []


def test_ids_are_unique_and_references_resolve(files, read_page):
    page = read_page(files["report.html"])
    ids = [value for _, name, value in page.attributes if name == "id"]
    assert len(ids) == len(set(ids))
    wanted = {v[1:] for _, n, v in page.attributes if n.endswith("href") and v.startswith("#")}
    wanted |= {ref for _, _, value in page.attributes for ref in re.findall(r"url\(#([^)]*)\)", value)}
    assert wanted <= set(ids)


def test_plotly_is_inside_once_and_whole(files):
    packed = re.findall(r'id="plotly-packed">([^<]*)</script>', files["report.html"])
    assert len(packed) == 1
    assert b"plotly.js" in gzip.decompress(base64.b64decode(packed[0]))[:400]


def test_interactive_figures_are_valid_plotly(files):
    """plotly.py checks every property; the report itself skips that for speed."""
    found = re.findall(r'class="plot-data">(.*?)</script>', files["report.html"], re.DOTALL)
    assert len(found) == 2
    for text in found:
        layout = graph_objects.Figure(json.loads(text)).layout
        scene = layout.scene
        flat = not scene.xaxis.title.text
        axes = (layout.xaxis, layout.yaxis, layout.yaxis2) if flat else (scene.xaxis, scene.yaxis, scene.zaxis)
        assert all(re.search(r"\[.+\]", axis.title.text) for axis in axes)


def test_names_from_a_file_cannot_break_the_page(trial, read_page):
    """A robot's name comes from a user's file."""
    evil = "</script><script src='http://x.example/y.js'></script>"
    robot = dataclasses.replace(trial.point.robot, name=evil)
    named = dataclasses.replace(trial, point=dataclasses.replace(trial.point, robot=robot))
    drawing = Drawing("plate", (4.0, 3.0), lambda figure: figure.subplots())
    plate = Plate("plate", evil, drawing, evil, {"data": [{"name": evil}]})
    files = page_files(verification_page(named, [plate]))
    text = files["report.html"]
    assert ElementTree.fromstring(files["plate.svg"])[0].text == f"{evil}: {evil}"
    assert read_page(text).values("script", "src") == []
    assert html.escape("<script src=") in text
    (data,) = re.findall(r'class="plot-data">(.*?)</script>', text, re.DOTALL)
    assert json.loads(data) == {"data": [{"name": evil}]}


def test_equal_results_give_equal_bytes(trial, files):
    again = verification_files(trial)
    assert [name for name in files if files[name] != again[name]] == []


def test_a_completed_page_holds_warnings_below_the_verdict_and_the_command_at_the_end(trial, files, read_page):
    said = ["cable 3 hangs slack <b>", "two states"]
    page = completed(files["report.html"], "cdpr-struct verify thesis-3-1 --modes 20", said, ["tilt acts."])
    text = re.sub(r"<nav.*?</nav>", "", page, flags=re.DOTALL)  # its contents name what follows
    text = read_page(text).text
    order = [typeset(verdict_lines(trial)[0]), f"Warning: {said[0]}", f"Warning: {said[1]}", "1. What a", "How to read"]
    order += ["Extensions", "tilt acts.", "Reproduce", "cdpr-struct verify thesis-3-1 --modes 20"]
    places = [text.index(piece) for piece in order]
    assert places == sorted(places)
    assert "<!-- end -->" not in page


def test_cable_page_of_a_taut_cable_holds(cable, cable_report, read_page):
    text = read_page(cable_report["report.html"]).text
    assert cable["validity"]["valid"]
    assert "within its printed limits" in text


def test_cable_page_of_a_slack_cable_fails_visibly(read_page):
    result = describe_cable(-10.0, 40.0, 30.0, 251327.0, 0.067, 9.81)
    page = read_page(cable_files(result)["report.html"])
    assert {v["parameter"] for v in result["validity"]["violations"]} == {"lambda2", "crossover_distance", "alpha_deg"}
    assert all(v["parameter"] in page.text for v in result["validity"]["violations"])
    assert "verdict fails" in page.values("section", "class")
