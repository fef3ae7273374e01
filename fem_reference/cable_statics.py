"""Where does a cable of bars hang, and with which forces? Many cables between held ends in one go.

Equilibrium of the interior nodes fixes all bar forces but one: from bar to bar the tension vector changes by
the weight of a node, t_j = p - (j - (n - 1)/2) w, so the vector p at mid-length is the only unknown. Each bar
then has its direction t_j / N_j and, by Hooke, its length L0 (1 + N_j / EA), and p is right when the bars
lead from start to end. These are the same discrete equations as for node displacements, written in forces.
The gap is the gradient of the complementary energy sum L0 (N_j + N_j^2 / 2EA) - p . chord, which is convex:
Newton with a line search finds the one state in which all bars pull, whatever the sag, and the precision
of p does not suffer from a large EA / L0. The Hessian is the flexibility of the cable between its ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cdpr_struct.fem_reference.arrays import element_count, fixed_array
from cdpr_struct.fem_reference.bar_element import internal_forces
from cdpr_struct.fem_reference.cable import CableData, CableEquilibrium
from cdpr_struct.fem_reference.errors import CableNotConvergedError, CompressedBarError, FemError, FoldedCableError

STANDARD_GRAVITY = (0.0, 0.0, -9.81)
MAX_ITERATIONS = 200
EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class CableBatch:
    """m cables of n bars each, as arrays: lengths, EA (m,), weight of one bar and wind on it (m, 3) [N].

    handed_on : (m, 3) [N], a further force on the first free node, from a pulley
    lump_weight : (m, n + 1, 3) [N], of what sits on each node
    line_give, line_tension : (m,) [m/N], [N]; the first bar is longer by give (N - tension), for what slides into it
        from behind the start when its tension N is not yet the one for which the lengths were taken
    """

    cables: tuple[CableData, ...]
    elements: int
    element_length: np.ndarray
    axial_stiffness: np.ndarray
    element_weight: np.ndarray
    lump_weight: np.ndarray
    handed_on: np.ndarray
    line_give: np.ndarray
    line_tension: np.ndarray

    @classmethod
    def of(
        cls, cables: tuple[CableData, ...], elements: int, gravity: ArrayLike, pressed: ArrayLike = (0.0, 0.0, 0.0)
    ) -> CableBatch:
        """Collect the arrays from cable data; gravity (3,) [m/s^2], world, and wind pressing on each metre of cable
        (m, 3) [N/m]."""
        elements, acceleration = element_count(elements), fixed_array("gravity", gravity, (3,))
        length = np.array([cable.unstrained_length for cable in cables]) / elements
        density = np.array([cable.linear_density for cable in cables])
        return cls(
            cables,
            elements,
            length,
            np.array([cable.axial_stiffness for cable in cables]),
            length[:, None] * (density[:, None] * acceleration + np.asarray(pressed, dtype=float)),
            np.array([cable.node_lumps(elements) for cable in cables])[..., None] * acceleration,
            np.zeros((len(length), 3)),
            *np.zeros((2, len(length))),
        )

    @property
    def unstrained_length(self) -> np.ndarray:
        """Whole lengths (m,) [m]."""
        return self.element_length * self.elements

    @property
    def slack_tension(self) -> np.ndarray:
        """Tension (m,) [N] below which a bar has no direction worth the name."""
        return 1e-12 * np.linalg.norm(self.element_weight, axis=-1) + 1e-16 * self.axial_stiffness

    def tension_vectors(self, mid_force: np.ndarray) -> np.ndarray:
        """Tension vectors (m, n, 3) [N] that leave every interior node in balance."""
        offsets = np.arange(self.elements) - 0.5 * (self.elements - 1)
        vectors = mid_force[:, None, :] - offsets[:, None] * self.element_weight[:, None, :]
        vectors[:, 0] += self.handed_on
        vectors[:, 1:] -= np.cumsum(self.lump_weight[:, 1:-1], axis=1)
        return vectors

    @property
    def on_end(self) -> np.ndarray:
        """Weight (m, 3) [N] that `mid_force` leaves to the end of each cable: half its own, and all that sits on it."""
        return 0.5 * self.elements * self.element_weight + self.lump_weight[:, 1:].sum(axis=1)

    @property
    def on_start(self) -> np.ndarray:
        """Weight (m, 3) [N] at the start: half its own, and what sits on the first node."""
        return 0.5 * self.elements * self.element_weight + self.lump_weight[:, 0]


@dataclass(frozen=True, eq=False)
class ChainState:
    """The m chains for trial forces `mid_force` (m, 3) [N].

    gap    : (m, 3) [m], by how much the chain overshoots its end
    flexibility : (m, 3, 3) [m/N], derivative of the gap by the force
    energy : (m,) [J], complementary energy
    """

    mid_force: np.ndarray
    tension_vectors: np.ndarray
    gap: np.ndarray
    flexibility: np.ndarray
    energy: np.ndarray


def chain_state(batch: CableBatch, chord: np.ndarray, mid_force: np.ndarray) -> ChainState:
    """Evaluate the chains with mid forces (m, 3) [N] against their chords (m, 3) [m]."""
    length, stiffness = batch.element_length[:, None], batch.axial_stiffness[:, None]
    vectors = batch.tension_vectors(mid_force)
    tension = np.maximum(np.linalg.norm(vectors, axis=-1), batch.slack_tension[:, None])
    directions = vectors / tension[..., None]
    give, slid = batch.line_give, batch.line_give * (tension[:, 0] - batch.line_tension)
    spans = length * (1.0 + tension / stiffness)
    spans[:, 0] += slid
    gap = np.einsum("mn,mnk->mk", spans, directions) - chord
    along = np.repeat(length / stiffness, batch.elements, axis=1)
    along[:, 0] += give
    across = spans / tension
    flexibility = np.einsum("mnk,mn,mnl->mkl", directions, along - across, directions)
    flexibility += across.sum(axis=1)[:, None, None] * np.eye(3)
    energy = (length * (tension + 0.5 * tension**2 / stiffness)).sum(axis=1) - (mid_force * chord).sum(axis=1)
    energy += give * tension[:, 0] * (0.5 * tension[:, 0] - batch.line_tension)
    return ChainState(mid_force, vectors, gap, flexibility, energy)


def starting_force(batch: CableBatch, chord: np.ndarray) -> np.ndarray:
    """First guess (m, 3) [N]: Hooke along the straight chord, or the shallow parabola of the spare length."""
    span = np.linalg.norm(chord, axis=-1)
    weight = np.linalg.norm(batch.element_weight * batch.elements + batch.lump_weight.sum(axis=1), axis=-1)
    strain = span / batch.unstrained_length - 1.0
    stretched = np.maximum(batch.axial_stiffness * strain, 0.0)
    stretched = stretched + np.cbrt(batch.axial_stiffness * weight**2 / 24.0)
    hanging = weight / np.sqrt(24.0 * np.maximum(-strain, EPS))
    size = np.where(strain < 0.0, np.minimum(stretched, hanging), stretched)
    return size[:, None] * chord / np.maximum(span, 1e-300)[:, None]


def solve_chains(
    batch: CableBatch, starts: np.ndarray, ends: np.ndarray, first: np.ndarray | None = None
) -> tuple[ChainState, int]:
    """Equilibrium of all cables between starts and ends (m, 3) [m]; `first` (m, 3) [N] warms the start.

    Returns the state and the number of Newton steps.

    Raises
    ------
    FoldedCableError : a slack cable folds within one bar and finds no balance.
    CableNotConvergedError : any other failure, with the remaining gap.
    """
    chord = ends - starts
    state = chain_state(batch, chord, starting_force(batch, chord) if first is None else first)
    reach = (np.abs(starts).max(axis=1) + np.abs(ends).max(axis=1)) / batch.unstrained_length + 1.0
    noise = 8.0 * EPS * batch.axial_stiffness * (reach + np.sqrt(batch.elements))  # of ends, and of a sum over bars
    for iteration in range(MAX_ITERATIONS):
        step = -np.linalg.solve(state.flexibility, state.gap[..., None])[..., 0]
        largest = np.linalg.norm(state.tension_vectors, axis=-1).max(axis=1)
        done = np.linalg.norm(step, axis=-1) <= np.maximum(1e-13 * largest, noise)
        if done.all():
            return chain_state(batch, chord, state.mid_force + step), iteration + 1
        state = _searched(batch, chord, state, step, done)
    raise _failure(batch, state, int(np.argmin(done)))


def _searched(
    batch: CableBatch, chord: np.ndarray, state: ChainState, step: np.ndarray, done: np.ndarray
) -> ChainState:
    """Halve each cable's step until its energy falls (or, at round-off, its gap shrinks)."""
    scale = np.ones(len(step))
    slope = (state.gap * step).sum(axis=1)
    gap = np.linalg.norm(state.gap, axis=1)
    for _ in range(60):
        trial = chain_state(batch, chord, state.mid_force + scale[:, None] * step)
        falls = trial.energy <= state.energy + 1e-4 * scale * slope
        settled = falls | done | (np.linalg.norm(trial.gap, axis=1) <= 0.9 * gap)
        if settled.all():
            break
        scale = np.where(settled, scale, 0.5 * scale)
    return trial


