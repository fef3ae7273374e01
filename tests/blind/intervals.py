"""Binomial bands, calibration, and whether a stated interval holds the truth."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from scipy.stats import beta

from tests.blind.deviations import NUMBERS_PER_CABLE

NORMAL_95 = 1.959964


def band(successes: int, total: int) -> tuple[float, float]:
    """Exact (Clopper-Pearson) 95 per cent band of a share."""
    low = 0.0 if successes == 0 else float(beta.ppf(0.025, successes, total - successes + 1))
    high = 1.0 if successes == total else float(beta.ppf(0.975, successes + 1, total - successes))
    return low, high


def share(flags: list[bool]) -> dict[str, Any]:
    """A share with its band; value None where there is no case."""
    total, successes = len(flags), sum(flags)
    if not total:
        return {"value": None, "successes": 0, "cases": 0, "band": None}
    return {"value": successes / total, "successes": successes, "cases": total, "band": list(band(successes, total))}


def expected_calibration_error(probabilities: np.ndarray, right: np.ndarray, bins: int = 10) -> float | None:
    """Mean distance of stated probability and share of right answers, over equal bins."""
    if not len(probabilities):
        return None
    which = np.minimum((probabilities * bins).astype(int), bins - 1)
    gaps = [abs(probabilities[which == b].mean() - right[which == b].mean()) * (which == b).sum() for b in set(which)]
    return float(sum(gaps) / len(probabilities))


def log_score(probabilities: np.ndarray, right: np.ndarray) -> float | None:
    """Mean log of the probability given to what was the case."""
    if not len(probabilities):
        return None
    stated = np.clip(np.where(right, probabilities, 1.0 - probabilities), 1e-3, 1.0)
    return float(np.log(stated).mean())


LOGARITHMIC = ("axial_stiffness", "cable_linear_density", "platform_inertia")
SIGN_FREE = ("tracker_frame", "gravity_tilt")  # whether the frame or the sensor is turned is a matter of words
RATIO = ("drum_scale", "load_cell_gain")


def true_parameters(effect: dict[str, Any], robot_mass: float = 1.0) -> np.ndarray:
    """Total change of the parameters as the interface wants it: scales as ratios, offsets in SI."""
    total = np.array(effect["total"], dtype=float)
    if effect["cause"] == "platform_mass":
        return 1.0 + total / robot_mass
    if effect["cause"] in LOGARITHMIC:
        return np.exp(total)
    return 1.0 + total if effect["cause"] in RATIO else total


def interval_flags(
    effect: dict[str, Any],
    parameters: dict[str, dict[str, Any]],
    robot_mass: float = 1.0,
    masts: np.ndarray | None = None,
) -> list[tuple[bool, float]]:
    """(covered, relative error) of each stated parameter that the truth has a number for.

    Entries `.._3` are those of cable 3; a lone entry is the mean over the cables. Of masts, entry `.._3_7` is that of
    the mast of cables 3 and 7; masts (m,) are the numbers of the cables' masts in the truth. Vector parameters are
    matched in the order x, y, z of their keys. What cannot be matched is left out rather than guessed.
    """
    truth, kept = true_parameters(effect, robot_mass), sorted(parameters, key=_natural)
    if len(kept) == 1 and effect.get("shape") == "common":
        pairs = [(kept[0], float(truth.mean()))]
    elif effect["cause"] == "frame_compliance" and masts is not None:
        pairs = [(key, float(truth[masts[n - 1]])) for key in kept if 0 < (n := _number(key)) <= len(masts)]
    elif len(kept) == len(truth):
        pairs = list(zip(kept, truth, strict=True))
    else:
        entries = [(key, _entry(key, effect["cause"])) for key in kept]
        pairs = [(key, float(truth[n])) for key, n in entries if 0 <= n < len(truth)]
    signs = (1.0, -1.0) if effect["cause"] in SIGN_FREE else (1.0,)
    judged = [[_judged(parameters[key], sign * value) for key, value in pairs] for sign in signs]
    return max(judged, key=lambda flags: sum(covered for covered, _ in flags))


def _judged(stated: dict[str, Any], truth: float) -> tuple[bool, float]:
    miss = abs(float(stated["value"]) - truth)
    neutral = 1.0 if abs(truth - 1.0) < abs(truth) and "ratio" in str(stated.get("unit", "")) else 0.0
    return bool(miss <= NORMAL_95 * float(stated["sigma"])), miss / max(abs(truth - neutral), 1e-12)


def _entry(key: str, cause: str) -> int:
    """Index in the truth of a key such as bias_3 or frame_anchor_x_3; -1 if it names no cable."""
    number, axis = _number(key), re.search(r"_([xyz])(?:_|$)", key)
    if NUMBERS_PER_CABLE.get(cause) == 3:
        return 3 * (number - 1) + "xyz".index(axis.group(1)) if number and axis else -1
    return number - 1


def _number(key: str) -> int:
    found = re.search(r"_(\d+)(?:_|$)", key)
    return int(found.group(1)) if found else 0


def _natural(key: str) -> tuple[int, str]:
    return _number(key), key
