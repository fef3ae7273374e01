"""Refits: all sizes of a set of causes together through the nonlinear residuals, and the evidence there.

Residuals bend with large effects, so causes near the best are refitted by Gauss and Newton through the whole
computation; the evidence is then Laplace's at the refitted size.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from cdpr_struct.diagnosis.evidence import Candidate, Choice, Screened, screen
from cdpr_struct.diagnosis.mode_pairing import STRAY_NATS
from cdpr_struct.diagnosis.null_model import NullModel, likeliest_tolerances, relinearised, tolerated
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import Setting, residuals
from cdpr_struct.diagnosis.setting import anchored
from cdpr_struct.diagnosis.world import World
from cdpr_struct.errors import CdprError

_ITERATIONS = 8
_STEP = 0.02  # of the prior's sigma
ASTRAY = 0.5  # strays of a world that is not right yet
_FEWER = 0.3  # strays by which another must be better


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """What hypotheses are judged on.

    world : as entered but for the likeliest tolerances (t,);  offset : (n,) what these did to the residuals, undone
    level : minus the log evidence of the null, so that gains compare;  extra : (n,) noise of bending
    entered : world as entered, where that is not `world`
    stray  : probability of each robot frequency to belong to no mode of the world it is about
    """

    setting: Setting
    world: World
    readings: Readings
    null: NullModel
    candidates: list[Candidate]
    budget: int
    level: float
    extra: np.ndarray
    likeliest: np.ndarray
    offset: np.ndarray
    entered: World
    stray: np.ndarray = field(default_factory=lambda: np.zeros(0))

    @property
    def z(self) -> np.ndarray:
        """(n,) whitened residuals as entered."""
        return self.null.white(self.null.r)

    @property
    def known(self) -> list[object]:
        """What fits on this ground share with it."""
        causes = [candidate.cause for candidate in self.candidates]
        fixed = [self.setting, self.setting.campaign, self.world, self.null, self.candidates]
        return [self, *fixed, *self.candidates, *causes]

    @property
    def paired(self) -> bool:
        """Whether there are robot frequencies, which each world pairs with its own modes."""
        return self.setting.robot_log.size > 0

    @property
    def strays(self) -> float:
        """Expected number of robot frequencies that belong to no mode."""
        return float(self.stray.sum())

    @property
    def ahead(self) -> float:
        """Log evidence of no cause at all beyond that in this ground, whose frequencies may be paired more freely."""
        return self.null.level + STRAY_NATS * self.setting.strays - self.level


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

    @classmethod
    def guessed(cls, ground: Ground, choices: tuple[Choice, ...], theta: np.ndarray, spread: float) -> "Fit":
        """Causes at sizes to start from."""
        blank = np.zeros((len(ground.null.r), len(theta)))
        return cls(choices, theta, np.eye(len(theta)), -np.inf, ground.z, blank, ground, spread)

    def also_by(self, spread: float) -> "Fit":
        """The fit with what its other patterns add to the gain."""
        return replace(self, gain=self.gain + spread, spread=spread)

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(c.candidate.name for c in self.choices)

    @property
    def bare(self) -> np.ndarray:
        """(n,) whitened residuals without the causes, to first order at the fit."""
        return self.white + self.signature @ self.theta

    @property
    def left(self) -> np.ndarray:
        """(n,) residuals left, in their own units."""
        result: np.ndarray = self.ground.null.lower @ self.white
        return result

    @property
    def world(self) -> World:
        """The world with the causes."""
        return world_with(self.ground.world, self.choices, self.theta)

    def parts(self) -> list[np.ndarray]:
        """theta of each cause."""
        return self.split(self.theta)

    def split(self, value: np.ndarray) -> list[np.ndarray]:
        """Parts of (..., d) numbers, those of each cause."""
        return np.split(value, np.cumsum([len(c.prior) for c in self.choices])[:-1], axis=-1)

    def explained(self, z: np.ndarray) -> float:
        """Share of the whitened sum of squares beyond noise that the causes take away, 0 to 1."""
        return explained_share(z, self.white)

    def adequacy(self) -> float:
        """chi^2 of what is left, sizes marginalised."""
        return float(self.white @ self.white + self.theta @ self.theta)


def explained_share(before: np.ndarray, after: np.ndarray) -> float:
    """Share of a whitened sum of squares beyond noise that is gone afterwards, 0 to 1; 0 where there was none."""
    excess, left = (float(z @ z) - len(z) for z in (before, after))
    return float(np.clip(1.0 - left / excess, 0.0, 1.0)) if excess > 0.0 else 0.0


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
    the search begins there in the ground of an earlier fit, and the evidence is against no cause at all.
    """
    theta = np.zeros(sum(c.signature.shape[1] for c in picked)) if start is None else start
    if start is None:
        white, signature = ground.z, -np.hstack([c.signature for c in picked])
    else:
        white = ground.null.white(_residuals(ground, picked, theta))
        signature = _signature(ground, picked, theta)
    cost = float(white @ white + theta @ theta)
    lowest = np.concatenate([c.pattern.lowest for c in picked])
    for _ in range(_ITERATIONS):
        matrix = np.eye(len(theta)) + signature.T @ signature
        target = np.linalg.solve(matrix, signature.T @ (white + signature @ theta))
        trials = theta + np.array([1.0, 0.5, 0.2])[:, None] * (np.maximum(target, lowest) - theta)
        whites = ground.null.white(_residuals(ground, picked, trials).T).T
        costs = (whites**2).sum(axis=1) + (trials**2).sum(axis=1)
        possible = world_with(ground.world, picked, trials).bodies_exist()
        costs = np.where(np.isfinite(costs) & possible, costs, np.inf)
        best = int(costs.argmin())
        if costs[best] > cost - 1e-3:
            break
        done = costs[best] > cost - 0.1
        theta, white, cost = trials[best], whites[best], float(costs[best])
        signature = _signature(ground, picked, theta)
        if done:
            break
    matrix = np.eye(len(theta)) + signature.T @ signature
    level = ground.null.level if start is None else ground.level
    gain = level - 0.5 * (cost + np.linalg.slogdet(matrix)[1]) - ground.null.log_volume
    gain -= 0.0 if start is None else STRAY_NATS * ground.strays
    gain += sum(c.log_weight for c in picked)
    return Fit(picked, theta, np.linalg.inv(matrix), float(gain), white, signature, ground)


