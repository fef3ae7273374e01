"""The diagnosis as a flow chart."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.reports.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE

SIZE = (9.6, 5.4)
_BOXES = {
    "files": ((0.0, 4.0), "campaign file, CSV, UFF:\nreadings and sigmas", GREY),
    "robot": ((0.0, 2.2), "robot file: entered\nvalues, tolerances", GREY),
    "peaks": ((2.7, 4.8), "recordings become\nfrequencies and ratios", GREY),
    "model": ((2.7, 2.9), "forward model at the\nreadings: balance,\nlengths, frequencies", BLUE),
    "residuals": ((5.4, 3.9), "residuals, linear in noise,\ntolerances and causes", BLUE),
    "library": ((5.4, 1.7), "hypotheses: causes, laws,\ncorrections, effects\nthat are left out", ORANGE),
    "test": ((8.1, 4.8), "is anything\nsignificant?", PURPLE),
    "evidence": ((8.1, 2.9), "evidence of each\nhypothesis; peaks\nassigned to modes", PURPLE),
    "decision": ((8.1, 0.9), "least expected loss;\nheld-out states confirm", PURPLE),
    "verdict": ((5.4, -0.3), "adequate | named |\nclass | unknown", GREEN),
    "next": ((2.7, 0.9), "next measurement", GREEN),
    "extended": ((2.7, -0.7), "extended robot:\nevery command takes it", GREEN),
}
_ARROWS = (
    ("files", "peaks"), ("files", "model"), ("robot", "model"), ("peaks", "residuals"), ("model", "residuals"),
    ("residuals", "evidence"), ("residuals", "test"), ("library", "evidence"), ("test", "evidence"),
    ("evidence", "decision"), ("decision", "verdict"), ("verdict", "extended"), ("verdict", "next"),
    ("extended", "robot"), ("next", "files"),
)  # fmt: skip
_WIDTH, _HEIGHT = 2.05, 0.95


def draw_flow(figure: Figure) -> None:
    """Boxes and arrows; the dashed arrows close the loop."""
    axes: Axes = figure.add_subplot()
    for place, text, colour in _BOXES.values():
        box = {"boxstyle": "round,pad=0.45", "facecolor": "white", "edgecolor": colour, "linewidth": 1.6}
        axes.text(*place, text, ha="center", va="center", fontsize=8.0, color=BLACK, bbox=box)
    for start, end in _ARROWS:
        line = "--" if end in ("robot", "files") else "-"
        arrow = {"arrowstyle": "-|>", "color": GREY, "linestyle": line, "shrinkA": 2, "shrinkB": 2}
        axes.annotate("", _edge(end, start), _edge(start, end), arrowprops=arrow)
    axes.set_xlim(-1.2, 9.3)
    axes.set_ylim(-1.4, 5.5)
    axes.set_axis_off()


def _edge(name: str, towards: str) -> tuple[float, float]:
    """Where the line to another box leaves a box."""
    (x, y), (u, v) = _BOXES[name][0], _BOXES[towards][0]
    across, up = u - x, v - y
    reach = min(0.5 * _WIDTH / abs(across) if across else 9.0, 0.5 * _HEIGHT / abs(up) if up else 9.0)
    return x + reach * across, y + reach * up
