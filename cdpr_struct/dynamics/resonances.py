"""Where a response can have peaks, and at which frequencies to evaluate it so that none falls between two of them."""

from dataclasses import dataclass

import numpy as np

# Spacing at most a quarter of a mode's half width about its frequency: there |H|^-2 is a parabola to 1 %. Further off,
# at most half of the distance to the mode: the response is smooth on the scale of that distance.
_CORE = np.array([0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0])
_GROWTH = 1.5
_DISTINCT = 0.01  # of the half width: nearer lines add nothing, and differences between them are mostly rounding
_STEPS = 2.0  # of the even lines: beyond this many of them their own spacing is fine enough
_ABOUT_A_POLE = 1e-3  # of its frequency: as half width with which lines are laid about an undamped mode
# A weak mode on the flank of a strong one peaks up to some five half widths off its frequency. Maxima beyond ten are
# humps between two antiresonances: measured up to 1 % of the highest peak, and none in driving-point responses.
PEAK_REACH = 10.0
"""Half widths between a mode and a peak that belongs to it, at most."""


@dataclass(frozen=True, slots=True, eq=False)
class Lines:
    """Frequencies to be added to a band.

    hertz : (n,) ascending;  mode : (n,) number of the mode that each was added for
    """

    hertz: np.ndarray
    mode: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class Resonances:
    """The k modes below the top of a band.

    hertz      : (k,) eigenfrequencies, ascending [Hz]
    half_width : (k,) damping ratio times frequency, zero where nothing damps the mode [Hz]
    known_to   : all modes up to this frequency are listed [Hz]
    """

    hertz: np.ndarray
    half_width: np.ndarray
    known_to: float

    def near(self, hertz: np.ndarray) -> np.ndarray:
        """(f,) bool: whether a maximum at this frequency belongs to a damped mode, or to one beyond `known_to`."""
        apart = np.abs(hertz[:, None] - self.hertz)
        return np.asarray((apart <= PEAK_REACH * self.half_width).any(axis=1) | (hertz > self.known_to))

    def lines(self, even: np.ndarray) -> Lines:
        """Lines that even ones (f,) lack; each mode is served up to the midpoints to its neighbours.

        An undamped mode gets no line at its own frequency, where the response is infinite.
        """
        reach = _STEPS * (even[1] - even[0])
        width = np.where(self.half_width > 0.0, self.half_width, _ABOUT_A_POLE * self.hertz)
        tails = np.log(reach / (_CORE[-1] * width.min(initial=reach))) / np.log(_GROWTH)
        growing = _CORE[-1] * _GROWTH ** np.arange(1.0, 2.0 + max(float(tails), 0.0))
        offset = np.outer(width, np.concatenate([_CORE, growing]))
        gap = 0.5 * np.diff(self.hertz, prepend=-np.inf, append=np.inf)
        below, above = (offset < np.minimum(side, reach)[:, None] for side in (gap[:-1], gap[1:]))
        mode = np.broadcast_to(np.arange(len(width))[:, None], offset.shape)
        own = np.flatnonzero(self.half_width > 0.0)
        place = self.hertz[:, None]
        hertz = np.concatenate([self.hertz[own], (place - offset)[below], (place + offset)[above]])
        return _distinct(hertz, np.concatenate([own, mode[below], mode[above]]), width, even)


def _distinct(hertz: np.ndarray, mode: np.ndarray, width: np.ndarray, even: np.ndarray) -> Lines:
    """Those inside the band, ascending, and apart from the even lines and from each other."""
    order = np.argsort(hertz, kind="stable")
    order = order[(hertz[order] > even[0]) & (hertz[order] < even[-1])]
    hertz, mode = hertz[order], mode[order]
    after = np.searchsorted(even, hertz)
    apart = np.minimum(np.minimum(hertz - even[after - 1], even[after] - hertz), np.diff(hertz, prepend=-np.inf))
    kept = apart > _DISTINCT * width[mode]
    return Lines(hertz[kept], mode[kept])
