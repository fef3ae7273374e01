"""Which peaks of a free vibration are modes of their own, and which others make because the motion is not small."""

import numpy as np

from cdpr_struct.measurement.modal_estimate import Modes

MODE, COMBINATION = "mode", "combination tone"
_NEAR = 0.03  # relative distance within which one mode of drifting frequency is fitted by two poles
_ALIKE = 0.9  # their modal assurance criterion
_SMALL = 0.35  # largest amplitude of a combination tone, in those of its smaller parent
_EXACT = 0.004  # distance of a combination tone from its parents' sum or difference, relative to the fastest


def assurance(one: np.ndarray, other: np.ndarray) -> float:
    """Modal assurance criterion of two complex shapes (c,): 1 if they are proportional, 0 if orthogonal."""
    top = abs(np.vdot(one, other)) ** 2
    bottom = float(np.vdot(one, one).real * np.vdot(other, other).real)
    return float(top / bottom) if bottom > 0.0 else 0.0


def _weighed(found: Modes) -> np.ndarray:
    """(k, c) shapes in units of the noise, so that metres and radians can be summed."""
    return found.shape / np.where(found.noise > 0.0, found.noise, np.inf)


def shadows(found: Modes) -> np.ndarray:
    """(k,) bool: a weaker pole beside a stronger one of the same shape; one mode whose frequency drifts."""
    shape, size = _weighed(found), found.strength
    doubled = np.zeros(len(found), dtype=bool)
    for i in np.argsort(size):
        for j in range(len(found)):
            near = abs(np.log(found.hertz[i] / found.hertz[j])) < _NEAR
            if j != i and size[j] > size[i] and near and assurance(shape[i], shape[j]) > _ALIKE:
                doubled[i] = True
    return doubled


def peak_kinds(found: Modes) -> list[str]:
    """Of each mode: "mode", or "combination tone" at the sum, difference or double of stronger ones.

    A motion that is not small drives the sums and differences of its frequencies; their amplitude falls with the
    product of their parents'.
    """
    size = np.linalg.norm(_weighed(found), axis=1)
    kinds = [MODE] * len(found)
    for i in np.argsort(-size):
        parents = [j for j in range(len(found)) if size[j] * _SMALL > size[i] and kinds[j] == MODE]
        tones = _tones(found.hertz[parents])
        slack = _EXACT * max(found.hertz[[i, *parents]]) + 3.0 * found.hertz_sigma[i]
        if len(tones) and float(np.abs(tones - found.hertz[i]).min()) < slack:
            kinds[i] = COMBINATION
    return kinds


def _tones(parents: np.ndarray) -> np.ndarray:
    """Sums and differences of two, and of two with a third."""
    if not len(parents):
        return np.zeros(0)
    pairs = np.concatenate([(parents[:, None] + parents).ravel(), np.abs(parents[:, None] - parents).ravel()])
    triple = np.abs(2.0 * parents[:, None] - parents).ravel()
    own = np.isclose(triple[:, None], parents[None], rtol=1e-12).any(axis=1)
    return np.concatenate([pairs[pairs > 0.0], triple[~own], 3.0 * parents])
