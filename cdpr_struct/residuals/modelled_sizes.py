"""Which modal constants does the model have in the place of the measured ones, and how do they change?

An identified mode is paired with one of the model's. Modes nearer to that than twice its width, which were not
identified themselves, are fitted as one with it, and their constants add up. The nearer, the more:

    C = sum of w A,   w = (1 - (distance in ln f / 2 zeta)^2)^2

In such a sum it does not matter how its modes mix with each other. How they mix with all others changes it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.association.detection import SHARE_INVISIBLE
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.mode_partners import paired
from cdpr_struct.measurement.mode_size import channel_shapes
from cdpr_struct.measurement.peak_kinds import MODE
from cdpr_struct.observation.robot_modes import VibratingModes
from cdpr_struct.residuals.modal_sizes import ModalSizes

_LEAST = 1e-12  # 1/kg: of a constant that is zero


@dataclass(frozen=True, slots=True, eq=False)
class ModelledSizes:
    """Of a modal constants, accelerometers being right.

    row (a,) : state of each, among the F where vibration was measured
    log (a,) : ln |C|;  gradient (a, n) : of it by what the modes of that state depend on
    doubt (a,) : one sigma of it, as modes may be in the sum or not: w (1 - w) of their constants' squares
    turn (a, n, 6) : change of the platform's motion in the mode itself, of unit kinetic energy, by the same
    """

    row: np.ndarray
    log: np.ndarray
    gradient: np.ndarray
    doubt: np.ndarray
    turn: np.ndarray

    @classmethod
    def about(
        cls, sizes: ModalSizes, states: np.ndarray, items: Sequence[Identified], robot: VibratingModes
    ) -> "ModelledSizes":
        """Constants of the modes at a point; states (F,), records that the numbers in `sizes` mean."""
        row = np.searchsorted(states, sizes.state)
        weight = _weights(sizes, row, items, robot)
        index = _of_states(weight, row, len(states))
        w = np.take_along_axis(weight, index[row], axis=1)
        rates = robot.motion_rates(index)[row]
        along, pushed = (_by(robot.platform[row], one) for one in (sizes.respond, sizes.excite))
        part = along * pushed
        faster = _by(rates, sizes.respond) * np.take_along_axis(pushed, index[row], axis=1)[:, None]
        faster += _by(rates, sizes.excite) * np.take_along_axis(along, index[row], axis=1)[:, None]
        change = (faster * w[:, None]).sum(axis=2)
        change += (_weight_rates(sizes, row, weight, items, robot) * part[:, None]).sum(axis=2)
        total = (weight * part).sum(axis=1)
        size = np.maximum(np.abs(total), _LEAST)
        doubt = np.sqrt((weight * (1.0 - weight) * part**2).sum(axis=1)) / size
        main = np.take_along_axis(rates, w.argmax(axis=1)[:, None, None, None], axis=2)[:, :, 0]
        turn = main @ np.linalg.cholesky(robot.mass)[row]
        return cls(row, np.log(size), change * (np.sign(total) / size)[:, None], doubt, turn)


def _by(motion: np.ndarray, along: np.ndarray) -> np.ndarray:
    """(a, ...) parts of motions (a, ..., 6) along directions (a, 6)."""
    return np.asarray((motion @ along.reshape((len(along), *(1,) * (motion.ndim - 3), 6, 1)))[..., 0])


def _weights(sizes: ModalSizes, row: np.ndarray, items: Sequence[Identified], robot: VibratingModes) -> np.ndarray:
    """(a, M) by which the model's modes are part of each constant."""
    found = np.zeros((len(sizes), robot.log_hertz.shape[1]))
    for number in np.unique(sizes.record):
        item, own = items[number], np.flatnonzero(sizes.record == number)
        k = int(row[own[0]])
        partner = _partners(item, k, robot)
        for i in own:
            main = int(partner[sizes.mode[i]])
            main = main if main >= 0 else _nearest(sizes.log_hertz[i], k, robot)
            apart = (robot.log_hertz[k] - robot.log_hertz[k, main]) / _width(item, sizes.mode[i])
            near = np.where(robot.mask[k], np.maximum(1.0 - apart**2, 0.0) ** 2, 0.0)
            near[np.setdiff1d(partner[partner >= 0], [main])] = 0.0
            found[i] = near
    return found


def _width(item: Identified, mode: int) -> float:
    """Of ln f, within which modes are fitted as one."""
    return 2.0 * float(item.modes.damping[mode])


def _partners(item: Identified, k: int, robot: VibratingModes) -> np.ndarray:
    """(j,) the model's mode for each of the record's, -1 for none."""
    own, modes = np.flatnonzero([kind == MODE for kind in item.kinds]), np.flatnonzero(robot.mask[k])
    shapes = channel_shapes(robot.platform[k, modes], item.record)
    found = np.full(len(item.modes), -1)
    which = paired(item.modes.take(own), np.ones(shapes.shape[1]), np.exp(robot.log_hertz[k, modes]), shapes)
    found[own] = np.where(which >= 0, modes[which], -1)
    return found


def _nearest(log_hertz: float, k: int, robot: VibratingModes) -> int:
    visible = robot.mask[k] & (robot.share[k] > SHARE_INVISIBLE)
    return int(np.where(visible, np.abs(robot.log_hertz[k] - log_hertz), np.inf).argmin())


def _of_states(weight: np.ndarray, row: np.ndarray, states: int) -> np.ndarray:
    """(F, q) modes that are part of any constant of their state, and as many others as make the rows equally long."""
    used = np.zeros((states, weight.shape[1]))
    np.maximum.at(used, row, weight)
    count = int((used > 0.0).sum(axis=1).max())
    return np.argsort(-used, axis=1, kind="stable")[:, :count]


def _weight_rates(
    sizes: ModalSizes, row: np.ndarray, weight: np.ndarray, items: Sequence[Identified], robot: VibratingModes
) -> np.ndarray:
    """(a, n, M) change of the weights, as modes come nearer or go."""
    width = np.array([_width(items[r], m) for r, m in zip(sizes.record, sizes.mode, strict=True)])
    main = weight.argmax(axis=1)
    apart = (robot.log_hertz[row] - np.take_along_axis(robot.log_hertz[row], main[:, None], axis=1)) / width[:, None]
    slope = -2.0 * 2.0 * apart * np.sqrt(weight) / width[:, None]
    gradient = robot.gradient[row]
    faster = gradient - np.take_along_axis(gradient, main[:, None, None], axis=2)
    return np.asarray(slope[:, None] * faster)
