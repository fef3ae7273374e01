"""Readings that a fit set aside: off by so much that their error is of another size than that of their kind."""

from collections.abc import Iterator

import numpy as np

from cdpr_struct.diagnosis.diagnosis import SetAside
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.inference.scale_mixture import KAPPA
from cdpr_struct.residuals.layout import Layout, Shelf
from cdpr_struct.residuals.recorded import Recorded


def set_aside(data: Recorded, where: Layout, found: Judged) -> list[SetAside]:
    """The readings set aside, worst first; peaks that belong to no mode are in `unassigned`."""
    noise = found.fit.noise
    odd = noise.outlying & np.isnan(where.groups.fixed_variance)
    rows = []
    readings = (*readings_by_group(data, where, found), *_modal_sizes(data, where, found))
    for group, kind, state, cable, value in readings:
        if odd[group]:
            factor = float(noise.responsibility[group] @ KAPPA)
            rows.append(_row(kind, data.campaign.states.names[state], cable, value, factor, _hertz(data, where, group)))
    return sorted(rows, key=lambda row: -row.gain)


def _row(kind: str, case: str, cable: int, value: np.ndarray, factor: float, hertz: float) -> SetAside:
    """A reading that is off by some stated sigmas (d,), and has its sigma enlarged by a factor."""
    gain = 0.5 * float(value @ value) * (1.0 - factor**-2) - len(value) * float(np.log(factor))
    return SetAside(kind, case, cable, float(np.linalg.norm(value)), gain, hertz)


def _modal_sizes(data: Recorded, where: Layout, found: Judged) -> Iterator[tuple[int, str, int, int, np.ndarray]]:
    """The same as `readings_by_group` of modal constants, whose blocks come last."""
    if data.vibrations is None or not len(where.of_sizes):
        return
    mean = found.fit.noise_mean[-1]
    for k, places in enumerate(where.sizes_of_states):
        for j in np.flatnonzero(places >= 0):
            place = int(places[j])
            state = int(data.vibrations.sizes.state[place])
            yield int(where.of_sizes[place]), "frf", state, -1, mean[k, j : j + 1]


def _hertz(data: Recorded, where: Layout, group: int) -> float:
    """Frequency [Hz] of the mode of a modal constant, 0 for other readings."""
    own = np.flatnonzero(where.of_sizes == group)
    if data.vibrations is None or not own.size:
        return 0.0
    return float(np.exp(data.vibrations.sizes.log_hertz[own[0]]))


def readings_by_group(data: Recorded, where: Layout, found: Judged) -> Iterator[tuple[int, str, int, int, np.ndarray]]:
    """Group, kind, state, cable (-1 for none) and errors in stated sigmas of every group of readings."""
    for shelf, mean in zip(where.shelves, found.fit.noise_mean, strict=False):  # modal constants come last
        yield from _readings(data, shelf, mean)


def _readings(data: Recorded, shelf: Shelf, mean: np.ndarray) -> Iterator[tuple[int, str, int, int, np.ndarray]]:
    """Group, kind, state, cable and errors in stated sigmas of every group of readings of a shelf."""
    m, own = data.cables, 6 + data.cables
    p = shelf.states.shape[1]
    for k in range(len(shelf.states)):
        for j, state in enumerate(shelf.states[k].tolist()):
            if state < 0:
                continue
            first = j * own
            yield int(shelf.index[k, first]), "position", state, -1, mean[k, first : first + 3]
            yield int(shelf.index[k, first + 3]), "rotation", state, -1, mean[k, first + 3 : first + 6]
            for i in range(m):
                at = first + 6 + i
                yield int(shelf.index[k, at]), "tension", state, i, mean[k, at : at + 1]
        for i in range(m):
            at = p * own + i
            yield int(shelf.index[k, at]), "length", int(shelf.states[k, 0]), i, mean[k, at : at + 1]
        for j, row in enumerate(shelf.cables[k].tolist()):
            if row >= 0 and data.vibrations is not None:
                at, rows = p * own + m + j, data.vibrations.rows
                state = int(data.vibrations.states[rows.state[row]])
                yield int(shelf.index[k, at]), "cable_frequency", state, int(rows.cable[row]), mean[k, at : at + 1]
        for j, row in enumerate(shelf.swivels[k].tolist()):
            if row >= 0:
                at = p * own + m + shelf.cables.shape[1] + j
                state, i = int(data.swivels.state[row]), int(data.swivels.cable[row])
                yield int(shelf.index[k, at]), "swivel", state, i, mean[k, at : at + 1]
