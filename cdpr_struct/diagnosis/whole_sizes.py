"""The whole change of a cause's parameters: the cause, and what tolerances of the same parameters add to it.

A cause is fitted beside tolerances, as if each anchor were off by the cause and by its own tolerance besides. What a
ruler would show is the sum, and data tell the sum better than its parts.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Seen
from cdpr_struct.hypotheses.hypothesis import SCALES, Part
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.residuals.linearised import Term
from cdpr_struct.residuals.recorded import Recorded
from cdpr_struct.robot.parameters import PARAMETERS
from cdpr_struct.robot.robot_arrays import RobotArrays

_STEP = 1e-4  # of a sigma: changes are linear in it
_FREE = 3.0  # sigmas from its bound, from which a number is as good as free
_SAME = 1e-3  # of a tolerance's change: what of it a cause cannot make, where it is the same change


@dataclass(frozen=True, slots=True, eq=False)
class WholeSize:
    """Numbers of a cause's pattern, (d,) in their own units, and their covariance (d, d)."""

    part: Part
    mean: np.ndarray
    covariance: np.ndarray

    @property
    def sigma(self) -> np.ndarray:
        """(d,)."""
        return np.sqrt(np.diagonal(self.covariance))

    @property
    def parameters(self) -> dict[str, dict[str, float | str]]:
        """Value, sigma and unit of each, as they are reported."""
        named = zip(self.part.pattern.parameters, self.mean, self.sigma, strict=True)
        return {p.name: p.shown(float(t), float(s)) for p, t, s in named}

    @property
    def is_change(self) -> bool:
        """Whether all sizes together are a sigma or more from what was entered."""
        return float(self.mean @ np.linalg.solve(self.covariance, self.mean)) > 1.0


def whole_sizes(data: Recorded, seen: Seen, found: Judged) -> list[WholeSize]:
    """Of each cause of a hypothesis; laws outside the model have no parameters, and those and lines are left out."""
    arrays = found.point.robot(data)
    mean, covariance = over_scales(found)
    tolerance, start = found.point.terms[0], len(mean) - sum(len(p.pattern.prior) for p in found.hypothesis.parts)
    rows = []
    for part in found.hypothesis.parts:
        d = len(part.pattern.prior)
        own = np.zeros((d, len(mean)))
        own[:, start : start + d] = np.diag(part.scale * part.pattern.prior)
        start += d
        if part.law is None:
            own[:, : len(tolerance.sigma)] += _shares(seen, arrays, tolerance, part)
        if part.cause.name != UNKNOWN and not part.cause.outside:
            rows.append(WholeSize(part, own @ mean, own @ covariance @ own.T))
    return rows


def over_scales(found: Judged) -> tuple[np.ndarray, np.ndarray]:
    """Mean (t,) and covariance (t, t) of all numbers, the scale of each single one averaged over.

    A fit is that of the likeliest scale, which draws a large number towards nothing. Vectors keep theirs, since it says
    how large those of their parts are that the data do not show; so do numbers whose bound is near.
    """
    mean, covariance = found.fit.z_mean.copy(), found.fit.z_covariance.copy()
    at = len(mean) - sum(len(part.pattern.prior) for part in found.hypothesis.parts)
    for part in found.hypothesis.parts:
        d, spread = len(part.pattern.prior), float(np.sqrt(covariance[at, at]))
        bounded = bool(part.pattern.positive[0]) and mean[at] < _FREE * spread
        if d == 1 and not bounded and not part.cause.tuned and spread < 1.0:
            value, variance = _averaged(float(mean[at]), spread**2, np.array(SCALES) / part.scale)
            along = covariance[:, at] / spread**2
            mean = mean + along * (value - mean[at])
            covariance = covariance + np.outer(along, along) * (variance - spread**2)
        at += d
    return mean, covariance


def _averaged(mean: float, variance: float, scales: np.ndarray) -> tuple[float, float]:
    """Mean and variance of a number under priors of several sigmas, equally likely, from those under a sigma of 1."""
    sure = 1.0 / variance - 1.0
    said, own = mean / variance / sure, 1.0 / sure
    whole = own + scales**2
    log = -0.5 * (said**2 / whole + np.log(whole))
    weight = np.exp(log - log.max()) / np.exp(log - log.max()).sum()
    means, variances = said * scales**2 / whole, own * scales**2 / whole
    middle = float(weight @ means)
    return middle, float(weight @ (variances + (means - middle) ** 2))


def _shares(seen: Seen, arrays: RobotArrays, tolerance: Term, part: Part) -> np.ndarray:
    """(d, t) change of a pattern's numbers by one sigma of each tolerance; zero of other parameters."""
    prior = np.array([parameter.prior for parameter in part.cause.basic(seen)])
    steps = _STEP * np.eye(len(prior))[:, None, :]
    by_cause = part.cause.apply(arrays, steps * prior)
    by_tolerance = tolerance.applied(arrays, _STEP * np.eye(len(tolerance.sigma))[:, None, :])
    own, other = _changes(arrays, by_cause, len(prior)), _changes(arrays, by_tolerance, len(tolerance.sigma))
    names = [name for name in PARAMETERS if name in own or name in other]
    zero = {name: np.zeros((_size(arrays, name), 1)) for name in names}
    columns = np.concatenate([own.get(n, np.repeat(zero[n], len(prior), axis=1)) for n in names])
    others = np.concatenate([other.get(n, np.repeat(zero[n], len(tolerance.sigma), axis=1)) for n in names])
    size = np.maximum(np.abs(columns).max(axis=1), np.abs(others).max(axis=1))
    columns, others = (change[size > 0.0] / size[size > 0.0, None] for change in (columns, others))
    made = np.linalg.lstsq(columns, others, rcond=None)[0]
    made[:, np.linalg.norm(others - columns @ made, axis=0) > _SAME * np.linalg.norm(others, axis=0)] = 0.0
    return np.asarray(np.linalg.pinv(part.pattern.basis) @ (prior[:, None] * made))


def _size(arrays: RobotArrays, name: str) -> int:
    value: np.ndarray = getattr(arrays, name)
    return int(np.prod(value.shape[value.ndim - PARAMETERS[name].axes :], dtype=int))


def _changes(arrays: RobotArrays, moved: RobotArrays, steps: int) -> dict[str, np.ndarray]:
    """Of each changed field, (numbers, steps) changes by each step; those of states are of the first one."""
    found = {}
    for name, rule in PARAMETERS.items():
        before, after = getattr(arrays, name), getattr(moved, name)
        if after is before:
            continue
        change = np.broadcast_to(after - before, np.broadcast_shapes(after.shape, before.shape))
        core = change.shape[change.ndim - rule.axes :]
        lead = change.shape[: change.ndim - rule.axes]
        flat = change.reshape((lead[0] if lead else 1, -1, *core))[:, 0]
        found[name] = np.broadcast_to(flat.reshape((len(flat), -1)), (steps, int(np.prod(core, dtype=int)))).T
    return found