def _refuse_folds(batch: CableBatch, state: ChainState) -> None:
    """Raise FoldedCableError if some bar is without tension."""
    tensions = np.linalg.norm(state.tension_vectors, axis=-1)
    limit = 100.0 * batch.slack_tension[:, None]
    if (tensions <= limit).any():
        cable, element = (int(index) for index in np.argwhere(tensions <= limit)[0])
        raise FoldedCableError(cable, element, float(tensions[cable, element]), float(tensions[cable].max()))


def _failure(batch: CableBatch, state: ChainState, cable: int) -> FemError:
    tensions = np.linalg.norm(state.tension_vectors[cable], axis=-1)
    weakest = int(np.argmin(tensions))
    if tensions[weakest] < 2.0 * np.linalg.norm(batch.element_weight[cable]):
        return FoldedCableError(cable, weakest, float(tensions[weakest]), float(tensions.max()))
    gap = float(np.linalg.norm(state.gap[cable]))
    return CableNotConvergedError(cable, gap, MAX_ITERATIONS, state.mid_force[cable])


def equilibria(
    batch: CableBatch, starts: np.ndarray, state: ChainState, iterations: int
) -> tuple[CableEquilibrium, ...]:
    """Turn solved chains into one CableEquilibrium a cable, each checked from its node positions.

    Raises
    ------
    FoldedCableError : a bar carries no tension (while searching for a pose that is no reason to stop).
    CompressedBarError : the stored nodes are nearer to each other than the unstrained bar is long.
    """
    _refuse_folds(batch, state)
    return tuple(_equilibrium(batch, index, starts[index], state, iterations) for index in range(len(starts)))


