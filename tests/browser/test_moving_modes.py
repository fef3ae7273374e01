"""The robot moves in its modes on the page, stops when it is told to, and turns under the mouse."""

import pytest

from tests.browser.test_pages import Sight

pytestmark = pytest.mark.browser

CLICK = "e => e.click()"
PICTURE = "document.querySelector('.mode-viewer canvas').toDataURL()"


def test_modes_move_stop_and_turn(browser, folders):
    with Sight(browser, folders["modes"] / "report.html", 400, "light") as sight:
        page = sight.page
        page.eval_on_selector(".mode-viewer", "e => e.scrollIntoView()")
        page.wait_for_timeout(300)
        first = page.evaluate(PICTURE)
        page.wait_for_timeout(300)
        assert page.evaluate(PICTURE) != first
        page.eval_on_selector(".mv-play", CLICK)
        still = page.evaluate(PICTURE)
        page.wait_for_timeout(300)
        assert page.evaluate(PICTURE) == still
        page.eval_on_selector(".mode-viewer [data-view='0,90']", CLICK)
        assert page.evaluate(PICTURE) != still
        assert page.locator(".mv-caption").inner_text().startswith("Mode 1 of 12: 2.4831 Hz, kind: cables")
        page.eval_on_selector(".mode-viewer [data-step='-1']", CLICK)
        assert page.locator(".mv-caption").inner_text().startswith("Mode 12 of 12")
        assert page.locator(".mv-energy div").count() == 9
        assert sight.complaints == []
