"""Measured robot frequencies beside the model's modes: which mode each peak is, and the model's exact frequency of it.

The residuals follow modes by the closed form; here the exact model says where they are in a given world.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis import robot_pitch
from cdpr_struct.diagnosis.modal_constants import log_constants, modelled_constants, unit_modal_mass
from cdpr_struct.diagnosis.mode_pairing import Modes, Pairing, paired
from cdpr_struct.diagnosis.null_model import STEP, misread, reading_steps, tolerance_count, tolerated
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import Setting, at_states, resting_and_vibrating
from cdpr_struct.diagnosis.vibrating_state import raised
from cdpr_struct.diagnosis.world import World
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.natural_frequencies import count_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.errors import CdprError, InputError

_LEAST_SHARE = 0.08  # of the kinetic energy in the platform: a mode with less is not seen there
_MARGINS = (1.35, 2.5, 6.0)  # times the highest peak: how far modes are looked for, until there are enough
_MOST_GAP = 0.05  # of ln f between the closed form and the exact model; beyond it they are different modes
_CABLES_SHARE = 0.004  # of ln f: what the closed form may miss of a mode that is all cables
_MOST_CONSTANT_GAP, _MOST_DOUBT = 0.2, 1.0  # of ln of a modal constant
_BEND = 1.0  # times the square of its spread: ln |1 + x| = x - x^2 / 2 where a mode turns by x towards another
_UNSURE = 50.0  # doubt of a modal constant per doubt of ln f: another mode has another constant
_ROUGH = (0.005, 0.006, 0.4)  # sigma of ln f of a cable's mode, more of the platform's; correlation: near enough
_ELSEWHERE = (0.05, 0.02)  # of ln f: in a world that may be wrong all modes may be off together, and each on its own


@dataclass(frozen=True, slots=True, eq=False)
class _Followed:
    """Modes as the closed form has them: rows, ln(exact / closed form), D and its rate there.

    rise, nearness (k, m) : what sensors raise the cables' own frequencies by, and how near the mode is to these
    """

    rows: robot_pitch.Rows
    gap: np.ndarray
    matrix: np.ndarray
    rate: np.ndarray
    rise: np.ndarray
    nearness: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class ModelModes:
    """All modes of a world at the states where peaks were measured, and (k, k) the covariance of their ln f."""

    modes: Modes
    followed: _Followed
    covariance: np.ndarray
    world: World


def model_modes(setting: Setting, world: World, points: dict[int, OperatingPoint]) -> ModelModes:
    """The modes of a world by the exact model.

    Raises
    ------
    InputError : far fewer modes than peaks.
    """
    modes = _modes_at(setting, points)
    followed = _followed(setting, world, modes)
    return ModelModes(modes, followed, _covariance(setting, world, followed), world)


def with_robot_rows(setting: Setting, model: ModelModes, wary: bool) -> Setting:
    """The setting with every peak given to a mode.

    wary : the modes' world may be far from the truth
    """
    peaks, followed, pairing = setting.campaign.robot_frequencies, model.followed, pairing_of(setting, model, wary)
    pick, own = pairing.chosen, _cables_doubt(model.modes)
    rows = robot_pitch.Rows(peaks.state, followed.rows.omega[pick], followed.rows.shape[pick])
    setting = replace(
        setting, robot_rows=rows, robot_gap=followed.gap[pick], robot_log=np.log(2.0 * np.pi * peaks.hertz),
        robot_doubt=100.0 * np.sqrt(pairing.doubt**2 + np.diagonal(own)[pick]),
        entered=followed.matrix[pick], entered_rate=followed.rate[pick], entered_rise=followed.rise[pick],
        nearness=followed.nearness[pick], stray=pairing.stray,
    )  # fmt: skip
    if not len(setting.constants):
        return setting
    gap, doubt = _constant_gap(setting, model, pick)
    unsure = np.minimum(_MOST_DOUBT, _UNSURE * pairing.doubt[setting.constants.peak])
    bend = _BEND * _constant_spread(setting, model.world) ** 2
    return replace(setting, constant_gap=gap, constant_doubt=100.0 * np.sqrt(doubt**2 + unsure**2 + bend**2))


def pairing_of(setting: Setting, model: ModelModes, wary: bool) -> Pairing:
    """Which mode each peak is; wary as in `with_robot_rows`."""
    covariance = model.covariance
    if wary:
        covariance = covariance + _ELSEWHERE[0] ** 2 + _ELSEWHERE[1] ** 2 * np.eye(len(covariance))
    return _paired(setting, model.modes, covariance)


def rough_strays(setting: Setting, points: dict[int, OperatingPoint]) -> float:
    """Expected number of peaks that are no mode of a world, whose modes are not followed: several times faster."""
    modes = _modes_at(setting, points)
    sigma = _ROUGH[0] + _ROUGH[1] * modes.energy
    alike = _ROUGH[2] + (1.0 - _ROUGH[2]) * np.eye(len(sigma))
    return float(_paired(setting, modes, alike * np.outer(sigma, sigma)).stray.sum())


def _paired(setting: Setting, modes: Modes, covariance: np.ndarray) -> Pairing:
    """The peaks paired with modes whose ln f have a covariance (k, k), but for what the closed form misses."""
    peaks, covariance = setting.campaign.robot_frequencies, covariance + _cables_doubt(modes)
    unlike = peaks.unlike(np.arange(len(peaks.hertz)), modes.shape, setting.radius)
    return paired(peaks.state, peaks.hertz, peaks.sigma / peaks.hertz, modes, covariance, unlike)


def _cables_doubt(modes: Modes) -> np.ndarray:
    """(k, k) covariance of ln f by what the closed form misses of the cables."""
    result: np.ndarray = np.diag((_CABLES_SHARE * (1.0 - modes.energy)) ** 2)
    return result


def _constant_spread(setting: Setting, world: World) -> np.ndarray:
    """(a,) one sigma of the model's ln |A| by tolerances and readings: large where modes share their motion."""
    readings, rows, parts = Readings.of(setting.campaign.states), setting.robot_rows, []
    off = tolerated(setting, world, STEP * np.eye(tolerance_count(setting)))
    noisy = misread(setting, readings, reading_steps(setting))
    for moved, read in ((world, readings), (off, readings), (world, noisy)):
        dynamics = _dynamics(setting, moved, read, rows.state)
        move = robot_pitch.first_order(dynamics, rows, setting.entered, setting.entered_rate)
        parts.append(modelled_constants(setting.constants, dynamics, rows, rows.omega * np.exp(move)))
    base, by_tolerance, by_reading = parts
    change = np.concatenate([by_tolerance - base, by_reading - base]) / STEP
    spread: np.ndarray = np.sqrt((change**2).sum(axis=0))
    return spread


