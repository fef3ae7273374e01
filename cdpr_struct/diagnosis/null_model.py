"""Tolerances and sensor noise as independent standard normal numbers, and what they do to the residuals.

Residuals are linear in these numbers near what was recorded: r = A u, so their covariance under the null is A A'.
A state's noise of pose and tension enters wrench balance, compatibility and frequencies together; states of one lock
share their length readings.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular

from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import Setting, residuals
from cdpr_struct.diagnosis.wandering_noise import remembered, runs
from cdpr_struct.diagnosis.world import World
from cdpr_struct.side_by_side import side_by_side

STEP = 0.1  # of a sigma
_WILD = 5.0  # times the median miss
_FARTHEST = 2.5  # sigmas
FLOOR = {  # what the model itself may miss
    "EQ": 0.05, "CO": 0.02, "NS": 0.1, "LP": 0.02, "CF": 0.03, "RF": 0.05, "FA": 0.5,
}  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class NullModel:
    """The null at a world: residuals (n,), their Jacobian to standard normal numbers, and the whitening.

    r : as recorded;  columns : (n, N) readings, then tolerances, then frequency noise and model floor
    lower : Cholesky factor of the covariance
    """

    r: np.ndarray
    columns: np.ndarray
    lower: np.ndarray

    def white(self, value: np.ndarray) -> np.ndarray:
        """L^-1 value for (n,) or (n, d)."""
        result: np.ndarray = solve_triangular(self.lower, value, lower=True, check_finite=False)
        return result

    def white_among(self, rows: np.ndarray, value: np.ndarray) -> np.ndarray:
        """Some rows of a value (n,) or (n, d), whitened by the covariance that they have without the others."""
        lower = np.linalg.cholesky(self.covariance[np.ix_(rows, rows)])
        result: np.ndarray = solve_triangular(lower, value[rows], lower=True, check_finite=False)
        return result

    @property
    def log_volume(self) -> float:
        """Half the logarithm of the covariance's determinant."""
        return float(np.log(np.diagonal(self.lower)).sum())

    @property
    def level(self) -> float:
        """Minus the log evidence of the null, but for a constant."""
        z = self.white(self.r)
        return float(0.5 * z @ z) + self.log_volume

    @property
    def covariance(self) -> np.ndarray:
        """(n, n)."""
        result: np.ndarray = self.lower @ self.lower.T
        return result


def tolerance_count(setting: Setting) -> int:
    """How many numbers describe the tolerances."""
    return sum(_tolerance_sizes(setting.campaign.robot.platform_anchors.shape[0]))


def _tolerance_sizes(m: int) -> tuple[int, ...]:
    """How many numbers each tolerance of a robot with m cables takes, in their order."""
    return (3 * m, 3 * m, m, m, 1, m, 1, 1, 3, 3, m, m, m)


def tolerated(setting: Setting, world: World, u: np.ndarray) -> World:
    """World whose tolerances are u (..., t) sigmas off."""
    tol, m = setting.campaign.tolerances, world.cables
    parts = np.split(u, np.cumsum(_tolerance_sizes(m))[:-1], axis=-1)
    lead, half = u.shape[:-1], np.sqrt(0.5)
    body = np.sqrt(np.diagonal(setting.campaign.robot.platform.inertia))
    inertia = np.exp(0.5 * tol.platform_inertia * parts[9])
    ball = 1.0 + (0.0 * body + 1.0) * (inertia - 1.0)
    moved = world.plus(
        frame_anchors=tol.anchor_m * parts[0].reshape((*lead, m, 3)),
        platform_anchors=tol.anchor_m * parts[1].reshape((*lead, m, 3)),
        length_offset=tol.length_m * parts[2],
        mass=tol.platform_mass_kg * parts[7][..., 0],
        center_of_mass=tol.center_of_mass_m * parts[8],
        cell_bias=tol.load_cell_bias_N * parts[11],
        pulley_radius=np.where(world.pulley_radius > 0.0, tol.pulley_radius_m * parts[12], 0.0),
    )
    return moved.times(
        axial_stiffness=np.exp(half * tol.axial_stiffness * (parts[3] + parts[4])),
        linear_density=np.exp(half * tol.linear_density * (parts[5] + parts[6])),
        inertia=ball[..., :, None] * ball[..., None, :],
        cell_gain=np.exp(tol.load_cell_gain * parts[10]),
    )


def reading_count(setting: Setting) -> int:
    """Numbers of noise in the readings: pose and tension a state, length a lock."""
    states, m = setting.campaign.states, setting.campaign.robot.platform_anchors.shape[0]
    return len(states.names) * (6 + m) + (int(states.lock.max()) + 1) * m


