"""Which corrections of the data are worth judging? Those that leave least of what every state says against itself.

Each state's residual is held against its readings and the tolerances; a state that is wrong for another reason costs
only so much, as it does under Student's distribution.
"""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.diagnosis.hypotheses.handling import Correction
from cdpr_struct.diagnosis.linearised import Local, Point
from cdpr_struct.diagnosis.recorded import Recorded, recorded
from cdpr_struct.observation.rest import static_residuals

_MOST = 4  # corrections that are judged
_DEGREES = 4.0  # of freedom, Student's: how surely a state is right that contradicts the others


def promising(data: Recorded, found: Sequence[Correction]) -> list[Correction]:
    """The likeliest corrections, of those that are likelier than the data as they are."""
    local = Local.about(data, Point.entered(data))
    covariance = _covariance(data, local)
    now = _cost(data, covariance)
    costs = [_cost(recorded(one.campaign), covariance) - one.log_prior - one.log_stretch for one in found]
    order = np.argsort(costs, kind="stable")
    return [found[i] for i in order[:_MOST] if costs[i] < now]


def _covariance(data: Recorded, local: Local) -> np.ndarray:
    """(S, 6 + m, 6 + m) of each state's residual by readings and tolerances."""
    size = np.where(data.read, 1.0, data.unread / data.sigma)
    noise = local.by_noise().static * size[:, None, :]
    tolerance = local.own_columns().static
    return np.asarray(noise @ np.swapaxes(noise, 1, 2) + tolerance @ np.swapaxes(tolerance, 1, 2))


def _cost(data: Recorded, covariance: np.ndarray) -> float:
    """Minus ln of the density of all states, each Student's."""
    r = static_residuals(data.arrays, data.readings, data.known, data.radius)
    r = np.broadcast_to(r, covariance.shape[:-1])
    square = np.einsum("si,si->s", r, np.linalg.solve(covariance, r[..., None])[..., 0])
    return float(0.5 * (_DEGREES + r.shape[1]) * np.log1p(square / _DEGREES).sum())
