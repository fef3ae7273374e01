"""Sizes of measured frequency responses: modal constants, which know neither damping nor frequency.

An accelerance is the sum over the modes of A s^2 / (s^2 + 2 zeta omega s + omega^2), s = i times the circular
frequency. A, the modal constant, is the product of the mode's motion at sensor and force over its modal mass; the
residue at the pole p that a fit finds is A p^2 / (2 i omega sqrt(1 - zeta^2)) (Ewins, Modal Testing, 2000, 2.7). In the
model, D(omega) is singular at a mode: D^-1 is there v v' / (v' dD/domega^2 v) / (omega'^2 - omega^2), so that
A = v v' / -(v' dD/domega^2 v) with its share of the cables' mass.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis import robot_pitch
from cdpr_struct.diagnosis.world import World
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.mode_size import modal_constants, ways
from cdpr_struct.measurement.signal_records import MOTION

DIRECTIONS = MOTION
NOISE = 0.05  # of a modal constant: what repeated modal tests scatter by
_FLOOR = 0.02  # of the largest constant of the mode in the same unit
_LEAST = 0.1  # of it: a channel with less is near a node of the mode
_APART = (0.01, 2.0)  # of ln f, and sums of damping ratios: nearer modes are fitted into each other


@dataclass(frozen=True, slots=True, eq=False)
class Constants:
    """a measured modal constants.

    peak (a,) number of the robot frequency;  respond, excite (a, 6) unit motion and wrench of the platform
    log (a,) ln |A|, A in 1/kg, 1/(kg m), 1/(kg m^2)
    sigma (a,) of ln |A|, each on its own;  common (a,) that of the mode's damping, shared by its channels
    """

    peak: np.ndarray
    respond: np.ndarray
    excite: np.ndarray
    log: np.ndarray
    sigma: np.ndarray
    common: np.ndarray

    def __len__(self) -> int:
        return len(self.log)


def measured_constants(campaign: Campaign) -> Constants:
    """Modal constants of all FRFs whose modes are among the campaign's robot frequencies."""
    peaks = campaign.robot_frequencies
    table: list[np.ndarray] = []
    for peak, (record, mode) in enumerate(peaks.origin.tolist()):
        item = campaign.identified[record] if record >= 0 else None
        if item is not None and item.record.kind == "frf" and _apart(item, mode):
            table += [np.concatenate([[peak], row]) for row in _of_mode(item, mode)]
    rows = np.array(table).reshape((-1, 16))
    return Constants(rows[:, 0].astype(int), rows[:, 1:7], rows[:, 7:13], *rows[:, 13:].T)


def _apart(item: Identified, i: int) -> bool:
    """Whether no other mode of the record is near mode i."""
    modes, others = item.modes, np.arange(len(item.modes)) != i
    gap = np.abs(np.log(modes.hertz / modes.hertz[i]))
    near = gap < np.maximum(_APART[0], _APART[1] * (modes.damping + modes.damping[i]))
    return not bool((near & others).any())


def _of_mode(item: Identified, i: int) -> list[np.ndarray]:
    """Rows (15,): respond, excite, ln |A|, its sigma, and the part that all channels share."""
    modes, along = item.modes, ways(item.record)
    size, ratio = np.abs(modal_constants(modes)[i]), float(modes.damping[i])
    turns = np.abs(along[:, :, 3:]).sum(axis=2) @ [2.0, 1.0]
    known = np.abs(along).sum(axis=2).min(axis=1) > 0.0
    rows = []
    for c in np.flatnonzero(known):
        share = float(size[c] / size[known & (turns == turns[c])].max())
        if share > _LEAST:
            own = [np.log(size[c]), np.hypot(NOISE, _FLOOR / share), float(modes.damping_sigma[i]) / ratio]
            rows.append(np.concatenate([*along[c], own]))
    return rows


def modelled_constants(
    constants: Constants, dynamics: robot_pitch.Dynamics, rows: robot_pitch.Rows, omega: np.ndarray
) -> np.ndarray:
    """(..., a) ln |A| of the modes of a model at their frequencies omega (..., r) [rad/s]."""
    matrix, slope = dynamics.matrix(omega**2), robot_pitch.rate(dynamics, omega**2)
    shape = robot_pitch.shape_of(matrix, dynamics.mass, rows.shape)
    return log_constants(constants, unit_modal_mass(shape, slope))


def unit_modal_mass(shape: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """(..., r, 6) shapes scaled to unit modal mass, that of the cables included; slope (..., r, 6, 6) dD/domega^2."""
    inertia = -np.einsum("...i,...ij,...j->...", shape, slope, shape)
    result: np.ndarray = shape / np.sqrt(np.maximum(inertia, 1e-300))[..., None]
    return result


def log_constants(constants: Constants, shape: np.ndarray) -> np.ndarray:
    """(..., a) ln |A| of modes whose platform shapes (..., r, 6) have unit modal mass."""
    own = np.take(shape, constants.peak, axis=-2)
    size = np.abs((own * constants.respond).sum(axis=-1) * (own * constants.excite).sum(axis=-1))
    result: np.ndarray = np.log(np.maximum(size, 1e-12))
    return result


def log_gain(constants: Constants, world: World) -> np.ndarray:
    """(..., a) ln of the accelerometers' gain in each constant; `world` per state."""
    result: np.ndarray = np.log(np.maximum(world.accelerometer_gain, 1e-3)) @ (constants.respond**2).T
    return result[..., 0, :] if world.accelerometer_gain.ndim > 1 else result