def misread(setting: Setting, readings: Readings, u: np.ndarray) -> Readings:
    """Readings with noise u (..., k) taken off, in sigmas."""
    states, m = setting.campaign.states, setting.campaign.robot.platform_anchors.shape[0]
    s, locks = len(states.names), int(states.lock.max()) + 1
    pose, tension, length = np.split(u, [6 * s, (6 + m) * s], axis=-1)
    pose = pose.reshape((*u.shape[:-1], s, 6))
    size = length.reshape((*u.shape[:-1], max(locks, 0), m))
    spread = np.concatenate([size, np.zeros((*u.shape[:-1], 1, m))], axis=-2)[..., states.lock, :]
    return readings.shifted(
        states.sigma_position[:, None] * pose[..., :3],
        states.sigma_rotation[:, None] * pose[..., 3:],
        np.where(np.isfinite(states.tension_sigma), states.tension_sigma, 0.0) * tension.reshape((*u.shape[:-1], s, m)),
        np.where(np.isfinite(states.length_sigma), states.length_sigma, 0.0) * spread,
    )


def null_model(setting: Setting, world: World, readings: Readings, extra: np.ndarray | None = None) -> NullModel:
    """The null linearised at a world and readings; `extra` (n,) is further noise of each residual."""
    off = tolerated(setting, world, STEP * np.eye(tolerance_count(setting)))
    noisy = misread(setting, readings, reading_steps(setting))

    def computed(at: tuple[World, Readings, bool]) -> np.ndarray:
        return residuals(setting, at[0], at[1], small=at[2])

    places = [(off, readings, True), (world, noisy, True), (world, readings, True), (world, readings, False)]
    by_tolerance, by_reading, base, r = side_by_side(computed, places, ())
    noise = _reading_columns(setting, (by_reading - base).T / STEP)
    tolerance = (by_tolerance - base).T / STEP
    more = np.zeros((len(base), 0)) if extra is None else np.diag(extra)
    columns = np.concatenate([noise, tolerance, _own_noise(setting), more], axis=1)
    return NullModel(r, columns, _lower(setting, columns))


def _lower(setting: Setting, columns: np.ndarray) -> np.ndarray:
    """(n, n) Cholesky factor of the covariance, the memory of the sensors' noise included."""
    mixed = remembered(columns, sensors(setting), setting.campaign.memory)
    return np.linalg.cholesky(mixed @ mixed.T)


def sensors(setting: Setting) -> list[np.ndarray]:
    """Numbers of the columns of a null that are readings of one sensor, in order."""
    start = reading_count(setting) + tolerance_count(setting)
    return runs(setting.campaign.states, setting.campaign.cable_frequencies, start)


def _reading_columns(setting: Setting, effect: np.ndarray) -> np.ndarray:
    """(n, k): the effect (n, 6 + 2 m) of the same reading of every state, given to each state's own column."""
    states, m = setting.campaign.states, setting.campaign.robot.platform_anchors.shape[0]
    s, locks = len(states.names), int(states.lock.max()) + 1
    columns = np.zeros((len(effect), reading_count(setting)))
    row, state = np.arange(len(effect)), setting.labels.state
    for j in range(6):
        columns[row, 6 * state + j] = effect[:, j]
    for i in range(m):
        columns[row, 6 * s + m * state + i] = effect[:, 6 + i]
        locked = states.lock[state] >= 0
        if locks:
            columns[row[locked], (6 + m) * s + m * states.lock[state[locked]] + i] = effect[locked, 6 + m + i]
    return columns


def reading_steps(setting: Setting) -> np.ndarray:
    """(6 + 2 m, k) noise that moves one reading of a kind in all states at once, by `STEP` sigmas."""
    states, m = setting.campaign.states, setting.campaign.robot.platform_anchors.shape[0]
    s = len(states.names)
    steps = np.zeros((6 + 2 * m, reading_count(setting)))
    for j in range(6):
        steps[j, j : 6 * s : 6] = STEP
    for i in range(m):
        steps[6 + i, 6 * s + i : (6 + m) * s : m] = STEP
        steps[6 + m + i, (6 + m) * s + i :: m] = STEP
    return steps


