"""Rows and readings of a campaign laid out in blocks: the linear model that evidence is computed from.

A block holds states that share a reading of their lengths. Its rows are those of its states, one after the other; its
readings are pose and tensions of each state, and the lengths of all at the end.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis.recorded import LENGTH, POSITION, ROTATION, TENSION, Recorded
from cdpr_struct.inference.linear_model import LinearModel
from cdpr_struct.inference.scale_mixture import NoiseGroups

FLOOR = (0.05, 2e-5)  # N, m: what catenary and rigid bodies miss of balance and lengths of the FEM, meshes refined


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """Where the rows and readings of states stand in blocks.

    block, place (S,) : of each state;  rows, width : of a block, padding included
    groups : readings that fail together
    """

    block: np.ndarray
    place: np.ndarray
    rows: int
    width: int
    groups: NoiseGroups

    @property
    def blocks(self) -> int:
        """K."""
        return len(self.groups.index)


def layout(data: Recorded) -> Layout:
    """The layout of a campaign's static readings."""
    states, own = data.states, 6 + data.cables
    block, place = np.zeros(states, dtype=int), np.zeros(states, dtype=int)
    for k, members in enumerate(data.blocks):
        block[members], place[members] = k, np.arange(len(members))
    most = max(len(members) for members in data.blocks)
    width = most * own + data.cables
    return Layout(block, place, most * own, width, _groups(data, block, place, width))


def _groups(data: Recorded, block: np.ndarray, place: np.ndarray, width: int) -> NoiseGroups:
    """Position, rotation, and each tension of a state; each length of a block. What nobody read has its own size."""
    index = np.full((len(data.blocks), width), -1)
    kind: list[int] = []
    fixed: list[float] = []

    def add(sensor: int, state: int, which: slice, where: np.ndarray) -> None:
        read = data.read[state, which]
        ratio = data.unread[state, which] / data.sigma[state, which]
        parts = [np.arange(len(where))] if read.all() else [np.array([i]) for i in range(len(where))]
        for part in parts:
            index[block[state], where[part]] = len(kind)
            kind.append(sensor)
            fixed.append(np.nan if read[part].all() else float(ratio[part].max() ** 2))

    m, own = data.cables, 6 + data.cables
    for s in range(data.states):
        start = place[s] * own
        add(POSITION, s, slice(0, 3), start + np.arange(3))
        add(ROTATION, s, slice(3, 6), start + np.arange(3, 6))
        for i in range(m):
            add(TENSION, s, slice(6 + i, 7 + i), np.array([start + 6 + i]))
    for members in data.blocks:
        first = int(members[0])
        for i in range(m):
            add(LENGTH, first, slice(6 + m + i, 7 + m + i), np.array([width - m + i]))
    return NoiseGroups(index, np.array(kind), np.array(fixed))


def assembled(
    data: Recorded, where: Layout, residual: np.ndarray, by_noise: np.ndarray, columns: np.ndarray
) -> LinearModel:
    """The linear model r = A u + X z of residuals (S, 6 + m), slopes (S, 6 + m, 6 + 2 m), columns (S, 6 + m, t)."""
    own, m = 6 + data.cables, data.cables
    k, n = where.blocks, where.rows
    r, floor = np.zeros((k, n)), np.ones((k, n))
    a, x = np.zeros((k, n, where.width)), np.zeros((k, n, columns.shape[-1]))
    for s in range(data.states):
        block, rows = where.block[s], slice(where.place[s] * own, (where.place[s] + 1) * own)
        r[block, rows], floor[block, rows] = residual[s], np.repeat(FLOOR, (6, m))
        a[block, rows, rows] = by_noise[s, :, :own]
        a[block, rows, where.width - m :] = by_noise[s, :, own:]
        x[block, rows] = columns[s]
    return LinearModel(r, a, x, floor, where.groups, np.zeros(0, dtype=int))


def rows_of(where: Layout, columns: np.ndarray) -> np.ndarray:
    """Columns (S, 6 + m, d) as they stand in blocks (K, n, d)."""
    own = columns.shape[1]
    found = np.zeros((where.blocks, where.rows, columns.shape[-1]))
    for s, (block, place) in enumerate(zip(where.block, where.place, strict=True)):
        found[block, place * own : (place + 1) * own] = columns[s]
    return found


def noise_of_states(data: Recorded, where: Layout, noise: np.ndarray) -> np.ndarray:
    """(S, 6 + 2 m) noise of each state's readings from that of the blocks (K, q)."""
    own, m = 6 + data.cables, data.cables
    starts = where.place[:, None] * own + np.arange(own)
    of_state = np.take_along_axis(noise[where.block], starts, axis=1)
    return np.concatenate([of_state, noise[where.block, where.width - m :]], axis=1)
