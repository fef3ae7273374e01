"""Natural frequencies of the robot at the measured state, in any world, followed mode by mode.

A mode is a root of D(omega) = K_E(omega) - omega^2 M. Small changes of the world move it by
-v' dD v / (v' dD/domega^2 v) with its platform shape v; larger ones are followed by Newton's method from there.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis.conditioned_state import Circumstances, Conditioned
from cdpr_struct.diagnosis.world import World
from cdpr_struct.dynamics.taut_cables import TautCables, closed_form_stiffness
from cdpr_struct.generated import cable_dsm, platform
from cdpr_struct.statics.cable_state import CableStates, cable_stiffness

_STEP = 1e-5
_ITERATIONS = 5
_SETTLED = 1e-7  # of omega^2
_LARGEST_MOVE = 0.02  # of ln omega, beyond the first-order estimate
_NEAR = 1e-3  # of a frequency: cables this near count fully
_STIFF = 100.0  # times omega^2: a direction so stiff follows at once, as along cables that hardly stretch


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """Paired robot frequencies: state (r,), omega (r,) of the model in the world as entered, platform shape (r, 6)."""

    state: np.ndarray
    omega: np.ndarray
    shape: np.ndarray


def taut(cables: CableStates, density: np.ndarray) -> TautCables:
    """Parameters of the closed-form dynamic stiffness of cables (...)."""
    across = cables.weight * np.cos(cables.inclination)
    epsilon = cable_dsm.epsilon(cables.chord, cables.tension, across)
    effective = cable_dsm.effective_length_integral(cables.chord, epsilon)
    along = cables.offset / cables.chord[..., None]
    sideways = np.cross([0.0, 0.0, 1.0], cables.heading)
    return TautCables(
        cables.chord, cables.tension, cables.axial_stiffness, effective,
        np.broadcast_to(density, cables.chord.shape), across, np.zeros_like(cables.chord), epsilon,
        cable_dsm.lambda_squared(cables.chord, cables.tension, cables.axial_stiffness, effective, across),
        np.stack([along, sideways, np.cross(along, sideways)], axis=-1),
    )  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Dynamics:
    """Everything of D(omega) at the rows' states: arrays (..., r, ...)."""

    cables: CableStates
    density: np.ndarray
    arms: np.ndarray
    fixed: np.ndarray
    mass: np.ndarray
    frame_compliance: np.ndarray
    masts: np.ndarray
    massless: bool

    @classmethod
    def at(
        cls, world: World, state: Conditioned, known: Circumstances, rows: np.ndarray, massless: bool, geometric: bool
    ) -> "Dynamics":
        """At the states (r,) of the rows; `world` per state."""
        cables = CableStates(*(_pick(getattr(state.cables, n), rows, _CORE.get(n, 1)) for n in CableStates.__slots__))
        rotation, arms = _pick(state.rotation, rows, 2), _pick(state.arms, rows, 2)
        mass = _mass_matrix(world, rotation, arms, known.payload[rows])
        fixed = _fixed_stiffness(world, cables, rotation, arms, geometric)
        return cls(
            cables, world.linear_density, arms, fixed, mass,
            world.frame_compliance, world.masts, massless,
        )  # fmt: skip

    def matrix(self, omega_squared: np.ndarray) -> np.ndarray:
        """D (..., r, 6, 6) at omega^2 (..., r) [rad^2/s^2]."""
        if self.massless:
            ends = cable_stiffness(self.cables)
        else:
            ends = closed_form_stiffness(taut(self.cables, self.density), omega_squared[..., None])
        stiffness, _ = self._carried(ends)
        result: np.ndarray = stiffness - omega_squared[..., None, None] * self.mass
        return result

    def at_rest(self) -> tuple[np.ndarray, np.ndarray]:
        """Static stiffness (..., r, 6, 6) at locked lengths, and what cables resist a twist by (..., r, 3m, 6)."""
        return self._carried(cable_stiffness(self.cables))

    def _carried(self, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness (..., r, 6, 6) of the platform on cable ends (..., r, m, 3, 3), and the cables' part of it."""
        map_ = platform.attachment(*np.moveaxis(self.arms, -1, 0))
        m = map_.shape[-3]
        stacked = map_.reshape((*map_.shape[:-3], 3 * m, 6))
        held = ends @ map_
        if np.any(self.frame_compliance):
            held = held - ends @ self._yielded(ends, held)
        carried = held.reshape((*held.shape[:-3], 3 * m, 6))
        return np.swapaxes(stacked, -1, -2) @ carried + self.fixed, carried

    def _yielded(self, ends: np.ndarray, held: np.ndarray) -> np.ndarray:
        """(..., m, 3, 6) motion of the cables' exits per twist: c F with the force F on a mast of compliance c.

        Of cables K, pulled by K A with exits held, F = sum K (A - c F), hence F = (1 + sum c K)^-1 sum K A.
        """
        give = self.frame_compliance[..., None, None]
        soft = np.einsum("mk,...kij->...mij", self.masts, give * ends) + np.eye(3)
        force = np.linalg.solve(soft, np.einsum("mk,...kij->...mij", self.masts, held))
        result: np.ndarray = give * force
        return result


_CORE = {"offset": 2, "heading": 2}


def _pick(value: np.ndarray, rows: np.ndarray, core: int) -> np.ndarray:
    return np.take(value, rows, axis=value.ndim - core - 1)


def _mass_matrix(world: World, rotation: np.ndarray, arms: np.ndarray, payload: np.ndarray) -> np.ndarray:
    """(..., r, 6, 6) about the platform origin, at which the payload (..., r) and sensors are [kg]."""
    payload = payload + world.sensor_mass
    center = (rotation @ world.center_of_mass[..., None])[..., 0]
    inertia = rotation @ world.inertia @ np.swapaxes(rotation, -1, -2)
    body = platform.mass_matrix(world.mass, *_parts(center), *_inertia_parts(inertia))
    matrix = np.array(np.broadcast_to(body, (*np.broadcast_shapes(body.shape[:-2], payload.shape), 6, 6)))
    for i in range(3):
        matrix[..., i, i] += payload
    if np.any(world.joint_mass):
        map_ = platform.attachment(*np.moveaxis(arms, -1, 0))
        matrix = matrix + np.einsum("...m,...mai,...maj->...ij", world.joint_mass, map_, map_)
    return matrix


def _parts(vector: np.ndarray) -> list[np.ndarray]:
    return [vector[..., i] for i in range(3)]


def _inertia_parts(inertia: np.ndarray) -> list[np.ndarray]:
    pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    return [inertia[..., i, j] for i, j in pairs]


def _fixed_stiffness(
    world: World, cables: CableStates, rotation: np.ndarray, arms: np.ndarray, geometric: bool
) -> np.ndarray:
    """(..., r, 6, 6) geometric terms of cable force and weight, and the hose."""
    center = (rotation @ world.center_of_mass[..., None])[..., 0]
    weight = -world.mass * world.gravity
    body = platform.geometric_stiffness(0.0, 0.0, weight, *_parts(center))
    pull = platform.geometric_stiffness(*_parts(cables.force_on_platform), *_parts(arms)).sum(axis=-3)
    rotational = (body + pull) * (1.0 if geometric else 0.0)
    matrix = np.zeros((*np.broadcast_shapes(rotational.shape[:-2], world.hose.shape), 6, 6))
    matrix[..., 3:, 3:] = rotational
    for i in range(3):
        matrix[..., i, i] += world.hose
    return matrix


def rate(dynamics: Dynamics, omega_squared: np.ndarray) -> np.ndarray:
    """dD/d(omega^2) (..., r, 6, 6)."""
    step = _STEP * omega_squared
    above, below = dynamics.matrix(omega_squared + step), dynamics.matrix(omega_squared - step)
    return (above - below) / (2.0 * step)[..., None, None]


def nearness(dynamics: Dynamics, omega: np.ndarray) -> np.ndarray:
    """(r, m) shares, large for cables that have a frequency of their own, ends held, near omega (r,)."""
    cables = dynamics.cables
    waves = omega[:, None] * cables.chord / np.sqrt(cables.tension / dynamics.density)
    weight = 1.0 / ((np.sin(waves) / waves) ** 2 + _NEAR**2)
    result: np.ndarray = weight / weight.sum(axis=-1, keepdims=True)
    return result


def first_order(
    dynamics: Dynamics, rows: Rows, entered: np.ndarray, entered_rate: np.ndarray, along: np.ndarray | None = None
) -> np.ndarray:
    """Change of ln omega (..., r) to first order, from D as entered (r, 6, 6) and its rate.

    along (..., r) : ln of what the nearest cables' own frequencies are moved by; D is compared where these are alike
    then, since at the same frequency a cable that passes by turns it over

    In very stiff directions the shape follows the change: there it is condensed exactly. With the shape held, a cable
    that hardly stretches would answer the square of the smallest turn with all its stiffness.
    """
    here = rows.omega**2 if along is None else (rows.omega * np.exp(along)) ** 2
    change = dynamics.matrix(here) - entered
    top = np.einsum("ri,...rij,rj->...r", rows.shape, change, rows.shape)
    top = top - _condensed(change, rows, entered, entered_rate)
    bottom = np.einsum("ri,rij,rj->r", rows.shape, entered_rate, rows.shape)
    move = -top / bottom / (2.0 * rows.omega**2)
    return move if along is None else along + move


def _condensed(change: np.ndarray, rows: Rows, entered: np.ndarray, entered_rate: np.ndarray) -> np.ndarray:
    """(..., r) what stiff directions take back of shape' change shape by giving way."""
    scale = np.sqrt(np.abs(np.diagonal(entered_rate, axis1=-2, axis2=-1)))
    values, vectors = np.linalg.eigh(entered / scale[:, :, None] / scale[:, None, :])
    stiff = values > _STIFF * rows.omega[:, None] ** 2
    if not stiff.any():
        return np.zeros(change.shape[:-2])
    modes = vectors / scale[:, :, None] * stiff[:, None, :]
    pull = np.einsum("rik,...rij,rj->...rk", modes, change, rows.shape)
    own = np.einsum("rik,...rij,rjl->...rkl", modes, change, modes)
    own = own + np.eye(6) * np.where(stiff, values, 1.0)[:, None, :]
    result: np.ndarray = (pull * np.linalg.solve(own, pull[..., None])[..., 0]).sum(axis=-1)
    return result


def shape_of(matrix: np.ndarray, mass: np.ndarray, near: np.ndarray) -> np.ndarray:
    """(..., r, 6) eigenvector of D (..., r, 6, 6) that is most like a shape `near` (r, 6), in the metric of masses."""
    scale = np.sqrt(np.abs(np.diagonal(mass, axis1=-2, axis2=-1)))
    _, vectors = np.linalg.eigh(matrix / scale[..., :, None] / scale[..., None, :])
    choice = np.abs(np.einsum("...i,...ij->...j", near * scale, vectors)).argmax(axis=-1)[..., None, None]
    result: np.ndarray = np.take_along_axis(vectors, choice, axis=-1)[..., 0] / scale
    return result


def follow(dynamics: Dynamics, rows: Rows, start: np.ndarray | None = None) -> np.ndarray:
    """omega (..., r) of each row's mode: Newton's method from a near start, the shape taken along.

    Where neighbours veer and the steps would leave the neighbourhood of the start, the start is kept.
    """
    first = rows.omega**2 if start is None else start**2
    here = dynamics.matrix(first)
    batch = here.shape[:-2]
    first = np.broadcast_to(first, batch)
    square, shape = first.copy(), np.broadcast_to(rows.shape, (*batch, 6))
    scale = np.sqrt(np.abs(np.diagonal(dynamics.mass, axis1=-2, axis2=-1)))
    for _ in range(_ITERATIONS):
        values, vectors = np.linalg.eigh(here / scale[..., :, None] / scale[..., None, :])
        overlap = np.abs(np.einsum("...i,...ij->...j", shape * scale, vectors))
        choice = overlap.argmax(axis=-1)[..., None]
        shape = np.take_along_axis(vectors, choice[..., None], axis=-1)[..., 0] / scale
        value = np.take_along_axis(values, choice, axis=-1)[..., 0]
        beyond = dynamics.matrix((1.0 + _STEP) * square)
        slope = np.einsum("...i,...ij,...j->...", shape, beyond - here, shape) / (_STEP * square)
        step = np.clip(-value / np.where(slope == 0.0, -1e-300, slope), -0.1 * square, 0.1 * square)
        square = square + step
        if (np.abs(step) < _SETTLED * square).all():
            break
        here = dynamics.matrix(square)
    moved, expected = np.abs(np.log(square / first)), np.abs(np.log(first / rows.omega**2))
    return np.sqrt(np.where(moved > _LARGEST_MOVE + 0.25 * expected, first, square))
