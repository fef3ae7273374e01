"""Panels that share their axes, in however many columns the page has room for."""

from collections.abc import Sequence

from matplotlib.axes import Axes


def label_ends(panels: Sequence[Axes], up: str, across: str) -> None:
    """Label the panels at the left end of each row, and those with none below them; the others share the labels."""
    for axes in panels:
        own = axes.get_subplotspec()
        first = own is None or own.is_first_col()
        axes.set_ylabel(up if first else "")
        lowest = not any(_is_beneath(other, axes) for other in panels)
        axes.set_xlabel(across if lowest else "")
        axes.tick_params(labelbottom=lowest, labelleft=first)


def _is_beneath(other: Axes, axes: Axes) -> bool:
    one, two = other.get_subplotspec(), axes.get_subplotspec()
    return one is not None and two is not None and one.colspan == two.colspan and one.rowspan.start > two.rowspan.start
