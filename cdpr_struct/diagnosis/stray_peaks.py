"""Peaks of the robot that no mode of the model explains, and large changes of the model that would explain them.

How far a peak is from a mode that it does not belong to says nothing; that it is there at all does. A stray peak so
costs any world the same in log evidence, and several of them are significant whatever the other residuals say. Small
changes never catch a stray, so causes that move modes are tried by large ones.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import binom, chi2

from cdpr_struct.diagnosis.evidence import Candidate, Choice, Screened, choice
from cdpr_struct.diagnosis.mode_pairing import STRAY
from cdpr_struct.diagnosis.refit import Fit, Ground, settled
from cdpr_struct.diagnosis.setting import strays_in
from cdpr_struct.diagnosis.world import World
from cdpr_struct.errors import CdprError
from cdpr_struct.side_by_side import side_by_side

SEVERAL = 1.5  # expected strays that are more than one
ONE = 0.7  # expected strays from which large changes are tried
_STEPS = (-2.5, -1.0, 1.0, 2.5)  # prior sigmas
_MOVES = 4.0  # [%] by which the largest step must move a peak
_SCALE = 2.5  # of the prior
_FEWER = 0.5  # strays, by which a change must be better
_BEHIND = 20.0  # nats by which a change that is not settled yet may be worse than none
_MOST_NUMBERS = 3  # that are tried one by one
_ADEQUATE = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class _Trial:
    """A cause of size theta (d,), in sigmas of its wide prior, and the stray peaks that it leaves."""

    picked: Choice
    theta: np.ndarray
    strays: float


def strays_left(ground: Ground, fit: Fit | None) -> float:
    """Expected number of stray peaks in the world of a fit, or of the null."""
    return (ground if fit is None else fit.ground).strays


def p_of_strays(strays: float, peaks: int) -> float:
    """Probability of at least so many stray peaks if the model is right; 1 for less than two."""
    count = int(strays + 0.5)
    return float(binom.sf(count - 1, peaks, np.exp(STRAY))) if count > 1 else 1.0


def explains(fit: Fit) -> bool:
    """Whether what a fit leaves may be noise."""
    return float(chi2.sf(fit.adequacy(), len(fit.white))) > _ADEQUATE


def clears(fit: Fit) -> bool:
    """Whether a fit explains the data and every peak."""
    return explains(fit) and fit.ground.strays < ONE


def caught(ground: Ground, before: Fit | None, rows: list[Screened]) -> list[Fit]:
    """Fits of a cause more, of those screened, whose large change explains peaks that no mode explains yet.

    Those that leave a peak more than the best need no fit if one of the best explains everything.
    """
    if strays_left(ground, before) < ONE:
        return []
    spread = {row.candidate.name: row.spread for row in rows}
    first, start, base = ((), np.zeros(0), 0.0) if before is None else (before.choices, before.theta, before.gain)

    def caught_by(trial: _Trial) -> Fit:
        sizes = np.concatenate([start, trial.theta])
        guess = Fit.guessed(ground, (*first, trial.picked), sizes, spread[trial.picked.candidate.name])
        return settled(ground, guess, base - _BEHIND)

    tried = _catching(ground, before)
    fewest = min((trial.strays for trial in tried), default=0.0)
    best = [trial for trial in tried if trial.strays < fewest + _FEWER]
    fits = side_by_side(caught_by, best, ground.known)
    if any(clears(fit) for fit in fits):
        return fits
    return fits + side_by_side(caught_by, [trial for trial in tried if trial not in best], ground.known)


def _catching(ground: Ground, before: Fit | None) -> list[_Trial]:
    """Single causes that explain strays on top of a fit, of the `budget` causes that explain most."""
    world = ground.world if before is None else before.world
    taken = () if before is None else before.names

    def best_along(direction: tuple[Choice, np.ndarray]) -> _Trial:
        return _best_along(ground, world, *direction)

    moving = [c for c in ground.candidates if c.name not in taken and _moves_modes(ground, c)]
    tried = [choice(candidate, pattern, _SCALE) for candidate in moving for pattern in candidate.patterns[:2]]
    directions = [(picked, direction) for picked in tried for direction in _directions(picked)]
    by_cause: dict[str, list[_Trial]] = {}
    for trial in side_by_side(best_along, directions, ground.known):
        by_cause.setdefault(trial.picked.candidate.name, []).append(trial)
    left = strays_in(ground.setting, world)
    first = sorted(by_cause.values(), key=lambda trials: min(map(_fewest, trials)))[: ground.budget]
    return [one for trials in first for one in trials if one.strays < left - _FEWER]


def _fewest(trial: _Trial) -> float:
    """Strays; among equals the smaller change."""
    return trial.strays + 0.01 * float(np.abs(trial.theta).max())


def _directions(picked: Choice) -> list[np.ndarray]:
    """Each number of a pattern that has few."""
    d = len(picked.prior)
    return list(np.eye(d)) if d <= _MOST_NUMBERS else []


def _best_along(ground: Ground, world: World, picked: Choice, direction: np.ndarray) -> _Trial:
    """The best large size along a direction, and from there by steps that each leave fewer strays."""
    sizes = [step / _SCALE * direction for step in _STEPS]
    best = min((_trial(ground, world, picked, theta) for theta in sizes), key=_fewest)
    while SEVERAL < best.strays < np.inf:
        steps = [0.4 * best.theta, -0.3 * best.theta]
        if 1 < len(best.theta) <= _MOST_NUMBERS:
            steps += [sign * row / _SCALE for row in np.eye(len(best.theta)) for sign in (1.0, -1.0)]
        near = min((_trial(ground, world, picked, best.theta + step) for step in steps), key=_fewest)
        if near.strays > best.strays - _FEWER:
            break
        best = near
    return best


def _moves_modes(ground: Ground, candidate: Candidate) -> bool:
    rows = ground.setting.labels.block == "RF"
    if "RF" not in candidate.cause.seen_in or not rows.any():
        return False
    pattern = candidate.patterns[0]
    moved = (ground.null.lower @ candidate.signature)[rows] @ (pattern.basis * pattern.prior)
    return float(np.abs(moved).max()) * max(_STEPS) > _MOVES


def _trial(ground: Ground, world: World, picked: Choice, theta: np.ndarray) -> _Trial:
    """Strays are infinite if there is no such world."""
    if (theta < picked.pattern.lowest).any():
        return _Trial(picked, theta, np.inf)
    try:
        changed = picked.candidate.cause.apply(world, (theta * picked.prior) @ picked.pattern.basis.T)
        return _Trial(picked, theta, strays_in(ground.setting, changed))
    except (ValueError, CdprError):  # a body or a cable that cannot exist, or a pose that does not hold
        return _Trial(picked, theta, np.inf)
