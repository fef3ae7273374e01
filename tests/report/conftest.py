"""One small verification, and the files made of it, for all tests of the reports."""

import dataclasses
import re
from html.parser import HTMLParser

import numpy as np
import pytest

from cdpr_struct.crosscheck.single_cable import describe_cable
from cdpr_struct.crosscheck.verification import verify
from cdpr_struct.reports.cable_page import cable_files
from cdpr_struct.reports.figures.frame_plan import FramePlan
from cdpr_struct.reports.verification_page import verification_files
from cdpr_struct.robot.robot_file import load_robot

INSIDE = ("#", "data:image/png;base64,")  # a reference on the page, or the bytes themselves


@pytest.fixture(scope="session")
def trial(thesis_point):
    """A verification that holds: few modes, for speed; 128 elements make the FEM certain enough."""
    return verify(thesis_point, [8, 16, 32], 20, most_elements=128)


@pytest.fixture(scope="session")
def wrong_trial(trial):
    """The same with one frequency of both models 5 % off: its report must say so."""
    factor = np.ones(len(trial.kinds))
    factor[3] = 1.05
    return dataclasses.replace(trial, dsm_hertz=factor * trial.dsm_hertz, exact_hertz=factor * trial.exact_hertz)


@pytest.fixture(scope="session")
def files(trial):
    return verification_files(trial)


@pytest.fixture(scope="session")
def cable():
    """The cable of thesis section 2.3, third load."""
    return describe_cable(100.0, -100.0, 20.0, 251327.4123, 0.067, 9.81)


@pytest.fixture(scope="session")
def cable_report(cable):
    return cable_files(cable)


class PageReader(HTMLParser):
    """What a browser would show and load: visible text, attributes, scripts by id."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.shown, self.attributes, self.scripts, self.styles = [], [], [], []
        self._inside = ""
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.attributes += [(tag, name, value or "") for name, value in attrs]
        self._inside = tag if tag in ("script", "style") else ""

    def handle_endtag(self, tag):
        if tag == self._inside:
            self._inside = ""

    def handle_data(self, data):
        {"script": self.scripts, "style": self.styles}.get(self._inside, self.shown).append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.shown).split())

    @property
    def foreign(self) -> list[str]:
        """Everything that the page would fetch from elsewhere."""
        sources = ("src", "href", "xlink:href", "srcset", "data", "action", "poster")
        found = [v for _, name, v in self.attributes if name in sources and not v.startswith(INSIDE)]
        found += self.values("link", "rel") + [s for s in self.styles if "@import" in s or "url(" in s]
        styled = [value for _, name, value in self.attributes if name in ("style", "clip-path", "fill")]
        found += [url for value in styled for url in re.findall(r"url\(([^)]*)\)", value) if not url.startswith("#")]
        return found + [s for s in self.scripts if any(word in s for word in ("fetch(", "XMLHttpRequest", "import("))]

    def values(self, tag: str, name: str) -> list[str]:
        return [value for t, n, value in self.attributes if (t, n) == (tag, name)]


@pytest.fixture(scope="session")
def read_page():
    return PageReader


@pytest.fixture(scope="session")
def inlined():
    """An SVG file as it stands on the page: without prologue and title."""
    return lambda svg: re.sub(r"\n <title>[^<]*</title>", "", svg[svg.index("<svg") :], count=1)


@pytest.fixture(scope="session")
def same():
    """Equality of arrays in which nan equals nan."""
    return lambda a, b: np.array_equal(np.asarray(a, float), np.asarray(b, float), equal_nan=True)


@pytest.fixture(scope="session")
def robot_plan():
    """Where a grid lies in the frame of a robot."""
    robot = load_robot("thesis-3-1")
    return lambda over: FramePlan.of(robot, over)
