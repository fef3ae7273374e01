"""The linear model that evidence is computed from: residuals, their slopes and columns, laid out in blocks."""

import numpy as np

from cdpr_struct.association.association import Association
from cdpr_struct.inference.linear_model import LinearModel, Stack
from cdpr_struct.inference.soft_rows import SoftExpectation
from cdpr_struct.residuals.commanded_lengths import MISSED
from cdpr_struct.residuals.doubt_of_sizes import doubt_of_sizes, posed_sizes
from cdpr_struct.residuals.layout import Layout, Shelf
from cdpr_struct.residuals.linearised import Local, Outside, Point, Rows
from cdpr_struct.residuals.modal_sizes import measured_sizes
from cdpr_struct.residuals.recorded import Recorded

FLOOR = (0.05, 2e-5, 3e-4, 5e-3)
"""N, m, of ln f, of ln A: what the model misses of the FEM's balance, lengths, frequencies and modal constants."""
_FLOOR_OF_SWIVELS = 1e-5  # rad, far below what encoders resolve


def linear_model(local: Local, where: Layout) -> LinearModel:
    """r = A u + X z about a point, referred to zero noise and zero numbers: r = R + A u0 + X z0."""
    by_noise, columns = local.by_noise, local.own_columns
    shift = shifts(local, by_noise, columns)
    r = local.r
    residual = Rows(
        r.static + shift.static, r.cables + shift.cables, r.robot, r.sizes + shift.sizes, r.swivels + shift.swivels
    )
    stacks = []
    for shelf in where.shelves:
        own, x = of_shelf(where, shelf, residual), of_shelf(where, shelf, columns)
        noise, soft = _noise(local, where, shelf, by_noise), soft_rows(where, shelf, local)
        stack = Stack(own, noise, x, _floor(local, where, shelf, own.shape), shelf.index, soft)
        stacks.append(stack.with_noise(_meant(local, where, shelf)) if local.data.sent.known.any() else stack)
    if len(residual.sizes):
        stacks.append(_of_sizes(local, where, residual.sizes, columns.sizes))
    return LinearModel(tuple(stacks), where.groups)


def _of_sizes(local: Local, where: Layout, residual: np.ndarray, columns: np.ndarray) -> Stack:
    """Modal constants, those of a state as one block: each with noise of its own, those of a mode with a common one.

    What they cannot be sure of is that of the robot as entered, the same for every hypothesis. The readings of their
    state, on which they hardly depend, count once more.
    """
    entered = Local.about(local.data, Point.entered(local.data))
    sizes = local.vibrating.measured.sizes if local.vibrating is not None else measured_sizes(local.data.campaign)
    place = sizes.by_state
    _, mode = np.unique(sizes.peak, return_inverse=True)
    shared = (mode[:, None] == np.arange(mode.max() + 1)) * sizes.common[:, None]
    common = [shared, posed_sizes(entered), np.diag(doubt_of_sizes(entered))]
    own = _placed(place, np.broadcast_to(sizes.sigma, (1, len(sizes))).T)[..., 0]
    floor = np.where(place >= 0, FLOOR[3], 1.0)
    noise = own[:, :, None] * np.eye(place.shape[1])
    index = np.where(place >= 0, where.of_sizes[place], -1)
    stack = Stack(_placed(place, residual), noise, _placed(place, columns), floor, index, np.zeros(0))
    return stack.with_noise(_placed(place, np.concatenate(common, axis=1)))


