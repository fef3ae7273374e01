"""The whole change of a cause's parameters: the cause, and what tolerances of the same parameters add to it.

A cause is fitted beside tolerances, as if each anchor were off by the cause and by its own tolerance besides. What a
ruler would show is the sum, and data tell the sum better than its parts.
"""

from dataclasses import fields

import numpy as np

from cdpr_struct.diagnosis.evidence import Choice
from cdpr_struct.diagnosis.null_model import tolerance_columns, tolerance_count, tolerated
from cdpr_struct.diagnosis.refit import Fit
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.world import World

_STEP = 1e-4  # of a sigma
_SAME = 1e-3  # of a tolerance's change that a cause cannot make


def whole_change(fit: Fit) -> tuple[np.ndarray, np.ndarray]:
    """(d,) sizes of the causes with the tolerances of their own parameters, in prior sigmas, and covariance (d, d).

    Residuals are z - S theta + C u with tolerances u, so for a given theta these have the mean -C'(z - S theta) and the
    covariance 1 - C'C. With shares M of the tolerances in the parameters the whole change is theta + M u.
    """
    setting = fit.ground.setting
    columns = tolerance_columns(setting, fit.ground.null)
    shares = np.concatenate([_shares(setting, fit.world, choice) for choice in fit.choices])
    slope = np.eye(len(fit.theta)) + shares @ columns.T @ fit.signature
    alone = shares @ (np.eye(columns.shape[1]) - columns.T @ columns) @ shares.T
    return fit.theta - shares @ columns.T @ fit.white, slope @ fit.covariance @ slope.T + alone


def _shares(setting: Setting, world: World, choice: Choice) -> np.ndarray:
    """(d, t) change of a cause's parameters, in prior sigmas, by one sigma of each tolerance; 0 of other parameters."""
    cause, pattern = choice.candidate.cause, choice.pattern
    prior = np.array([parameter.prior for parameter in cause.basic(setting)])
    by_cause = cause.apply(world, _STEP * np.diag(prior))
    by_tolerance = tolerated(setting, world, _STEP * np.eye(tolerance_count(setting)))
    names = [f.name for f in fields(World) if by_cause.is_batched(f.name) or by_tolerance.is_batched(f.name)]
    own = np.concatenate([_change(world, by_cause, name, len(prior)) for name in names])
    other = np.concatenate([_change(world, by_tolerance, name, tolerance_count(setting)) for name in names])
    size = np.maximum(np.abs(own).max(axis=1), np.abs(other).max(axis=1))
    own, other = (change[size > 0.0] / size[size > 0.0, None] for change in (own, other))
    made = np.linalg.lstsq(own, other, rcond=None)[0]
    made[:, np.linalg.norm(other - own @ made, axis=0) > _SAME * np.linalg.norm(other, axis=0)] = 0.0
    result: np.ndarray = np.linalg.pinv(pattern.basis) @ (prior[:, None] * made) / choice.prior[:, None]
    return result


def _change(world: World, moved: World, name: str, steps: int) -> np.ndarray:
    """(., k) change of a field by each of k steps."""
    value: np.ndarray = getattr(world, name)
    change = np.broadcast_to(getattr(moved, name) - value, (steps, *value.shape))
    return change.reshape((steps, -1)).T
