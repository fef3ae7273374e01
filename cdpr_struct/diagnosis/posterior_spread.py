"""How sure a diagnosis is of the robot that it extends: the posterior of every number that may be off."""

import numpy as np

from cdpr_struct.diagnosis.whole_sizes import over_scales
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.residuals.recorded import Recorded
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.tolerances import FINDABLE, VARIED, Spread, Varied, change_between

_STEP = 1e-3  # sigmas: changes are linear in it
_SMALL = 1e-6  # of the largest singular value: directions below it are known exactly


def posterior_spread(data: Recorded, found: Judged, extended: RobotArrays) -> Spread:
    """Changes of the extended robot's numbers: tolerances as the data narrowed them, and the sizes of the causes."""
    mean, covariance = over_scales(found)
    steps = _STEP * np.eye(len(mean))
    ways = np.concatenate([mean + steps, mean - steps, mean[None]])
    robots = _robots(data, found, ways)
    off = _found_off(data.arrays, robots)
    change = change_between(data.arrays, robots, (*VARIED, *off))
    count = len(mean)
    slope = (change[:count] - change[count : 2 * count]).T / (2.0 * _STEP)
    left, size, _ = np.linalg.svd(slope @ _root(covariance), full_matrices=False)
    kept = size > _SMALL * size[:1]
    beside = change[-1] - change_between(data.arrays, extended, (*VARIED, *off))[0]
    return Spread(left[:, kept] * size[kept], beside, off)


def _found_off(entered: RobotArrays, robots: RobotArrays) -> tuple[Varied, ...]:
    """Numbers beside those of tolerances in which probable robots differ."""
    return tuple(
        one for one in map(Varied.found, FINDABLE) if np.ptp(change_between(entered, robots, (one,)), axis=0).any()
    )


def _robots(data: Recorded, found: Judged, ways: np.ndarray) -> RobotArrays:
    """Robots with numbers (n, t) put in, an axis of one state behind the first."""
    arrays = data.arrays
    for term, z in zip(found.point.terms, found.split(ways), strict=True):
        arrays = term.applied(arrays, z[:, None])
    return arrays


def _root(covariance: np.ndarray) -> np.ndarray:
    """(t, t) whose product with itself is a covariance that may be singular."""
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))
