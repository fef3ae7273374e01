"""Which law damps the robot: the entered one, another medium, the cables' material, or friction?

Damping ratios are linear in the size of each law, so that the evidence is an integral over one or two sizes. The
entered law is uncertain by its tolerance; shapes and shares of the model by a sixth of each mode's damping.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc

from cdpr_struct.diagnosis.damping_rows import DampingRows
from cdpr_struct.hypotheses.detectable import FALSE_ALARMS, NAMED
from cdpr_struct.measurement.loss import Loss

_USUAL = Loss()
SCATTER = "the damping ratios scatter by more than their sigmas under every law"
MODEL_SHARE = 0.15  # of a mode's damping: how well the model knows its energies and angles
_POINTS, _DECADES = {1: 4001, 2: 601}, 4.0  # of the prior, level in the logarithm of the size
_LARGEST = 0.3  # damping ratio of the largest size considered
UNITS = {"damping_ratio_factor": "", "stiffness_time": "s", "loss_factor": "", "friction_moment": "N m"}
_LAWS = (
    ("viscous_damping", "a medium at rest", "damping_ratio_factor", "entered"),
    ("viscous_damping", "in the cables' material", "stiffness_time", "material"),
    ("hysteretic_damping", "", "loss_factor", "structural"),
    ("coulomb_damping", "", "friction_moment", "friction"),
)


@dataclass(frozen=True, slots=True)
class LawFit:
    """One hypothesis: causes, pattern, sizes {parameter: (median, 2.5 %, 97.5 %)}, evidence against the entered law.

    laws : numbers of its laws;  square : whitened sum of squares that the best sizes leave
    """

    causes: tuple[str, ...]
    pattern: str
    sizes: Mapping[str, tuple[float, float, float]]
    gain: float
    p_adequate: float
    laws: tuple[int, ...]
    square: float


@dataclass(frozen=True, slots=True, eq=False)
class DampingFinding:
    """status : named, class, unknown, adequate or not testable;  reason : why not testable, else "" """

    status: str
    causes: tuple[str, ...]
    fits: tuple[LawFit, ...]
    rows: DampingRows
    reason: str


def damping_finding(rows: DampingRows, tolerance: float, loss: Loss = _USUAL) -> DampingFinding:
    """Compare the laws on measured damping ratios; `tolerance` is the entered ratio's, relative."""
    same_class = loss.nats_of_a_class
    if len(rows) < 2:
        return DampingFinding("not testable", (), (), rows, "needs free decays or FRFs with two clear modes or windows")
    covariance = _covariance(rows, tolerance)
    p_null = float(chdtrc(len(rows), _square(rows, covariance, rows.entered)))
    fits = sorted((_fit(rows, covariance, laws) for laws in _hypotheses(rows)), key=lambda f: -f.gain)
    best = fits[0]
    if best.gain < NAMED and max(p_null, best.p_adequate) >= FALSE_ALARMS:
        return DampingFinding("adequate", (), tuple(fits), rows, "")
    if best.p_adequate < FALSE_ALARMS:
        sure = best.gain >= NAMED and _fit(rows, covariance * _scatter(best, len(rows)), best.laws).gain >= NAMED
        return DampingFinding("unknown" if sure else "not testable", (), tuple(fits), rows, "" if sure else SCATTER)
    near = list(dict.fromkeys(f.causes for f in fits if f.gain > best.gain - same_class and len(f.causes) == 1))
    if len(best.causes) == 2 and not near:
        return DampingFinding("named", best.causes, tuple(fits), rows, "")
    names = tuple(dict.fromkeys(name for causes in near for name in causes))
    return DampingFinding("named" if len(names) == 1 else "class", names, tuple(fits), rows, "")


def _hypotheses(rows: DampingRows) -> list[list[int]]:
    """Numbers of the laws of each hypothesis: every law alone, and friction with one of the others."""
    possible = [j for j in range(4) if j != 3 or np.isfinite(rows.friction).all()]
    possible = [j for j in possible if np.abs(getattr(rows, _LAWS[j][3])).max() > 0.0]
    return [[j] for j in possible] + [[j, 3] for j in possible if j != 3 and 3 in possible]


def _covariance(rows: DampingRows, tolerance: float) -> np.ndarray:
    """(n, n) of the damping ratios: noise, the entered law, and the model's shares (a mode's windows share them)."""
    same = rows.mode[:, None] == rows.mode[None]
    size = MODEL_SHARE * np.maximum(np.abs(rows.ratio), rows.entered)
    share = size[:, None] * size[None] * same
    entered = tolerance * rows.entered
    covariance: np.ndarray = np.diag(rows.sigma**2) + share + entered[:, None] * entered[None]
    return covariance


def _likelihood(rows: DampingRows, covariance: np.ndarray, sizes: np.ndarray, signature: np.ndarray) -> np.ndarray:
    """(h,) log likelihood, against the entered law, of sizes (h, l) of laws with signatures (l, n)."""
    lower = np.linalg.cholesky(covariance)
    z, law = (np.linalg.solve(lower, x.T) for x in (rows.ratio - rows.entered, signature))
    pull, curve = law.T @ z, law.T @ law
    result: np.ndarray = sizes @ pull - 0.5 * np.einsum("hi,ij,hj->h", sizes, curve, sizes, optimize=True)
    return result


def _square(rows: DampingRows, covariance: np.ndarray, predicted: np.ndarray) -> float:
    z = np.linalg.solve(np.linalg.cholesky(covariance), rows.ratio - predicted)
    return float(z @ z)


def _scatter(fit: LawFit, count: int) -> float:
    """By how much variances must grow for what the fit leaves to be noise (Birge's ratio squared)."""
    return max(1.0, fit.square / count)


def _fit(rows: DampingRows, covariance: np.ndarray, laws: Sequence[int]) -> LawFit:
    signature = np.stack([getattr(rows, _LAWS[j][3]) for j in laws])
    top = np.log(_LARGEST / np.abs(signature).max(axis=1))
    # a size beyond which even the least damped row would exceed the limit is of no use; four decades below it
    axes = [np.linspace(t - _DECADES * np.log(10.0), t, _POINTS[len(laws)]) for t in top]
    sizes = np.exp(np.stack([a.ravel() for a in np.meshgrid(*axes, indexing="ij")], axis=1))
    log = _likelihood(rows, covariance, sizes, signature)
    weight = np.exp(log - log.max())
    gain = float(log.max() + np.log(weight.mean()))
    best = sizes[log.argmax()]
    found = {}
    for column, j in enumerate(laws):
        name, shift = _LAWS[j][2], 1.0 if j == 0 else 0.0
        low, middle, high = _quantiles(sizes[:, column], weight)
        found[name] = (middle + shift, low + shift, high + shift)
    causes, patterns = [_LAWS[j][0] for j in laws], [_LAWS[j][1] for j in laws if _LAWS[j][1]]
    square = _square(rows, covariance, rows.entered + best @ signature)
    tail = float(chdtrc(len(rows), square))
    return LawFit(tuple(causes), ", ".join(patterns), found, gain, tail, tuple(laws), square)


def _quantiles(sizes: np.ndarray, weight: np.ndarray) -> tuple[float, float, float]:
    order = np.argsort(sizes)
    share = np.cumsum(weight[order]) / weight.sum()
    low, middle, high = (float(np.interp(q, share, sizes[order])) for q in (0.025, 0.5, 0.975))
    return low, middle, high
