"""Campaigns whose readings the ordinary commands wrote: statics, locked lengths, modes; sensors as the tables say.

The robot that wrote them and the one that is entered may differ. Where the same model writes and judges (crime=True)
this proves laws of the arithmetic, never that a diagnosis is right about a real robot.
"""

from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.generated.platform import rotation
from cdpr_struct.measurement.campaign import CableFrequencies, Campaign, RobotFrequencies, States
from cdpr_struct.observation.circumstances import exit_turns
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions, masts_of
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.tolerances import Tolerances
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse

CRIME = True
NO_CABLES = CableFrequencies(*(np.zeros(0, dtype=t) for t in (int, int, int, bool, float, float)))
NO_PEAKS = RobotFrequencies(*(np.zeros(0, dtype=t) for t in (int, float, float)))
SIGMA_TENSION, SIGMA_LENGTH, SIGMA_POSITION, SIGMA_ROTATION, SIGMA_HERTZ = 2.0, 5e-4, 5e-4, 3.5e-4, 3e-3
MASS = 0.0092  # relative: the platform's smallest detectable error in `measured`, as the diagnosis itself says
TO_SENSORS = (
    "cell_gain", "cell_bias", "friction", "bearing_friction", "pulley_drag", "backlash", "tracker", "slip", "creep",
    "sensor_mass", "accelerometer_gain",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Plan:
    """Where a robot is measured: S poses held, each also with further loads at its locked lengths.

    position, angles : (S, 3);  payload (S,) [kg];  loads : put on at the lengths of the first pose
    frequencies : states where single cables are plucked, and the robot is shaken
    """

    position: np.ndarray
    angles: np.ndarray
    payload: np.ndarray
    loads: tuple[float, ...] = ()
    cables_in: tuple[int, ...] = ()
    robot_in: tuple[int, ...] = ()
    modes: int = 12
    model: str = "exact"
    assembly: str = "consistent"


@dataclass(frozen=True, eq=False)
class _State:
    """One state of a robot as it is then: pose, tensions, encoder lengths."""

    robot: Robot
    position: np.ndarray
    rotation: np.ndarray
    tension: np.ndarray
    length: np.ndarray
    payload: float
    hours: float
    lock: int
    cables: object = field(repr=False)


def plan_of(robot: Robot, count: int, seed: int = 1, **more) -> Plan:
    """Random poses about the home pose."""
    generator = np.random.default_rng(seed)
    low, high = robot.frame_anchors.min(axis=0), robot.frame_anchors.max(axis=0)
    position = robot.home.position + 0.16 * (high - low) * generator.uniform(-1.0, 1.0, (count, 3)) * [1.0, 1.0, 0.5]
    angles = np.radians(generator.uniform(-8.0, 8.0, (count, 3)))
    return Plan(position, angles, np.resize([0.0, 10.0, 20.0], count), **more)


def extended(robot: Robot, **fields) -> Robot:
    """The robot with extensions."""
    return replace(robot, extensions=Extensions.of(len(robot.cables), fields))


def on_pulleys(name: str, radius: float) -> Robot:
    """A built-in robot whose cables run over pulleys."""
    robot = load_robot(name)
    return replace(robot, pulleys=tuple(Pulley(radius) for _ in robot.cables))


def _at_hour(robot: Robot, hours: float) -> Robot:
    """The robot after so many hours: cables crept, winches slipped, everything of sensors left out."""
    more = robot.extensions
    lag = 1.0 + more.creep * np.log10(1.0 + 60.0 * hours)
    cables = tuple(replace(cable, axial_stiffness=cable.axial_stiffness / lag) for cable in robot.cables)
    bare = replace(more.without(*TO_SENSORS), length_offset=more.length_offset + more.slip * hours)
    return replace(robot, cables=cables, extensions=bare)


def _states(robot: Robot, plan: Plan, time: np.ndarray) -> list[_State]:
    model, found = "spring" if plan.model == "spring" else "sagging", []
    for k, (place, angle, load) in enumerate(zip(plan.position, plan.angles, plan.payload, strict=True)):
        machine, turn = _at_hour(robot, time[k]).with_load(load), rotation(*angle)
        held = inverse(machine, place, turn, model)
        found.append(_State(machine, place, turn, held.tensions, held.lengths, load, time[k], k, held.cables))
    for load in plan.loads:
        hours = time[len(found)]
        found.append(_locked(_at_hour(robot, hours).with_load(load), found[0], load, hours, model))
    return found


def _locked(machine: Robot, first: _State, load: float, hours: float, model: str) -> _State:
    rest = forward(machine, first.length, first.position, first.rotation, model).require_converged()
    return _State(machine, rest.position, rest.rotation, rest.tensions, first.length, load, hours, 0, rest.cables)


def written(robot: Robot, plan: Plan, entered: Robot | None = None, seed: int = 2) -> Campaign:
    """The readings of a robot without noise; `entered` is the one to be diagnosed (default: the same)."""
    count, m = len(plan.position) + len(plan.loads), len(robot.cables)
    generator = np.random.default_rng(seed)
    time = np.sort(generator.uniform(0.0, 5.0, count))
    time[0] = 0.0
    states = _states(robot, plan, time)
    approach = generator.choice([-1.0, 1.0], (count, m))
    more = robot.extensions
    turned = Rotation.from_rotvec(np.array(more.tracker[3:])).as_matrix()
    position = np.array([turned.T @ (s.position - more.tracker[:3]) for s in states])
    matrix = np.array([turned.T @ s.rotation for s in states])
    wrap = exit_turns(robot if entered is None else entered, position, matrix)
    tension = np.array([s.tension for s in states])
    rows = States(
        names=tuple(f"s{i}" for i in range(count)), position=position,
        angles=Rotation.from_matrix(matrix).as_euler("xyz"),
        sigma_position=np.full(count, SIGMA_POSITION), sigma_rotation=np.full(count, SIGMA_ROTATION),
        payload=np.array([s.payload for s in states]),
        tension=more.cell_gain * _at_winch(more, tension, approach, wrap) + more.cell_bias,
        tension_sigma=np.full((count, m), SIGMA_TENSION),
        length=_encoders(more, np.array([s.length for s in states]), approach),
        length_sigma=np.full((count, m), SIGMA_LENGTH), lock=np.array([s.lock for s in states]),
        loaded=np.arange(count) >= len(plan.position), static=np.arange(count) < len(plan.position),
        temperature=np.full(count, np.nan), approach=approach, time=3600.0 * time,
    )  # fmt: skip
    return Campaign(
        "written", robot if entered is None else entered, robot.name, plan.model, Tolerances(), frozenset(), rows,
        _plucked(robot, plan, states), _shaken(robot, plan, states), assembly=plan.assembly,
    )  # fmt: skip


def _at_winch(more: Extensions, tension: np.ndarray, approach: np.ndarray, wrap: np.ndarray) -> np.ndarray:
    """Tensions behind the pulleys at the exits: capstan, then the balance of moments about a bearing, then drag."""
    before = tension * np.exp(more.friction * approach * wrap)
    after, turn = before, np.cos(0.5 * np.pi * wrap)
    for _ in range(60):
        carried = np.sqrt(after**2 + before**2 - 2.0 * after * before * turn)
        after = before + approach * more.bearing_friction * carried
    return after + approach * more.pulley_drag


def _encoders(more: Extensions, length: np.ndarray, approach: np.ndarray) -> np.ndarray:
    """What encoders before a drive with play say where its drum has turned by `length`, scale and zero as entered."""
    return length - 0.5 * approach * more.backlash / more.length_scale


def vibrating_point(robot: Robot, state: _State) -> OperatingPoint:
    """The state with the sensors' mass on the platform, at its locked lengths."""
    mass = robot.extensions.sensor_mass
    if not mass:
        return OperatingPoint(state.robot, state.position, state.rotation, state.cables)
    machine = state.robot.with_load(mass)
    rest = forward(machine, state.length, state.position, state.rotation).require_converged()
    return OperatingPoint(machine, rest.position, rest.rotation, rest.cables)


def _shaken(robot: Robot, plan: Plan, states: list[_State]) -> RobotFrequencies:
    """The first modes by the certified eigenproblem."""
    if not plan.robot_in:
        return NO_PEAKS
    model = "static" if plan.model == "static" else "exact"
    count = 6 if model == "static" else plan.modes
    found = [
        certified_modes(vibrating_point(robot, states[i]), model, count, plan.assembly).frequencies.hertz
        for i in plan.robot_in
    ]
    hertz = np.concatenate(found)
    return RobotFrequencies(np.repeat(plan.robot_in, count), hertz, SIGMA_HERTZ * hertz)


def _plucked(robot: Robot, plan: Plan, states: list[_State]) -> CableFrequencies:
    """The lowest two modes of every cable across its plane and in it, by bisection of the exact cables' count."""
    if not plan.cables_in:
        return NO_CABLES
    m = len(robot.cables)
    hertz = np.concatenate([clamped_hertz(vibrating_point(robot, states[i]), 4).ravel() for i in plan.cables_in])
    second = [(2, 0), (2, 1)] if any(robot.pulleys) else [(2, 1), (2, 0)]  # swivels are softer across the plane
    cable, (mode, in_plane) = np.repeat(np.arange(m), 4), np.array([(1, 0), (1, 1), *second]).T
    tiled = len(plan.cables_in)
    return CableFrequencies(
        np.repeat(plan.cables_in, 4 * m), np.tile(cable, tiled), np.tile(mode, m * tiled),
        np.tile(in_plane.astype(bool), m * tiled), hertz, SIGMA_HERTZ * hertz,
    )  # fmt: skip


def clamped_hertz(point: OperatingPoint, count: int) -> np.ndarray:
    """(m, count) lowest natural frequencies of each cable between held ends [Hz], by bisection of their count."""
    cables = cable_dynamics(point, "exact")
    high = np.repeat(cables.first_frequency[:, None] * (count + 2.0), count, axis=1)
    low, number = np.zeros_like(high), np.arange(1, count + 1)
    for _ in range(60):
        middle = 0.5 * (low + high)
        below = np.stack([cables.clamped_count(column) for column in middle.T], axis=1) < number
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return 0.5 * (low + high) / (2.0 * np.pi)


def noisy(campaign: Campaign, seed: int, factor: float = 1.0) -> Campaign:
    """The campaign with noise of the stated sigmas; states of one lock share that of their lengths."""
    generator, states = np.random.default_rng(seed), campaign.states
    _, first = np.unique(states.lock, return_inverse=True)

    def drawn(shape: tuple[int, ...]) -> np.ndarray:
        return factor * generator.normal(size=shape)

    moved = replace(
        states,
        position=states.position + drawn(states.position.shape) * states.sigma_position[:, None],
        angles=states.angles + drawn(states.angles.shape) * states.sigma_rotation[:, None],
        tension=states.tension + drawn(states.tension.shape) * states.tension_sigma,
        length=states.length + drawn(states.length.shape)[first] * states.length_sigma,
    )
    cables, robot = campaign.cable_frequencies, campaign.robot_frequencies
    return replace(
        campaign,
        states=moved,
        cable_frequencies=replace(cables, hertz=cables.hertz + drawn(cables.hertz.shape) * cables.sigma),
        robot_frequencies=replace(robot, hertz=robot.hertz + drawn(robot.hertz.shape) * robot.sigma),
    )


def mast_values(robot: Robot, sizes: np.ndarray) -> np.ndarray:
    """(m,) one value of `sizes` for all cables of a mast."""
    _, mast = np.unique(masts_of(robot.frame_anchors), axis=0, return_inverse=True)
    return np.resize(sizes, mast.max() + 1)[mast.ravel()]


@cache
def cogiro() -> Robot:
    return load_robot("cogiro")


def measured(robot: Robot, seed: int) -> Campaign:
    """Six poses and one more load at the first one's lengths; CoGiRo is entered."""
    return noisy(written(robot, plan_of(cogiro(), 6, loads=(40.0,)), cogiro()), seed)


def lighter(times_detectable: float) -> Robot:
    return cogiro().with_load(mass=cogiro().platform.mass * (1.0 - MASS * times_detectable))


def with_states(campaign: Campaign, **changed: np.ndarray) -> Campaign:
    return replace(campaign, states=replace(campaign.states, **changed))
