"""One cause, several causes, or nothing: refits with all causes free, forward, exchange, backward.

Residuals bend with large effects, so causes near the best are refitted by Gauss and Newton through the whole
computation; the evidence is then Laplace's at the refitted size.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from cdpr_struct.diagnosis.evidence import Candidate, Choice, Screened, choices, log_bayes_factor, screen
from cdpr_struct.diagnosis.null_model import NullModel, null_model
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import Setting, residuals
from cdpr_struct.diagnosis.setting import anchored
from cdpr_struct.diagnosis.world import World

MOST_CAUSES = 3
NEAR = 12.0  # nats from the best at screening: refitted
LEAST = 3.0  # nats below which a cause is not worth settling
_SETTLED = 3.0
_ITERATIONS = 4
_STEP = 0.02  # of the prior's sigma


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """What hypotheses are judged on: fixed part, world and readings as entered, null and whitened residuals.

    level : minus the log evidence of the null as entered, so that gains compare;  extra : (n,) noise of bending
    """

    setting: Setting
    world: World
    readings: Readings
    null: NullModel
    candidates: list[Candidate]
    budget: int
    level: float
    extra: np.ndarray

    @property
    def z(self) -> np.ndarray:
        """(n,) whitened residuals as entered."""
        return self.null.white(self.null.r)


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """Causes with their refitted sizes.

    choices : pattern and scale of each;  theta (d,) stacked, in prior sigmas;  covariance (d, d)
    gain    : log evidence against the null;  ground : where it was judged
    white (n,) whitened residuals left;  signature (n, d) at the fit;  spread : gain by its other patterns
    """

    choices: tuple[Choice, ...]
    theta: np.ndarray
    covariance: np.ndarray
    gain: float
    white: np.ndarray
    signature: np.ndarray
    ground: "Ground"
    spread: float = 0.0

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(c.candidate.name for c in self.choices)

    def parts(self) -> list[np.ndarray]:
        """theta of each cause."""
        return np.split(self.theta, np.cumsum([c.signature.shape[1] for c in self.choices])[:-1])

    def explained(self, z: np.ndarray) -> float:
        """Share of the whitened sum of squares beyond noise that the causes take away, 0 to 1."""
        excess = float(z @ z) - len(z)
        left = float(self.white @ self.white) - len(z)
        return float(np.clip(1.0 - left / excess, 0.0, 1.0)) if excess > 0.0 else 0.0

    def adequacy(self) -> float:
        """chi^2 of what is left, sizes marginalised."""
        return float(self.white @ self.white + self.theta @ self.theta)


def world_with(world: World, picked: tuple[Choice, ...], theta: np.ndarray) -> World:
    """World with causes of sizes theta (..., d), in prior sigmas."""
    start = 0
    for choice in picked:
        d = choice.signature.shape[1]
        basic = (theta[..., start : start + d] * choice.prior) @ choice.pattern.basis.T
        world = choice.candidate.cause.apply(world, basic)
        start += d
    return world


def refit(ground: Ground, picked: tuple[Choice, ...], start: np.ndarray | None = None) -> Fit:
    """Gauss-Newton on all sizes together through the nonlinear residuals, steps halved while they do not help.

    The residuals are r(theta) = r0 - J theta, so the signature, d(model)/d(theta), has the sign of -J. With a start
    the search begins there, and the evidence is against zero residuals of the same ground.
    """
    theta = np.zeros(sum(c.signature.shape[1] for c in picked)) if start is None else start
    if start is None:
        white, signature = ground.z, -np.hstack([c.signature for c in picked])
    else:
        white = ground.null.white(_residuals(ground, picked, theta))
        signature = _signature(ground, picked, theta, white)
    cost = float(white @ white + theta @ theta)
    lowest = np.concatenate([c.pattern.lowest for c in picked])
    for _ in range(_ITERATIONS):
        matrix = np.eye(len(theta)) + signature.T @ signature
        target = np.linalg.solve(matrix, signature.T @ (white + signature @ theta))
        trials = theta + np.array([1.0, 0.5, 0.2])[:, None] * (np.maximum(target, lowest) - theta)
        whites = ground.null.white(_residuals(ground, picked, trials).T).T
        costs = (whites**2).sum(axis=1) + (trials**2).sum(axis=1)
        costs = np.where(np.isfinite(costs), costs, np.inf)
        best = int(costs.argmin())
        if costs[best] > cost - 1e-3:
            break
        done = costs[best] > cost - 0.1
        theta, white, cost = trials[best], whites[best], float(costs[best])
        signature = _signature(ground, picked, theta, white)
        if done:
            break
    matrix = np.eye(len(theta)) + signature.T @ signature
    level = ground.null.level if start is None else ground.level
    gain = level - 0.5 * (cost + np.linalg.slogdet(matrix)[1]) - ground.null.log_volume
    gain += sum(c.log_weight for c in picked)
    return Fit(picked, theta, np.linalg.inv(matrix), float(gain), white, signature, ground)


def settled(ground: Ground, fit: Fit) -> Fit:
    """The fit again, with frequencies paired in its own world and the null linearised there."""
    world = world_with(ground.world, fit.choices, fit.theta)
    setting = anchored(ground.setting, world) if ground.setting.robot_rows.omega.size else ground.setting
    null = null_model(setting, world, ground.readings, extra=ground.extra)
    there = replace(ground, setting=setting, null=null)
    again = refit(there, fit.choices, fit.theta)
    return replace(again, gain=again.gain + fit.spread, spread=fit.spread)


def _residuals(ground: Ground, picked: tuple[Choice, ...], theta: np.ndarray) -> np.ndarray:
    return residuals(ground.setting, world_with(ground.world, picked, theta), ground.readings)


def _signature(ground: Ground, picked: tuple[Choice, ...], theta: np.ndarray, white: np.ndarray) -> np.ndarray:
    moved = _residuals(ground, picked, theta + _STEP * np.eye(len(theta)))
    return -(ground.null.white(moved.T) - white[:, None]) / _STEP


def rank(ground: Ground, accepted: tuple[Choice, ...] = ()) -> list[Fit]:
    """Refits of accepted causes plus one more, best first; causes far from the best at screening are left out."""
    taken = {c.candidate.name for c in accepted}
    others = np.hstack([c.signature for c in accepted]) if accepted else None
    rows = screen([c for c in ground.candidates if c.name not in taken], ground.z, others)
    near = [row for row in rows if row.gain > rows[0].gain - NEAR or len(rows) < 4]
    # What looks far off at first sight may come near when refitted: the best few always get their chance.
    chosen = {row.candidate.name: row for row in [*rows[: ground.budget], *near[: 2 * ground.budget]]}
    fits = []
    for row in chosen.values():
        spread = max(row.gain - _own(row.best, ground.z, others), 0.0)
        for choice in _worth_trying(row):
            fit = refit(ground, (*accepted, choice))
            fits.append(replace(fit, gain=fit.gain + spread, spread=spread))
    best = max((fit.gain for fit in fits), default=0.0)
    if best >= LEAST:
        fits = [settled(ground, fit) for fit in fits if fit.gain > best - _SETTLED * NEAR]
    alone: dict[tuple[str, ...], Fit] = {}
    for fit in sorted(fits, key=lambda fit: -fit.gain):
        alone.setdefault(fit.names, fit)
    return list(alone.values())


def _worth_trying(row: Screened) -> list[Choice]:
    """The pattern that screening prefers, and all cables alike."""
    alike = [c for c in choices(row.candidate) if c.pattern.label == "all alike" and c.scale == row.best.scale]
    return [row.best, *(c for c in alike if row.best.pattern.label != "all alike")]


def _own(choice: Choice, z: np.ndarray, others: np.ndarray | None) -> float:
    signature = choice.signature if others is None else np.hstack([others, choice.signature])
    return float(log_bayes_factor(signature, z)) + choice.log_weight


@dataclass(frozen=True, slots=True, eq=False)
class Selection:
    """What was chosen.

    fit    : the chosen causes, or None for none;  first : all single causes refitted, best first
    rivals : per chosen cause, the fits in which another cause takes its place, best first
    """

    fit: Fit | None
    first: list[Fit]
    rivals: list[list[Fit]]


def select(ground: Ground, first_threshold: float, next_threshold: float) -> Selection:
    """Forward selection with an exchange step; a cause is taken if it raises the log evidence by its threshold."""
    first = rank(ground)
    if not first or first[0].gain < first_threshold:
        return Selection(None, first, [])
    best = first[0]
    while len(best.choices) < MOST_CAUSES and not _is_noise(best):
        further = rank(ground, best.choices)
        if not further or further[0].gain < best.gain + next_threshold:
            break
        best = _exchanged(ground, further[0])
    rivals = []
    for i in range(len(best.choices)):
        kept = tuple(c for j, c in enumerate(best.choices) if j != i)
        rivals.append([fit for fit in (rank(ground, kept) if kept else first) if fit.names[-1] != best.names[i]])
    return Selection(best, first, rivals)


def _is_noise(fit: Fit) -> bool:
    return float(chi2.sf(fit.adequacy(), len(fit.white))) > 0.2


def _exchanged(ground: Ground, fit: Fit) -> Fit:
    """The fit after each cause but the last had its chance to be replaced by a better one."""
    for i in range(len(fit.choices) - 1):
        kept = tuple(c for j, c in enumerate(fit.choices) if j != i)
        other = rank(ground, kept)
        if other and other[0].gain > fit.gain + 0.5:
            fit = other[0]
    return fit
