"""How omega^2 of a mode changes with everything that the vibration depends on: Rayleigh's quotient, its field held.

Of a mode of unit modal mass, d(omega^2) = dQ, with Q = displacement^T (stiffness - omega^2 mass) displacement. Each
cable's field is held as a function of the fraction of its length; a ramp follows its lever arm. A frame end that gives
way by C under its reaction g changes Q by -g' dC g, also where nothing gave way before: a mast does so under the
reactions of all its cables. A part that moves in the platform adds -2 omega^2 (c . v) y + (omega_k^2 - omega^2) y^2,
y its motion.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.ritz_modes import RitzModes
from cdpr_struct.observation.cable_fields import CableFields
from cdpr_struct.observation.dependence import (
    ADDED,
    ARM,
    BENDING,
    CABLE_COLUMNS,
    DENSITY,
    EA,
    GIVE,
    LENGTH,
    PLACE,
    PULL,
    TIGHTENED,
    WEIGHT,
)
from cdpr_struct.statics.masts import MastShapes


@dataclass(frozen=True, slots=True, eq=False)
class CableGradient:
    """Of omega^2 of k modes by the columns of each cable (..., m, k, CABLE_COLUMNS), and the frame ends' reactions
    (..., m, k, 3) [N] in modes of unit modal mass, world axes."""

    columns: np.ndarray
    reaction: np.ndarray

    def plus(self, other: "CableGradient", sign: float = 1.0) -> "CableGradient":
        """With that of a further part of the energy."""
        return CableGradient(self.columns + sign * other.columns, self.reaction + sign * other.reaction)


def cable_gradient(
    cables: np.ndarray, fields: CableFields, squared: np.ndarray, turn: np.ndarray | None = None
) -> CableGradient:
    """Gradient at cables (..., m, CABLE_COLUMNS).

    squared : (..., k) omega^2 [rad^2/s^2]
    turn : (..., k, 3) rotation of the platform in each mode; None if it is held
    """
    state = _State.of(cables, fields)
    inertia = squared[..., None, :]
    result = np.zeros((*fields.slope.shape[:-2], CABLE_COLUMNS))
    _elastic(result, state, fields)
    square = state.integral((fields.motion**2).sum(axis=-1))
    density, length, place = (cables[..., None, i] for i in (DENSITY, LENGTH, PLACE))
    added = cables[..., None, ADDED]
    result[..., DENSITY] = -inertia * length * square
    result[..., LENGTH] -= inertia * density * square
    pull, share = state.force(fields.slope), fields.stations.share[..., None, :, None]
    hurled = (inertia * density * length)[..., None, None] * fields.motion
    there, slope = fields.loaded[..., 0, :, :], fields.loaded[..., 1, :, :]
    result[..., ADDED] = -inertia[..., None] * (there**2).sum(axis=-1)
    result[..., PLACE] = 2.0 * inertia * (added * (there * slope).sum(axis=-1)).sum(axis=-1)
    lumped = inertia[..., None] * (added[..., None] * there).sum(axis=-2)
    reaction = -state.integral(pull + (1.0 - share) * hurled) - place[..., None] * lumped
    result[..., GIVE] = -(reaction[..., :, None] * reaction[..., None, :]).reshape((*reaction.shape[:-1], 9))
    if turn is not None:
        end = state.integral(pull - share * hurled) - (1.0 - place)[..., None] * lumped
        result[..., ARM] = 2.0 * np.cross(end, turn[..., None, :, :])
    return CableGradient(result, reaction)


def whole_gradient(own: CableGradient, masts: MastShapes, modes: RitzModes, mount: np.ndarray) -> np.ndarray:
    """(..., n, k) gradient by `Dependence.vector`; mount (..., PARTS) omega_k of moving parts [rad/s]."""
    platform, squared = modes.platform, modes.omega**2
    columns = np.moveaxis(own.columns, -2, -1)
    cables = columns.reshape((*columns.shape[:-3], -1, columns.shape[-1]))
    pulled = np.einsum("maq,...mka->...qk", masts.shapes, own.reaction)
    twice = (platform[..., :, None] * platform[..., None, :]).reshape((*platform.shape[:-1], 36))
    body = np.swapaxes(np.concatenate([-squared[..., None] * twice, twice], axis=-1), -1, -2)
    by_coupling = (-2.0 * squared[..., None] * modes.internal)[..., None] * platform[..., None, :]
    inner = np.concatenate([by_coupling, (2.0 * mount[..., None, :] * modes.internal**2)[..., None]], axis=-1)
    inner = inner.reshape((*squared.shape, -1))
    return np.concatenate([cables, -(pulled**2), body, np.swapaxes(inner, -1, -2)], axis=-2)


@dataclass(frozen=True, slots=True, eq=False)
class _State:
    """Along each cable, with axes for modes and stations: tangent (..., m, 1, s, 3), tension, stiffness of a string
    with this tension across it, EA, length, stiffening by bending (..., m, 1, s or 1); weights (..., m, 1, s)."""

    tangent: np.ndarray
    tension: np.ndarray
    string: np.ndarray
    axial: np.ndarray
    length: np.ndarray
    tightened: np.ndarray
    bending: np.ndarray
    weights: np.ndarray

    @classmethod
    def of(cls, cables: np.ndarray, fields: CableFields) -> "_State":
        weight = cables[..., WEIGHT, None] * fields.stations.share
        vector = cables[..., None, PULL] + weight[..., None] * np.array([0.0, 0.0, 1.0])
        tension = np.maximum(np.linalg.norm(vector, axis=-1), np.finfo(float).tiny)
        axial, length, tightened, bending = (cables[..., i, None, None] for i in (EA, LENGTH, TIGHTENED, BENDING))
        tangent = (vector / tension[..., None])[..., None, :, :]
        string = 1.0 / (1.0 / tension[..., None, :] + 1.0 / axial)
        weights = fields.stations.weight[..., None, :]
        return cls(tangent, tension[..., None, :], string, axial, length, tightened, bending, weights)

    def integral(self, values: np.ndarray) -> np.ndarray:
        """Over the fraction of the cable: (..., m, k, s) or (..., m, k, s, 3) without s."""
        if values.ndim > self.weights.ndim:
            return np.asarray((self.weights[..., None, :] @ values)[..., 0, :])
        return np.asarray((values * self.weights).sum(axis=-1))

    def parts(self, slope: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Slope along (..., m, k, s) and across (..., m, k, s, 3) the cable."""
        along = (self.tangent * slope).sum(axis=-1)
        return along, slope - along[..., None] * self.tangent

    def force(self, slope: np.ndarray) -> np.ndarray:
        """(..., m, k, s, 3) change of the cable force."""
        along, across = self.parts(slope)
        swung = (self.tightened * self.string)[..., None] * across
        return ((self.axial * along)[..., None] * self.tangent + swung) / self.length[..., None]


