"""Many minima and crossings of smooth functions at once: all brackets advance together, one evaluation a round."""

from collections.abc import Callable

import numpy as np

Values = Callable[[np.ndarray, np.ndarray], np.ndarray]

_ROUNDS = 6
_CLOSE = 1e-3  # of the bracket: a parabola whose lowest point lies that near the best point found it, to 1e-6 in value


def bracketed_minima(values: Values, place: np.ndarray, value: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lowest points of q functions by successive parabolas.

    Parameters
    ----------
    values : (places (r,), numbers (r,) of the functions) -> values (r,)
    place : (q, 3) ascending;  value : (q, 3), the middle one not above the others

    Returns
    -------
    Places (q,), inside the brackets, and values (q,).
    """
    place, value = place.copy(), value.copy()
    rows = np.arange(len(place))
    for _ in range(_ROUNDS):
        vertex = _vertex(place[rows], value[rows])
        width = place[rows, 2] - place[rows, 0]
        moving = np.abs(vertex - place[rows, 1]) > _CLOSE * width
        rows, vertex = rows[moving], vertex[moving]
        if len(rows) == 0:
            break
        _narrow(place, value, rows, vertex, values(vertex, rows))
    return place[:, 1], value[:, 1]


def _vertex(place: np.ndarray, value: np.ndarray) -> np.ndarray:
    """Lowest point of the parabola through three points; between the middles of the two intervals."""
    slopes = np.diff(value, axis=1) / np.diff(place, axis=1)
    middles = 0.5 * (place[:, 1:] + place[:, :-1])
    bend = slopes[:, 1] - slopes[:, 0]
    share = np.where(bend > 0.0, -slopes[:, 0] / np.where(bend > 0.0, bend, 1.0), 0.5)
    found: np.ndarray = middles[:, 0] + share * (middles[:, 1] - middles[:, 0])
    return found


def _narrow(place: np.ndarray, value: np.ndarray, rows: np.ndarray, new: np.ndarray, found: np.ndarray) -> None:
    """Put the new points into the brackets `rows`, in place."""
    old, best = place[rows, 1], value[rows, 1]
    better, right = found < best, new > old
    inner, inner_value = np.where(better, old, new), np.where(better, best, found)
    end = np.where(better == right, 0, 2)  # a better point moves the end behind it, a worse one becomes the end
    place[rows, end], value[rows, end] = inner, inner_value
    place[rows, 1], value[rows, 1] = np.where(better, new, old), np.where(better, found, best)


def bracketed_crossings(values: Values, place: np.ndarray, value: np.ndarray) -> np.ndarray:
    """(q,) zeros of q functions that change sign between two places each (q, 2), by false position (Illinois)."""
    place, value = place.copy(), value.copy()
    rows, last, width = np.arange(len(place)), np.full(len(place), -1), place[:, 1] - place[:, 0]
    found = _secant(place, value)
    for _ in range(_ROUNDS):
        new = values(found[rows], rows)
        end = (np.sign(new) == np.sign(value[rows, 1])).astype(int)
        twice = rows[end == last[rows]]
        value[twice, 1 - last[twice]] *= 0.5
        place[rows, end], value[rows, end], last[rows] = found[rows], new, end
        better = _secant(place[rows], value[rows])
        moved = np.abs(better - found[rows]) > _CLOSE * np.abs(width[rows])
        found[rows] = better
        rows = rows[moved]
        if len(rows) == 0:
            break
    return found


def _secant(place: np.ndarray, value: np.ndarray) -> np.ndarray:
    """(q,) where the straight lines through two points each cross zero."""
    slope = (value[:, 1] - value[:, 0]) / (place[:, 1] - place[:, 0])
    return np.asarray(place[:, 0] - value[:, 0] / slope)
