"""Where the rows and readings of a campaign stand in blocks: states that share a reading are one block.

Rows of a block are those of its states, then cable frequencies and swivel angles measured there, then the robot's
modes. Its readings are pose and tensions of each state, lengths that all share, the cable frequencies and the swivel
angles. Blocks of one size are stacked.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cdpr_struct.inference.scale_mixture import NoiseGroups
from cdpr_struct.residuals.recorded import (
    CABLE_FREQUENCY,
    LENGTH,
    MODAL_SIZE,
    POSITION,
    ROTATION,
    SWIVEL,
    TENSION,
    Recorded,
)


@dataclass(frozen=True, slots=True, eq=False)
class Shelf:
    """Blocks of one size: their states (K, p), -1 for none, cable rows (K, c) and swivel rows (K, w) likewise, and
    vibrating states (K, v).

    vibrating : numbers among the F states where vibration was measured
    index (K, q) : group of each reading, -1 for none
    """

    states: np.ndarray
    cables: np.ndarray
    swivels: np.ndarray
    vibrating: np.ndarray
    index: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """All shelves, groups of readings that fail together, the number m of cables.

    of_sizes : groups of the modal constants;  sizes_of_states (K, n) : which of them belong to each of K states
    """

    shelves: tuple[Shelf, ...]
    groups: NoiseGroups
    m: int
    of_sizes: np.ndarray
    sizes_of_states: np.ndarray


def layout(data: Recorded) -> Layout:
    """The layout of a campaign's readings."""
    shelves: dict[tuple[int, bool], list[np.ndarray]] = {}
    vibrating = np.zeros(0, dtype=int) if data.vibrations is None else data.vibrations.states
    for members in data.blocks:
        moves = bool(np.isin(members, vibrating).any())
        shelves.setdefault((0 if moves else len(members), moves), []).append(members)
    groups = _Groups(data)
    built = tuple(_shelf(data, blocks, groups) for _, blocks in sorted(shelves.items(), key=lambda item: item[0]))
    count = 0 if data.vibrations is None else len(data.vibrations.sizes)
    places = np.zeros((0, 0), dtype=int) if data.vibrations is None else data.vibrations.sizes.by_state
    sizes = np.array([groups.new(MODAL_SIZE) for _ in range(count)], dtype=int)
    return Layout(built, NoiseGroups(np.array(groups.kind), np.array(groups.fixed)), data.cables, sizes, places)


class _Groups:
    """Groups of readings, numbered as they are asked for."""

    def __init__(self, data: Recorded) -> None:
        self.data = data
        self.kind: list[int] = []
        self.fixed: list[float] = []

    def new(self, kind: int, fixed: float = np.nan) -> int:
        """Number of a new group."""
        self.kind.append(kind)
        self.fixed.append(fixed)
        return len(self.kind) - 1

    def of(self, kind: int, state: int, which: slice) -> list[int]:
        """Groups of some readings of a state: one for all, or each its own where some were not read."""
        read = self.data.read[state, which]
        ratio = self.data.unread[state, which] / self.data.sigma[state, which]
        if read.all():
            return [self.new(kind)] * len(read)
        return [self.new(kind, np.nan if r else float(u**2)) for r, u in zip(read, ratio, strict=True)]


def _shelf(data: Recorded, blocks: list[np.ndarray], groups: _Groups) -> Shelf:
    """Blocks stacked, filled up to the largest."""
    measured, m = data.vibrations, data.cables
    none = [np.zeros(0, dtype=int)] * len(blocks)
    cables, moving = none, none
    if measured is not None:
        local = [np.flatnonzero(np.isin(measured.states, members)) for members in blocks]
        cables = [np.flatnonzero(np.isin(measured.rows.state, own)) for own in local]
        moving = local if measured.peaks is not None else none
    states = _filled(blocks)
    rows = _filled(cables)
    turns = [np.flatnonzero(np.isin(data.swivels.state, members)) for members in blocks]
    turned = _filled(turns)
    index = np.full((len(blocks), states.shape[1] * (6 + m) + m + rows.shape[1] + turned.shape[1]), -1)
    for k, members in enumerate(blocks):
        own = list(_indices(members, groups, m))
        index[k, : len(members) * (6 + m)] = own[:-m]
        lengths = states.shape[1] * (6 + m)
        index[k, lengths : lengths + m] = own[-m:]
        index[k, lengths + m : lengths + m + len(cables[k])] = [groups.new(CABLE_FREQUENCY) for _ in cables[k]]
        last = lengths + m + rows.shape[1]
        index[k, last : last + len(turns[k])] = [groups.new(SWIVEL) for _ in turns[k]]
    return Shelf(states, rows, turned, _filled(moving), index)


def _indices(members: np.ndarray, groups: _Groups, m: int) -> Iterator[int]:
    """Groups of the readings of a block: position, rotation and tensions of each state, the lengths of all."""
    for state in members.tolist():
        yield from groups.of(POSITION, state, slice(0, 3))
        yield from groups.of(ROTATION, state, slice(3, 6))
        for i in range(m):
            yield from groups.of(TENSION, state, slice(6 + i, 7 + i))
    for i in range(m):
        yield from groups.of(LENGTH, int(members[0]), slice(6 + m + i, 7 + m + i))


def _filled(parts: list[np.ndarray]) -> np.ndarray:
    """(K, most) numbers, filled up with -1."""
    found = np.full((len(parts), max((len(part) for part in parts), default=0)), -1)
    for k, part in enumerate(parts):
        found[k, : len(part)] = part
    return found


def noise_of_states(data: Recorded, where: Layout, noise: tuple[np.ndarray, ...]) -> np.ndarray:
    """(S, 6 + 2 m) noise of each state's readings from that of the blocks, (K, q) a shelf."""
    own, m = 6 + data.cables, data.cables
    found = np.zeros_like(data.sigma)
    for shelf, values in zip(where.shelves, noise, strict=False):  # modal constants come last
        p = shelf.states.shape[1]
        for k, j in zip(*np.nonzero(shelf.states >= 0), strict=True):
            state = shelf.states[k, j]
            found[state, :own] = values[k, j * own : (j + 1) * own]
            found[state, own:] = values[k, p * own : p * own + m]
    return found
