"""Binomial bands, calibration, and whether a stated interval holds the truth."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation
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
OTHER_BASIS = ("internal_force",)  # stated along other directions of the null space: the length alone compares
RATIO = ("drum_scale", "load_cell_gain")


def true_parameters(effect: dict[str, Any], robot_mass: float = 1.0) -> np.ndarray:
    """Total change of the parameters as the interface wants it: scales as ratios, offsets in SI."""
    total = np.array(effect["total"], dtype=float)
    if effect["cause"] == "gravity_tilt":  # gravity turned about x and y; stated is its horizontal share along x and y
        return np.array([-total[1], total[0]])
    if effect["cause"] == "tracker_frame":  # what the tracker shows; stated is the way back
        back = Rotation.from_rotvec(-total[3:])
        return np.concatenate([-back.apply(total[:3]), -total[3:]])
    if effect["cause"] == "platform_mass":
        return 1.0 + total / robot_mass
    if effect["cause"] in LOGARITHMIC:
        return np.exp(total)
    return 1.0 + total if effect["cause"] in RATIO else total


@dataclass(frozen=True)
class Compared:
    """A stated number beside the true one; `neutral` is the number that means no effect."""

    value: float
    sigma: float
    truth: float
    neutral: float

    @property
    def covered(self) -> bool:
        """Whether the 95 per cent interval holds the truth."""
        return bool(abs(self.value - self.truth) <= NORMAL_95 * self.sigma)


def compared(
    effect: dict[str, Any],
    parameters: dict[str, dict[str, Any]],
    robot_mass: float = 1.0,
    masts: np.ndarray | None = None,
) -> list[Compared]:
    """Each stated parameter that the truth has a number for.

    Entries `.._3` are those of cable 3; a lone entry is the mean over the cables. Of masts, entry `.._3_7` is that of
    the mast of cables 3 and 7; masts (m,) are the numbers of the cables' masts in the truth. Vector parameters are
    matched in the order x, y, z of their keys. What cannot be matched is left out rather than guessed.
    """
    truth, kept = true_parameters(effect, robot_mass), sorted(parameters, key=_natural)
    if effect["cause"] in OTHER_BASIS:
        return [_lengths(truth, [parameters[key] for key in kept])] if kept else []
    if len(kept) == 1 and effect.get("shape") == "common":
        pairs = [(kept[0], float(truth.mean()))]
    elif effect["cause"] == "frame_compliance" and masts is not None:
        pairs = [(key, float(truth[masts[n - 1]])) for key in kept if 0 < (n := _number(key)) <= len(masts)]
    elif len(kept) == len(truth):
        pairs = list(zip(kept, truth, strict=True))
    elif len(truth) == 1 and effect["cause"] in parameters:
        pairs = [(effect["cause"], float(truth[0]))]
    else:
        entries = [(key, _entry(key, effect["cause"])) for key in kept]
        pairs = [(key, float(truth[n])) for key, n in entries if 0 <= n < len(truth)]
    return [_beside(parameters[key], value) for key, value in pairs]


def relative_error(numbers: list[Compared]) -> float:
    """Length of the miss over that of the true change, of all the parameters of one effect."""
    miss = np.linalg.norm([number.value - number.truth for number in numbers])
    return float(miss / max(np.linalg.norm([number.truth - number.neutral for number in numbers]), 1e-12))


def _beside(stated: dict[str, Any], truth: float) -> Compared:
    neutral = 1.0 if abs(truth - 1.0) < abs(truth) and "ratio" in str(stated.get("unit", "")) else 0.0
    return Compared(float(stated["value"]), float(stated["sigma"]), truth, neutral)


def _lengths(truth: np.ndarray, stated: list[dict[str, Any]]) -> Compared:
    """Lengths of the stated and of the true vector; sigma of a length is that along the vector."""
    value = np.array([float(number["value"]) for number in stated])
    sigma = np.array([float(number["sigma"]) for number in stated])
    length = float(np.linalg.norm(value))
    along = value / max(length, 1e-12)
    return Compared(length, float(np.linalg.norm(along * sigma)), float(np.linalg.norm(truth)), 0.0)


def _entry(key: str, cause: str) -> int:
    """Index in the truth of a key such as bias_3 or frame_anchor_x_3; -1 if it names no cable."""
    number, axis = _number(key), re.search(r"_([xyz])(?:_|$)", key)
    if NUMBERS_PER_CABLE.get(cause) == 3:
        return 3 * (number - 1) + "xyz".index(axis.group(1)) if number and axis else -1
    if cause == "tracker_frame" and axis:
        return "xyz".index(axis.group(1)) + 3 * key.startswith("turn")
    if cause == "platform_inertia" and axis:
        return "xyz".index(axis.group(1))
    return number - 1


def _number(key: str) -> int:
    found = re.search(r"_(\d+)(?:_|$)", key)
    return int(found.group(1)) if found else 0


def _natural(key: str) -> tuple[int, str]:
    return _number(key), key