def _placed(place: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values (a, ...) in blocks (K, n, ...), zero where there is none."""
    return np.where((place >= 0).reshape((*place.shape, *(1,) * (values.ndim - 1))), values[place], 0.0)


def shifts(local: Local, by_noise: Rows, columns: Rows) -> Rows:
    """A u0 + X z0: what noise and numbers of the point add to the residuals there."""
    noise, z = local.point.noise, local.told()
    static = np.einsum("srj,sj->sr", by_noise.static, noise) + columns.static @ z
    turned = np.einsum("wj,wj->w", by_noise.swivels, noise[local.data.swivels.state]) + columns.swivels @ z
    if local.vibrating is None:
        return Rows(static, local.r.cables, local.r.robot, local.r.sizes, turned)
    own = noise[local.vibrating.measured.states]
    cables = np.einsum("rj,rj->r", by_noise.cables, own[local.vibrating.measured.rows.state]) + columns.cables @ z
    robot = np.einsum("fmj,fj->fm", by_noise.robot, own) + columns.robot @ z
    return Rows(static, cables, robot, columns.sizes @ z, turned)


def of_shelf(where: Layout, shelf: Shelf, rows: Rows) -> np.ndarray:
    """Rows (or columns) as they stand in the blocks of a shelf, (K, n, ...)."""
    extra = rows.static.shape[2:]
    k = len(shelf.states)
    parts = []
    of = ((shelf.states, rows.static), (shelf.cables, rows.cables), (shelf.swivels, rows.swivels))
    for index, values in (*of, (shelf.vibrating, rows.robot)):
        if index.shape[1]:
            own = np.where((index >= 0).reshape((*index.shape, *(1,) * (values.ndim - 1))), values[index], 0.0)
            parts.append(own.reshape((k, -1, *extra)))
    return np.concatenate(parts, axis=1)


def stacked(where: Layout, rows: Rows) -> list[np.ndarray]:
    """Columns as they stand in the blocks of every shelf."""
    found = [of_shelf(where, shelf, rows) for shelf in where.shelves]
    return [*found, _placed(where.sizes_of_states, rows.sizes)] if len(rows.sizes) else found


def _noise(local: Local, where: Layout, shelf: Shelf, by_noise: Rows) -> np.ndarray:
    """(K, n, q) what readings do: those of a state to its rows, lengths to all, cable frequencies and swivel angles to
    their own."""
    own, m = 6 + where.m, where.m
    slopes = of_shelf(where, shelf, by_noise)
    k, n, _ = slopes.shape
    (_, p), (_, c), (_, w) = shelf.states.shape, shelf.cables.shape, shelf.swivels.shape
    found = np.zeros((k, n, shelf.index.shape[1]))
    found[..., p * own : p * own + m] = slopes[..., own:]
    found[..., : p * own] = _of_each_state(slopes[..., :own], _places(local, shelf, n, own), p)
    if c and local.vibrating is not None:
        sigma = np.where(shelf.cables >= 0, local.vibrating.measured.sigma[shelf.cables], 0.0)
        for j in range(c):
            found[:, p * own + j, p * own + m + j] = sigma[:, j]
    if w:
        turn = np.where(shelf.swivels >= 0, local.data.swivels.sigma[shelf.swivels], 0.0)
        for j in range(w):
            found[:, p * own + c + j, p * own + m + c + j] = turn[:, j]
    found[np.broadcast_to((shelf.index < 0)[:, None, :], found.shape)] = 0.0
    return found


def _of_each_state(columns: np.ndarray, place: np.ndarray, states: int) -> np.ndarray:
    """(K, n, p d) of columns (K, n, d): errors of each of p states, in its own rows alone."""
    return np.concatenate([np.where((place == j)[..., None], columns, 0.0) for j in range(states)], axis=-1)


def errors_of_states(local: Local, where: Layout, columns: Outside) -> list[np.ndarray]:
    """What d errors that each state has for itself do to the blocks, (K, n, p d) a shelf."""
    rows, found = local.r.of_outside(columns), []
    for shelf in where.shelves:
        own = of_shelf(where, shelf, rows)
        place = _places(local, shelf, own.shape[1], 6 + where.m)
        found.append(_of_each_state(own, place, shelf.states.shape[1]))
    return [*found, np.zeros((*where.sizes_of_states.shape, 0))] if len(local.r.sizes) else found


def _meant(local: Local, where: Layout, shelf: Shelf) -> np.ndarray:
    """(K, n, 6 p) by how much commanded lengths would differ if another pose was meant, one sigma of it."""
    own, (k, p) = 6 + where.m, shelf.states.shape
    found = np.zeros((k, p * own, 6 * p))
    for j in range(p):
        slope = local.data.sent.slope[shelf.states[:, j]] * MISSED
        rows = slice(j * own + 6, (j + 1) * own)
        found[:, rows, 6 * j : 6 * (j + 1)] = np.where((shelf.states[:, j] >= 0)[:, None, None], slope, 0.0)
    rest = len(shelf.cables[0]) + len(shelf.swivels[0]) + shelf.vibrating.shape[1] * local.r.robot.shape[1]
    return np.concatenate([found, np.zeros((k, rest, 6 * p))], axis=1)


def _places(local: Local, shelf: Shelf, rows: int, own: int) -> np.ndarray:
    """(K, n) which state of its block each row belongs to."""
    k, p = shelf.states.shape
    place = np.zeros((k, rows), dtype=int)
    place[:, : p * own] = np.repeat(np.arange(p), own)
    if p == 1 or rows == p * own:
        return place
    of = local.states_of_rows
    parts = [_looked_up(of.cables, shelf.cables), _looked_up(of.swivels, shelf.swivels)]
    if local.vibrating is not None:
        moving = local.vibrating.measured.states[shelf.vibrating]
        parts.append(np.repeat(moving, local.r.robot.shape[1], axis=1))
    state = np.concatenate(parts, axis=1)
    place[:, p * own :] = (shelf.states[:, None, :] == state[:, :, None]).argmax(axis=-1)
    return place


def _looked_up(values: np.ndarray, index: np.ndarray) -> np.ndarray:
    """Values (r,) at an index (K, c), -1 where it is."""
    return np.where(index >= 0, values[index], -1) if index.size else np.full(index.shape, -1)


def floor_of_states(data: Recorded) -> np.ndarray:
    """(S, 6 + m) [N, m], what the model misses of balance and lengths of each state.

    While the platform moves its balance is as open as its inertia, which is not in the model. Rows of what a guide
    holds are empty: their floor is one.
    """
    floor = np.tile(np.repeat(FLOOR[:2], (6, data.cables)), (data.states, 1))
    floor[:, :6] += (float(data.arrays.mass.max()) * data.known.acceleration)[:, None]
    floor[:, :6][:, data.held] = 1.0
    return floor


def _floor(local: Local, where: Layout, shelf: Shelf, shape: tuple[int, ...]) -> np.ndarray:
    """(K, n)."""
    floor = np.ones(shape)
    own, (k, p), (_, c), (_, w) = 6 + where.m, shelf.states.shape, shelf.cables.shape, shelf.swivels.shape
    states = np.where(shelf.states[..., None] >= 0, floor_of_states(local.data)[shelf.states], 1.0)
    floor[:, : p * own] = states.reshape((k, p * own))
    floor[:, p * own : p * own + c] = np.where(shelf.cables >= 0, FLOOR[2], 1.0)
    last = p * own + c
    floor[:, last : last + w] = np.where(shelf.swivels >= 0, _FLOOR_OF_SWIVELS, 1.0)
    return floor


def soft_rows(where: Layout, shelf: Shelf, local: Local) -> np.ndarray:
    """(s,) rows of the robot's modes in the blocks of a shelf."""
    start = shelf.states.shape[1] * (6 + where.m) + shelf.cables.shape[1] + shelf.swivels.shape[1]
    return start + np.arange(shelf.vibrating.shape[1] * local.r.robot.shape[1])


class Lists:
    """Lists of peaks as soft rows of a linear model, whose predictions refer to zero noise and numbers.

    shift (F, M) : prediction of ln f at the point of linearisation;  columns (F, M, t) of it
    """

    def __init__(self, association: Association, shift: np.ndarray, columns: np.ndarray, shelf: Shelf) -> None:
        self.association, self.shift, self.columns, self.shelf = association, shift, columns, shelf

    def copy(self) -> "Lists":
        """The same lists, to be assigned anew."""
        return Lists(self.association.at(), self.shift, self.columns, self.shelf)

    @classmethod
    def of(cls, local: Local, where: Layout) -> "Lists | None":
        """None without peaks."""
        found = None if local.vibrating is None else local.vibrating.association()
        if found is None:
            return None
        columns = local.own_columns
        shift = shifts(local, local.by_noise, columns).robot
        shelf = next(shelf for shelf in where.shelves if shelf.vibrating.shape[1])
        return cls(found, shift, columns.robot, shelf)

    def expect(self, mean: np.ndarray, variance: np.ndarray, predictive: bool | None = None) -> SoftExpectation:
        """As `Association.expect`, for rows (K, s) of the shelf's blocks."""
        said = self.association.expect(self.of_modes(mean) - self.shift, self.of_modes(variance), predictive)
        return SoftExpectation(self._rows(said.value + self.shift), self._rows(said.precision), said.constant)

    @property
    def left(self) -> float:
        """Expected number of peaks that belong to no mode, as they were last assigned."""
        assignment = self.association.assignment
        if assignment is None:
            return 0.0
        return float(self.association.peaks.count.sum() - assignment.number.sum())

    def at_point(self, covariance: np.ndarray) -> SoftExpectation:
        """As if the modes were those of the point, as sure as numbers z of a covariance (t, t) are."""
        variance = np.einsum("fmt,tu,fmu->fm", self.columns, covariance, self.columns, optimize=True)
        return self.expect(self._rows(self.shift), self._rows(variance), False)

    def of_modes(self, rows: np.ndarray) -> np.ndarray:
        """(F, M) from (K, s)."""
        k, v = np.nonzero(self.shelf.vibrating >= 0)
        found = np.zeros_like(self.shift)
        found[self.shelf.vibrating[k, v]] = rows.reshape((*self.shelf.vibrating.shape, -1))[k, v]
        return found

    def _rows(self, modes: np.ndarray) -> np.ndarray:
        """(K, s) from (F, M)."""
        index = self.shelf.vibrating
        return np.where((index >= 0)[..., None], modes[index], 0.0).reshape((len(index), -1))
