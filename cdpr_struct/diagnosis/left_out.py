"""Does a chosen model predict blocks of data that it was not fitted to? Linear about the fit, sizes of noise kept."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.inference.block_sums import BlockSums
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.residuals.layout import Layout, Shelf
from cdpr_struct.residuals.recorded import Recorded

_NONE = (-1, -1, -1, 0.0)
_CONCERNED = 0.1  # share of the rows that are concerned at least: those that change most
KINDS = ("EQ", "CO", "CF", "RF", "FA", "SW")
"""Wrench balance, cable lengths, cable frequencies, robot frequencies, modal constants, swivel angles."""


@dataclass(frozen=True, slots=True, eq=False)
class LeftOut:
    """Residuals (n,) of blocks that were not fitted, before and after, and one sigma of them if nothing were wrong.

    kind (n,) of `KINDS`;  state, cable (n,) from 0, -1 for none
    hertz (n,) : of rows of ln f and of modal constants the frequency, else 0
    kept (causes,) : log evidence that each cause keeps without the block that it needs most [nat]
    """

    kind: np.ndarray
    state: np.ndarray
    cable: np.ndarray
    before: np.ndarray
    after: np.ndarray
    sigma: np.ndarray
    hertz: np.ndarray
    kept: np.ndarray

    @property
    def concerned(self) -> np.ndarray:
        """(n,) where the causes, fitted to other data, change a prediction by over one sigma (a tenth at least)."""
        change = np.abs(self.before - self.after) / self.sigma
        return change > min(1.0, float(np.quantile(change, 1.0 - _CONCERNED)))

    def rms(self, rows: np.ndarray) -> tuple[float, float]:
        """Root mean squares before and after, in sigmas, of some rows."""
        return tuple(float(np.sqrt(np.mean((r[rows] / self.sigma[rows]) ** 2))) for r in (self.before, self.after))  # type: ignore[return-value]

    def ratio(self, rows: np.ndarray) -> float:
        """How many times smaller the error became, counted in sigmas."""
        before, after = self.rms(rows)
        return before / max(after, 1e-12)


def left_out(data: Recorded, where: Layout, found: Judged) -> LeftOut | None:
    """Each block predicted from the fit to all the others; None with a single block or without causes.

    What adds a mode stays as it was fitted, before and after: without it there is nothing that could be off. See
    `added_modes`.
    """
    sizes = [len(part.pattern.prior) for part in found.hypothesis.parts]
    first = found.model.parameters - sum(sizes)
    sums = _beside_modes(BlockSums.of(found.model, found.fit.noise, found.fit.soft, first), found)
    places = [first + own for own in np.split(np.arange(sum(sizes)), np.cumsum(sizes)[:-1])]
    parts = zip(found.hypothesis.parts, places, strict=False)
    causes = [own for part, own in parts if not part.cause.tuned]
    if not causes or len(sums.gram) < 2:
        return None
    after = _predictions(sums, np.concatenate(causes))
    kept = np.array([min(sums.gain(own, np.array([k])) for k in range(len(sums.gram))) for own in causes])
    return _read(data, where, found, sums, after, kept)


def rows_of(data: Recorded, where: Layout, found: Judged, noise: NoiseState) -> LeftOut:
    """Residuals of a fit as they stand and less its causes, nothing left out; sigmas at given sizes of the noise."""
    first = found.model.parameters - sum(len(part.pattern.prior) for part in found.hypothesis.parts)
    sums = _beside_modes(BlockSums.of(found.model, noise, found.fit.soft, first), found)
    after = sums.residual - sums.columns[:, first:] @ found.fit.z_mean[first:]  # columns of added modes are zero
    return _read(data, where, found, sums, after, np.zeros(0))


def _read(
    data: Recorded, where: Layout, found: Judged, sums: BlockSums, after: np.ndarray, kept: np.ndarray
) -> LeftOut:
    """The rows that hold a reading."""
    modes = np.zeros((0, 0)) if found.lists is None else np.exp(found.lists.association.modes.ln_frequency)
    kind, state, cable, hertz = _labels(data, where, modes)
    read = (kind >= 0) & np.isfinite(sums.sigma)
    kinds = np.array(KINDS, dtype=object)[kind[read].astype(int)]
    before, after, sigma, hertz = (part[read] for part in (sums.residual, after, sums.sigma, hertz))
    return LeftOut(kinds, state[read].astype(int), cable[read].astype(int), before, after, sigma, hertz, kept)


def _beside_modes(sums: BlockSums, found: Judged) -> BlockSums:
    """The same with the numbers of added modes held as they were fitted."""
    held = [np.full(len(part.pattern.prior), part.cause.tuned) for part in found.hypothesis.parts]
    if not any(own.any() for own in held):
        return sums
    fixed = np.zeros(found.model.parameters, dtype=bool)
    fixed[-sum(map(len, held)) :] = np.concatenate(held)
    shift, free = np.where(fixed, found.fit.z_mean, 0.0), ~fixed
    return replace(
        sums, residual=sums.residual - sums.columns @ shift, columns=sums.columns * free,
        score=(sums.score - sums.gram @ shift) * free, gram=sums.gram * (free[:, None] & free),
    )  # fmt: skip


def _predictions(sums: BlockSums, causes: np.ndarray) -> np.ndarray:
    """(n,) residuals less what the causes make of each block's, fitted to the other blocks."""
    after = sums.residual.copy()
    for k in range(len(sums.gram)):
        z = np.linalg.solve(*sums.without(np.array([k])))
        rows = sums.block == k
        after[rows] -= sums.columns[rows][:, causes] @ z[causes]
    return after


