"""From a campaign to the fixed part of its residuals: which states, which rows, which modes."""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis import robot_pitch
from cdpr_struct.diagnosis.cable_pitch import cable_log_frequencies, exact_log_frequencies
from cdpr_struct.diagnosis.conditioned_state import Circumstances, Conditioned, masts_of
from cdpr_struct.diagnosis.extended_robot import robot_of
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import Labels, Setting, _States
from cdpr_struct.diagnosis.world import World
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.natural_frequencies import count_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.inverse_kinematics import inverse

_LEAST_SHARE = 0.15  # of the kinetic energy in the platform: a mode with less is not seen there
_MARGIN = 1.35
_NEIGHBOUR = 0.06  # of ln f: modes nearer than this may be taken for each other
_MOST_GAP = 0.05  # of ln f between the closed form and the exact model; beyond it they are different modes


def make_setting(campaign: Campaign) -> Setting:
    """The fixed part of a campaign's residuals.

    Raises
    ------
    InputError : a state with neither tensions nor lengths, or more robot frequencies than the model has.
    """
    states, m = campaign.states, len(campaign.robot.cables)
    if not len(states.names):
        raise InputError(campaign.source, "measurement", "no states", "static states, loaded poses or frequencies")
    campaign = _with_tensions(campaign)
    states = campaign.states
    held = np.flatnonzero(states.has_tension)
    locked = np.flatnonzero(~states.has_tension & states.has_length)
    known = circumstances(campaign)
    anchors = campaign.robot.platform_anchors
    radius = float(max(np.sqrt((anchors**2).sum(axis=1).mean()), 1e-3))
    with_length = states.has_length[held]
    null, commanded = _null_spaces(campaign, held, m)
    blank = np.zeros(0)
    setting = Setting(
        campaign, known, held, locked, with_length, null, commanded, radius, Labels(blank, blank, blank),
        campaign.cable_frequencies, np.zeros(campaign.cable_frequencies.hertz.size),
        robot_pitch.Rows(np.zeros(0, dtype=int), blank, np.zeros((0, 6))), blank, blank, blank, blank, blank,
        campaign.model == "static", campaign.assembly == "consistent",
    )  # fmt: skip
    setting = _with_frequencies(setting)
    return replace(setting, labels=_labels(setting))


def circumstances(campaign: Campaign) -> Circumstances:
    """What is known of each state without error."""
    states = campaign.states
    tension = states.tension[np.isfinite(states.tension)]
    weight = campaign.robot.platform.mass * campaign.robot.gravity
    mean = float(tension.mean()) if tension.size else weight / len(campaign.robot.cables)
    hours = (states.time - np.nanmin(states.time)) / 3600.0 if np.isfinite(states.time).any() else 0.0 * states.time
    return Circumstances(
        payload=states.payload,
        approach=np.where(np.isfinite(states.approach), states.approach, 0.0),
        hours=np.where(np.isfinite(hours), hours, 0.0),
        center=states.position.mean(axis=0),
        masts=masts_of(campaign.robot.frame_anchors),
        mean_tension=mean,
        sagging=campaign.model != "spring",
    )


def _with_tensions(campaign: Campaign) -> Campaign:
    """States known by their pose only get the simulation's tensions, with a sigma of a tenth."""
    states = campaign.states
    blind = np.flatnonzero(~states.has_tension & ~states.has_length)
    if not blind.size:
        return campaign
    tension, sigma = states.tension.copy(), states.tension_sigma.copy()
    for i in blind:
        turn = Readings.of(states).rotation[i]
        robot = campaign.robot.with_load(float(states.payload[i]))
        model = "spring" if campaign.model == "spring" else "sagging"
        computed = inverse(robot, states.position[i], turn, model).tensions
        known = np.isfinite(tension[i])
        tension[i] = np.where(known, tension[i], computed)
        sigma[i] = np.where(known, sigma[i], 0.1 * computed.mean())
    return replace(campaign, states=replace(states, tension=tension, tension_sigma=sigma))


