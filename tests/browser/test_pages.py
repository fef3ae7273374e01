"""The page of every command in a browser: on a phone and on a desk, light and dark, without a network."""

from pathlib import Path

import pytest

from tests.browser.conftest import COMMANDS

pytestmark = pytest.mark.browser

LOOKS = Path(__file__).with_name("looks.js").read_text("utf-8")
SCREENS = [(width, scheme) for width in (400, 1400) for scheme in ("light", "dark")]
EVERYDAY = ("modes", "map-of-three-axes", "frf", "forward")  # the others have figures of the same kinds
PAGES = [name if name in EVERYDAY else pytest.param(name, marks=pytest.mark.slow) for name in COMMANDS]
READY = "!document.querySelector('.plot-data') || document.documentElement.dataset.drawn === 'all'"


class Sight:
    """An open page, and what the browser complained about."""

    def __init__(self, browser, page: Path, width: int, scheme: str, scripts: bool = True) -> None:
        self.complaints: list[str] = []
        self.context = browser.new_context(
            viewport={"width": width, "height": 900}, color_scheme=scheme, offline=True, java_script_enabled=scripts
        )
        self.page = self.context.new_page()
        self.page.on("console", lambda said: said.type == "error" and self.complaints.append(said.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("requestfailed", lambda request: self.complaints.append(f"fetched {request.url[:80]}"))
        self.page.goto(page.as_uri())
        if scripts:
            self.page.wait_for_function(READY, timeout=30_000)

    def show(self, width: int, scheme: str) -> None:
        """On another screen."""
        self.page.set_viewport_size({"width": width, "height": 900})
        self.page.emulate_media(color_scheme=scheme)
        self.page.wait_for_timeout(200)  # for the change to be noticed
        self.page.wait_for_function(READY, timeout=30_000)

    def __enter__(self):
        return self

    def __exit__(self, *_) -> None:
        self.context.close()


@pytest.mark.parametrize("command", PAGES)
def test_page_can_be_read_everywhere(command, browser, folders):
    """No error, every figure there and named, nothing cropped, letters of 9 pixels or more."""
    with Sight(browser, folders[command] / "report.html", *SCREENS[0]) as sight:
        for width, scheme in SCREENS:
            sight.show(width, scheme)
            assert [*sight.complaints, *sight.page.evaluate(LOOKS)] == [], (width, scheme)


@pytest.mark.slow
def test_static_figures_can_be_read_on_a_phone(browser, folders):
    """Without scripts the figures are those drawn for narrow screens."""
    for command in ("frf", "plan", "map", "diagnose"):
        with Sight(browser, folders[command] / "report.html", 400, "dark") as sight:
            sight.page.evaluate("document.querySelectorAll('.live').forEach((e) => e.classList.remove('live'))")
            sight.page.evaluate("document.querySelectorAll('.plot').forEach((e) => e.remove())")
            assert sight.page.evaluate(LOOKS) == [], command


@pytest.mark.slow
def test_dark_pages_are_dark(browser, folders):
    """Paper, static and interactive figures take the colours of the scheme."""
    shade = "e => { const c = getComputedStyle(e); return (c.fill || c.backgroundColor).match(/\\d+/g).map(Number) }"
    for scheme, bright in (("light", True), ("dark", False)):
        with Sight(browser, folders["verify"] / "report.html", 1400, scheme) as sight:
            paper = sight.page.eval_on_selector("body", "e => getComputedStyle(e).backgroundColor")
            still = sight.page.eval_on_selector("#convergence .wide [id$='patch_1'] path", shade)
            live = sight.page.eval_on_selector("#determinant .plot .bglayer rect, #determinant .plot .bg", shade)
            assert (int(paper.split("(")[1].split(",")[0]) > 128) is bright
            assert (still[0] > 128) is bright
            assert (live[0] > 128) is bright


def test_the_slider_goes_through_the_slices(browser, folders):
    """Each step of the slider shows one slice, and the frame stays."""
    with Sight(browser, folders["map-of-three-axes"] / "report.html", 1400, "light") as sight:
        shown = "document.querySelector('.plot').data.map((trace) => trace.visible !== false)"
        before = sight.page.evaluate(shown)
        sight.page.locator(".slider-rail-touch-rect").click(position={"x": 4, "y": 4}, force=True)
        sight.page.wait_for_timeout(300)
        after = sight.page.evaluate(shown)
        assert before == [False, False, True, True, False, False, True, True, True, True]
        assert after == [True, True, False, False, False, False, True, True, True, True]


def test_hover_names_a_mode(browser, folders):
    with Sight(browser, folders["frf"] / "report.html", 1400, "light") as sight:
        first = sight.page.locator(".plot .xy2 .points path").first
        first.scroll_into_view_if_needed()
        mark = first.bounding_box()
        sight.page.mouse.move(mark["x"] + mark["width"] / 2, mark["y"] + mark["height"] / 2)
        sight.page.wait_for_selector(".hoverlayer .hovertext")
        assert "mode " in sight.page.locator(".hoverlayer .hovertext").first.text_content()


@pytest.mark.parametrize("command", PAGES)
def test_every_figure_is_a_file_twice(command, browser, folders, written):
    """Each figure of the page is there as SVG and as PDF, and result.json lists both."""
    with Sight(browser, folders[command] / "report.html", 1400, "light", scripts=False) as sight:
        figures = sight.page.eval_on_selector_all("figure", "all => all.map((each) => each.id)")
    assert figures
    assert {f"{name}.{form}" for name in figures for form in ("svg", "pdf")} <= written(command)
