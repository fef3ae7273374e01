"""Measured numbers against predicted ones within tolerances: each by itself, and all of them together."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.special import chdtrc, ndtri

from cdpr_struct.observation.robot_modes import PLATFORM_SHARE
from cdpr_struct.robot.tolerances import Spread


@dataclass(frozen=True, slots=True, eq=False)
class Compared:
    """n readings.

    low, high : (n,) band of each by itself, the sensor's noise included;  inside : (n,) bool
    sigmas : (n,) measured minus predicted, in sigmas of tolerances and noise
    p_value : that all readings together lie as far off or further, if tolerances and noise are as stated; they share
        the same robot, so they are judged by their joint covariance
    """

    low: np.ndarray
    high: np.ndarray
    inside: np.ndarray
    sigmas: np.ndarray
    p_value: float


def compared(
    measured: np.ndarray,
    noise: np.ndarray,
    predicted: np.ndarray,
    ends: np.ndarray,
    rates: np.ndarray,
    spread: Spread,
    level: float,
    scatter: np.ndarray | None = None,
) -> Compared:
    """Compare readings (n,).

    Parameters
    ----------
    noise : (n,) sigma of each reading;  ends : (n, 2) band of what is predicted, tolerances only, at this level
    rates : (p, n) of the predicted numbers;  spread : which robots are probable, about the predicted one
    scatter : (n,) sigma of each prediction by itself, which its band has already; default: none
    """
    reach = ndtri(0.5 + 0.5 * level)
    middle = np.clip(predicted, *ends.T)
    low = middle - np.hypot(middle - ends[:, 0], reach * noise)
    high = middle + np.hypot(ends[:, 1] - middle, reach * noise)
    off, own = measured - middle, rates.T @ spread.root
    alone = noise if scatter is None else np.hypot(noise, scatter)
    covariance = own @ own.T + np.diag(alone**2)
    sigma = np.sqrt(np.diag(covariance))
    whitened = np.linalg.solve(np.linalg.cholesky(covariance), off)
    inside = (measured >= low) & (measured <= high)
    return Compared(low, high, inside, off / sigma, float(chdtrc(len(off), float(whitened @ whitened))))


def seen_on_platform(share: np.ndarray) -> np.ndarray:
    """Which modes a sensor on the platform sees, by its share (k,) of their kinetic energy."""
    return np.flatnonzero(share >= PLATFORM_SHARE)


def assigned(measured: np.ndarray, hertz: np.ndarray, sigma: np.ndarray) -> np.ndarray:
    """(n,) which of k modes each frequency without a number is: one to one, the least sum of squared sigmas.

    measured : (n,) [Hz], n <= k;  hertz : (k,) [Hz];  sigma : (k,) of ln f
    """
    cost = (np.log(measured[:, None] / hertz) / sigma) ** 2
    rows, columns = linear_sum_assignment(cost)
    result = np.empty(len(measured), dtype=int)
    result[rows] = columns
    return result
