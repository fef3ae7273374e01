"""Stepwise selection by the Bayesian information criterion, fitted with lmfit: causes in, none ever out.

A step tries every cause not yet taken in each of its patterns (all cables alike, each its own, one alone), sizes that
cannot be negative bounded, and takes the one with the smallest BIC, until that no longer falls.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.diagnosis_baselines.material import Material
from cdpr_struct.diagnosis.evidence import Choice, choice

MOST = 5  # causes; no case hides more than two
_START = 0.1  # prior sigmas, for sizes that are bounded


def stepwise_bic(material: Material) -> tuple[str, ...]:
    """The causes that lower the BIC, in the order taken."""
    return _forward(_options(material), material.z, 0.0)


def stepwise_extended_bic(material: Material) -> tuple[str, ...]:
    """The same by the extended criterion: each cause also pays for the number of options it was chosen from."""
    options = _options(material)
    return _forward(options, material.z, 2.0 * float(np.log(len(options))))


def _options(material: Material) -> list[Choice]:
    return [choice(candidate, pattern, 1.0) for candidate in material.visible for pattern in candidate.patterns]


def _forward(options: list[Choice], z: np.ndarray, price: float) -> tuple[str, ...]:
    """Names taken while each lowers the BIC by more than `price`."""
    taken: tuple[Choice, ...] = ()
    level = _bic(float(z @ z), len(z), 0)
    while len(taken) < MOST:
        names = {c.candidate.name for c in taken}
        found = _best(taken, [c for c in options if c.candidate.name not in names], z, level - price)
        if found is None:
            break
        taken, level = (*taken, found[0]), found[1]
    return tuple(c.candidate.name for c in taken)


def _best(taken: tuple[Choice, ...], options: list[Choice], z: np.ndarray, level: float) -> tuple[Choice, float] | None:
    """The option with the smallest BIC below `level`.

    Without bounds the BIC is no larger, so options are fitted in that order and the rest left once it is passed.
    """
    limits = np.array([_unbounded(taken, option, z) for option in options])
    found = None
    for i in np.argsort(limits):
        if limits[i] >= level:
            break
        own = float(fitted(_stacked(taken, options[i]), _lowest(taken, options[i]), z).bic)
        if own < level:
            found, level = (options[i], own), own
    return found


def _unbounded(taken: tuple[Choice, ...], option: Choice, z: np.ndarray) -> float:
    """BIC of ordinary least squares."""
    signature = _stacked(taken, option)
    left = z - signature @ np.linalg.lstsq(signature, z, rcond=None)[0]
    return _bic(float(left @ left), len(z), signature.shape[1])


def _bic(square: float, count: int, parameters: int) -> float:
    """As lmfit defines it."""
    return count * float(np.log(square / count)) + parameters * float(np.log(count))


def _stacked(taken: tuple[Choice, ...], option: Choice) -> np.ndarray:
    return np.hstack([c.signature for c in (*taken, option)])


def _lowest(taken: tuple[Choice, ...], option: Choice) -> np.ndarray:
    return np.concatenate([c.pattern.lowest for c in (*taken, option)])


def fitted(signature: np.ndarray, lowest: np.ndarray, z: np.ndarray) -> Any:
    """lmfit's result for residuals z (n,) + G theta, G (n, d) and lower bounds of theta (d,)."""
    from lmfit import Minimizer, Parameters

    parameters = Parameters()
    for j, low in enumerate(lowest):
        parameters.add(f"theta_{j}", value=0.0 if np.isinf(low) else _START, min=low)

    def left(values: Any) -> np.ndarray:
        theta = np.array([values[f"theta_{j}"].value for j in range(len(lowest))])
        result: np.ndarray = z + signature @ theta
        return result

    return Minimizer(left, parameters, calc_covar=False).leastsq()