def _equilibrium(
    batch: CableBatch, index: int, start: np.ndarray, state: ChainState, iterations: int
) -> CableEquilibrium:
    cable, vectors, handed = batch.cables[index], state.tension_vectors[index], batch.handed_on[index]
    length, weight = float(batch.element_length[index]), batch.element_weight[index]
    tensions = np.linalg.norm(vectors, axis=-1)
    steps = vectors * (length * (1.0 / tensions + 1.0 / cable.axial_stiffness))[:, None]
    nodes = np.vstack([start, start + np.cumsum(steps, axis=0)])
    left_over = internal_forces(nodes, length, cable.axial_stiffness)[1:-1] - weight - batch.lump_weight[index, 1:-1]
    left_over[0] -= handed
    weakest = int(np.argmin(np.linalg.norm(np.diff(nodes, axis=0), axis=-1)))
    stretch = float(np.linalg.norm(nodes[weakest + 1] - nodes[weakest])) / length - 1.0
    if stretch < -64.0 * EPS * (1.0 + np.abs(nodes).max() / length):
        raise CompressedBarError(index, weakest, cable.axial_stiffness * stretch)
    return CableEquilibrium(
        cable,
        fixed_array("node_load", weight, (3,)),
        fixed_array("nodes", nodes, (None, 3)),
        fixed_array("tensions", vectors, (None, 3)),
        start_force=fixed_array("start_force", -vectors[0] + handed - 0.5 * weight - batch.lump_weight[index, 0], (3,)),
        end_force=fixed_array("end_force", vectors[-1] - 0.5 * weight - batch.lump_weight[index, -1], (3,)),
        residual_norm=float(np.linalg.norm(left_over, axis=-1).max()),
        iterations=iterations,
    )


def solve_cable(
    cable: CableData, start: ArrayLike, end: ArrayLike, elements: int, gravity: ArrayLike = STANDARD_GRAVITY
) -> CableEquilibrium:
    """Static equilibrium of a cable of `elements` bars between two held ends.

    Parameters
    ----------
    cable : CableData.
    start, end : (3,) [m], world.
    elements : number n of bars, at least 2.
    gravity : (3,) [m/s^2], world; z is up by default.

    Raises
    ------
    FoldedCableError : an exactly vertical slack cable that folds inside a bar.
    CableNotConvergedError : the iteration stopped.
    ValueError : wrong shapes or numbers, or something in line or a winch at the start, which `solve_robot` knows.
    """
    for name in ("line_give", "winch_tension"):
        if getattr(cable, name):
            raise ValueError(f"solve_cable knows no CableData.{name}, got {getattr(cable, name)!r}; use solve_robot")
    batch = CableBatch.of((cable,), elements, gravity)
    starts = fixed_array("start", start, (3,))[None]
    ends = fixed_array("end", end, (3,))[None]
    state, iterations = solve_chains(batch, starts, ends)
    return equilibria(batch, starts, state, iterations)[0]
