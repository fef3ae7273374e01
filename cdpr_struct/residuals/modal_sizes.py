"""Sizes of measured frequency responses: modal constants, which know neither damping nor frequency.

An accelerance is the sum over the modes of A s^2 / (s^2 + 2 zeta omega s + omega^2), s = i times the circular
frequency. A, the modal constant, is the product of the mode's motion at sensor and force over its modal mass (Ewins,
Modal Testing, 2000, 2.7): in the model the product of its platform motions, of unit modal mass.
"""

from dataclasses import dataclass, fields

import numpy as np

from cdpr_struct.association.doubles import MERGED_WITHIN
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.mode_size import modal_constants, ways

NOISE = 0.05  # of a modal constant: what repeated modal tests scatter by
_FLOOR = 0.02  # of the largest constant of the mode in the same unit
_LEAST = 0.1  # of it: a channel with less is near a node of the mode
_APART = 2.0  # sums of damping ratios: nearer modes are fitted into each other


@dataclass(frozen=True, slots=True, eq=False)
class ModalSizes:
    """a measured modal constants.

    peak (a,) number of the robot frequency, state (a,) of the campaign, log_hertz (a,) of it
    respond, excite (a, 6) unit motion and wrench of the platform
    log (a,) ln |A|, A in 1/kg, 1/(kg m), 1/(kg m^2)
    sigma (a,) of ln |A|, each on its own;  common (a,) that of the mode's damping, shared by its channels
    record, mode (a,) number of the identified record, and of the mode in it
    """

    peak: np.ndarray
    state: np.ndarray
    log_hertz: np.ndarray
    respond: np.ndarray
    excite: np.ndarray
    log: np.ndarray
    sigma: np.ndarray
    common: np.ndarray
    record: np.ndarray
    mode: np.ndarray

    def __len__(self) -> int:
        return len(self.log)

    @property
    def none(self) -> "ModalSizes":
        """No constants."""
        return ModalSizes(*(getattr(self, f.name)[:0] for f in fields(self)))

    @property
    def by_state(self) -> np.ndarray:
        """(K, n) numbers of the constants of each of K states, -1 for none."""
        states, count = np.unique(self.state, return_counts=True)
        found = np.full((len(states), count.max(initial=0)), -1)
        for k, state in enumerate(states):
            found[k, : count[k]] = np.flatnonzero(self.state == state)
        return found

    def log_gain(self, gain: np.ndarray) -> np.ndarray:
        """(..., a) ln of the accelerometers' gain (..., 6) in each constant."""
        return np.asarray(np.log(np.maximum(gain, 1e-3)) @ (self.respond**2).T)


def measured_sizes(campaign: Campaign) -> ModalSizes:
    """Modal constants of all FRFs whose modes are among the campaign's robot frequencies."""
    peaks = campaign.robot_frequencies
    table: list[np.ndarray] = []
    for i, (record, mode) in enumerate(peaks.origin.tolist()):
        item = campaign.identified[record] if record >= 0 else None
        if item is not None and item.record.kind == "frf" and _apart(item, mode):
            table += [np.concatenate([[i], row]) for row in _of_mode(item, mode)]
    rows = np.array(table).reshape((-1, 16))
    peak = rows[:, 0].astype(int)
    log_hertz = np.log(peaks.hertz[peak]) if len(peak) else np.zeros(0)
    log, sigma, common = rows[:, 13:].T
    state = peaks.state[peak].astype(int)
    origin = (peaks.origin[peak] if len(peak) else np.zeros((0, 2), dtype=int)).T
    return ModalSizes(peak, state, log_hertz, rows[:, 1:7], rows[:, 7:13], log, sigma, common, *origin)


def _apart(item: Identified, i: int) -> bool:
    """Whether no other mode of the record is near mode i."""
    modes, others = item.modes, np.arange(len(item.modes)) != i
    gap = np.abs(np.log(modes.hertz / modes.hertz[i]))
    near = gap < np.maximum(MERGED_WITHIN, _APART * (modes.damping + modes.damping[i]))
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