def _labels(data: Recorded, where: Layout, modes: np.ndarray) -> np.ndarray:
    """(4, n) number of the kind (-1: no reading), state, cable and frequency [Hz] of every row, shelf by shelf.

    modes (F, M) : frequencies of the robot [Hz]
    """
    rows = [
        row for shelf in where.shelves for k in range(len(shelf.states)) for row in _of_block(data, shelf, k, modes)
    ]
    for places in where.sizes_of_states.tolist():
        of = _state_of(data, places[0])
        rows += [(4, of, -1, _hertz_of(data, place)) if place >= 0 else _NONE for place in places]
    return np.array(rows, dtype=float).reshape((-1, 4)).T


def _state_of(data: Recorded, place: int) -> int:
    """State of a modal constant."""
    return -1 if data.vibrations is None else int(data.vibrations.sizes.state[place])


def _hertz_of(data: Recorded, place: int) -> float:
    """Frequency [Hz] of the mode of a modal constant."""
    return 0.0 if data.vibrations is None else float(np.exp(data.vibrations.sizes.log_hertz[place]))


def _of_block(data: Recorded, shelf: Shelf, k: int, modes: np.ndarray) -> Iterator[tuple[int, int, int, float]]:
    m, measured = data.cables, data.vibrations
    for state in shelf.states[k].tolist():
        tensions = state >= 0 and bool(data.read[state, 6 : 6 + m].any())
        yield from [(0 if tensions else -1, state, -1, 0.0)] * 6
        for i in range(m):
            yield (1 if state >= 0 and data.read[state, 6 + m + i] else -1), state, i, 0.0
    if measured is not None:
        for row in shelf.cables[k].tolist():
            place = int(measured.states[measured.rows.state[row]]), int(measured.rows.cable[row])
            yield (2, *place, float(np.exp(measured.log_hertz[row]))) if row >= 0 else _NONE
    for row in shelf.swivels[k].tolist():
        yield (5, int(data.swivels.state[row]), int(data.swivels.cable[row]), 0.0) if row >= 0 else _NONE
    if measured is None:
        return
    for f in shelf.vibrating[k].tolist():
        yield from ((3, int(measured.states[f]), -1, hertz) if f >= 0 else _NONE for hertz in modes[f])