def _constant_gap(setting: Setting, model: ModelModes, pick: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(a,) ln(exact / closed form) of the modal constants of the paired modes, and (a,) how far that may be off.

    Where the two differ much the mode shares its motion with a cable, and neither is to be trusted.
    """
    exact = log_constants(setting.constants, model.modes.shape[pick])
    closed = unit_modal_mass(model.followed.rows.shape, model.followed.rate)
    gap = exact - log_constants(setting.constants, closed[pick])
    off = np.abs(gap) > _MOST_CONSTANT_GAP
    return np.where(off, 0.0, gap), np.where(off, _MOST_DOUBT, 0.3 * np.abs(gap))


def _modes_at(setting: Setting, points: dict[int, OperatingPoint]) -> Modes:
    """All modes in which the platform moves, somewhat beyond the highest peak of each state."""
    peaks, parts = setting.campaign.robot_frequencies, []
    for i in np.unique(peaks.state):
        own = peaks.hertz[peaks.state == i]
        wider = (_modes(setting, points[int(i)], int(i), margin * float(own.max())) for margin in _MARGINS)
        try:
            modes = next((found for found in wider if len(found.hertz) >= min(own.size, 6)), None)
        except CdprError as error:
            case = setting.campaign.states.names[i]
            hint = "see whether this is the robot that was measured, and these its tensions there"
            raise CdprError(f"{setting.campaign.source}: case {case}: {error}; {hint}") from error
        if modes is None:
            raise InputError(
                setting.campaign.source, f"robot frequencies of case {setting.campaign.states.names[i]}",
                own.tolist(), f"frequencies below {_MARGINS[-1]:g} times which the model's platform has as many modes"
                " (is it this robot that was measured?)",
            )  # fmt: skip
        parts.append(modes)
    return Modes(*(np.concatenate([getattr(p, name) for p in parts]) for name in Modes.__slots__))


def _modes(setting: Setting, point: OperatingPoint, state: int, highest: float) -> Modes:
    name = "static" if setting.massless else "exact" if setting.known.sagging else "dsm"
    way = "consistent" if setting.geometric else "thesis"
    omega = 2.0 * np.pi * highest
    cables = cable_dynamics(point, name, omega, rough=True)  # type: ignore[arg-type]
    count = 6 if setting.massless else int(count_below(point, cables, np.array([omega]), way)[0]) + 3  # type: ignore[arg-type]
    found = ritz_modes(point, cables.expansion(omega), count, way)  # type: ignore[arg-type]
    modes = Modes(np.full(len(found.omega), state), found.omega / (2.0 * np.pi), found.platform, found.platform_energy)
    return modes.some(np.flatnonzero(modes.energy >= (0.0 if setting.massless else _LEAST_SHARE)))


def _followed(setting: Setting, world: World, modes: Modes) -> _Followed:
    """The modes in the closed form: its own frequency, shape and slope, and how far it is from the exact one."""
    exact = 2.0 * np.pi * modes.hertz
    rows = robot_pitch.Rows(modes.state, exact, modes.shape)
    readings = Readings.of(setting.campaign.states)
    dynamics, rise = _dynamics_and_rise(setting, world, readings, modes.state)
    gap = np.log(exact / robot_pitch.follow(dynamics, rows))
    gap = np.where(np.abs(gap) < _MOST_GAP, gap, 0.0)
    omega = robot_pitch.follow(dynamics, rows, exact * np.exp(-gap))
    matrix = dynamics.matrix(omega**2)
    scale = np.sqrt(np.abs(np.diagonal(dynamics.mass, axis1=-2, axis2=-1)))
    _, vectors = np.linalg.eigh(matrix / scale[:, :, None] / scale[:, None, :])
    best = np.abs(np.einsum("ri,rij->rj", modes.shape * scale, vectors)).argmax(axis=-1)
    shape = np.take_along_axis(vectors, best[:, None, None], axis=-1)[..., 0] / scale
    rows = robot_pitch.Rows(modes.state, omega, shape)
    return _Followed(
        rows, gap, matrix, robot_pitch.rate(dynamics, omega**2), rise, robot_pitch.nearness(dynamics, omega)
    )


def _dynamics(setting: Setting, world: World, readings: Readings, state: np.ndarray) -> robot_pitch.Dynamics:
    """D(omega) of rows at their states, the other states left out."""
    return _dynamics_and_rise(setting, world, readings, state)[0]


def _dynamics_and_rise(
    setting: Setting, world: World, readings: Readings, state: np.ndarray
) -> tuple[robot_pitch.Dynamics, np.ndarray]:
    """D(omega) of rows at their states, and (..., r, m) what sensors raise the cables' own frequencies by there."""
    some = np.unique(state)
    wide, known = world.per_state(), at_states(setting, some)
    rest, moving = resting_and_vibrating(setting, wide, readings, some)
    rise, local = raised(rest, moving), np.searchsorted(some, state)
    at = robot_pitch.Dynamics.at(wide, moving, known, local, setting.massless, setting.geometric)
    return at, np.zeros((local.size, world.cables)) if rise is None else np.take(rise, local, axis=-2)


def _covariance(setting: Setting, world: World, followed: _Followed) -> np.ndarray:
    """(k, k) of the modes' ln f by tolerances and by the noise of their states' readings."""
    readings, rows = Readings.of(setting.campaign.states), followed.rows
    off = tolerated(setting, world, STEP * np.eye(tolerance_count(setting)))
    moved = _dynamics(setting, off, readings, rows.state)
    common = robot_pitch.first_order(moved, rows, followed.matrix, followed.rate) / STEP
    noisy = _dynamics(setting, world, misread(setting, readings, reading_steps(setting)), rows.state)
    own = robot_pitch.first_order(noisy, rows, followed.matrix, followed.rate) / STEP
    together = rows.state[:, None] == rows.state[None]
    result: np.ndarray = common.T @ common + together * (own.T @ own)
    return result
