"""A plotly scene to be turned: axes to scale, and the nearest camera that sees all of the box and its letters."""

from itertools import product

import numpy as np

from cdpr_struct.reports.figures.limits import near_groups, number_ranges
from cdpr_struct.reports.figures.plot_parts import Plot, plot_axis, plot_layout
from cdpr_struct.reports.figures.style import BLACK

_FROM = np.array([0.36, -0.87, 0.33])  # where the camera stands, seen from the middle of the box
_SLOPE = np.tan(np.pi / 8.0)  # half the height of what plotly's camera sees, over its distance
_LETTERS = (74.0, 46.0)  # room for ticks and names of the axes, across and up [px]
_NEAREST, _FARTHEST, _STEPS = 0.7, 6.0, 200
_TURNS = 20  # of centring: each leaves a small part of what is off
_WIDE, _NARROW = 960.0, 376.0  # widths [px]
_LOWEST, _HIGHEST = 240.0, 580.0  # heights [px]
_GLANCE = 2.0  # distance from which the shape of the box is judged
_BAR = (100.0, 70.0)  # taken by a colour bar beside a wide figure, below a narrow one [px]
_APART = (26.0, 13.0)  # anchors nearer than that on a phone share a label [px]


def solid_scene(box: np.ndarray, bar: bool = False) -> dict[str, Plot]:
    """`layout` and, for phones, `narrow` of a figure that shows a box (2, 3) [m]; bar : beside a colour bar."""
    size = box[1] - box[0]
    wide, narrow = _pixels(size, _WIDE - _BAR[0] * bar), _pixels(size, _NARROW)
    axes = {
        f"{name}axis": {
            **plot_axis(f"{name} [m]"), "backgroundcolor": "white", "color": BLACK, "range": ends,
            "nticks": int(np.clip(2 + 5 * share, 3, 6)),
        }
        for name, ends, share in zip("xyz", box.T.tolist(), (size / size.max()).tolist(), strict=True)
    }  # fmt: skip
    scene = {
        "aspectmode": "manual",
        "aspectratio": dict(zip("xyz", (size / size.max()).tolist(), strict=True)),
        "camera": _camera(size, wide),
        **axes,
    }
    below = {"l": 0, "r": 0, "t": 0, "b": int(_BAR[1]) * bar}
    near = {"camera": _camera(size, narrow)}
    return {
        "layout": {**plot_layout(round(wide[1])), "margin": {"l": 0, "r": 0, "t": 0, "b": 0}, "scene": scene},
        "narrow": {"margin": below, "height": round(narrow[1] + below["b"]), "scene": near},
    }


def anchor_labels(anchors: np.ndarray, box: np.ndarray) -> list[str]:
    """Numbers of anchors (m, 3); those that would overprint each other on a phone stand together at the first."""
    size = box[1] - box[0]
    pixels = _pixels(size, _NARROW)
    eye, center = (np.array([place[axis] for axis in "xyz"]) for place in _camera(size, pixels).values())
    points = (anchors - 0.5 * (box[0] + box[1])) / size.max()
    places = 0.5 * np.array(pixels) * _seen(points, eye, center, pixels[0] / pixels[1])
    labels = [""] * len(anchors)
    for group in near_groups(places, _APART):
        labels[group[0]] = number_ranges([i + 1 for i in group])
    return labels


def _pixels(size: np.ndarray, width: float) -> tuple[float, float]:
    """Width and height of a figure that a box with its letters fills [px]."""
    corners = _corners(size)
    across, up = np.ptp(_seen(corners, _GLANCE * _FROM / np.linalg.norm(_FROM), np.zeros(3), 1.0), axis=0)
    high = (width - 2.0 * _LETTERS[0]) * up / across + 2.0 * _LETTERS[1]
    return width, float(np.clip(high, _LOWEST, _HIGHEST))


def _corners(size: np.ndarray) -> np.ndarray:
    """(8, 3) of a box about the origin whose largest edge is 1, as plotly places it."""
    return np.array(list(product((-0.5, 0.5), repeat=3))) * size / size.max()


def _camera(size: np.ndarray, pixels: tuple[float, float]) -> Plot:
    """The nearest camera from which the box and the letters around it fit into a figure of so many pixels."""
    corners = _corners(size)
    free = 1.0 - 2.0 * np.array(_LETTERS) / np.array(pixels)
    shape = pixels[0] / pixels[1]
    for distance in np.linspace(_NEAREST, _FARTHEST, _STEPS):
        center = _centred(corners, distance, shape)
        eye = center + distance * _FROM / np.linalg.norm(_FROM)
        if (np.abs(_seen(corners, eye, center, shape)) <= free).all():
            break
    named = [dict(zip("xyz", place.tolist(), strict=True)) for place in (eye, center)]
    return dict(zip(("eye", "center"), named, strict=True))


def _centred(corners: np.ndarray, distance: float, shape: float) -> np.ndarray:
    """Where to look so that what is seen of the box lies in the middle of the figure."""
    center = np.zeros(3)
    away = distance * _FROM / np.linalg.norm(_FROM)
    right, up = _screen(away)
    for _ in range(_TURNS):
        seen = _seen(corners, center + away, center, shape)
        off = 0.5 * (seen.min(axis=0) + seen.max(axis=0)) * distance * _SLOPE
        center = center + off[0] * shape * right + off[1] * up
    return center


def _screen(away: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors to the right and up on the screen of a camera that stands there."""
    right = np.cross([0.0, 0.0, 1.0], away)
    right /= np.linalg.norm(right)
    return right, np.cross(away / np.linalg.norm(away), right)


def _seen(points: np.ndarray, eye: np.ndarray, center: np.ndarray, shape: float) -> np.ndarray:
    """(n, 2) places of points (n, 3) on the screen, from -1 to 1 across and up; far outside what is behind the eye."""
    away = eye - center
    right, up = _screen(away)
    depth = np.maximum((eye - points) @ away / np.linalg.norm(away), 1e-3)
    return np.stack([(points - eye) @ right / (depth * _SLOPE * shape), (points - eye) @ up / (depth * _SLOPE)], axis=1)