def _own_noise(setting: Setting) -> np.ndarray:
    """(n, .) noise of frequencies, and the floor of the model."""
    labels = setting.labels
    size = np.array([FLOOR[b] for b in labels.block])
    size[labels.block == "RF"] = np.hypot(size[labels.block == "RF"], setting.robot_doubt)
    size[labels.block == "FA"] = np.hypot(size[labels.block == "FA"], setting.constant_doubt)
    floor = np.diag(size)
    rows = setting.campaign
    relative = [
        rows.cable_frequencies.sigma / rows.cable_frequencies.hertz,
        rows.robot_frequencies.sigma / rows.robot_frequencies.hertz,
    ]
    own = np.zeros((len(labels), 0))
    for name, sigma in zip(("CF", "RF"), relative, strict=True):
        mine = np.flatnonzero(labels.block == name)
        block = np.zeros((len(labels), mine.size))
        block[mine, np.arange(mine.size)] = 100.0 * sigma
        own = np.concatenate([own, block], axis=1)
    if len(setting.constants):
        own = np.concatenate([own, _constant_noise(setting)], axis=1)
    return np.concatenate([own, floor], axis=1)


def _constant_noise(setting: Setting) -> np.ndarray:
    """(n, .) noise of modal constants, each on its own, and by the damping that channels of a mode share."""
    constants, mine = setting.constants, np.flatnonzero(setting.labels.block == "FA")
    modes, number = np.unique(constants.peak, return_inverse=True)
    block = np.zeros((len(setting.labels), len(mine) + len(modes)))
    block[mine, np.arange(len(mine))] = 100.0 * constants.sigma
    block[mine, len(mine) + number] = 100.0 * constants.common
    return block


def null_with_bending(
    setting: Setting, world: World, readings: Readings, count: int, seed: int
) -> tuple[NullModel, np.ndarray]:
    """The null with what its linearisation misses over `count` draws added as noise; that noise (n,).

    Where a draw takes a mode of the robot past its neighbour, it says nothing of small changes: the misses of robot
    frequencies are clipped at a multiple of their median. Cable frequencies are known by their number: two in-plane
    modes that noise may let cross are both in doubt by what they lie apart.
    """
    null = null_model(setting, world, readings)
    generator = np.random.default_rng(seed)
    noise, tolerance = reading_count(setting), tolerance_count(setting)
    u = generator.standard_normal((count, noise + tolerance))
    moved = drawn_residuals(setting, world, readings, u)
    missed = np.abs(moved - u @ null.columns[:, : noise + tolerance].T)
    most = np.where(setting.labels.block == "CF", np.inf, _WILD * np.median(missed, axis=0))
    extra = np.sqrt((np.minimum(missed, most) ** 2).mean(axis=0))
    columns = np.concatenate([null.columns, np.diag(extra)], axis=1)
    return NullModel(null.r, columns, _lower(setting, columns)), extra


def tolerance_columns(setting: Setting, null: NullModel) -> np.ndarray:
    """(n, t) what each tolerance does to the whitened residuals."""
    noise = reading_count(setting)
    return null.white(null.columns[:, noise : noise + tolerance_count(setting)])


def likeliest_tolerances(setting: Setting, null: NullModel, white: np.ndarray) -> np.ndarray:
    """(t,) tolerances that explain whitened residuals (n,) best, in sigmas; none beyond `_FARTHEST`."""
    likeliest = -tolerance_columns(setting, null).T @ white
    result: np.ndarray = likeliest * min(1.0, _FARTHEST / max(float(np.abs(likeliest).max()), 1e-9))
    return result


def relinearised(
    setting: Setting, world: World, readings: Readings, extra: np.ndarray, u: np.ndarray
) -> tuple[NullModel, np.ndarray]:
    """The null at a world whose tolerances are u already, and the offset that keeps its residuals those of u = 0.

    To first order r(0) = r(u) - A u with the columns A at u: what bends on the way from 0 to u no longer counts.
    """
    null = null_model(setting, world, readings, extra)
    noise = reading_count(setting)
    offset = -null.columns[:, noise : noise + len(u)] @ u
    return NullModel(null.r + offset, null.columns, null.lower), offset


def drawn_residuals(setting: Setting, world: World, readings: Readings, u: np.ndarray) -> np.ndarray:
    """(k, n) changes of the residuals by readings and tolerances off by u (k, N), through the nonlinear computation."""
    noise = reading_count(setting)
    worlds, noisy = tolerated(setting, world, u[:, noise:]), misread(setting, readings, u[:, :noise])
    return residuals(setting, worlds, noisy) - residuals(setting, world, readings)


def drawn_campaigns(setting: Setting, world: World, readings: Readings, count: int, seed: int) -> np.ndarray:
    """(count, n) residuals of the null about those at hand, noise of frequencies and the model's floor included."""
    generator = np.random.default_rng(seed)
    u = generator.standard_normal((count, reading_count(setting) + tolerance_count(setting)))
    own = _own_noise(setting)
    return drawn_residuals(setting, world, readings, u) + generator.standard_normal((count, own.shape[1])) @ own.T
