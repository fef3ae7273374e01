"""How densely a mode puts a peak at the place where one was measured, for each scale of the peak's error."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.association.peak_noise import SCALES, PeakNoise
from cdpr_struct.association.peaks import PeakLists


@dataclass(frozen=True, slots=True, eq=False)
class PairDensity:
    """Densities in ln f of the peaks of L lists, were each caused by each mode.

    by_scale (4, L, J, M) : weight of the scale times density, `total` (L, J, M) their sum
    square (L, J, M) : expected squared distance between peak and mode
    correction (4, L, J, M) or None : expected ln density minus ln of the density used, if they differ
    """

    by_scale: np.ndarray
    total: np.ndarray
    square: np.ndarray
    correction: np.ndarray | None


def pair_density(
    peaks: PeakLists, noise: PeakNoise, mean: np.ndarray, variance: np.ndarray, predictive: bool = False
) -> PairDensity:
    """Densities given modes ln f ~ N(mean, variance), both (L, M).

    By default exp of the expected ln density, the optimum of the variational bound: a mode that is uncertain by more
    than the error of a peak is paid for by -variance / 2 (tau kappa s)^2. With `predictive` the density of the peak
    under N(mean, variance + (tau kappa s)^2), which is no optimum of the bound but does not shut out uncertain modes:
    for the first step.
    """
    sd = SCALES[:, None, None] * peaks.sd * noise.tau[peaks.kind][:, None]
    error = (sd**2)[..., None]  # (4, L, J, 1)
    height = noise.weight[peaks.kind] * (noise.tau / np.exp(noise.ln_tau))[peaks.kind][:, None]
    height = height.T[:, :, None, None] / np.sqrt(2.0 * np.pi)  # (4, L, 1, 1)
    distance = (peaks.ln_frequency[:, :, None] - mean[:, None, :]) ** 2
    spread = variance[:, None, :]
    square = distance + spread
    if not predictive:
        by_scale = square * (-0.5 / error)
        np.exp(by_scale, out=by_scale)
        by_scale *= height / np.sqrt(error)
        return PairDensity(by_scale, by_scale.sum(axis=0), square, None)
    wide = error + spread
    by_scale = height * np.exp(-0.5 * distance / wide) / np.sqrt(wide)
    correction = 0.5 * (distance / wide + np.log(wide / error) - square / error)
    return PairDensity(by_scale, by_scale.sum(axis=0), square, correction)
