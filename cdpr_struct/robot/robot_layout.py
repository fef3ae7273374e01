"""Anchors of a plausible robot with any usual number of cables: a place to begin when a robot file is written.

Up to seven cables hang from the top of the frame. With eight or more, half of them (the larger one) come from the top
and end at the platform's lower edge, the others come from the floor and end at its upper edge, so that cables cross.
Seen from above, neighbours pass the middle on different sides, so that they resist turning.
"""

import numpy as np

COUNTS = (4, *range(6, 17))
_TURNED = 0.35  # of the angle between two cables: how far their ends on the platform are turned, in turn to both sides
_CORNERS = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
_SPREAD = np.array([1.2, 0.8])  # of four ends on the platform, along both axes


def anchors(cables: int, frame: np.ndarray, platform: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frame anchors (m, 3), world, and platform anchors (m, 3), platform frame [m].

    frame, platform : (3,) width, depth, height [m]; the frame stands on the floor about the origin

    Raises
    ------
    ValueError : a number of cables that is not in `COUNTS`.
    """
    if cables not in COUNTS:
        raise ValueError(f"{cables} cables; 4, or 6 to 16")
    swap, half = [1, 0, 2], 0.5 * platform[2]
    if cables < 8:
        above, on_platform = _level(cables, frame, platform)
        return _raised(above, frame[2]), _raised(on_platform, half)
    upper = (cables + 1) // 2
    top, low_edge = _level(upper, frame, platform)
    floor, high_edge = _level(cables - upper, frame[swap], platform[swap])  # spread along the other axis
    ends = _raised(top, frame[2]), floor[:, swap]
    return np.concatenate(ends), np.concatenate([_raised(low_edge, -half), _raised(high_edge[:, swap], half)])


def _level(count: int, frame: np.ndarray, platform: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ends (count, 3) of cables on frame and platform, seen from above: four in corners, others on ellipses."""
    if count == 4:
        return _flat(_CORNERS * frame[:2]), _flat(_CORNERS * platform[:2] * _SPREAD)
    angles = -0.75 * np.pi + 2.0 * np.pi * np.arange(count) / count
    turn = _TURNED * 2.0 * np.pi / count * np.where(np.arange(count) % 2 == 0, 1.0, -1.0)
    return _flat(_ellipse(angles) * frame[:2]), _flat(_ellipse(angles + turn) * platform[:2])


def _ellipse(angles: np.ndarray) -> np.ndarray:
    """(k, 2) places at angles (k,) on a circle of diameter one."""
    return 0.5 * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _flat(plan: np.ndarray) -> np.ndarray:
    return np.column_stack([plan, np.zeros(len(plan))])


def _raised(places: np.ndarray, height: float) -> np.ndarray:
    return np.asarray(places + np.array([0.0, 0.0, height]))
