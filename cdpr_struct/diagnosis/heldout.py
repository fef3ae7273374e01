"""Does an extended model predict states and kinds of data that it was not fitted to?"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular

from cdpr_struct.diagnosis.evidence import log_bayes_factor
from cdpr_struct.diagnosis.mode_pairing import STRAY_NATS
from cdpr_struct.diagnosis.refit import Fit
from cdpr_struct.diagnosis.residuals import UNITS, Labels, Setting


@dataclass(frozen=True, slots=True, eq=False)
class Held:
    """Residuals (n,) of data that were not fitted, before and after, and their one sigma under the null."""

    labels: Labels
    before: np.ndarray
    after: np.ndarray
    sigma: np.ndarray

    @property
    def concerned(self) -> np.ndarray:
        """(n,) where the cause, fitted to other data, predicts a change beyond one sigma (at least a tenth of all)."""
        change = np.abs(self.before - self.after) / self.sigma
        return change > min(1.0, float(np.quantile(change, 0.9)))

    def rms(self, rows: np.ndarray | None = None) -> tuple[float, float]:
        """Root mean squares before and after, in sigmas."""
        pick = slice(None) if rows is None else rows
        before, after = (float(np.sqrt(np.mean((r[pick] / self.sigma[pick]) ** 2))) for r in (self.before, self.after))
        return before, after

    def ratio(self, rows: np.ndarray | None = None) -> float:
        """How many times smaller the error became, errors counted in their sigmas."""
        before, after = self.rms(rows)
        return before / max(after, 1e-12)

    def by_kind(self, read: np.ndarray) -> dict[str, dict[str, float | str]]:
        """Root mean squares of each block over the readings that the cause concerns, before and after.

        The ratio is that of errors in their sigmas, as `ratio` counts them.

        Parameters
        ----------
        read : (n,) rows that hold readings at all
        """
        table: dict[str, dict[str, float | str]] = {}
        for block, unit in UNITS.items():
            own = (self.labels.block == block) & read
            rows = own & self.concerned
            if not rows.any():
                continue
            before, after = (float(np.sqrt(np.mean(r[rows] ** 2))) for r in (self.before, self.after))
            sigmas = self.rms(rows)
            table[_NAMES[block]] = {
                "before": before, "after": after, "unit": unit, "ratio": self.ratio(rows), "counted": int(rows.sum()),
                "of": int(own.sum()), "before_sigmas": sigmas[0], "after_sigmas": sigmas[1],
            }  # fmt: skip
        return table


_NAMES = {
    "EQ": "static_state (wrench balance)", "CO": "static_state (cable lengths)", "NS": "static_state (internal force)",
    "LP": "loaded_pose", "CF": "cable_frequency", "RF": "robot_frequency", "FA": "frf (modal constants)",
}  # fmt: skip


def groups_of(setting: Setting) -> np.ndarray:
    """(n,) groups that are left out together: a state, or all states of one lock; with a single one, a kind of data."""
    state, lock = setting.labels.state, setting.campaign.states.lock
    groups = np.where(lock[state] >= 0, 1_000_000 + lock[state], state)
    if len(np.unique(groups)) < 2:
        return np.unique(setting.labels.block.astype(str), return_inverse=True)[1]
    return groups


def weakest(fit: Fit, groups: np.ndarray, caught: np.ndarray) -> np.ndarray:
    """Per cause of a fit, the log evidence that it adds to the others, with the group left out that it needs most.

    Linear about the fit, and robot frequencies (r,) that belong to no mode without a cause: `caught` (causes, r) is by
    how much less probable that is with it. A cause that lives on one group of states alone explains that group, not
    the robot.
    """
    null, peaks = fit.ground.null, groups[fit.ground.setting.labels.block == "RF"]
    zero, signature = null.lower @ fit.bare, null.lower @ fit.signature
    owner = np.repeat(np.arange(len(fit.choices)), [c.signature.shape[1] for c in fit.choices])
    least = np.full(len(fit.choices), np.inf)
    for group in np.unique(groups):
        rows = groups != group
        white = null.white_among(rows, np.column_stack([zero, signature]))
        z, columns = white[:, 0], white[:, 1:]
        whole = float(log_bayes_factor(columns, z))
        for i in range(len(least)):
            strays = STRAY_NATS * float(caught[i] @ (peaks != group))
            least[i] = min(least[i], whole - float(log_bayes_factor(columns[:, owner != i], z)) + max(strays, 0.0))
    return least


def left_out(fit: Fit, nominal: np.ndarray, groups: np.ndarray) -> Held:
    """Each group predicted from the fit to all the others, linear about the fit.

    Parameters
    ----------
    nominal : (n,) residuals of the model as entered;  groups : (n,) labels of the groups
    """
    null = fit.ground.null
    signature = null.lower @ fit.signature
    zero = null.lower @ fit.white + signature @ fit.theta
    return predicted(fit.ground.setting.labels, nominal, zero, signature, null.covariance, groups)


def predicted(
    labels: Labels, nominal: np.ndarray, zero: np.ndarray, signature: np.ndarray, covariance: np.ndarray,
    groups: np.ndarray,
) -> Held:  # fmt: skip
    """Held-out residuals of a linear model: zero (n,) at theta = 0, d(model)/d(theta) (n, d), theta in prior sigmas."""
    after = np.zeros(len(zero))
    for group in np.unique(groups):
        out = groups == group
        fitted = _fit_to(zero[~out], signature[~out], covariance[np.ix_(~out, ~out)])
        after[out] = zero[out] - signature[out] @ fitted
    return Held(labels, nominal, after, np.sqrt(np.diagonal(covariance)))


def _fit_to(zero: np.ndarray, signature: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """theta (d,) that fits the given rows best, prior included."""
    lower = np.linalg.cholesky(covariance)
    white, columns = (solve_triangular(lower, part, lower=True) for part in (zero, signature))
    result: np.ndarray = np.linalg.solve(np.eye(columns.shape[1]) + columns.T @ columns, columns.T @ white)
    return result


def transfer(fit: Fit, nominal: np.ndarray) -> dict[str, float]:
    """Per kind of data, how many times smaller its error is when fitted to the other kinds only."""
    kinds = fit.ground.setting.labels.kind
    if len(set(kinds.tolist())) < 2:
        return {}
    held = left_out(fit, nominal, kinds)
    return {str(kind): held.ratio(kinds == kind) for kind in dict.fromkeys(kinds.tolist())}
