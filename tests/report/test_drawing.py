"""A figure in its three forms: SVG and PDF for papers, SVG for narrow screens."""

import re
import xml.etree.ElementTree as ElementTree

import pytest

from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.figures.narrow import WIDTH

pytestmark = pytest.mark.every_form

SCREEN = 400 - 2 * 12  # width of a phone less the page's margins [px]


def panels(figure):
    for number, axes in enumerate(figure.subplots(2, 4, sharex=True).ravel()):
        axes.plot([0.0, 1.0], [0.0, number], label="a curve with a long name")
        axes.set_title(f"panel {number}", fontsize=6.0)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside right upper")


def names(figure):
    axes = figure.subplots()
    axes.barh(range(12), range(12))
    axes.set_yticks(range(12), [f"{i}: clamp the cables at their exits and weigh the platform" for i in range(12)])
    axes.set_xlabel("log evidence against the nominal model, which stands at zero by definition [nats]")


def matrix(figure):
    figure.subplots(3, 3, sharex="col", sharey="row")


def letters(svg: str) -> list[float]:
    return [float(size) for size in re.findall(r"font(?:-size)?: (?:bold )?([\d.]+)px", svg)]


def width(svg: str) -> float:
    return float(re.search(r'viewBox="[-\d.]+ [-\d.]+ ([\d.]+) [\d.]+"', svg)[1])


@pytest.mark.parametrize("draw", [panels, names])
def test_letters_of_a_narrow_figure_can_be_read_on_a_phone(draw):
    """9 pixels or more, in a figure that is as wide as the screen; the wide one would have 5."""
    drawing = Drawing("f", (9.6, 4.0), draw)
    narrow, wide = drawing.narrow_svg, drawing.svg
    assert min(letters(narrow)) * SCREEN / width(narrow) >= 9.0
    assert min(letters(wide)) * SCREEN / width(wide) < 5.0


def test_many_panels_stand_two_abreast_and_a_matrix_keeps_its_columns():
    places = [len(columns_of(Drawing("f", (9.6, 4.0), draw).narrow_svg)) for draw in (panels, matrix)]
    assert places == [2, 3]


def columns_of(svg: str) -> set[float]:
    """Left ends of the panels' backgrounds."""
    paths = re.findall(r'id="f-narrow-axes_\d+">\s*<g id="f-narrow-patch_\d+">\s*<path d="M ([\d.]+)', svg)
    return {round(float(x)) for x in paths}


def test_a_narrow_figure_is_as_wide_as_its_screen():
    assert width(Drawing("f", (9.6, 4.0), panels).narrow_svg) == pytest.approx(72.0 * WIDTH, rel=0.03)


def test_a_pdf_has_its_fonts_and_its_title_but_no_date():
    pdf = Drawing("f", (4.0, 3.0), panels).pdf("robot: λ² & more")
    assert pdf.startswith(b"%PDF")
    assert b"/FontFile2" in pdf
    assert b"/Type3" not in pdf
    assert "robot".encode("utf-16-be") in pdf
    assert b"Date" not in pdf


def test_equal_drawings_give_equal_bytes():
    one, other = (Drawing("f", (4.8, 3.0), names) for _ in range(2))
    assert one.pdf("t") == other.pdf("t")
    assert one.narrow_svg == other.narrow_svg


def test_an_svg_file_says_whose_it_is():
    root = ElementTree.fromstring(Drawing("f", (4.0, 3.0), panels).svg_file("<robot>: forces"))
    assert root[0].tag.endswith("title")
    assert root[0].text == "<robot>: forces"
