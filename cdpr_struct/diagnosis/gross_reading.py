"""A tension so wrong that nothing can be computed with it: a dead cell, a slip of the pen by a factor.

Tensions are put into the model as they were read, so a cable that seems slack sags, and derivatives are those of
another robot. Where one other tension of one cable would balance a state's weight as well as that of other states is
balanced, the reading is replaced by it, with a sigma too wide to say anything, and told like any that is set aside.
"""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.conditioned_state import LEAST_TENSION, condition, held_state, unbalanced
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import readings_of_states
from cdpr_struct.diagnosis.setting import circumstances
from cdpr_struct.diagnosis.suspect_reading import Suspect
from cdpr_struct.diagnosis.world import World
from cdpr_struct.measurement.campaign import Campaign

_FEWEST = 3  # states, of which most tell how well weights are balanced
_GROSS = 100.0  # chi^2 per number of a state's balance, in units of what most states leave
_MENDED, _ALONE = 0.04, 4.0  # share of it left with the other tension; how much more any other cable leaves
_STEPS, _TOP = 120, 5.0  # tensions tried; the largest, in medians of all
_WIDE = 0.2  # sigma of the replaced reading, of its new value


def without_gross_tension(campaign: Campaign) -> tuple[Campaign, Suspect] | None:
    """The campaign with its clearest gross tension replaced, and which it was; None if there is none."""
    states = campaign.states
    held = np.flatnonzero(np.isfinite(states.tension).all(axis=1))
    if len(held) < _FEWEST or np.median(states.tension[held]) <= LEAST_TENSION:
        return None
    tried = np.geomspace(LEAST_TENSION, _TOP * float(np.median(states.tension[held])), _STEPS)
    before, after = _imbalances(campaign, held, tried)
    scale = max(1.0, float(np.median(before)))
    best = after.min(axis=0)
    i, c = (int(k) for k in np.unravel_index((best / before[:, None]).argmin(), best.shape))
    second = float(np.delete(best[i], c).min())
    if before[i] < _GROSS * scale or best[i, c] > _MENDED * before[i] or second < _ALONE * max(best[i, c], scale):
        return None
    state, value = int(held[i]), float(tried[after[:, i, c].argmin()])
    off = abs(value - float(states.tension[state, c])) / float(states.tension_sigma[state, c])
    tension, sigma = states.tension.copy(), states.tension_sigma.copy()
    tension[state, c], sigma[state, c] = value, max(_WIDE * value, float(sigma[state, c]))
    gain = 3.0 * (before[i] - best[i, c]) / scale
    wrong = Suspect("tension", state, c, -1, off, gain)
    return replace(campaign, states=replace(states, tension=tension, tension_sigma=sigma)), wrong


def _imbalances(campaign: Campaign, held: np.ndarray, tried: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """chi^2 per number of the balance of states (s,), as read and (g, s, m) with each tried tension in each cable."""
    states, wide = campaign.states, World.of(campaign.robot).per_state()
    readings, known = readings_of_states(Readings.of(states), held), circumstances(campaign).at(held)
    read = condition(wide, readings, known)
    own = _wrenches(read.arms, read.cables.force_on_platform)
    alike = np.broadcast_to(tried[:, None, None], (len(tried), *readings.tension.shape))
    other = held_state(wide, read.position, read.rotation, alike, known)
    other_wrench = _wrenches(other.arms, other.cables.force_on_platform)
    middle = len(tried) // 2
    unit = other_wrench[middle] / tried[middle] * states.tension_sigma[held][..., None]
    noise = np.linalg.cholesky(np.einsum("smi,smj->sij", unit, unit))
    left = unbalanced(wide, read, known)
    changed = left[:, None] - own + other_wrench
    return _per_number(noise, left[:, None])[:, 0], _per_number(noise, changed)


def _wrenches(arms: np.ndarray, force: np.ndarray) -> np.ndarray:
    """(..., s, m, 6) about the platform origin."""
    return np.concatenate([force, np.cross(np.broadcast_to(arms, force.shape), force)], axis=-1)


def _per_number(noise: np.ndarray, wrench: np.ndarray) -> np.ndarray:
    """chi^2 / 6 (..., s, k) of wrenches (..., s, k, 6) with Cholesky factors of their covariance (s, 6, 6)."""
    white = np.linalg.solve(noise, np.swapaxes(wrench, -1, -2))
    result: np.ndarray = (white**2).mean(axis=-2)
    return result
