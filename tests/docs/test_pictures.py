"""Pictures of the documentation are what the code computes. If not: python docs/pictures."""

import json
import re
import sys
from pathlib import Path

import pytest

from cdpr_struct.reports.diagnose.cause_pages import NO_PICTURE, pages
from cdpr_struct.reports.figures.style import FONT_STACK, svg

DOCS = Path(__file__).parents[2] / "docs"
PICTURES = DOCS / "causes" / "pictures"
FEW = ("axial_stiffness", "load_cell_bias", "accelerometer_mass")
TEXT = re.compile(r"<text[^>]*>(.*?)</text>", re.DOTALL)


@pytest.fixture(scope="module", autouse=True)
def drawing():
    """The folder docs/pictures is a program of its own, not a package."""
    sys.path.insert(0, str(DOCS / "pictures"))
    yield
    sys.path.remove(str(DOCS / "pictures"))


def words(picture: str) -> list[str]:
    """Texts of a picture; their places may differ with the version of matplotlib."""
    return sorted(re.sub(r"\s+", " ", re.sub(r"<[^>]*>", "", found)).strip() for found in TEXT.findall(picture))


@pytest.mark.parametrize("name", FEW)
def test_effects_are_those_that_were_drawn(name):
    import gallery
    import small_multiples
    import typical

    found = typical.of_library(name, typical.entered())
    assert gallery.stale({name: found}) == []
    assert words(small_multiples.picture(name, found)) == words((PICTURES / f"{name}.svg").read_text("utf-8"))


def test_another_effect_is_seen():
    import gallery
    import typical

    found = typical.of_library("load_cell_bias", typical.entered())
    assert gallery.stale({"load_cell_gain": found}) == ["load_cell_gain"]


@pytest.mark.slow
def test_effects_of_all_causes_are_those_that_were_drawn():
    import gallery
    import typical

    assert gallery.stale(typical.effects()) == []


def test_every_cause_has_its_picture_on_its_page_and_in_the_gallery():
    names = {name.removesuffix(".md") for name in pages()} - {"index", *NO_PICTURE}
    assert (
        {path.stem for path in PICTURES.glob("*.svg")}
        == names
        == set(json.loads((PICTURES / "effects.json").read_text()))
    )
    shown = (DOCS / "causes" / "gallery.md").read_text("utf-8")
    assert set(re.findall(r"\(pictures/(\w+)\.svg\)", shown)) == names
    assert all(f"(pictures/{name}.svg)" in pages()[f"{name}.md"] for name in names)


def test_the_gallery_is_the_page_of_its_numbers():
    import gallery

    numbers = json.loads(gallery.NUMBERS.read_text("utf-8"))
    assert gallery.page(numbers) == (DOCS / "causes" / "gallery.md").read_text("utf-8")


@pytest.mark.parametrize("name", ["anatomy_robot", "anatomy_cable", "anatomy_modes", "diagnosis_flow"])
def test_anatomy_says_what_it_said(name):
    import anatomy
    import flow

    draw = {
        "anatomy_robot": (anatomy.ROBOT_SIZE, anatomy.draw_robot),
        "anatomy_cable": (anatomy.CABLE_SIZE, anatomy.draw_cable),
        "anatomy_modes": (anatomy.MODES_SIZE, anatomy.draw_modes),
        "diagnosis_flow": (flow.SIZE, flow.draw_flow),
    }
    size, drawn = draw[name]
    assert words(svg(name, size, drawn)) == words((DOCS / f"{name}.svg").read_text("utf-8"))


def test_fonts_of_a_figure_are_a_list_that_browsers_can_read():
    """A font list inside quotes is one unknown font."""
    shown = svg("font", (1.0, 1.0), lambda figure: figure.suptitle("text"))
    assert FONT_STACK in shown
    assert "''" not in shown
