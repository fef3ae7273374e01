"""Does an extended model predict states and kinds of data that it was not fitted to?"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis.residuals import UNITS, Labels


@dataclass(frozen=True, slots=True, eq=False)
class Held:
    """Residuals (n,) of data that were not fitted, before and after, and their one sigma under the null."""

    labels: Labels
    before: np.ndarray
    after: np.ndarray
    sigma: np.ndarray

    def ratio(self, rows: np.ndarray | None = None) -> float:
        """How many times smaller the error became, errors counted in their sigmas."""
        pick = slice(None) if rows is None else rows
        size = [float(np.sqrt(np.mean((r[pick] / self.sigma[pick]) ** 2))) for r in (self.before, self.after)]
        return size[0] / max(size[1], 1e-12)

    def by_kind(self) -> dict[str, dict[str, float | str]]:
        """Root mean squares before and after of each block, in its unit."""
        table: dict[str, dict[str, float | str]] = {}
        for block, unit in UNITS.items():
            rows = self.labels.block == block
            if rows.any():
                before, after = (float(np.sqrt(np.mean(r[rows] ** 2))) for r in (self.before, self.after))
                table[f"{_NAMES[block]}"] = {"before": before, "after": after, "unit": unit, "ratio": before / after}
        return table


_NAMES = {
    "EQ": "static_state (wrench balance)", "CO": "static_state (cable lengths)", "NS": "static_state (internal force)",
    "LP": "loaded_pose", "CF": "cable_frequency", "RF": "robot_frequency",
}  # fmt: skip


def left_out(
    labels: Labels,
    nominal: np.ndarray,
    zero: np.ndarray,
    signature: np.ndarray,
    covariance: np.ndarray,
    groups: np.ndarray,
) -> Held:
    """Each group predicted from the fit to all the others.

    Parameters
    ----------
    nominal : (n,) residuals of the model as entered
    zero, signature : residuals (n,) at theta = 0 and d(model)/d(theta) (n, d), linear about the fit;
        theta in prior sigmas
    covariance : (n, n) under the null;  groups : (n,) labels of the groups
    """
    after = np.zeros(len(zero))
    for group in np.unique(groups):
        out = groups == group
        fitted = fit_to(zero[~out], signature[~out], covariance[np.ix_(~out, ~out)])
        after[out] = zero[out] - signature[out] @ fitted
    return Held(labels, nominal, after, np.sqrt(np.diagonal(covariance)))


def fit_to(zero: np.ndarray, signature: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """theta (d,) that fits the given rows best, prior included."""
    lower = np.linalg.cholesky(covariance)
    white, columns = np.linalg.solve(lower, zero), np.linalg.solve(lower, signature)
    result: np.ndarray = np.linalg.solve(np.eye(columns.shape[1]) + columns.T @ columns, columns.T @ white)
    return result


def transfer(
    labels: Labels, nominal: np.ndarray, zero: np.ndarray, signature: np.ndarray, covariance: np.ndarray
) -> dict[str, float]:
    """Per kind of data, how many times smaller its error is when fitted to the other kinds only."""
    kinds = labels.kind
    if len(set(kinds.tolist())) < 2:
        return {}
    held = left_out(labels, nominal, zero, signature, covariance, kinds)
    return {str(kind): held.ratio(kinds == kind) for kind in dict.fromkeys(kinds.tolist())}