def _null_spaces(campaign: Campaign, held: np.ndarray, m: int) -> tuple[np.ndarray, np.ndarray]:
    """Null space (held, m, q) of the structure matrix and commanded lengths (held, m), where no encoder was read."""
    states, robot, q = campaign.states, campaign.robot, max(m - 6, 0)
    null, commanded = np.zeros((len(held), m, q)), np.zeros((len(held), m))
    turn = Readings.of(states).rotation
    for k, i in enumerate(held):
        if states.has_length[i] or not q:
            continue
        arms = robot.platform_anchors @ turn[i].T
        away = robot.frame_anchors - states.position[i] - arms
        unit = away / np.linalg.norm(away, axis=1, keepdims=True)
        matrix = np.concatenate([unit, np.cross(arms, unit)], axis=1).T
        null[k] = np.linalg.svd(matrix)[2][6:].T
        model = "spring" if campaign.model == "spring" else "sagging"
        loaded = robot.with_load(float(states.payload[i]))
        commanded[k] = inverse(loaded, states.position[i], turn[i], model, allow_unheld=True).lengths
    return null, commanded


def _with_frequencies(setting: Setting) -> Setting:
    campaign = setting.campaign
    if not campaign.cable_frequencies.hertz.size and not campaign.robot_frequencies.hertz.size:
        return setting
    return anchored(setting, World.of(campaign.robot, len(campaign.states.names)), wary=True)


def anchored(setting: Setting, world: World, wary: bool = False) -> Setting:
    """The same residuals with frequencies paired and corrected by the exact model in a given world.

    wary : frequencies whose partner is ambiguous are nearly left out; for a world that may be far from the truth
    """
    campaign = setting.campaign
    wide = world.per_state()
    state = _States(setting, wide, Readings.of(campaign.states)).all
    wanted = set(campaign.cable_frequencies.state.tolist()) | set(campaign.robot_frequencies.state.tolist())
    robot = robot_of(campaign.robot, world)
    points = {int(i): _point(robot, state, i, campaign.states.payload[i]) for i in wanted}
    gap = np.zeros(campaign.cable_frequencies.hertz.size)
    if gap.size and setting.known.sagging:
        plain = replace(wide, bending_stiffness=0.0 * wide.bending_stiffness, added_mass=0.0 * wide.added_mass)
        closed = cable_log_frequencies(plain, state.cables, campaign.cable_frequencies)
        exact = exact_log_frequencies(points, campaign.cable_frequencies)
        gap = np.where(np.isfinite(exact), exact - closed, 0.0)
    setting = replace(setting, cable_gap=gap)
    if not campaign.robot_frequencies.hertz.size:
        return setting
    return _with_robot_rows(setting, wide, state, points, wary)


def _point(robot: Robot, state: Conditioned, i: int, payload: float) -> OperatingPoint:
    cables = CableStates(*(getattr(state.cables, name)[i] for name in CableStates.__slots__))
    return OperatingPoint(robot.with_load(float(payload)), state.position[i], state.rotation[i], cables)