def _elastic(result: np.ndarray, state: _State, fields: CableFields) -> None:
    """Fills in what the elastic energy depends on."""
    along, across = state.parts(fields.slope)
    swung = (across**2).sum(axis=-1)
    softer = (state.string / state.tension) ** 2 * state.tightened * swung
    shear = 2.0 * (state.axial - state.tightened * state.string) * along / state.tension
    pull = (shear[..., None] * across + softer[..., None] * state.tangent) / state.length[..., None]
    share = fields.stations.share[..., None, :]
    length = state.length[..., 0]
    result[..., PULL] = state.integral(pull)
    result[..., WEIGHT] = state.integral(share * pull[..., 2])
    result[..., EA] = state.integral(along**2 + state.tightened * (state.string / state.axial) ** 2 * swung) / length
    energy = state.integral(state.axial * along**2 + state.tightened * state.string * swung)
    result[..., LENGTH] = -energy / length**2
    result[..., TIGHTENED] = state.integral(state.string * swung) / length
    if fields.curvature.shape[-2]:
        _, bent = state.parts(fields.curvature)
        energy = state.integral((bent**2).sum(axis=-1))
        result[..., BENDING] = energy / length**3
        result[..., LENGTH] -= 3.0 * state.bending[..., 0] * energy / length**4