def settled(ground: Ground, fit: Fit, reach: float = -np.inf) -> Fit:
    """The fit again in its own world: frequencies paired and the null linearised there; strays cost evidence.

    Its tolerances are those that are likeliest beside the causes. Where peaks stay astray the world was not right yet,
    and it is settled again as long as fewer are left, its log evidence rises, and is within reach of what is better.
    """
    fits = [_settled_once(ground, fit)]
    while fits[-1].ground.strays > ASTRAY and fits[-1].gain > reach:
        again = _settled_once(ground, fits[-1])
        if again.ground.strays > fits[-1].ground.strays - _FEWER or again.gain < fits[-1].gain:
            break
        fits.append(again)
    return max(fits, key=lambda one: one.gain)


def _settled_once(ground: Ground, fit: Fit) -> Fit:
    """One pass; a guess, which has explained nothing yet, says nothing of tolerances and keeps those of the ground.

    Sizes at the edge of what can exist may be beyond it with other tolerances: then those of the fit are kept.
    """
    grounds = [ground] if not np.isfinite(fit.gain) else [_beside(ground, fit), _as_in(ground, fit.ground)]
    for about in grounds:
        world = world_with(about.world, fit.choices, fit.theta)
        try:
            setting = anchored(about.setting, world)
        except (ValueError, CdprError):  # a body or a cable that cannot exist, or a pose that does not hold
            continue
        null, offset = relinearised(setting, world, about.readings, about.extra, about.likeliest)
        there = replace(about, setting=setting, null=null, offset=offset, stray=setting.stray)
        return refit(there, fit.choices, fit.theta).also_by(fit.spread)
    return replace(fit, gain=-np.inf)


def _beside(ground: Ground, fit: Fit) -> Ground:
    """The ground about the tolerances that are likeliest beside the causes of a fit."""
    u = likeliest_tolerances(fit.ground.setting, fit.ground.null, fit.white)
    return replace(ground, likeliest=u, world=tolerated(ground.setting, ground.entered, u))


def _as_in(ground: Ground, other: Ground) -> Ground:
    """The ground about the tolerances of another one."""
    return replace(ground, likeliest=other.likeliest, world=other.world)


def screen_beyond(fit: Fit, found: list[Candidate]) -> list[Screened]:
    """Gain of each cause, with its signature in the fit's world, on top of the fit's own; best first."""
    return screen(found, fit.bare, fit.signature)


def _residuals(ground: Ground, picked: tuple[Choice, ...], theta: np.ndarray) -> np.ndarray:
    return residuals(ground.setting, world_with(ground.world, picked, theta), ground.readings) + ground.offset


def _signature(ground: Ground, picked: tuple[Choice, ...], theta: np.ndarray) -> np.ndarray:
    """(n, d) by differences, frequencies to first order."""
    trials = theta + _STEP * np.concatenate([np.zeros((1, len(theta))), np.eye(len(theta))])
    moved = residuals(ground.setting, world_with(ground.world, picked, trials), ground.readings, small=True)
    return -ground.null.white((moved[1:] - moved[0]).T) / _STEP