def _with_robot_rows(
    setting: Setting, world: World, state: Conditioned, points: dict[int, OperatingPoint], wary: bool
) -> Setting:
    rows = setting.campaign.robot_frequencies
    exact, shape, doubt = np.zeros(rows.hertz.size), np.zeros((rows.hertz.size, 6)), np.zeros(rows.hertz.size)
    for i in np.unique(rows.state):
        own = np.flatnonzero(rows.state == i)
        own = own[np.argsort(rows.hertz[own])]
        hertz, shapes, energy = _modes(setting, points[int(i)], float(rows.hertz[own].max()))
        seen = np.flatnonzero(energy >= (_LEAST_SHARE if not setting.massless else 0.0))
        if seen.size < own.size:
            raise InputError(
                setting.campaign.source, f"robot frequencies of case {setting.campaign.states.names[i]}",
                rows.hertz[own].tolist(), f"at most {seen.size} in this band, where the platform moves",
            )  # fmt: skip
        chosen = seen[robot_pitch.pair_modes(rows.hertz[own], hertz[seen], energy[seen])]
        exact[own], shape[own] = 2.0 * np.pi * hertz[chosen], shapes[chosen]
        doubt[own] = _doubt(rows.hertz[own], hertz[chosen], energy[chosen], hertz[seen], wary)
    first = robot_pitch.Rows(rows.state, exact, shape)
    rigid = replace(world, frame_compliance=0.0 * world.frame_compliance, hose=0.0 * world.hose)
    massless, geometric = setting.massless, setting.geometric
    plain = robot_pitch.Dynamics.at(rigid, state, setting.known, rows.state, massless, geometric)
    gap = np.log(exact / robot_pitch.follow(plain, first))
    gap = np.where(np.abs(gap) < _MOST_GAP, gap, 0.0)
    dynamics = robot_pitch.Dynamics.at(world, state, setting.known, rows.state, massless, geometric)
    omega = robot_pitch.follow(dynamics, first, exact * np.exp(-gap))
    entered = dynamics.matrix(omega**2)
    scale = np.sqrt(np.abs(np.diagonal(dynamics.mass, axis1=-2, axis2=-1)))
    _, vectors = np.linalg.eigh(entered / scale[:, :, None] / scale[:, None, :])
    best = np.abs(np.einsum("ri,rij->rj", shape * scale, vectors)).argmax(axis=-1)
    shape = np.take_along_axis(vectors, best[:, None, None], axis=-1)[..., 0] / scale
    return replace(
        setting, robot_rows=robot_pitch.Rows(rows.state, omega, shape), robot_gap=gap, robot_doubt=doubt,
        robot_log=np.log(2.0 * np.pi * rows.hertz), entered=entered, entered_rate=robot_pitch.rate(dynamics, omega**2),
    )  # fmt: skip


def _doubt(measured: np.ndarray, chosen: np.ndarray, energy: np.ndarray, seen: np.ndarray, wary: bool) -> np.ndarray:
    """Extra noise [%] of modes in which cables take part, and of those whose partner is ambiguous."""
    mixed = 1.5 * (1.0 - energy)
    if not wary:
        return mixed
    own = np.abs(np.log(measured / chosen))
    near = (np.abs(np.log(seen[None] / measured[:, None])) < 3.0 * own[:, None] + _NEIGHBOUR).sum(axis=1) > 1
    return np.where((energy < 0.8) | near, 8.0 + 100.0 * own, mixed)


def _modes(setting: Setting, point: OperatingPoint, highest: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Frequencies [Hz], platform shapes and platform shares of the energy, somewhat beyond the highest measured."""
    name = "static" if setting.massless else "exact" if setting.known.sagging else "dsm"
    way = "consistent" if setting.geometric else "thesis"
    cables = cable_dynamics(point, name, 2.0 * np.pi * highest * _MARGIN)  # type: ignore[arg-type]
    omega = 2.0 * np.pi * highest * _MARGIN
    count = 6 if setting.massless else int(count_below(point, cables, np.array([omega]), way)[0]) + 3  # type: ignore[arg-type]
    modes = ritz_modes(point, cables.expansion(omega), count, way)  # type: ignore[arg-type]
    return modes.omega / (2.0 * np.pi), modes.platform, modes.platform_energy


def _labels(setting: Setting) -> Labels:
    m = setting.campaign.robot.platform_anchors.shape[0]
    block: list[str] = []
    state: list[int] = []
    cable: list[int] = []

    def add(name: str, states: np.ndarray, cables: list[int]) -> None:
        for i in states:
            block.extend([name] * len(cables))
            state.extend([int(i)] * len(cables))
            cable.extend(cables)

    add("EQ", setting.held, [-1] * 6)
    add("CO", setting.held[setting.with_length], list(range(m)))
    add("NS", setting.held[~setting.with_length], [-1] * setting.null_space.shape[-1])
    add("LP", setting.locked, [-1] * 6)
    for i, c in zip(setting.cable_rows.state, setting.cable_rows.cable, strict=True):
        add("CF", np.array([i]), [int(c)])
    for i in setting.robot_rows.state:
        add("RF", np.array([i]), [-1])
    return Labels(np.array(block, dtype=object), np.array(state, dtype=int), np.array(cable, dtype=int))
